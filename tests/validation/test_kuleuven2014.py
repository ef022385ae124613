"""P. Appeltans, P. Beerden, B. De Winter, J. Dhont, Case studie dynamica, KU Leuven (2014).

Their formulas for a spatial retracting leg (kuleuven2014_formulas.py), against the motion of
particles (kuleuven2014_truth.py). studies/kuleuven2014/errors.csv names the term in which each
formula is wrong. Tolerances are for rounding: 1e-9 of the quantity beside numerical derivatives
(Cauchy's integral, tests/support/mechanism/leg_of_particles.py), 1e-12 between closed forms; a term
counts as wrong from 1e-4 of the quantity on.
"""

from __future__ import annotations

import csv
from dataclasses import replace

import numpy as np
import pytest

from loads import leg_dynamics
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.mechanism.leg_of_particles import Floats
from tests.validation.kuleuven2014_formulas import HOLD, PRINTED, RIGHT
from tests.validation.kuleuven2014_truth import (
    NOW,
    dynamics,
    publications_instant,
    quantity,
    symbols,
    truth,
)

SEEDS = range(3)
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
    ours, found = dynamics(seed), truth(seed)
    for mine, true in (
        (ours.wheel_omega, "omega wheel"),
        (ours.wheel_alpha, "alpha wheel"),
        (ours.leg_omega, "omega leg"),
        (ours.leg_alpha, "alpha leg"),
        (ours.r_BC, "r_BC"),
        (ours.r_BD, "r_BD"),
        (ours.v_B, "v_B"),
        (ours.v_C, "v_C"),
        (ours.v_D, "v_D"),
        (ours.a_C, "a_C"),
        (ours.a_D, "a_D"),
        (ours.coriolis_C, "Coriolis"),
        (ours.p_leg, "p leg"),
        (ours.p_wheel, "p wheel"),
        (ours.L_leg, "L leg"),
        (ours.L_wheel, "L wheel"),
        (ours.L_leg_rate, "L rate leg"),
        (ours.L_wheel_rate, "L rate wheel"),
        (ours.F_B, "F_B"),
        (ours.M_B, "M_B"),
    ):
        size = np.abs(found[true]).max()
        np.testing.assert_allclose(
            ours.to_world(mine)[0], found[true], rtol=0.0, atol=1e-9 * size, err_msg=true
        )


@each("seed", SEEDS)
@each("key", HOLD)
def test_the_rest_of_the_printed_formulas_holds(key: tuple[str, str], seed: int) -> None:
    true = quantity(seed, key[1])
    assert value(HOLD[key], seed, key[1]) == pytest.approx(true, rel=1e-9)


@each("seed", SEEDS)
@each("name", RIGHT)
def test_closed_forms(name: str, seed: int) -> None:
    """Those of the publication that hold, put right; primed axes."""
    ours = getattr(dynamics(seed), name)[0]
    np.testing.assert_allclose(ours, value(RIGHT[name], seed, "'"), rtol=1e-12)


@each("seed", SEEDS)
def test_following_the_yaw_changes_what_the_publication_has(seed: int) -> None:
    """Not counted as an error, since its A may move straight: an aircraft that rolls where it
    points has -omega_g v_v along x' in every acceleration as well.
    """
    particles = publications_instant(seed)
    motion = particles.motion(np.array([NOW]))
    rolling = leg_dynamics(particles.leg, replace(motion, course_rate=motion.omega_g))
    extra = np.array([-motion.omega_g[0] * motion.v_v[0], 0.0, 0.0])
    for point in "BCD":
        change = getattr(rolling, f"a_{point}") - getattr(dynamics(seed), f"a_{point}")
        assert change[0] == pytest.approx(extra, abs=1e-12)
