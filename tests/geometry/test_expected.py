"""The unknowns of meshes before they are made, beside those that gmsh then makes."""

from __future__ import annotations

import math
import re
import sys
import time

import pytest

from fea.core.memory import most_unknowns, solid_memory
from fea.cut.region import PIECE_REACH, pieces
from geometry import Cut, CutPin, Hole, Pin, Segment, Slot
from geometry.mesh import expected
from geometry.mesh.cut_piece import Piece, piece_mesh
from geometry.mesh.gmsh_session import MeshError
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from tests.support.each import each

SHAFT = Pin("P", (Segment(0.03, 0.04, connection="A"), Segment(0.07, 0.04)))
CUTS: dict[str, Cut] = {
    "hole": Hole(0.05, 0.008),
    "small hole": Hole(0.05, 0.001),
    "countersunk": Hole(0.05, 0.008, chamfer=0.002),
    "blind": Hole(0.05, 0.008, depth=0.01),
    "keyway": Slot(0.004, 0.026, 0.012, 0.005, radius=0.001),
}
PINS = {
    "plain": SHAFT,
    "shoulder": Pin("P", (Segment(0.02, 0.03), Segment(0.03, 0.02, connection="A")), 0.002),
    "small fillet": Pin("P", (Segment(0.02, 0.03), Segment(0.03, 0.02, connection="A")), 0.0005),
    "tube": Pin("P", (Segment(0.05, 0.02, 0.012, connection="A"),)),
}


def piece(*cuts: Cut) -> Piece:
    pin = CutPin(SHAFT, cuts)
    assert isinstance(pin, CutPin)
    (found,) = pieces(pin, (), PIECE_REACH)
    return found


@pytest.fixture
def seen(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """What is expected of each mesh."""
    found: list[float] = []

    def look(gmsh: object, name: str, most: float) -> None:
        found.append(expected.expected_unknowns(gmsh))

    for module in ("cut_piece", "solid_mesh"):
        monkeypatch.setattr(sys.modules[f"geometry.mesh.{module}"], "require_few", look)
    return found


@each("kind", CUTS)
def test_a_local_solid_has_as_many_unknowns_as_expected(kind: str, seen: list[float]) -> None:
    """`python -m benchmarks expected` has more: 0.64 to 1.43 times as many."""
    mesh = piece_mesh(piece(CUTS[kind]), 1.0)
    assert 0.5 < seen[-1] / (3 * len(mesh.nodes)) < 2.0


@each("kind", PINS)
def test_a_solid_has_as_many_unknowns_as_expected(kind: str, seen: list[float]) -> None:
    mesh = solid_mesh(PINS[kind], MeshSize())
    assert 0.5 < seen[-1] / (3 * len(mesh.nodes)) < 2.0


def test_a_mesh_that_needs_too_much_memory_is_refused_before_it_is_made() -> None:
    """gmsh went on for minutes, and the memory of a keyway's sharp radius was found out by then."""
    tiny = piece(Slot(0.004, 0.026, 0.012, 0.005, radius=1e-6))
    start = time.process_time()
    with pytest.raises(MeshError) as refused:
        piece_mesh(tiny, 1.0, most=most_unknowns(2000.0, 6))
    assert time.process_time() - start < 5.0
    assert refused.value.code == "too-many-elements"
    said = str(refused.value)
    assert re.search(r"about 2,[678]00,000 unknowns, of which 340,000 fit into the memory", said)
    assert "130,000 times smaller than what is meshed" in said


def test_the_unknowns_that_fit_into_a_memory() -> None:
    assert solid_memory(most_unknowns(2000.0)) == pytest.approx(2000.0, rel=2e-3)
    assert most_unknowns(2000.0, 6) == pytest.approx(2000.0 / (5e-3 + 6 * 1.5e-4), rel=2e-3)
    assert most_unknowns(math.inf) > 1e11
