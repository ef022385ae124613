"""A short hunt; the long one is `python -m tests.fuzz`."""

from __future__ import annotations

import re
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pinstress import load_study
from pinstress.cli.check import examine
from pinstress.study.reading.errors import InputError
from pinstress.study.schema.units import (
    DIMENSION_EXPONENTS,
    DIMENSIONS_NEEDING_UNIT,
    UNIT_SYSTEMS,
    to_si,
)
from tests.fuzz import grammar
from tests.fuzz.kills import kill, whole_run
from tests.support.each import sampled

ROOT = Path(__file__).parents[2]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "first", "count"),
    [
        ("mutants", 1, 10),
        ("files", 1, 8),
        pytest.param("mutants", 11, 430, marks=pytest.mark.long),
        pytest.param("files", 9, 122, marks=pytest.mark.long),
    ],
)
def test_broken_input_ends_with_a_message_or_a_result(kind: str, first: int, count: int) -> None:
    """Studies; tables, CAD files and meshes. From a process of its own, which forks: here other
    tests have left threads, beside which a forked gmsh waits for ever.
    """
    command = [sys.executable, "-m", "tests.fuzz", f"--{kind}", f"{count}", "--seed", f"{first}"]
    done = subprocess.run(
        [*command, "--runs", "20"], cwd=ROOT, capture_output=True, text=True, timeout=3600
    )
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]


@pytest.mark.parametrize(
    ("first", "count"),
    [
        (1, 1),  # one of each kind takes half a minute
        pytest.param(2, 127, marks=[pytest.mark.slow, pytest.mark.long]),
    ],
)
def test_valid_studies_have_results(first: int, count: int) -> None:
    """Drawn by a grammar; `python -m tests.fuzz grammar` draws others. What is refused or fails
    must be so for a reason that is listed there.
    """
    command = [sys.executable, "-m", "tests.fuzz", "grammar", "--count", f"{count}"]
    command += ["--seed", f"{first}"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=3600)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]


@pytest.mark.slow
@pytest.mark.parametrize("first", [1, 26, 51, 76])
def test_valid_studies_are_accepted(first: int, tmp_path: Path) -> None:
    """As `check` does, which computes their loads and shapes: none is refused without a reason that
    is listed in the grammar, and no pin is unheld. To solve them takes a quarter of an hour.
    """
    refused = {}
    for seed in range(first, first + 25):
        (folder := tmp_path / f"{seed}").mkdir()
        try:
            found = examine(load_study(grammar.draw(seed).write(folder))).unheld
        except InputError as error:
            found = [str(error)]
        if found and not any(re.search(reason, found[0]) for reason in grammar.REASONS):
            refused[seed] = found[0]
    assert refused == {}


@pytest.mark.slow
@pytest.mark.parametrize("jobs", sampled([1, 2], every=2, first=1))
def test_a_run_that_is_ended_leaves_a_whole_folder_and_no_process(
    tmp_path: Path, jobs: int
) -> None:
    longest = whole_run(tmp_path, jobs)
    assert [k.wrong for k in (kill(seed, tmp_path, jobs, longest) for seed in range(3))] == [""] * 3


UNITS = st.lists(
    st.sampled_from(
        ["m", "in", "lb", "psi", "N", "s", "deg", "*", "/", "^", "2", "-", "(", ")", " "]
    )
)


@settings(deadline=None)  # the first unit waits for pint
@given(
    value=st.one_of(
        st.text(),
        st.floats(),
        st.integers(),
        st.none(),
        st.booleans(),
        st.builds(lambda x, unit: f"{x} {''.join(unit)}", st.floats(), UNITS),
    ),
    dimension=st.sampled_from(sorted(DIMENSION_EXPONENTS)),
    system=st.sampled_from(sorted(UNIT_SYSTEMS)),
)
def test_a_quantity_is_a_finite_number_or_a_sentence(
    value: object, dimension: str, system: str
) -> None:
    with suppress(ValueError):
        assert abs(to_si(value, dimension, UNIT_SYSTEMS[system])) < 1e200


@settings(deadline=None)  # the first unit waits for pint
@given(
    value=st.floats(-1e6, 1e6),
    dimension=st.sampled_from(sorted({*DIMENSION_EXPONENTS} - {*DIMENSIONS_NEEDING_UNIT})),
)
def test_a_number_and_the_same_number_in_words_agree(value: float, dimension: str) -> None:
    system = UNIT_SYSTEMS["in-lbf-s"]
    assert to_si(repr(value), dimension, system) == to_si(value, dimension, system)
