"""The growth of costs with the number of unknowns, stage by stage: fitted powers."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

import numpy as np

from benchmarks.pins.accuracy import LOAD, PIN, STEEL
from benchmarks.timing import power, table
from fea.harmonic.model import HarmonicModel
from fea.harmonic.superposition import Circumference
from fea.solid.model import SolidModel, acting
from fea.solid.superposition import envelope
from geometry.mesh.section_mesh import SectionSize, meridian_mesh
from geometry.mesh.solid_mesh import MeshSize, solid_mesh

SECTION, SECTIONS = SectionSize(3.0, 6.0, 0.5), (1.0, 1.6, 2.5, 4.0, 6.3)
SOLID, SOLIDS = MeshSize(across=3.0, arc=1.5), (1.0, 1.4, 2.0, 2.4)
RUNS = 2


def growth() -> str:
    """Return the table of times of the smallest and the largest mesh, s, and the powers."""
    rows = [
        *_rows("harmonic", ("meshing", "solving one harmonic", "maximum"), [
            partial(_harmonic, SECTION.finer(f)) for f in SECTIONS
        ]),
        *_rows("solid", ("meshing", "assembly", "solving, stresses", "maximum"), [
            partial(_solid, SOLID.finer(f)) for f in SOLIDS
        ]),
    ]  # fmt: skip
    head = ("model", "stage", "unknowns", "s", "unknowns", "s", "time ~")
    return f"Minimum of {RUNS} runs; exponents fitted over all meshes:\n\n{table(head, rows)}"


Timed = tuple[int, list[float]]


def _rows(
    model: str, stages: tuple[str, ...], meshes: list[Callable[[], Timed]]
) -> list[tuple[object, ...]]:
    runs = [[work() for work in meshes] for _ in range(RUNS)]
    counts = np.array([unknowns for unknowns, _ in runs[0]], dtype=np.float64)
    spent = np.min([[stage for _, stage in run] for run in runs], axis=0)  # (meshes, stages)
    stages, spent = (*stages, "in all"), np.column_stack([spent, spent.sum(axis=1)])
    first, last = (f"{int(counts[k]):,}" for k in (0, -1))
    return [
        (model, stage, first, float(s[0]), last, float(s[-1]), f"n^{power(counts, s):.2f}")
        for stage, s in zip(stages, spent.T, strict=True)
    ]


def _harmonic(size: SectionSize) -> Timed:
    marks = [time.perf_counter()]
    mesh = meridian_mesh(PIN, size)
    marks.append(time.perf_counter())
    fields = HarmonicModel(PIN, mesh, STEEL, ("start",)).solve(tuple(LOAD.coefficients()))
    marks.append(time.perf_counter())
    Circumference(fields, LOAD).top(fields.points[:, 1] > 0.01)
    marks.append(time.perf_counter())
    return fields.unknowns, np.diff(marks).tolist()


def _solid(size: MeshSize) -> Timed:
    marks = [time.perf_counter()]
    mesh = solid_mesh(PIN, size, (PIN.stations[1], PIN.length))
    marks.append(time.perf_counter())
    model = SolidModel(PIN, mesh, STEEL, ("start",))
    assert model.stiffness is not None
    marks.append(time.perf_counter())
    fields = model.solve(acting([LOAD]))
    marks.append(time.perf_counter())
    envelope(fields, LOAD)
    marks.append(time.perf_counter())
    return model.space.unknowns, np.diff(marks).tolist()
