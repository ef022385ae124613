"""P. Appeltans, P. Beerden, B. De Winter, J. Dhont, Case studie dynamica, KU Leuven (2014).

Their formulas for a spatial retracting leg (kuleuven2014_formulas.py), against the motion of
particles (kuleuven2014_truth.py). studies/kuleuven2014/errors.csv names the term in which each
formula is wrong. Tolerances are for rounding: 1e-9 of the quantity beside numerical derivatives
(Cauchy's integral, tests/support/mechanism/leg_of_particles.py), 1e-11 beside closed forms; a term
counts as wrong from 1e-4 of the quantity on.
"""

from __future__ import annotations

import csv
from dataclasses import replace

import numpy as np
import pytest

from tests.conftest import ROOT
from tests.support.each import each
from tests.support.mechanism.leg_in_space import quantities
from tests.support.mechanism.leg_of_particles import Floats
from tests.validation.kuleuven2014_formulas import HOLD, PRINTED, RIGHT
from tests.validation.kuleuven2014_truth import (
    NOW,
    ours,
    publications_instant,
    quantity,
    symbols,
    truth,
)

SEEDS = range(3)
QUANTITIES = ("omega", "alpha", "p", "L", "L rate")
TABLE = ROOT / "studies" / "kuleuven2014" / "errors.csv"


def errors() -> list[dict[str, str]]:
    return list(csv.DictReader(TABLE.read_text().splitlines()))


def value(formula: str, seed: int, name: str) -> Floats:
    """A formula of the table or of PRINTED as a number."""
    return np.asarray(eval(formula, symbols(seed, primed="'" in name)))


def test_the_list_is_complete() -> None:
    """One whole formula for every row, and no row twice."""
    keys = [(row["equation"], row["quantity"]) for row in errors()]
    assert sorted(keys) == sorted(PRINTED)
    assert all(row["why"] for row in errors())


@each("seed", SEEDS)
@each("row", errors())
def test_the_printed_formula_is_off_by_the_named_term(row: dict[str, str], seed: int) -> None:
    name = row["quantity"]
    whole = value(PRINTED[row["equation"], name], seed, name)
    true = quantity(seed, name)
    wrong, right = value(row["printed"], seed, name), value(row["right"], seed, name)
    size = max(np.abs(true).max(), np.abs(whole).max())
    assert np.abs(whole - true).max() > 1e-4 * size
    np.testing.assert_allclose(whole - true, wrong - right, rtol=0.0, atol=1e-9 * size)


@each("seed", SEEDS)
def test_ours_are_the_true_ones(seed: int) -> None:
    """At the publication's own instant: world axes, heading 0, A's path straight."""
    (mine, to_world), found = ours(seed), truth(seed)
    names = ["r_BC", "r_BD", "v_C", "v_D", "a_C", "a_D", "F_B", "M_B"]
    names += [f"{what} {body}" for body in ("leg", "wheel") for what in QUANTITIES]
    for name in names:
        size = np.abs(found[name]).max()
        vector = to_world @ mine[name]
        np.testing.assert_allclose(vector, found[name], rtol=0.0, atol=1e-9 * size, err_msg=name)
    coriolis, true = to_world @ mine["coriolis_C"], found["Coriolis"]
    np.testing.assert_allclose(coriolis, true, rtol=0.0, atol=1e-9 * np.abs(true).max())


@each("seed", SEEDS)
@each("key", HOLD)
def test_the_rest_of_the_printed_formulas_holds(key: tuple[str, str], seed: int) -> None:
    true = quantity(seed, key[1])
    # One of the components is zero, or round-off of the others.
    assert value(HOLD[key], seed, key[1]) == pytest.approx(true, rel=1e-9, abs=1e-12)


@each("seed", SEEDS)
@each("name", RIGHT)
def test_closed_forms(name: str, seed: int) -> None:
    """Those of the publication that hold, put right; primed axes."""
    mine = ours(seed)[0][{"wheel_omega": "omega wheel"}.get(name, name)]
    right = value(RIGHT[name], seed, "'")
    np.testing.assert_allclose(mine, right, rtol=0.0, atol=1e-11 * np.abs(right).max())


@each("seed", SEEDS)
def test_following_the_yaw_changes_what_the_publication_has(seed: int) -> None:
    """Not counted as an error, since its A may move straight: an aircraft that rolls where it
    points has -omega_g v_v along x' in every acceleration as well.
    """
    motion = publications_instant(seed).motion(np.array([NOW]))
    rolling = quantities(replace(publications_instant(seed), follow=1.0), NOW)[0]
    extra = np.array([-motion.omega_g[0] * motion.v_v[0], 0.0, 0.0])
    for point in "CD":
        change = rolling[f"a_{point}"] - ours(seed)[0][f"a_{point}"]
        assert change == pytest.approx(extra, abs=1e-9)
