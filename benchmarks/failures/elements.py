"""Invalid elements: folded over their neighbours, or bent inside out."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from matplotlib.axes import Axes
from skfem import Basis, ElementTetP2

from benchmarks.failures.asked import STUDIES, command, row, study, told
from benchmarks.failures.broken_meshes import FOLDED, INSIDE_OUT, MM, TURNED
from benchmarks.failures.draw import INK, line_style, note
from benchmarks.failures.entry import Entry
from fea.core.pin_loads import Floats, PinLoads
from fea.solid.model import SolidModel, acting
from fea.solid.superposition import envelope
from geometry.imported.imported_pin import SolidBody
from geometry.imported.named_bands import with_places
from geometry.mesh.quality import distortion, folded
from geometry.mesh.solid_mesh import MeshError, SolidMesh
from geometry.mesh.tet10 import Quadratic, quadratic
from pinstress.study.model.pins import material, pin
from reports.format.numbers import engineering

FORCE = 1e4  # N
MPA = 1e6


@dataclass(frozen=True)
class Broken:
    """The results on a mesh file, computed without looking at the signs of det J.

    peak: largest von Mises stress half-way between clamp and band, Pa.
    volume: the sum of the sizes of all elements, m^3.
    shape: (M,), least over largest det J.
    folds: number of folds.
    told: pinstress's message; empty if it accepts the file.
    """

    volume: float
    peak: float
    shape: Floats
    folds: int
    told: str


def read(name: str) -> Quadratic:
    """Return a mesh file without any check."""
    import meshio

    found = meshio.read(STUDIES / f"{name}.msh")
    (block,) = found.cells
    return quadratic(np.asarray(found.points) * MM, np.asarray(block.data, dtype=np.int64))


@cache
def broken(name: str) -> Broken:
    """Return the results on a file of studies/failures, solved although it may be broken."""
    made = read(name)
    sound = pin(study(TURNED), "P")
    assert isinstance(sound, SolidBody)
    mesh = with_places(made.mesh, sound.file)
    steel = material(study(TURNED), "steel")
    loads = PinLoads("push", ("link",), np.array([[[0.0, -FORCE, 0.0]]]))
    model = SolidModel(sound, SolidMesh(mesh, 1.0, 0), steel, ("start",))
    fields = model.solve(acting((loads,)))
    z = fields.space.nodes[fields.surface.nodes][:, 2]
    peak = envelope(fields, loads, (z > 10 * MM) & (z < 40 * MM)).maximum
    volume = float(Basis(made.mesh, ElementTetP2(), intorder=2).dx.sum())
    return Broken(volume, peak, distortion(made), folded(made.mesh), refusal(name))


@cache
def refusal(name: str) -> str:
    """Return the message with which pinstress rejects a study; empty if it accepts it."""
    try:
        pin(study(name), "P")
    except MeshError as error:
        return str(error)
    return ""


def entries() -> tuple[Entry, ...]:
    """Return the entries of this family."""
    sound, over, out = broken(TURNED), broken(FOLDED), broken(INSIDE_OUT)
    return (
        Entry(
            FOLDED,
            "An inverted element in a mesh file",
            "An inner node that lies beyond the far side of its own elements folds them over their "
            "neighbours. Assembly uses the magnitude of det J, and its sign depends on the node "
            "numbering, so neither reveals the error.",
            f"{engineering(over.peak / MPA, 3)} MPa between clamp and load, from elements with "
            f"a total volume of {engineering(over.volume / MM**3, 4)} mm³.",
            f"{engineering(sound.peak / MPA, 3)} MPa on the valid mesh, of "
            f"{engineering(sound.volume / MM**3, 4)} mm³.",
            f"Rejected: {over.told}. It checks that the two elements of every inner facet are on "
            "opposite sides of it; a file with mixed node orientations is accepted: "
            f"{told(row(TURNED))}",
            (command(FOLDED), command(TURNED)),
            "The folded mesh gives a different stress from the valid one and is rejected",
            lambda figure, axes: _draw(axes[0], axes[1], sound, over, "one node moved"),
        ),
        Entry(
            INSIDE_OUT,
            "Quadratic elements bent inside out",
            "A mid-edge node can bend an element so far that det J changes sign inside it, even "
            "between "
            "all its nodes and integration points.",
            f"{engineering(out.peak / MPA, 3)} MPa, {100 * abs(out.peak / sound.peak - 1):.0f} "
            "% off, because of a single mid-edge node.",
            f"{engineering(sound.peak / MPA, 3)} MPa on the valid mesh.",
            f"Rejected: {out.told}. det J is a cubic polynomial, and the signs of its Bernstein "
            "coefficients prove it positive everywhere (`geometry/mesh/quality.py`); in its own "
            "meshes the minimum of det J must exceed a tenth of its maximum.",
            (command(INSIDE_OUT),),
            "The bent mesh gives a different stress from the valid one and is rejected",
            lambda figure, axes: _draw(axes[0], axes[1], sound, out, "one edge bent"),
        ),
    )


def _draw(left: Axes, right: Axes, sound: Broken, wrong: Broken, what: str) -> None:
    texts = ("valid mesh", f"{what}:\nplausible number,\nrejected by pinstress")
    for k, (mesh, text) in enumerate(zip((sound, wrong), texts, strict=True)):
        color = (INK, line_style(1)["color"])[k]
        left.plot(mesh.peak / MPA, k, ("o", "X")[k], color=color, ms=7)
        note(left, mesh.peak / MPA, k, text, (8, -2), color)
        right.plot(np.sort(mesh.shape), drawstyle="steps-post", **line_style(k))
        right.set(xlabel="elements, in order", ylabel="min / max det J")
        if wrong.folds:
            right.clear()
    left.set(xlabel="von Mises stress away from the clamp [MPa]", yticks=[], ylim=(-0.5, 1.6))
    low, high = sorted((sound.peak / MPA, wrong.peak / MPA))
    left.set_xlim(low - 0.2 * (high - low), high + 1.6 * (high - low))
    if wrong.folds:
        for k, mesh in enumerate((sound, wrong)):
            color = (INK, line_style(1)["color"])[k]
            right.plot(mesh.volume / MM**3, k, ("o", "X")[k], color=color, ms=7)
            note(right, mesh.volume / MM**3, k, f"{engineering(mesh.volume / MM**3)} mm³", (0, 12),
                 color, "center")  # fmt: skip
        a, b = sound.volume / MM**3, wrong.volume / MM**3
        right.set(xlabel="total element volume [mm³]", yticks=[], ylim=(-0.5, 1.6))
        right.set_xlim(a - 0.5 * (b - a), b + 0.5 * (b - a))
    else:
        right.axhline(0.0, color="#8a8a8a", linewidth=0.8)
        note(right, 0.5 * len(wrong.shape), wrong.shape.min() * 0.9, "inside out", (0, 0))
