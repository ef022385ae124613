"""Edits drawn at random: what is drawn, how rows are compared, and a small run."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

import pinstress
from benchmarks.runs.edits import STUDIES, _difference, _draws, edits
from pinstress.study.reading.in_python import changed_study
from tests.support.each import each, sampled


def test_every_kind_of_edit_is_drawn_and_makes_a_valid_study() -> None:
    rng, kinds = np.random.default_rng(1), set()
    for name in STUDIES:
        study = pinstress.load_study(pinstress.shipped_studies()[name])
        for kind, draws in _draws(study).items():
            kinds.add(kind)
            if kind == "material":  # another one, which the benchmark adds to the study
                continue
            change = draws[int(rng.integers(len(draws)))](rng)
            changed = changed_study(study, {change.key: change.value})
            assert changed.table != study.table, change.key
            assert change.pin in study.table.pin
    sizes = {"clearance", "gap", "diameter", "length"}
    loads = {"load", "small load", "impulse time"}
    assert kinds == sizes | loads | {"strength", "range of strength", "material"}


@each(
    ("one", "other", "apart"),
    [
        ({"a": [1.0, 2.0], "seconds": 3.0}, {"a": [1.0, 2.0], "seconds": 4.0}, 0.0),
        ({"a": [1.0, 2.0]}, {"a": [1.0, 2.5]}, 0.2),
        ({"a": 1.0}, {"b": 1.0}, math.inf),
        ([1.0], [1.0, 1.0], math.inf),
        ("safe", "fails", math.inf),
        (0.0, -1e-30, 1.0),
    ],
)
def test_the_difference_of_rows(one: object, other: object, apart: float) -> None:
    assert _difference(one, other) == pytest.approx(apart)
    assert _difference(other, one) == pytest.approx(apart)


@pytest.mark.slow
@pytest.mark.parametrize("studies", sampled([["one_pin"], ["one_pin", "clevis"]], every=2))
def test_a_small_run(studies: list[str]) -> None:
    """Every full answer is that of a run, every quick one within its error."""
    text = edits(8, studies)
    found = re.search(r"(\d+) of (\d+) full rows differ .* and (\d+) quick rows", text)
    assert found is not None, text
    assert int(found[2]) >= 6
    assert (found[1], found[3]) == ("0", "0")
    assert text.count("| --- |") >= 2  # times, and differences from runs
