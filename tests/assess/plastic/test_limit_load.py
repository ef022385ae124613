"""The elastic-plastic solid against limit loads in closed form, and what its numerics promise."""

import math

import numpy as np
import pytest

from assess.plastic import path
from assess.plastic.body import FlowingBody, untied
from assess.plastic.flow import FlowRule
from assess.plastic.limit_load import bracket, limit_on_mesh
from assess.plastic.mechanism import isochoric, upper_bound, work_of_flow
from assess.plastic.pin_body import acting_at, hexahedral, nodal_forces, pin_body, plane_of, refine
from assess.plastic.solve import TETRAHEDRA_NOTE, body_on, flow_field, limit_load
from fea.core.material import Material
from fea.core.pin_loads import LoadAmounts, PinLoads, UnitLoad
from fea.core.tractions import tractions_of
from geometry import CutPin, Hole, Pin, Segment
from geometry.mesh.hexahedra import HexSize, hexahedra
from pinbase.arrays import Floats
from tests.support.exact.plastic import (
    RULE,
    STEEL,
    YIELD,
    D,
    bar,
    couples,
    cylinder,
    elastic_moment,
    limit,
)

Points = tuple[tuple[float, float], ...]

COARSE, FINE = HexSize(2, 0.5), HexSize(4, 0.25)


def test_the_face_of_a_shoulder_has_its_whole_force() -> None:
    pin = Pin("p", (Segment(1.0, 2.0), Segment(2.0, 3.0), Segment(1.0, 2.0)))
    for name, force in (("shoulder 1", 7.0), ("shoulder 2", -4.0)):
        loads = PinLoads("axial", (name,), np.array([[[0.0, 0.0, force]]]))
        mesh = hexahedra(pin, FINE, 4)
        elements = hexahedral(mesh.nodes, mesh.elements)
        total = nodal_forces(pin, RULE, mesh, elements, acting_at(loads, 0)).sum(axis=0)
        assert total == pytest.approx([0.0, 0.0, force], rel=1e-3, abs=1e-9)


@pytest.mark.parametrize("hardening", [(), ((0.02, 400e6),)])
def test_patch_of_distorted_elements_flows_uniformly(
    hardening: Points,
) -> None:
    """The displacement of a uniform strain past yield leaves no force inside, and one stress."""
    mesh = hexahedra(Pin("p", (Segment(D, D), Segment(D, 1.5 * D))), COARSE)
    elements = hexahedral(mesh.nodes, mesh.elements)
    rule = FlowRule(Material("steel", 200e9, 0.3, None, YIELD, hardening=hardening))
    body = FlowingBody(elements, untied(len(mesh.nodes)), rule)
    strain = np.array([[4e-3, 1e-3, 0.0], [1e-3, -2e-3, 5e-4], [0.0, 5e-4, -1e-3]])
    flow = body.flow((mesh.nodes @ strain).ravel(), body.at_rest())
    assert np.ptp(flow.stress, axis=(0, 1)).max() < 1e-9 * YIELD
    assert flow.equivalent.min() > 1e-3
    forces = body.forces(flow.stress).reshape(-1, 3)
    x, y, z = mesh.nodes.T
    ends = (z < 1e-9) | (np.abs(z - D) < 1e-9) | (z > 2 * D - 1e-9)
    inside = ~ends & (np.hypot(x, y) < 0.45 * D)
    assert inside.sum() > 20
    assert np.abs(forces[inside]).max() < 1e-10 * np.abs(forces).max()


@pytest.mark.parametrize("part", [0.95, 1.1])
def test_newton_converges_quadratically(monkeypatch: pytest.MonkeyPatch, part: float) -> None:
    """Each residual is below three times the square of the one before, down to round-off."""
    monkeypatch.setattr(path, "RESIDUAL_TOLERANCE", 1e-10)
    made = pin_body(bar(), RULE, (), acting_at(couples(1), 0), COARSE)
    along = path.EquilibriumPath(made.body, made.forces)
    work = part * along.compliance * 1.7 * elastic_moment()
    found = along.step(along.start(), None, work)
    assert (found.flow.equivalent > 0.0).mean() > 0.1
    late = np.array([r for r in found.residuals if r < 0.5])
    assert len(late) >= 3
    assert (late[1:] < np.maximum(3.0 * late[:-1] ** 2, 1e-10)).all()


def test_thick_cylinder_in_plane_strain() -> None:
    exact = 2.0 / math.sqrt(3.0) * YIELD * math.log(1.3)
    assert exact == pytest.approx(75.7380e6, rel=1e-5)
    found = limit_on_mesh(*cylinder(2))
    assert found.reached == pytest.approx(exact, rel=5e-3)
    assert exact * (1.0 - 1e-4) <= found.above.factor <= 1.004 * exact
    elastic = found.curve.permanent < 1e-9 * found.curve.displacement
    assert elastic.any()  # loaded, and nothing remains: not the round-off of the solution
    assert not found.curve.permanent[elastic].any()


def test_the_upper_bound_holds_for_mechanisms_whose_volume_changes() -> None:
    """Without the charge swelling mechanisms have too low bounds: pressure is for free there."""
    exact = 2.0 / math.sqrt(3.0) * YIELD * math.log(1.3)
    body, forces, more = cylinder(2)
    found = limit_on_mesh(body, forces, more)
    increment, stress = found.last.unknowns, found.last.flow.stress
    radius = np.hypot(*body.elements.nodes.T[:2])[body.ties.first // 3]
    uncharged = []
    for part in (0.0, 0.02, -0.02, 0.1, -0.1):
        swollen = increment * (1.0 + part * (radius - 1.0) / 0.3)
        uncharged.append(work_of_flow(body, more.elements, swollen) / (forces @ swollen))
        bound = upper_bound(body, forces, more, swollen, stress)
        assert bound.factor >= exact * (1.0 - 1e-4)  # of arcs that are parabolas
    assert min(uncharged) < 0.99 * exact


def test_a_mechanism_loses_its_change_of_volume_and_keeps_its_power() -> None:
    made = pin_body(bar(0.5), RULE, (), acting_at(couples(1), 0), COARSE)
    fine = refine(made.body.elements).elements
    found = limit(bar(0.5), couples(1), COARSE).last.unknowns
    other = isochoric(made.body, made.forces, fine, found)
    assert made.forces @ other == pytest.approx(made.forces @ found, rel=1e-9)

    def changed(u: Floats) -> float:
        each = np.abs(fine.volume_change(made.body.displacement(u)))
        return float((each * fine.weights).sum())

    assert changed(other) < 0.5 * changed(found)


@pytest.mark.parametrize(("bore", "shape"), [(0.0, 1.69765), (0.5, 1.58448)])
def test_bars_in_bending(bore: float, shape: float) -> None:
    found = limit(bar(bore), couples(1), COARSE)
    exact = shape * elastic_moment(bore)
    assert found.reached == pytest.approx(exact, rel=1e-2)
    assert exact <= found.above.factor <= 1.02 * exact


@pytest.mark.slow
def test_bar_in_torsion() -> None:
    found = limit(bar(), couples(2), COARSE)
    elastic = YIELD / math.sqrt(3.0) * math.pi / 16 * D**3
    assert found.reached == pytest.approx(4.0 / 3.0 * elastic, rel=1e-2)
    assert found.above.factor == pytest.approx(4.0 / 3.0 * elastic, rel=1e-2)


def _cantilever() -> tuple[Pin, PinLoads]:
    pin = Pin("p", (Segment(2 * D, D), Segment(0.5 * D, D, connection="a")))
    force = 1e3 * np.array([[[1.0, 0.0, 0.0]]])
    return pin, PinLoads("c", ("a",), force)


def test_part_of_a_turn_stands_for_the_whole() -> None:
    """A quarter, a half by reflection, a half by a turn, and all of it give one answer."""
    pin, loads = _cantilever()
    turned = loads.turned(-0.4)
    # an axial force a millionth as large forbids what rests on odd harmonics
    axial = np.array([0.0, 0.0, 0.01])
    tiny = PinLoads("c", ("a",), loads.forces + axial)
    both = PinLoads("c", ("a",), turned.forces + axial)
    found = []
    for case, quarters in ((loads, 1), (tiny, 2), (turned, 2), (both, 4)):
        made = pin_body(pin, RULE, ("start",), acting_at(case, 0), COARSE)
        assert made.sector.quarters == quarters
        along = path.EquilibriumPath(made.body, made.forces)
        energy = along.compliance * 4 / quarters
        *_, last = along.steps(along.compliance * np.array([2.0, 5.0, 9.0]))
        found.append((energy, last.factor))
    assert found[1] == pytest.approx(found[0], rel=1e-4)
    assert found[2] == pytest.approx(found[0], rel=5e-3)  # turned against the mesh
    assert found[3] == pytest.approx(found[2], rel=1e-4)


@pytest.mark.long
@pytest.mark.slow
def test_finer_meshes_stay_within_the_bracket() -> None:
    pin, loads = _cantilever()
    meshes = [limit(pin, loads, f, ("start",)) for f in (COARSE, FINE, HexSize(6, 0.125))]
    lower, upper = bracket(meshes[:2])
    assert upper / lower < 1.07  # a hundredth of it for equilibrium of whole elements alone
    assert lower <= meshes[2].reached <= upper
    assert lower <= meshes[2].above.factor <= upper
    lower, upper = bracket(meshes[1:])
    assert upper / lower < 1.06


@pytest.mark.slow
def test_fillets_hardly_change_the_limit_load() -> None:
    """A shaft clamped by its head: at most by as much as the arm of its bending gets shorter."""
    parts = Segment(0.5 * D, 1.5 * D), Segment(2 * D, D), Segment(0.5 * D, D, connection="a")
    loads = _cantilever()[1]
    found = [
        limit(Pin("p", parts, fillet=fillet), loads, FINE, ("start",)).reached
        for fillet in (0.01 * D, 0.0, 0.05 * D, 0.2 * D)
    ]
    ratios = np.array(found) / found[0]
    assert ratios[1] == pytest.approx(1.0, abs=0.015)  # its mesh has no small elements there
    assert 1.0 < ratios[2] < 1.0 + 0.05 / 2.25
    assert ratios[2] < ratios[3] < 1.0 + 0.2 / 2.25


def test_unloading_leaves_nothing_of_an_elastic_pin_and_something_of_a_flowing_one() -> None:
    pin, loads = _cantilever()
    found = limit(pin, loads, COARSE, ("start",))
    curve = found.curve
    assert curve.permanent[1] < 1e-9 * curve.displacement[1]
    assert 0.0 < found.permanent_at(0.9 * found.reached) < found.permanent_at(0.97 * found.reached)
    assert (np.diff(curve.displacement) > 0.0).all()


def test_pins_that_need_tetrahedra_are_refused_with_the_reason() -> None:
    pin, loads = _cantilever()
    cut = CutPin(pin, (Hole(D, D / 4.0),))
    found = limit_load(cut, STEEL, ("start",), loads)
    assert (found.method, found.note) == ("none", TETRAHEDRA_NOTE)


def test_the_field_of_flow_is_in_the_axes_of_the_pin() -> None:
    """A cantilever pushed aslant: it moves that way, flows near the clamp and not at the end."""
    pin, loads = _cantilever()
    aslant = loads.turned(0.4)
    made = body_on(pin, RULE, ("start",), aslant, COARSE)
    found = limit_on_mesh(made.body, made.forces, refine(made.body.elements))
    field = flow_field(made, found.last, 0.4)
    tip = field.displacement[field.points[:, 2].argmax()]
    assert math.atan2(tip[1], tip[0]) == pytest.approx(0.4, abs=1e-2)
    near, far = field.points[:, 2] < 0.5 * D, field.points[:, 2] > 2.0 * D
    assert field.plastic_strain[near].max() > 1e-3
    assert field.plastic_strain[far].max() < 1e-4
    assert field.factor == pytest.approx(found.reached, rel=1e-2)
    assert field.von_mises.max() == pytest.approx(YIELD, rel=0.2)


def test_hardening_raises_the_limit_to_that_of_the_last_stress() -> None:
    pin, loads = bar(), couples(1)
    hard = FlowRule(Material("steel", 200e9, 0.3, None, YIELD, hardening=((1e-3, 1.2 * YIELD),)))
    made = pin_body(pin, hard, (), acting_at(loads, 0), COARSE)
    found = limit_on_mesh(made.body, made.forces, refine(made.body.elements))
    assert found.reached == pytest.approx(1.2 * 1.69765 * elastic_moment(), rel=2e-2)


def test_pressures_of_contact_are_loads_like_others() -> None:
    """A cosine pressure on rings that are cut from a band, aslant, and the band's own."""
    force = 1e3 * np.array([[[0.6, 0.8, 0.0]]])
    band = PinLoads("c", ("a",), force, distribution="cosine")
    whole = Pin("p", (Segment(2 * D, D), Segment(0.5 * D, D, connection="a")))
    rings = tuple(Segment(0.25 * D, D, connection=name) for name in "ab")
    cut = Pin("p", (Segment(2 * D, D), *rings))
    on_rings = {}
    for unit, both in band.coefficients().items():
        size = -float(tractions_of(whole, unit)[0].mean[0])
        on_rings[UnitLoad("", "pressure", unit.n, (("a", size), ("b", size)))] = both
    found = []
    for pin, loads in ((whole, band), (cut, LoadAmounts("c", on_rings, 1))):
        turned = acting_at(loads, 0, -plane_of(loads, 0))
        made = pin_body(pin, RULE, ("start",), turned, COARSE)
        assert (made.sector.quarters, made.sector.mirror) == (2, True)
        found.append(path.EquilibriumPath(made.body, made.forces).compliance)
    assert found[1] == pytest.approx(found[0], rel=1e-2)
