"""Meshes of pieces: halves beside wholes, spots that are meshed finely, recesses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from skfem import Basis, ElementTetP0

from geometry import Cut, CutPin, Hole, Pin, Segment, Slot
from geometry.mesh.cut_piece import Piece, clipped, piece_mesh
from geometry.mesh.solid_mesh import SolidMesh
from tests.support.pins.recesses import as_recesses

SHAFT = Pin("P", (Segment(0.03, 0.02),))
ROUNDED = Hole(0.015, 0.006, mouth_radius=0.001)


def piece(*cuts: Cut, mirrors: tuple[str, ...] = ()) -> Piece:
    named = {f"{cut.what} {k}": cut for k, cut in enumerate(cuts, 1)}
    return Piece(SHAFT, 0.0, 0.03, 0.0, named, mirrors)


def volume(mesh: SolidMesh) -> float:
    """Volume of the curved tetrahedra, m^3."""
    return float(Basis(mesh.mesh, ElementTetP0(), intorder=4).dx.sum())


def test_a_piece_above_its_mirror_plane_is_half_of_the_whole() -> None:
    """Also where the plane divides a rounded mouth, which only the whole piece can have."""
    assert ROUNDED.undivided
    half = replace(
        piece(ROUNDED, mirrors=("z",)), profile=Pin("P", (Segment(0.015, 0.02),)),
        cuts={"hole 1": replace(ROUNDED, z=0.0)},
    )  # fmt: skip
    assert (half.origin, piece(ROUNDED).origin) == (0.015, 0.0)
    ours, whole = piece_mesh(half, 0.5), CutPin(SHAFT, [ROUNDED])
    assert volume(ours) == pytest.approx(whole.volume / 2.0, rel=2e-3)
    assert ours.nodes[:, 2].min() == pytest.approx(0.0, abs=1e-9)
    names = [name for name in ours.mesh.boundaries if half.cut_at(name)]
    assert {half.cut_at(name) for name in names} == {"hole 1"}
    assert half.cut_at("start") is None


def test_elements_are_small_at_a_spot() -> None:
    spot = (0.01, 0.003, 0.015)  # on the rim of the hole, at its side
    of_hole = piece(Hole(0.015, 0.006), mirrors=("y",))
    plain, fine = (piece_mesh(of_hole, 0.5, spots, 4.0) for spots in ((), [spot]))
    near = [float(np.sort(np.linalg.norm(m.nodes - spot, axis=1))[5]) for m in (plain, fine)]
    assert near[1] < near[0] / 2.0
    assert volume(fine) == pytest.approx(volume(plain), rel=2e-3)


def test_a_recess_is_meshed_as_the_cut_that_it_is() -> None:
    """Corners at the bottom of a keyway are fine in both."""
    slot = Slot(0.005, 0.02, 0.006, 0.003, radius=0.0005)
    (recess,) = as_recesses(CutPin(SHAFT, [slot])).cuts.values()
    ours, other = (piece_mesh(piece(cut), 0.6) for cut in (recess, slot))
    assert volume(ours) == pytest.approx(volume(other), rel=2e-3)
    assert volume(ours) == pytest.approx(CutPin(SHAFT, [slot]).volume, rel=2e-3)
    assert any(name.startswith("recess 1") for name in ours.mesh.boundaries)


def test_a_part_of_a_pin_keeps_its_names() -> None:
    """Its volume is what lies between, by the whole pin's radii."""
    pin = Pin("P", (Segment(0.03, 0.02, connection="A"), Segment(0.02, 0.03)), fillet=0.001)
    part = clipped(pin, 0.01, 0.045)
    assert part.labels == ("A", "segment 2")
    z = np.linspace(0.01, 0.045, 200_001)
    outer = np.array([pin.radii(float(x))[1] for x in z[::100]])
    assert part.volume == pytest.approx(np.pi * np.trapezoid(outer**2, z[::100]), rel=1e-3)
