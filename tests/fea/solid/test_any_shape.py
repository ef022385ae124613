"""Pins that are no bodies of revolution, and the same pin from a profile, a CAD file and a mesh."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.peak import ErrorParts
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.core.voigt import von_mises
from fea.solid.field import SolidField
from fea.solid.model import SolidModel, acting
from fea.solid.superposition import envelope
from fea.solve.solve import solve_pin
from geometry import CutPin, Flat, Hole, Pin, PinLike, Segment
from geometry.imported.body_file import BodyFile, Place
from geometry.imported.imported_pin import SolidBody
from geometry.imported.meshing import solid_mesh
from geometry.mesh.solid_mesh import MeshSize
from tests.support.each import each
from tests.support.pins.pin_files import MM, write_mesh, write_step
from tests.support.pins.unit_loads import forces

IN_MM = Pin("P", (Segment(20.0, 30.0), Segment(40.0, 20.0)), fillet=5.0)
PROFILE = Pin(
    "P",
    (Segment(0.02, 0.03), Segment(0.02, 0.02), Segment(0.02, 0.02, connection="B")),
    fillet=0.005,
)
LOAD = PinLoads("case", ("B",), np.array([[[0.0, 1000.0, 0.0]]]))
FINE = MeshSize(across=6.0, arc=4.0)


def peak(pin: PinLike, material: Material, size: MeshSize) -> float:
    model = SolidModel(pin, solid_mesh(pin, size, (0.04, 0.06)), material, ("start",))
    fields = model.solve(acting([LOAD]))
    return envelope(replace(fields, revolved=True), LOAD).maximum  # the mean over directions


@cache
def peak_of_profile(material: Material) -> float:
    """Once for both kinds of file."""
    return peak(PROFILE, material, FINE)


@pytest.mark.slow
@each("kind", ["step", "vtk"])
def test_a_file_of_a_pin_has_its_peak(kind: str, steel: Material, tmp_path: Path) -> None:
    """To 1 %, with both turned about the axis, because one direction scatters by as much."""
    path = tmp_path / f"pin.{kind}"
    if kind == "step":
        write_step(IN_MM, path)
    else:
        write_mesh(solid_mesh(PROFILE, FINE, (0.04, 0.06)), path)
    body = SolidBody(BodyFile("P", path, MM, (Place("B", (0.04, 0.06)),)))
    size = FINE if kind == "step" else MeshSize()
    assert peak(body, steel, size) == pytest.approx(peak_of_profile(steel), rel=1e-2)


@pytest.mark.long
@pytest.mark.slow
def test_a_small_cross_hole_in_tension_trebles_the_stress(steel: Material) -> None:
    """A hole of a tenth of the diameter. Kirsch: 3 at a hole in a wide plate; a hole across a round
    bar of d/D = 0.1 is a little above that on the gross section near the surface (Peterson, chart
    4.94: K_tg = 3.0 to 3.2; the largest stress is just below the surface, in the depth), and what
    mesh and recovery leave is 5 %. So 2.9 to 3.4. A quarter turn from there, on the loaded line,
    it is compression of about the nominal stress.
    """
    bar = Pin("P", (Segment(0.04, 0.02), Segment(0.01, 0.02, connection="B")))
    pin = CutPin(bar, (Hole(0.02, 0.002, 0.3),))
    model = SolidModel(pin, solid_mesh(pin, MeshSize(across=6.0, corner=1.0)), steel, ("start",))
    fields = model.solve(forces("B", along=(2,)))
    nominal = 1.0 / (math.pi * 0.01**2)
    x = fields.space.nodes
    across = np.array([-math.sin(0.3), math.cos(0.3), 0.0])
    near = np.hypot(x @ across, x[:, 2] - 0.02) < 0.0011
    stress = fields.stress[near, :, 0]
    assert 2.9 < von_mises(stress).max() / nominal < 3.4
    side = np.abs(x[near, 2] - 0.02) < 0.0002
    assert stress[side, 2].max() / nominal == pytest.approx(von_mises(stress).max() / nominal, 0.1)
    loaded = np.abs(x[near] @ across) < 0.0001
    a, b, _ = across
    pressed = stress[loaded] @ np.array([a * a, b * b, 0.0, 0.0, 0.0, 2.0 * a * b])
    assert -1.3 < np.median(pressed) / nominal < -0.7


def test_forces_on_a_cut_band_act_at_its_middle(steel: Material) -> None:
    """A flat on one side takes away area and centroid, not the load's resultants: the clamp carries
    exactly the force, and its moment about the origin.
    """
    bar = Pin("P", (Segment(0.02, 0.02), Segment(0.02, 0.02, connection="B")))
    pin = CutPin(bar, (Flat(0.025, 0.045, 0.007, 0.4),))
    case = PinLoads("case", ("B",), np.array([[[30.0, 40.0, 50.0]]]), np.array([0.0, 0.0, 2.0]),
                    distribution="cosine")  # fmt: skip
    model = SolidModel(pin, solid_mesh(pin, MeshSize(across=3.0)), steel, ("start",))
    fields = model.solve(acting([case]))
    assert not fields.revolved
    support = fields.support @ fields.coefficients(case)[0]
    expected = [-30.0, -40.0, -50.0, 0.03 * 40.0, -0.03 * 30.0, -2.0]
    assert support == pytest.approx(np.array(expected), abs=1e-6)
    assert envelope(fields, case).scatter == 0.0


def on_rim(point: tuple[float, float, float]) -> float:
    """Distance (m) from the rims of a hole of 6 mm along x through a bar of 20 mm at z = 10 mm."""
    a = 2.0 * math.pi * np.arange(2000) / 2000
    y, z = 0.003 * np.cos(a), 0.01 + 0.003 * np.sin(a)
    x = np.sqrt(0.01**2 - y**2)
    return float(min(np.linalg.norm(np.stack([s * x, y, z], 1) - point, axis=1).min()
                     for s in (1.0, -1.0)))  # fmt: skip


def test_a_pin_may_be_held_by_a_hole(steel: Material) -> None:
    """By a cross pin, say; its rim is the edge of a clamp."""
    bar = Pin("P", (Segment(0.03, 0.02), Segment(0.02, 0.02, connection="B")))
    pin = CutPin(bar, (Hole(0.01, 0.006),))
    case = PinLoads("case", ("B",), np.array([[[0.0, 0.0, 1000.0]]]))
    (found,) = solve_pin(pin, steel, ("hole 1",), (case,), Requirement(0.5, meshes=1))
    peak = found.peak
    assert (peak.model, peak.verdict) == ("solid", "singular")
    (zone,) = peak.singular_at
    assert (zone.kind, zone.between) == ("the edge of a clamp", ("the body", "its clamp"))
    assert zone.governs
    assert "model the hub" in zone.advice
    assert zone.excluded == pytest.approx(0.1 * 0.02, rel=1e-3)
    assert zone.max_von_mises > (peak.max_von_mises or math.inf)
    assert on_rim(zone.location) < zone.excluded
    assert peak.location is not None
    assert on_rim(peak.location) > zone.excluded
    assert isinstance(found.answer, SolidField)
    fields = found.answer.solution.fields
    force = fields.support @ fields.coefficients(case)[0]
    assert force[:3] == pytest.approx([0.0, 0.0, -1000.0], abs=1e-6)


def test_a_body_that_nothing_holds_closes_its_balance(steel: Material, tmp_path: Path) -> None:
    """Three bands on a file's bar, wherever its z begins; a peak where a flat's step is sharp is
    no value.
    """
    bar = Pin("P", tuple(Segment(0.02, 0.02, connection=c) for c in "ABC"))
    pin = CutPin(bar, (Flat(0.025, 0.035, 0.004, math.pi / 2),))
    solid = solid_mesh(pin, MeshSize(across=2.5, corner=1.0), (0.02, 0.04))
    solid.mesh.doflocs[2] -= 0.1
    path = write_mesh(solid, tmp_path / "bar.vtk")
    places = tuple(Place(c, (0.02 * i - 0.1, 0.02 * (i + 1) - 0.1)) for i, c in enumerate("ABC"))
    body = SolidBody(BodyFile("P", path, MM, places))
    load = PinLoads("case", ("A", "B", "C"), np.array([[[0, -500.0, 0], [0, 1000.0, 0],
                                                        [0, -480.0, 0]]]))  # fmt: skip
    (found,) = solve_pin(body, steel, (), (load,), Requirement(0.05, meshes=1))
    assert found.peak.verdict == "singular"
    assert found.peak.reasons == ("too-few-meshes", "no-error-known", "imbalance-reacted",
                                  "not-axisymmetric", "mesh-limit")  # fmt: skip
    assert found.peak.parts == ErrorParts(found.peak.max_von_mises or 0.0)
    assert found.peak.interval is not None
    assert found.peak.interval[0] == 0.0
    assert found.peak.imbalance == pytest.approx((0.02, 0.02 / 3.0), rel=1e-3)
    (zone,) = found.peak.singular_at
    assert zone.governs
    step = np.array([-0.075, -0.065])  # where the flat ends
    assert np.abs(zone.location[2] - step).min() <= zone.excluded
    assert zone.excluded == pytest.approx(0.1 * 0.02, rel=1e-3)
    assert isinstance(found.answer, SolidField)
    assert np.abs(found.answer.solution.fields.support).max() < 1e-6
