"""Pins of any size: gmsh and OpenCASCADE get them in a unit that fits their tolerances."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from geometry import CutPin, Flat, Hole, Pin, Segment
from geometry.imported.meshing import solid_mesh
from geometry.mesh.gmsh_session import MeshError, gmsh_model
from geometry.mesh.section_mesh import SectionSize, Spot, meridian_mesh
from geometry.mesh.solid_mesh import MeshSize
from tests.support.each import each
from tests.support.errors import raises

PIN = Pin(
    "P",
    (Segment(1.0, 1.5, bore=0.3), Segment(2.0, 1.0, bore=0.3, connection="B")),
    fillet=0.125,
)

CUT = CutPin(PIN, (Hole(2.0, 0.25, 0.3), Flat(2.5, 3.0, 0.4, 1.0)))
MICROMETRE, KILOMETRE = 2.0**-20, 2.0**10


@each("unit", [MICROMETRE, 2.0**-6, KILOMETRE])
def test_a_section_is_the_same_to_the_last_bit(unit: float) -> None:
    spot = Spot(0.75, 0.0, 0.01, 0.1)
    one = meridian_mesh(PIN, SectionSize(), [spot])
    other = meridian_mesh(PIN.scaled(unit), SectionSize(), [spot.scaled(unit)])
    assert np.array_equal(other.mesh.doflocs, one.mesh.doflocs * unit)
    assert {k: v.tolist() for k, v in one.edges.items()} == {
        k: v.tolist() for k, v in other.edges.items()
    }


@cache
def surfaces(pin: Pin | CutPin) -> set[str]:
    return set(solid_mesh(pin, MeshSize(across=2.0)).mesh.boundaries)


@pytest.mark.parametrize("unit", [MICROMETRE, KILOMETRE])
@pytest.mark.parametrize("pin", [PIN, CUT], ids=["turned", "cut"])
def test_a_solid_of_any_size_is_meshed(unit: float, pin: Pin | CutPin) -> None:
    small = pin.scaled(unit)
    mesh = solid_mesh(small, MeshSize(across=2.0)).mesh
    assert mesh.doflocs[2].max() == pytest.approx(3.0 * unit, rel=1e-9)
    assert set(mesh.boundaries) == surfaces(pin)
    assert small.volume == pytest.approx(pin.volume * unit**3, rel=1e-6)


def test_whatever_gmsh_raises_names_the_pin() -> None:
    with raises(MeshError, "gmsh-failed", "pin E: ", "Unknown"), gmsh_model("E") as gmsh:
        gmsh.model.occ.getMass(3, 9)


def test_what_is_not_gmshs_passes() -> None:
    with pytest.raises(ZeroDivisionError), gmsh_model("E"):
        print(1 // 0)
