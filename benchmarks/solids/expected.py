"""The number of unknowns expected of a mesh of tetrahedra before it is made, compared with its
number.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from unittest import mock

import gmsh

from benchmarks.cuts.random_cuts import cut_trials, kind_trials
from benchmarks.random_pins import trials
from benchmarks.timing import table
from fea.cut.region import PIECE_REACH, pieces
from geometry import CutPin, Hole, Pin, Segment, Slot
from geometry.imported.body_file import BodyFile
from geometry.imported.cad_mesh import cad_mesh
from geometry.mesh.cut_piece import piece_mesh
from geometry.mesh.cut_solid import cut_solid
from geometry.mesh.expected import expected_unknowns
from geometry.mesh.gmsh_session import gmsh_model, silence
from geometry.mesh.solid_mesh import MeshSize, SolidMesh, solid_mesh

SEED = 7
IN_OTHER_WAYS = 4  # pins with cuts that are also meshed as whole solids and from files
SHAFT = Pin("shaft", (Segment(0.03, 0.04, connection="A"), Segment(0.07, 0.04)))
SMALL = {  # features far smaller than their pin
    "keyway, radius d / 100": CutPin(SHAFT, (Slot(0.004, 0.026, 0.012, 0.005, 0.0, 4e-4),)),
    "keyway, radius d / 400": CutPin(SHAFT, (Slot(0.004, 0.026, 0.012, 0.005, 0.0, 1e-4),)),
    "hole, d / 400": CutPin(SHAFT, (Hole(0.05, 1e-4),)),
}
Make = Callable[[], SolidMesh]


def expected() -> str:
    """Return the table for first meshes: whole pins and bodies from files as solids, and local
    solids about cuts.
    """
    found = [(name, *_measured(make)) for name, make in _meshes()]
    rows = [(name, n, f"{e:,.0f}", e / n, spent, made) for name, n, e, spent, made in found]
    ratios = [row[3] for row in rows]
    head = ("mesh", "unknowns", "expected", "ratio", "expecting, s", "meshing, s")
    return (
        f"{len(rows)} meshes: expected are {min(ratios):.2f} to {max(ratios):.2f} times as many "
        f"unknowns as there are.\n\n{table(head, rows)}"
    )


def _meshes() -> Iterator[tuple[str, Make]]:
    for plain in trials(4, SEED):
        yield f"whole, {plain.pin.name}", partial(solid_mesh, plain.pin, MeshSize())
    for k, cut in enumerate((*cut_trials(3, SEED), *kind_trials(6, SEED))):
        pin, name = cut.pin, _name(cut.pin)
        (piece, *_) = pieces(pin, cut.clamps, PIECE_REACH)
        yield f"local, {name}", partial(piece_mesh, piece, 1.0)
        if k < IN_OTHER_WAYS:
            yield f"whole, {name}", partial(solid_mesh, pin, MeshSize())
            yield f"file, {name}", partial(_from_file, pin)
    for name, small in SMALL.items():
        assert isinstance(small, CutPin)
        (piece,) = pieces(small, (), PIECE_REACH)
        yield f"local, {name}", partial(piece_mesh, piece, 1.0)


def _name(pin: CutPin) -> str:
    kinds = sorted({cut.what for cut in pin.cuts.values()})
    return f"{pin.name}: {', '.join(kinds)}"


def _from_file(pin: CutPin) -> SolidMesh:
    """Return the mesh of a pin from a file whose lengths are in mm."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "pin.step"
        with gmsh_model(pin.name) as model, silence():
            cut_solid(model, pin.profile.scaled(1e3), pin.scaled(1e3).cuts)
            model.write(str(path))
        return cad_mesh(BodyFile("P", path, 1e-3, ()), MeshSize())


def _measured(make: Make) -> tuple[int, float, float, float]:
    """Return unknowns of a mesh, those expected, and the processor times of the expectation and of
    all else, s.
    """
    start = time.process_time()
    with _watched() as seen:
        mesh = make()
    expected, spent = seen[-1]
    return 3 * mesh.mesh.doflocs.shape[1], expected, spent, time.process_time() - start - spent


@contextmanager
def _watched() -> Iterator[list[tuple[float, float]]]:
    """Yield a list to which each mesh that gmsh makes adds its expected unknowns and the time of
    this, s.
    """
    seen: list[tuple[float, float]] = []
    generate = gmsh.model.mesh.generate

    def watched(dimension: int) -> None:
        start = time.process_time()
        found = expected_unknowns(gmsh)
        seen.append((found, time.process_time() - start))
        generate(dimension)

    with mock.patch.object(gmsh.model.mesh, "generate", watched):
        yield seen
