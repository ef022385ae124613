"""How right the solid model's peak in a fillet is, beside a finer solution of the same model."""

from __future__ import annotations

import time

import numpy as np

from benchmarks.timing import table
from fea.envelope import envelope
from fea.material import Material
from fea.peak import Refinement, discretisation_error
from fea.pin_loads import PinLoads
from fea.solid import SolidModel, acting
from geometry import Pin, Segment
from geometry.solid_mesh import MeshSize, solid_mesh

PIN = Pin("P", (Segment(0.02, 0.03), Segment(0.04, 0.02, connection="B")), fillet=0.004)
STEEL = Material("steel", 2.0e11, 0.3)
LOAD = PinLoads("bending", ("B",), np.array([[[0.0, 1000.0, 0.0]]]))
STEP = 2.0**0.5


def fillet() -> str:
    """A shoulder fillet in bending: the last mesh is the reference for those before it."""
    steps: list[Refinement] = []
    for level in range(5):
        start = time.perf_counter()
        mesh = solid_mesh(PIN, MeshSize(across=3.0, arc=1.5).finer(STEP**level), (0.02, 0.06))
        model = SolidModel(PIN, mesh, STEEL, ("start",))
        found = envelope(model.solve(acting([LOAD])), LOAD)
        steps.append(Refinement(model.unknowns, found.maximum, time.perf_counter() - start))
    best = steps[-1].max_von_mises
    rows = []
    for i, step in enumerate(steps):
        estimate = discretisation_error(tuple(steps[: i + 1]), STEP) if i else float("nan")
        rows.append(
            (
                step.dofs,
                step.seconds,
                step.max_von_mises / 1e6,
                abs(step.max_von_mises / best - 1.0),
                estimate / step.max_von_mises,
            )
        )
    head = ("unknowns", "s", "peak, MPa", "error against the last", "estimated error")
    return table(head, rows)
