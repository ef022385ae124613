"""Derivatives of a pin in contact by forces and clearances."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fea.asked import Asked
from fea.derivatives.derivatives import Adjoint
from fea.derivatives.in_lugs import joint_derivatives, of_pressures
from fea.derivatives.records import SolvedCase
from fea.harmonic.evaluate import HarmonicAnswer
from fea.joint.solve_in_lugs import InLugs, solve_in_lugs
from tests.fea.test_solve_in_lugs import LUGS, PIN, STEADY, STEEL


def test_forces_and_clearances_together_are_the_stress() -> None:
    """All of both s times as large: pressures and stress as well. And by a clearance it is as by
    differences with other contact, by a force across what is symmetric it is none.
    """
    lugs = tuple(replace(lug, tilt=math.inf, clearance=1e-5) for lug in LUGS)
    (made,) = solve_in_lugs(InLugs(PIN, STEEL, lugs, (STEADY,)), Asked(0.1))
    solution, links, model = made.solution, made.solution.peak.governing, made.model
    answer = solution.answer
    assert isinstance(answer, HarmonicAnswer)
    assert made.rings is not None
    assert links is not None
    assert model is not None
    loads = solution.loads.at(np.array([solution.instant]))
    solved = SolvedCase(made.rings, STEEL, (), loads, answer.solution, answer.singularities)
    ours = joint_derivatives(solved, model, links)
    assert ours.maximum == pytest.approx(solution.peak.max_von_mises, rel=1e-12)
    forces = sum(
        x * float(links.forces[0, links.surfaces.index(c), "xy".index(axis)])
        for (c, axis), x in ours.by_force.items()
    )
    loose = sum(1e-5 * x for x in ours.by_clearance.values())
    assert len(ours.by_force) == 6
    assert len(ours.by_clearance) == 3
    assert forces + loose == pytest.approx(ours.maximum, rel=1e-8)
    for c in "LMR":
        assert abs(ours.by_force[c, "y"]) < 1e-6 * abs(ours.by_force[c, "x"])
    adjoint, stress = Adjoint(solved), []
    for more in (1e-7, -1e-7):
        other = model.varied(tuple(replace(x, clearance=x.clearance + more) for x in model.lugs))
        waves = model.waves(other.pressed(links))[:, 0]
        stress.append(of_pressures(adjoint, model.rings, waves))
    assert sum(ours.by_clearance.values()) == pytest.approx(
        (stress[0] - stress[1]) / 2e-7, rel=0.02
    )
