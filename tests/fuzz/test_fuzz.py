"""A short hunt; the long one is `python -m tests.fuzz`."""

from __future__ import annotations

from contextlib import suppress
from functools import partial
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pinstress.units import DIMENSIONS, SYSTEMS, UNIT_NEEDED, to_si
from tests.fuzz.bodies import write_files
from tests.fuzz.hunt import break_file, hunt
from tests.fuzz.kills import kill, whole_run


@pytest.mark.slow
@pytest.mark.parametrize("first", range(1, 121, 20))
def test_broken_studies_end_with_a_message_or_a_result(tmp_path: Path, first: int) -> None:
    """Twenty mutants each, of which one is run if it can be."""
    wrong = [
        str(case)
        for seed in range(first, first + 20)
        for case in hunt(seed, tmp_path, run_too=seed == first)
        if case.end.wrong
    ]
    assert wrong == []


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("whole") / "files"
    write_files(folder)
    return folder


@pytest.mark.slow
@pytest.mark.parametrize("first", range(1, 81, 20))
def test_broken_files_end_with_a_message_or_a_result(
    tmp_path: Path, whole: Path, first: int
) -> None:
    """Tables, CAD files and meshes."""
    wrong = [
        str(case)
        for seed in range(first, first + 20)
        for case in hunt(seed, tmp_path, seed == first, partial(break_file, whole))
        if case.end.wrong
    ]
    assert wrong == []


@pytest.mark.slow
@pytest.mark.parametrize("jobs", [1, 2])
def test_a_run_that_is_ended_leaves_a_whole_folder_and_no_process(
    tmp_path: Path, jobs: int
) -> None:
    longest = whole_run(tmp_path, jobs)
    assert [k.wrong for k in (kill(seed, tmp_path, jobs, longest) for seed in range(4))] == [""] * 4


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
    dimension=st.sampled_from(sorted(DIMENSIONS)),
    system=st.sampled_from(sorted(SYSTEMS)),
)
def test_a_quantity_is_a_finite_number_or_a_sentence(
    value: object, dimension: str, system: str
) -> None:
    with suppress(ValueError):
        assert abs(to_si(value, dimension, SYSTEMS[system])) < 1e200


@settings(deadline=None)  # the first unit waits for pint
@given(
    value=st.floats(-1e6, 1e6), dimension=st.sampled_from(sorted({*DIMENSIONS} - {*UNIT_NEEDED}))
)
def test_a_number_and_the_same_number_in_words_agree(value: float, dimension: str) -> None:
    system = SYSTEMS["in-lbf-s"]
    assert to_si(repr(value), dimension, system) == to_si(value, dimension, system)
