"""The solid model against beam theory, superposition, balance, and what must be refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

from assess.opinion.cantilever import cantilever
from fea.core.equilibrium import out_of_balance
from fea.core.material import Material
from fea.core.model import MeshProblem
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.singular.singularities import find_singularities
from fea.solid.evaluate import solid_result, solid_solution
from fea.solid.field import SolidField
from fea.solid.model import SolidModel
from fea.solve.solve import solve_pin
from geometry import Pin, Segment
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from tests.support.pins.solid_line import axial_stress
from tests.support.pins.unit_loads import forces

LONG = Pin("long", (Segment(0.10, 0.02), Segment(0.02, 0.02, connection="B")))


def test_a_long_cantilever_bends_as_beams_do(steel: Material) -> None:
    """Mid-span, five diameters long: axial stress within 1 % (recovery on a mesh of 5 elements
    across), tip deflection within 2 % of Timoshenko's with kappa = 6(1+nu)/(7+6nu) for the circle
    (the clamp also hinders the root's lateral contraction, which theory does not).
    """
    force = 1000.0
    model = SolidModel(LONG, solid_mesh(LONG, MeshSize(across=5.0)), steel, ("start",))
    fields = model.solve(forces("B", along=(1,)))
    z = np.linspace(0.03, 0.08, 11)
    found = axial_stress(fields, np.array([force]), 0.01, -math.pi / 2, z)
    assert found == pytest.approx(cantilever(LONG, {"B": force}, z).stress, rel=1e-2)

    inertia, area, nu = math.pi / 4 * 0.01**4, math.pi * 0.01**2, steel.poisson_ratio
    kappa = 6 * (1 + nu) / (7 + 6 * nu)
    _, mu = steel.lame
    a, L = 0.10, 0.12
    w = force / (L - a)
    bending = w * (L**4 / 8 - (a**4 / 8 + a**3 * (L - a) / 6)) / (steel.youngs_modulus * inertia)
    shear = w * (L**2 - a**2) / 2 / (kappa * mu * area)
    tip = np.abs(fields.space.nodes - [0.0, 0.0, L]).sum(axis=1).argmin()
    deflection = fields.displacement[tip, 1, 0] * force
    assert deflection == pytest.approx(bending + shear, rel=2e-2)


def test_beam_forces_are_those_of_the_diagrams() -> None:
    pin = Pin("P", (Segment(1.0, 2.0), Segment(2.0, 2.0, connection="B"), Segment(0.5, 3.0)))
    found = cantilever(pin, {"B": 10.0}, np.array([0.0, 1.0, 2.0, 3.0, 3.4]))
    assert found.shear == pytest.approx([10.0, 10.0, 5.0, 0.0, 0.0])
    assert found.moment == pytest.approx([20.0, 10.0, 2.5, 0.0, 0.0])
    assert found.stress[:3] == pytest.approx(np.array([20.0, 10.0, 2.5]) / (math.pi / 4))


def test_a_pin_that_nothing_holds_needs_loads_in_balance(steel: Material) -> None:
    """Three bands, load in the middle: solved when in balance, refused when not nearly so."""
    pin = Pin("P", tuple(Segment(0.02, 0.02, connection=c) for c in "ABC"))
    balanced = np.array([[[0.0, -500.0, 0.0], [0.0, 1000.0, 0.0], [0.0, -500.0, 0.0]]])
    lop = balanced.copy()
    lop[0, 0, 1] = -300.0
    cases = tuple(PinLoads(n, ("A", "B", "C"), f) for n, f in (("ok", balanced), ("lop", lop)))
    ok, refused = solve_pin(pin, steel, (), cases, Requirement(0.5, model="solid", meshes=2))
    assert refused.peak.verdict == "rigid"
    assert refused.peak.max_von_mises is None
    assert refused.peak.reasons == ("force-imbalance",)
    left = out_of_balance(pin, cases[1])
    assert (left.force, left.couple, left.largest) == pytest.approx((200.0, 4.0, 1000.0))
    # against beam theory: three-point bending by bands of 20 mm, M = F/2 * 20 mm - w * 5 mm^2 / ...
    moment = 500.0 * 0.02 - 1000.0 / 0.02 * 0.01**2 / 2
    assert refused.answer is None
    assert isinstance(ok.answer, SolidField)
    fields = ok.answer.solution.fields
    (c,) = fields.coefficients(cases[0])
    stress = axial_stress(fields, c, 0.01, math.pi / 2, np.array([0.03]))[0]
    # a short beam (three diameters): local effects of the bands, a tenth of the bending stress
    assert stress == pytest.approx(moment * 0.01 / (math.pi / 4 * 0.01**4), rel=0.12)


def test_stresses_do_not_depend_on_where_rigid_motions_are_removed(
    steel: Material, monkeypatch: pytest.MonkeyPatch
) -> None:
    pin = Pin("P", tuple(Segment(0.02, 0.02, connection=c) for c in "ABC"))
    mesh = solid_mesh(pin, MeshSize(across=2.0))
    units = forces("A", "B", "C", along=(1,))
    force = np.array([-500.0, 1000.0, -500.0])
    one = SolidModel(pin, mesh, steel, ())
    other = SolidModel(pin, mesh, steel, ())
    nodes = one.space.nodes
    far = [int(np.linalg.norm(nodes - x, axis=1).argmin()) for x in
           ([0, 0, 0], [0, 0, 0.06], [0.01, 0, 0.03])]  # fmt: skip
    fixed = [3 * far[0], 3 * far[0] + 1, 3 * far[0] + 2, 3 * far[1], 3 * far[1] + 1, 3 * far[2] + 1]
    assert set(fixed) != set(one.fixed.tolist())
    other.__dict__["fixed"] = np.sort(fixed)
    s = [m.solve(units).stress @ force for m in (one, other)]
    assert np.abs(s[0] - s[1]).max() < 1e-9 * np.abs(s[0]).max()


@pytest.mark.slow
def test_a_sharp_corner_and_a_clamp_edge_are_singular(steel: Material) -> None:
    """As Williams has it; outside of them the solid's surface is on the harmonic model's to 5 %.
    The sections, which no zone swallows, may govern (32 M / (pi d^3) at the shoulder).
    """
    pin = Pin("P", (Segment(0.02, 0.03), Segment(0.02, 0.02, connection="B")))
    load = PinLoads("case", ("B",), np.array([[[0.0, 1000.0, 0.0]]]))
    requirement = Requirement(0.2, model="solid", meshes=3)
    peak, exact = (
        solve_pin(pin, steel, ("start",), (load,), a)[0].peak
        for a in (requirement, Requirement(0.2, model="harmonic"))
    )
    assert (peak.model, exact.model) == ("solid", "harmonic")
    for found in (peak, exact):
        assert found.verdict == "singular"
        rim, corner = found.singular_at
        assert (rim.kind, corner.kind) == ("the edge of a clamp", "a sharp corner")
        assert rim.governs
        assert corner.governs
        assert (rim.excluded, corner.excluded) == pytest.approx((0.003, 0.002))
        # Williams: lambda = 0.5445 at three quarters free, 0.7112 at a quarter with one side held
        assert rim.exponent_theory == pytest.approx(1.0 - 0.7112, abs=1e-4)
        assert corner.exponent_theory == pytest.approx(1.0 - 0.5445, abs=1e-4)
        assert found.places is not None
        x, y, z = found.places.surface.location
        r = math.hypot(x, y)
        assert math.hypot(r - 0.01, z - 0.02) > 0.999 * 0.002
        assert math.hypot(r - 0.015, z) > 0.999 * 0.003
    for inside, zone in zip(peak.singular_at, exact.singular_at, strict=True):
        assert inside.exponent is not None
        assert inside.exponent > 0.2  # it grows with every mesh, how fast is known to no more
        assert zone.exponent == pytest.approx(zone.exponent_theory, abs=0.05)
    solid, harmonic = peak.places, exact.places
    assert solid is not None
    assert harmonic is not None
    assert solid.surface.max_von_mises == pytest.approx(harmonic.surface.max_von_mises, rel=0.05)
    nominal = 32.0 * 10.0 / (math.pi * 0.02**3)
    for found in (peak, exact):
        assert found.places is not None
        assert found.places.section is not None
        assert found.places.section.max_von_mises == pytest.approx(nominal, rel=1e-9)


@pytest.mark.long
@pytest.mark.slow
def test_a_fillet_converges(cantilever_pin: Pin, steel: Material) -> None:
    """Bending of a shoulder fillet, D/d = 1.5, r/d = 0.25 (so h/r = 1): Peterson's Kt is 1.41 for
    the largest principal stress, and von Mises is below that. The peak must lie between the nominal
    stress where it is and 1.41 times the nominal stress at the shoulder, where the moment is
    larger; and the estimate must cover the difference from a finer mesh.
    """
    load = PinLoads("case", ("P1",), np.array([[[0.0, 1000.0, 0.0]]]))
    (coarse,) = solve_pin(
        cantilever_pin, steel, ("start",), (load,), Requirement(0.05, model="solid")
    )
    assert coarse.peak.verdict == "converged", coarse.peak.note
    size = MeshSize().finer(2.0)
    singularities = find_singularities(cantilever_pin, ("start",), ("P1",), steel.poisson_ratio)
    problem = MeshProblem(cantilever_pin, steel, ("start",), (load,), singularities)
    fine = solid_result(solid_solution(problem, size), {}, 2.0, load)
    a, b = coarse.peak.max_von_mises, fine.maximum
    assert a is not None
    assert coarse.peak.error_estimate is not None
    assert abs(a - b) <= coarse.peak.error_estimate
    z = np.array([fine.location[2], 0.02])
    M = cantilever(cantilever_pin, {"P1": 1000.0}, z).moment
    here, shoulder = M * 0.01 / (math.pi / 4 * 0.01**4)
    assert 0.02 < z[0] < 0.025
    assert here < b < 1.41 * shoulder
