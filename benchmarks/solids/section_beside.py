"""The harmonic model on the pin of the comparison with CalculiX: error and time of its maximum."""

from __future__ import annotations

import time

import numpy as np

from benchmarks.solids.calculix_ours import ALONG_Y, BAND, CLAMP, FORCE, PIN, STEEL
from benchmarks.timing import table
from fea.core.pin_loads import PinLoads
from fea.harmonic.model import HarmonicModel
from fea.harmonic.superposition import Circumference
from geometry.mesh.section_mesh import SectionSize, meridian_mesh

SIZES = tuple(SectionSize(2.0, 5.0, 0.7).finer(f) for f in (1.0, 1.4, 2.0, 2.8))
FINEST = SectionSize(20.0, 50.0, 0.1)
RUNS = 3
LOADS = PinLoads("case", (BAND,), np.array([[[0.0, FORCE, 0.0]]]))


def peak(size: SectionSize) -> tuple[int, float, float]:
    """Return unknowns, the largest von Mises stress at the fillet, Pa, and the time from the pin
    on, s.

    The time is the least of some runs of meshing, solution and maximum.
    """
    spent = []
    for _ in range(RUNS):
        start = time.perf_counter()
        section = meridian_mesh(PIN, size)
        fields = HarmonicModel(PIN, section, STEEL, (CLAMP,)).solve((ALONG_Y[0][0],))
        r, z = fields.points.T
        corner = PIN.stations[1]
        near = (z >= corner) & (z <= corner + PIN.fillet) & (np.arange(len(r)) < fields.skin)
        value = Circumference(fields, LOADS).top(near).value
        spent.append(time.perf_counter() - start)
    return fields.unknowns, value, min(spent)


def beside(rows: list[tuple[str, int, float, float]]) -> str:
    """Return the table of errors and times of other programs (name, unknowns, maximum, seconds),
    each compared with the first mesh of a section that is at least as accurate.
    """
    _, true, _ = peak(FINEST)
    ours = [(n, abs(value / true - 1.0), s) for n, value, s in map(peak, SIZES)]
    lines: list[tuple[object, ...]] = [
        ("harmonic, with meshing", n, f"{100.0 * error:.2f}", s, "") for n, error, s in ours
    ]
    for name, n, value, spent in rows:
        error = abs(value / true - 1.0)
        as_good = next((s for _, e, s in ours if e <= error), None)
        ratio = "" if as_good is None else f"{spent / as_good:.0f}"
        lines.append((name, n, f"{100.0 * error:.2f}", spent, ratio))
    return table(("model", "unknowns", "error, %", "s", "times the harmonic model's"), lines)
