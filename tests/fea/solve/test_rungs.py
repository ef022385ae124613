"""One mesh of one model: all leave out the same places, and finer meshes are better."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.mesh_history import MeshHistory
from fea.core.mesh_result import MeshMaximum
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.core.verdict import evidence_of
from fea.solid.evaluate import SOLID_MESHES
from fea.solve.single_mesh import ModelMesh, Problem, result_on
from fea.solve.solve import solve_pin
from geometry import ArgumentError, CutPin, Hole, Pin, Segment
from geometry.mesh.elements import Element
from tests.support.each import sampled
from tests.support.errors import raises

SHARP = Pin("S", (Segment(0.02, 0.03), Segment(0.02, 0.02), Segment(0.02, 0.02, connection="B")))
LOAD = PinLoads("bending", ("B",), np.array([[[0.0, 500.0, 0.0]], [[0.0, 1000.0, 0.0]]]))
ALL = (
    ModelMesh("beam"),
    ModelMesh("harmonic"),
    *(ModelMesh("solid", element, -1) for element in ("linear", "straight", "curved")),
)


@pytest.mark.parametrize("rung", ALL, ids=lambda r: f"{r.model} {r.element}")
def test_no_model_reads_stress_where_it_has_no_bound(rung: ModelMesh, steel: Material) -> None:
    """Wide zones, so that the maximum of each would lie inside: the corner at z = 0.02 holds the
    largest bending moment of the thin shaft.
    """
    problem = Problem(SHARP, steel, ("start",), LOAD, distance=0.3)
    assert {p.kind for p in problem.singularities} == {
        "sharp corner", "edge of a clamp", "edge of a load",
    }  # fmt: skip
    result = result_on(problem, rung)
    x, y, z = result.location
    for singularity in problem.singularities:
        assert np.hypot(np.hypot(x, y) - singularity.r, z - singularity.z) >= singularity.radius * (
            1.0 - 1e-6
        )
    assert result.instant == 1  # where the load is twice as large
    close = result_on(Problem(SHARP, steel, ("start",), LOAD, distance=0.01), rung)
    assert close.maximum > 1.05 * result.maximum


def test_a_harmonic_rung_is_the_mesh_of_a_run(cantilever_pin: Pin, steel: Material) -> None:
    load = PinLoads("bending", ("P1",), np.array([[[0.0, 1000.0, 0.0]]]))
    problem = Problem(cantilever_pin, steel, ("start",), load)
    first = result_on(problem, ModelMesh("harmonic", level=0))
    second = result_on(problem, ModelMesh("harmonic", level=1), (first,))
    requirement = Requirement(model="harmonic", meshes=2)
    (run,) = solve_pin(cantilever_pin, steel, ("start",), (load,), requirement)
    assert [s.dofs for s in run.peak.history] == [first.unknowns, second.unknowns]
    assert [s.max_von_mises for s in run.peak.history] == [first.maximum, second.maximum]


@pytest.mark.slow
@pytest.mark.parametrize("element", sampled(["linear", "curved", "straight"], every=2))
def test_finer_solid_meshes_are_nearer_to_the_harmonic_model(
    element: Element, cantilever_pin: Pin, steel: Material
) -> None:
    """Measured from the first to the second mesh: linear 51 to 24 %, straight 22 to 11 %, curved 25
    to 7 %, the last ones with 22,000, 38,000 and 38,000 unknowns.
    """
    load = PinLoads("bending", ("P1",), np.array([[[0.0, 1000.0, 0.0]]]))
    problem = Problem(cantilever_pin, steel, ("start",), load)
    exact = result_on(problem, ModelMesh("harmonic", level=3)).maximum
    levels = (0, 3) if element == "linear" else (-1, 1)
    results = [result_on(problem, ModelMesh("solid", element, level)) for level in levels]
    coarse, fine = (abs(result.maximum / exact - 1.0) for result in results)
    assert results[0].unknowns < results[1].unknowns
    assert fine < 0.6 * coarse
    assert fine == pytest.approx(
        {"linear": 0.24, "straight": 0.11, "curved": 0.07}[element], abs=0.03
    )


@pytest.mark.slow
def test_a_pin_that_is_no_body_of_revolution_finds_its_edges_on_any_element(
    steel: Material,
) -> None:
    """The rim of the clamp is left out with linear elements too, whose sides have no nodes."""
    pin = CutPin(Pin("H", (Segment(0.06, 0.02, connection="B"),)), (Hole(0.04, 0.004),))
    problem = Problem(pin, steel, ("start",), LOAD)
    for rung in (ModelMesh("solid", "linear"), ModelMesh("solid")):
        result = result_on(problem, rung)
        x, y, z = result.location
        assert np.hypot(np.hypot(x, y) - 0.01, z) >= 0.1 * 0.02
    for rung in (ModelMesh("beam"), ModelMesh("harmonic")):
        with raises(ArgumentError, "not-axisymmetric"):
            result_on(problem, rung)


def test_stress_that_is_not_finite_has_no_verdict() -> None:
    result = MeshMaximum(900, float("nan"), 0, (0.0, 0.0, 0.0))
    with raises(SolveError, "not-finite", "pin P, case up"):
        evidence_of(MeshHistory("P", "up", "solid", (result,), (0.1,), SOLID_MESHES), ())
