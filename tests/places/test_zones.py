"""The zone of a singularity is its own field, never the fillet or groove beside it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import skfem
from hypothesis import given, settings
from hypothesis import strategies as st

from assess.derivatives.derivatives import Adjoint
from assess.derivatives.records import SolvedCase
from benchmarks.joints.named_pins import even_pull
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.core.zone import DISTANCE_VARIATIONS
from fea.harmonic.section_solution import SectionProblem, harmonic_solution
from fea.singular.singularities import find_singularities, free_of_arcs, singularities_of
from fea.solid.sharp_edges import SharpEdges
from fea.solve.solve import solve_pin
from fea.support.support import Solution
from geometry import Arc, CutPin, GeometryError, Hole, Pin, Segment, meridian
from geometry.mesh.outline_motion import DIFFERENCE_STEPS
from geometry.mesh.section_mesh import meridian_mesh
from geometry.mesh.sizing import SectionSize, Spot
from geometry.shape.dimensions import dimensions
from pinbase.arrays import Floats

D, FORCE, NU, E = 0.02, 1e5, 0.3, 205e9
WITHIN = 0.03  # of what is read in the fillet: the requirement; found: 0.5 %
FINE = SectionSize(3.0, 24.0, 0.35)


def tension(pin: Pin, clamp: str, at: float, band: str) -> dict[str, float]:
    """Largest von Mises stress of each of the pin's arcs, Pa, by second-order triangles of
    scikit-fem for axial force alone, on a mesh graded to a millionth of the diameter at the
    singular z and to 24 elements along the arcs. Nothing of the program's but the mesh.
    """
    made = meridian_mesh(pin, FINE, [Spot(D / 2.0, at, 1e-5 * D, 0.1 * D)])
    mesh, element = made.mesh, skfem.ElementVector(skfem.ElementTriP2())
    shear = E / (2.0 * (1.0 + NU))
    bulk = 2.0 * shear * NU / (1.0 - 2.0 * NU)
    sides = {tuple(pair): k for k, pair in enumerate(np.sort(mesh.facets.T, axis=1).tolist())}

    def facets(name: str) -> np.ndarray:
        pairs = np.sort(made.edges[name][:, :2], axis=1).tolist()
        return np.array([sides[tuple(pair)] for pair in pairs])

    def strain(u: Any, r: Floats) -> tuple[Floats, ...]:
        return u.grad[0, 0], u[0] / r, u.grad[1, 1], u.grad[0, 1] + u.grad[1, 0]

    def energy(u: Any, v: Any, w: Any) -> Any:
        a, b = strain(u, w.x[0]), strain(v, w.x[0])
        straight = sum(x * y for x, y in zip(a[:3], b[:3], strict=True))
        all_round = bulk * sum(a[:3]) * sum(b[:3])
        return w.x[0] * (all_round + 2.0 * shear * straight + shear * a[3] * b[3])

    loaded = pin.band(band)
    traction = FORCE / (2.0 * math.pi * loaded.radius * loaded.length)
    on_band = skfem.FacetBasis(mesh, element, facets=facets(band))
    load = skfem.LinearForm(lambda v, w: w.x[0] * traction * v[1]).assemble(on_band)
    basis = skfem.Basis(mesh, element, intorder=4)
    stiffness = skfem.BilinearForm(energy).assemble(basis)
    held = basis.get_dofs(facets(clamp)).all()
    axis = basis.get_dofs(lambda x: np.abs(x[0]) < 1e-12).all("u^1")
    fixed = np.unique(np.concatenate([held, axis]))
    u = skfem.solve(*skfem.condense(stiffness, load, D=fixed))
    out = {}
    for name in made.edges:
        if "fillet" in name:
            read = skfem.FacetBasis(mesh, element, facets=facets(name), intorder=4)
            rr, tt, zz, rz = strain(read.interpolate(u), read.global_coordinates()[0])
            first, second, third = (bulk * (rr + tt + zz) + 2.0 * shear * x for x in (rr, tt, zz))
            square = (first - second) ** 2 + (second - third) ** 2 + (third - first) ** 2
            out[name] = float(np.sqrt(0.5 * square + 3.0 * (shear * rz) ** 2).max())
    return out


def solved(pin: Pin, clamp: str, band: str, steel: Material, distance: float) -> Solution:
    loads = even_pull(band, FORCE)
    material = replace(steel, youngs_modulus=E, poisson_ratio=NU)
    return solve_pin(pin, material, (clamp,), (loads,), Requirement(distance=distance))[0]


def shoulder(gap: float, radius: float) -> Pin:
    """A shaft that is held on its surface up to a gap before a fillet, both in diameters."""
    held, shaft = Segment(D, D, name="held"), Segment((gap + radius) * D, D, name="shaft")
    return Pin("C", (held, shaft, Segment(0.03, 1.5 * D, connection="L")), radius * D)


@pytest.mark.parametrize(("gap", "radius"), [(0.15, 0.1), (0.05, 0.04)])
def test_a_clamps_edge_beside_a_fillet(gap: float, radius: float, steel: Material) -> None:
    """At the usual distance, and at one of half a diameter, the fillet is the maximum, to the
    requirement; with one that is shorter than the gap the rim may be more, never less. As a ball of
    a tenth of the diameter and its double, both were cut away: 0.05 d gave -24 %.
    """
    pin = shoulder(gap, radius)
    fillet = tension(pin, "held", D, "L")["fillet 2"]
    for distance in (0.1, 0.5):
        peak = solved(pin, "held", "L", steel, distance).peak
        assert peak.max_von_mises == pytest.approx(fillet, rel=WITHIN)
        assert peak.verdict == "singular"
        assert peak.interval is not None
        assert peak.interval[0] == pytest.approx(fillet, rel=WITHIN)  # twice ends at the fillet
    close = solved(pin, "held", "L", steel, 0.01).peak
    assert (close.max_von_mises or 0.0) > (1.0 - 0.01) * fillet


def test_a_sharp_corner_beside_a_fillet(steel: Material) -> None:
    """A shaft between a sharp shoulder and one with a fillet, 0.05 d from the corner."""
    ends = Segment(0.02, 1.5 * D, name="held"), Segment(0.03, 1.5 * D, connection="L")
    shaft = Segment(0.09 * D, D, name="shaft", fillet=0.04 * D)
    pin = Pin("S", (ends[0], shaft, ends[1]))
    fillet = tension(pin, "held", 0.02, "L")["fillet 2"]
    (corner,) = (p for p in find_singularities(pin, ("held",), (), NU) if p.kind == "sharp corner")
    assert corner.radius == pytest.approx(0.05 * D)
    for distance in (0.1, 0.5):
        peak = solved(pin, "held", "L", steel, distance).peak
        assert peak.lower_end > (1.0 - WITHIN) * fillet
        assert peak.max_von_mises == pytest.approx(fillet, rel=WITHIN)


def test_an_edge_of_a_load_beside_a_groove(steel: Material) -> None:
    """A uniform traction up to 0.005 d before a groove 0.02 d deep. With the largest distance, a
    tenth of half a diameter would leave the groove out.
    """
    deep, gap = 0.02 * D, 0.005 * D
    groove = Segment(3.0 * deep, D - 2.0 * deep, name="groove", fillet=deep)
    shaft, rim = Segment(D, D, name="shaft", fillet=deep), Segment(gap, D, name="rim")
    pin = Pin("G", (Segment(D, D, name="held"), shaft, groove, rim, Segment(D, D, connection="L")))
    arcs = tension(pin, "held", D, "L")
    peak = solved(pin, "held", "L", steel, 0.5).peak
    (load,) = (zone for zone in peak.singular_at if zone.kind == "the edge of a load")
    assert load.excluded == pytest.approx(gap)
    assert peak.max_von_mises == pytest.approx(max(arcs.values()), rel=WITHIN)
    assert math.dist((peak.location or (0.0,))[2:], (2.0 * D + 2.0 * deep,)) < deep


@pytest.mark.slow
def test_a_clamps_edge_beside_a_hole(steel: Material) -> None:
    """0.05 d apart: the edge of the hole is the maximum whether a tenth or a fifth of the diameter
    is left out, of which the fifth would leave out the hole's worst point.
    """
    segments = Segment(D, D, name="held"), Segment(1.5 * D, D), Segment(D, D, connection="L")
    pin = CutPin(Pin("H", segments), (Hole(1.15 * D, 0.2 * D),))
    loads = PinLoads("t", ("L",), np.array([[[0.0, 0.0, FORCE]]]))
    found = []
    for distance in (0.1, 0.2):
        requirement = Requirement(distance=distance, meshes=2)
        peak = solve_pin(pin, steel, ("held",), (loads,), requirement)[0].peak
        found.append(peak.max_von_mises)
        assert [zone.excluded for zone in peak.singular_at][1] == pytest.approx(0.05 * D)
        assert peak.location is not None
        assert peak.location[2] == pytest.approx(1.15 * D, abs=0.01 * D)
    assert found[0] == pytest.approx(found[1], rel=WITHIN)


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.sampled_from([1.0, 1.1, 1.5]), min_size=3, max_size=5),
    st.floats(0.01, 0.3),
    st.sampled_from([0.0, 0.01, 0.05]),
    st.sampled_from([0.01, 0.1, 0.5]),
)
def test_no_zone_reaches_into_an_arc(
    diameters: list[float], length: float, radius: float, distance: float
) -> None:
    """Points of arcs, as a mesh has them, are in no zone nor in its double, but for a quarter of
    the radius of one that begins at the singularity or nearly so.
    """
    names = [f"s{k}" for k in range(len(diameters))]
    segments = (Segment(length, d, name=n) for d, n in zip(diameters, names, strict=True))
    try:
        pin = Pin("H", tuple(segments), fillet=radius)
    except GeometryError:
        return
    arcs = [e for e in meridian(pin) if isinstance(e, Arc) and e.turn < 0.0]
    for p in find_singularities(pin, (names[0],), (names[-1],), NU, distance):
        nominal = distance * 2.0 * p.r * (0.1 if p.kind == "edge of a load" else 1.0)
        assert p.radius <= nominal
        for arc in arcs:
            turn = np.linspace(0.0, arc.turn, 400)
            c, s = np.cos(turn), np.sin(turn)
            x, y = arc.start[0] - arc.centre[0], arc.start[1] - arc.centre[1]
            r, z = arc.centre[0] + c * x - s * y, arc.centre[1] + s * x + c * y
            away = float(np.hypot(r - p.r, z - p.z).min())
            for times in (1.0, *DISTANCE_VARIATIONS):
                allowed = max(away, 0.25 * arc.radius)
                assert p.varied(times).radius <= allowed * (1.0 + 1e-4)
        if not any(p.limit < 2.0 * nominal for _ in arcs):
            assert p.radius == pytest.approx(nominal)
            assert p.varied(2.0).radius == pytest.approx(2.0 * nominal)


def test_zones_do_not_depend_on_what_is_loaded() -> None:
    """Cases of a pin share their zones: one load's edge shortens none of another's."""
    pin = Pin("Z", tuple(Segment(0.001, D, name=name, connection=name) for name in "ABCD"))
    alone = find_singularities(pin, ("A",), (), NU)
    assert set(alone) < set(find_singularities(pin, ("A",), ("C",), NU))


def test_zones_of_solids_end_at_the_fillets_of_their_profile() -> None:
    """Points along a clamp's edge, 0.05 d from a fillet, and far from any."""
    pin = shoulder(0.05, 0.04)
    free = free_of_arcs(pin, np.array([D / 2.0, D / 2.0]), np.array([D, 0.0]))
    assert free == pytest.approx([0.05 * D, 1.05 * D])
    points = np.array([[D / 2.0, 0.0, D]])
    edges = SharpEdges(np.zeros((0, 3)), points, np.array([D / 2.0]), free[:1])
    read = np.array([[D / 2.0, 0.0, D + x * D] for x in (0.04, 0.06, 0.15)])
    for distance in (0.1, 0.2):
        ((zone, within),) = edges.singularities(read, distance)
        assert zone.radius == pytest.approx(0.05 * D)
        assert within.tolist() == [True, False, False]


def test_a_zone_moves_with_the_fillet_that_ends_it(steel: Material) -> None:
    """Zones on pins with a dimension a little larger or smaller, as derivatives have them, are
    those that are found on such pins: one as large as the diameter says, one up to a fillet.
    """
    pin = Pin("C", (Segment(D, D, name="held"), *shoulder(0.05, 0.1).segments[1:]), 0.1 * D)
    clamps, loads = ("held",), PinLoads("t", ("L",), np.array([[[0.0, 1e3, 0.0]]]))
    zones = singularities_of(pin, steel, clamps, (loads,))
    assert {zone.radius < zone.limit for zone in zones} == {True, False}
    section = harmonic_solution(SectionProblem(pin, steel, clamps, (loads,), zones), 0, 1.0)
    of = Adjoint(SolvedCase(pin, steel, clamps, loads, section, zones))
    for dimension in dimensions(pin):
        motion = of.outline_nodes.motion(dimension)
        velocity = of.interior.velocity(motion.velocity[:, :, None])[:, :, 0]
        for x, moved in zip(DIFFERENCE_STEPS, motion.pins, strict=True):
            found = of._places_at(moved, x * motion.step, velocity)
            there = singularities_of(moved, steel, clamps, (loads,))
            expected = [[p.r, p.z, p.radius] for p in there]
            assert found == pytest.approx(np.array(expected), rel=1e-6, abs=1e-12)
