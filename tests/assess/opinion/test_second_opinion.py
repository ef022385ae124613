"""A second opinion: when it differs, that failures are reported, and what CalculiX itself says."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from assess.opinion import calculix
from assess.opinion.calculix_compare import compared_nodes, second_opinions
from assess.opinion.opinions import Opinion
from fea.core.material import Material
from fea.core.model import MeshProblem
from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.solid.evaluate import solid_solution
from fea.solve.solve import solve_pin
from geometry import CutPin, Flat, Pin, Segment
from geometry.mesh.solid_mesh import MeshSize
from tests.support.pins import calculix_stand_in

AGREED = Opinion("P", "up", 100.0, 5.0, 900, 1e-7, 1e-5, 95.0, 95.0)
FORCES = np.array([[[0.0, 1e3, 0.0]], [[0.0, -2e3, 500.0]]])
STUB = Pin("P", (Segment(0.01, 0.02), Segment(0.005, 0.02, connection="P1")))
UP = PinLoads("up", ("P1",), FORCES)
FIRST = UP.at(np.array([0]))


def test_what_is_beyond_its_limit_is_complained_of() -> None:
    assert AGREED.complaint == ""
    assert AGREED.deviation == pytest.approx(-0.05)
    told = {
        "displacements on the same mesh differ by 1.0e-03, allowed 1e-05": {"displacement": 1e-3},
        "von Mises stresses on the same mesh differ by 2.0e-02, allowed 1e-04": {"stress": 0.02},
        "its maximum is +36.0% from the answer, allowed 35.0%": {"theirs": 136.0},
        "ccx failed": {"failure": "ccx failed"},
    }
    for complaint, change in told.items():
        assert replace(AGREED, **change).complaint == complaint  # type: ignore[arg-type]
    assert replace(AGREED, theirs=134.0).complaint == ""
    assert "nan" in replace(AGREED, stress=float("nan")).complaint


def test_a_failure_of_calculix_is_in_the_opinion(
    steel: Material, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "ccx").write_text("#!/bin/sh\necho '*ERROR in nonsense'\n")
    (tmp_path / "ccx").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    peak = Maximum("P", "up", "beam", "converged", "", 1e8, 1e6, governing=FIRST)
    (opinion,) = second_opinions(STUB, steel, ("start",), (UP,), (peak,), 0.1)
    assert opinion.complaint == "ccx failed: *ERROR in nonsense"
    assert opinion.theirs is None


def test_a_pin_that_is_not_held_has_no_opinion(cantilever_pin: Pin, steel: Material) -> None:
    peak = Maximum("P", "up", "auto", "rigid", "nothing holds it")
    assert second_opinions(cantilever_pin, steel, (), (UP,), (peak,), 0.1) == ()


@pytest.fixture
def stand_in(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(calculix, "run", calculix_stand_in.run)


@pytest.mark.usefixtures("stand_in")
def test_another_program_on_our_deck_agrees_on_a_clamped_pin(steel: Material) -> None:
    """To 1e-6 of displacements and 1e-5 of stresses, of which so many digits are written; at the
    instant that is asked for, whichever model answered.
    """
    peaks = (
        Maximum("P", "up", "harmonic", "converged", "", 5e6, 1e6, governing=UP.at(np.array([1]))),
        Maximum("P", "again", "solid", "converged", "", 5e6, 1e6, governing=FIRST),
    )
    cases = (UP, replace(UP, case="again"))
    opinions = second_opinions(STUB, steel, ("start",), cases, peaks, 0.1)
    for one in opinions:
        assert one.displacement is not None
        assert one.stress is not None
        assert one.displacement < 1e-6
        assert one.stress < 1e-5
        assert one.ours == pytest.approx(one.theirs, rel=1e-5)
    full, half = (one.theirs or 0.0 for one in opinions)
    assert 0.4 * full < half < 0.6 * full  # half the force, and no push along


@pytest.mark.usefixtures("stand_in")
def test_another_program_agrees_on_a_pin_that_nothing_holds(steel: Material) -> None:
    pin = Pin("P", tuple(Segment(0.005, 0.02, connection=c) for c in "ABC"))
    forces = np.array([[[0.0, 1e3, 0.0], [0.0, -2e3, 0.0], [0.0, 1e3, 0.0]]])
    loads = PinLoads("up", ("A", "B", "C"), forces)
    peak = Maximum("P", "up", "harmonic", "converged", "", 1.5e7, 1e6, governing=loads)
    (one,) = second_opinions(pin, steel, (), (loads,), (peak,), 0.1)
    assert one.displacement is not None
    assert one.displacement < 2e-6
    assert one.ours == pytest.approx(one.theirs, rel=1e-5)


def test_what_no_longer_is_a_body_of_revolution_is_read_on_its_surface(steel: Material) -> None:
    """Of a pin with a flat no section tells which nodes inside lie in a singular place."""
    plain = Pin("P", (Segment(0.01, 0.02, connection="P1"),))
    pin = CutPin(plain, (Flat(0.004, 0.01, 0.008),))
    solution = solid_solution(MeshProblem(pin, steel, ("start",), (UP,)), MeshSize(2.0))
    surface = set(solution.fields.surface.nodes.tolist())
    read = set(compared_nodes(solution).tolist())
    excluded = surface - read
    assert read < surface
    x = solution.fields.space.nodes[list(excluded)]
    near_rim = np.hypot(np.hypot(x[:, 0], x[:, 1]) - 0.01, x[:, 2]) < 0.0025
    near_step = np.abs(x[:, 2] - 0.004) < 0.0025
    assert (near_rim | near_step).all()
    assert near_rim.any()
    assert near_step.any()


def test_nodes_that_are_missing_are_told(steel: Material, monkeypatch: pytest.MonkeyPatch) -> None:
    def short(folder: Path) -> str:
        calculix_stand_in.write(folder, np.zeros((5, 3)), np.zeros((5, 6)))
        return "Total CalculiX Time: 0.5\n"

    monkeypatch.setattr(calculix, "run", short)
    peak = Maximum("P", "up", "harmonic", "converged", "", 1e8, 1e6, governing=FIRST)
    (one,) = second_opinions(STUB, steel, ("start",), (UP,), (peak,), 0.1)
    assert one.complaint.startswith("ccx did not write results for all ")


@pytest.mark.peers
def test_calculix_agrees_on_a_clamped_pin(cantilever_pin: Pin, steel: Material) -> None:
    """At the governing instant, the second."""
    (solved,) = solve_pin(cantilever_pin, steel, ("start",), (UP,), Requirement(0.05, "harmonic"))
    assert solved.instant == 1
    (opinion,) = second_opinions(cantilever_pin, steel, ("start",), (UP,), (solved.peak,), 0.1)
    assert opinion.complaint == ""
    assert opinion.ours == pytest.approx(opinion.theirs, rel=1e-4)
    other = replace(solved.peak, governing=FIRST)
    (opinion,) = second_opinions(cantilever_pin, steel, ("start",), (UP,), (other,), 0.1)
    assert "its maximum is -5" in opinion.complaint  # half the force


@pytest.mark.peers
def test_calculix_agrees_on_a_pin_that_nothing_holds(steel: Material) -> None:
    pin = Pin(
        "P",
        (
            Segment(0.02, 0.02, connection="A"),
            Segment(0.02, 0.02, connection="B"),
            Segment(0.02, 0.02, connection="C"),
        ),
    )
    forces = np.array([[[0.0, 1e3, 0.0], [0.0, -2e3, 0.0], [0.0, 1e3, 0.0]]])
    loads = PinLoads("up", ("A", "B", "C"), forces, distribution="cosine")
    (solved,) = solve_pin(pin, steel, (), (loads,), Requirement(0.05))
    (opinion,) = second_opinions(pin, steel, (), (loads,), (solved.peak,), 0.1)
    assert opinion.complaint == ""
    assert opinion.displacement is not None
    assert opinion.displacement < 2e-6
