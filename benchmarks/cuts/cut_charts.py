"""Cross holes compared with charts of the literature: tension, bending and torsion over d/D."""

from __future__ import annotations

from functools import cache

import numpy as np

from benchmarks.random_pins import STEEL
from benchmarks.timing import table
from fea.cut.local_model import LocalModel, Read
from fea.cut.region import pieces
from fea.solid.superposition import squares
from geometry import CutPin, Hole, Pin, Segment
from geometry.mesh.cut_piece import piece_mesh
from pinbase.arrays import Floats

D = 0.02
RATIOS = (0.05, 0.1, 0.15, 0.2, 0.3)
FINE = 1.5  # fineness of the mesh over that of the first
SCATTERED, ABOUT_FIRST, FINEST = (0.15, 0.3), (1.0, 1.1, 1.2, 1.3, 1.45, 1.6), 3.0
BAR = Pin("bar", (Segment(0.16, D, name="side"),))
# Polynomials in d / D, from the third power down, of the largest stress over the nominal stress of
# the whole section at the extreme fibre. Pilkey & Pilkey, Peterson's Stress Concentration Factors,
# 3rd ed., chapter 4: tubes with a transverse hole, with an inner diameter of zero.
PETERSON = {
    "tension": (0.0, 11.357, 0.427, 3.0),
    "bending": (-45.0, 41.0, -6.25, 3.0),
    "torsion": (-38.33, 32.764, -6.055, 4.0),
}


def chart(load: str, ratio: float) -> float:
    """Return the factor of the literature."""
    return float(np.polyval(PETERSON[load], ratio))


@cache
def model(ratio: float) -> LocalModel:
    """Return an eighth of a bar with a hole along x. ratio: of the diameters of hole and bar."""
    (piece,) = pieces(CutPin(BAR, (Hole(0.08, ratio * D),)), ())
    return LocalModel(piece, piece_mesh(piece, FINE), STEEL)


def uncut(of: LocalModel, load: str) -> Floats:
    """Return the stress (G, P, 6, 1) of the bar without the hole, 1 at the extreme fibre."""
    x, y, _ = np.moveaxis(of.faces.images, -1, 0)
    out = np.zeros((*x.shape, 6, 1))
    if load == "torsion":
        out[..., 3, 0], out[..., 4, 0] = 2.0 * x / D, -2.0 * y / D
    else:
        out[..., 2, 0] = 1.0 if load == "tension" else 2.0 * x / D
    return out


def cut_scatter() -> str:
    """Return the table of the scatter of the largest von Mises stress with the positions of nodes.

    The scatter is the error times the square of the fineness, on meshes about as fine as the first
    one, under random superpositions of tension, bending in two planes and torsion.
    """
    amounts = np.concatenate([np.eye(4), np.random.default_rng(5).normal(size=(12, 4))])

    def maxima(ratio: float, fine: float) -> Floats:
        (piece,) = pieces(CutPin(BAR, (Hole(0.08, ratio * D),)), ())
        of = LocalModel(piece, piece_mesh(piece, fine), STEEL)
        x, y, _ = np.moveaxis(of.faces.images * 2.0 / D, -1, 0)
        stress = np.zeros((*x.shape, 6, 4))
        stress[..., 2, :3] = np.stack([np.ones_like(x), x, y], axis=-1)
        stress[..., 3, 3], stress[..., 4, 3] = x, -y
        return np.asarray(np.sqrt(squares(of.solve(stress).stress)(amounts).max(axis=0)))

    rows = []
    for ratio in SCATTERED:
        true = maxima(ratio, FINEST)
        off = [100.0 * abs(maxima(ratio, f) / true - 1.0) * f**2 for f in ABOUT_FIRST]
        root = float(np.sqrt(np.mean(np.square(off))))
        rows.append((ratio, np.size(off), root, float(np.quantile(off, 0.95)), float(np.max(off))))
    head = ("d / D", "maxima", "root mean square, %", "95 % are below, %", "largest, %")
    return table(head, rows)


def factors(load: str, ratio: float) -> tuple[float, float]:
    """Return the largest principal and von Mises stress over the nominal stress."""
    found = model(ratio)
    return largest(found.solve(uncut(found, load)))


def largest(read: Read) -> tuple[float, float]:
    """Return the largest principal stress and the largest von Mises stress."""
    xx, yy, zz, yz, xz, xy = np.moveaxis(read.stress[..., 0], -1, 0)
    tensor = np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz], axis=1).reshape(-1, 3, 3)
    a, b, c = np.linalg.eigvalsh(tensor).T
    mises = np.sqrt(0.5 * ((a - b) ** 2 + (b - c) ** 2 + (c - a) ** 2))
    return float(c.max()), float(mises.max())


def cut_charts() -> str:
    """Return the table over loads and ratios."""
    rows = []
    for load in PETERSON:
        for ratio in RATIOS:
            principal, mises = factors(load, ratio)
            known = chart(load, ratio)
            apart = 100.0 * (known / principal - 1.0)
            rows.append((load, ratio, known, principal, f"{apart:+.1f}", mises))
    ours = "ours, principal", "Peterson over ours, %", "ours, von Mises"
    head = ("load", "d / D", "Peterson", *ours)
    return table(head, rows)
