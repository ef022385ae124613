"""The accuracy of the solid model's maximum in a fillet, compared with that of a much finer
section.
"""

from __future__ import annotations

import numpy as np

from benchmarks.timing import table
from fea.core.material import Material
from fea.core.peak import Refinement, discretisation_error
from fea.core.pin_loads import PinLoads
from fea.harmonic.fields import MeridianFields
from fea.harmonic.model import HarmonicModel
from fea.harmonic.superposition import Circumference
from fea.solid.model import SolidModel, acting
from fea.solid.superposition import envelope
from geometry import Pin, Segment
from geometry.mesh.section_mesh import SectionSize, meridian_mesh
from geometry.mesh.solid_mesh import MeshSize, solid_mesh

PIN = Pin("P", (Segment(0.02, 0.03), Segment(0.04, 0.02, connection="B")), fillet=0.004)
STEEL = Material("steel", 2.0e11, 0.3)
LOAD = PinLoads("bending", ("B",), np.array([[[0.0, 1000.0, 0.0]]]))
FILLET = (0.02, 0.024)  # z of the fillet, m, from the shoulder to the tangent
FINEST = SectionSize(24.0, 50.0, 0.08)
STEP, MESHES = 2.0**0.5, 4


def truth() -> float:
    """Return the largest von Mises stress in the fillet on a much finer section, Pa."""
    model = HarmonicModel(PIN, meridian_mesh(PIN, FINEST), STEEL, ("start",))
    return peak(model.solve(tuple(LOAD.coefficients())))


def peak(fields: MeridianFields) -> float:
    """Return the largest von Mises stress in the fillet, Pa."""
    r, z = fields.points.T
    near = (z >= FILLET[0]) & (z <= FILLET[1]) & (r >= PIN.segments[1].diameter / 2.0 * (1 - 1e-9))
    return Circumference(fields, LOAD).top(near).value


def fillet() -> str:
    """Return the table of a shoulder fillet in bending on ever finer meshes."""
    steps: list[Refinement] = []
    for level in range(MESHES):
        mesh = solid_mesh(PIN, MeshSize(across=3.0, arc=1.5).finer(STEP**level), (0.02, 0.06))
        model = SolidModel(PIN, mesh, STEEL, ("start",))
        found = envelope(model.solve(acting([LOAD])), LOAD)
        steps.append(Refinement(model.space.unknowns, found.maximum, 0.0))
    true = truth()
    rows = []
    for i, step in enumerate(steps):
        estimate = discretisation_error(tuple(steps[: i + 1]), STEP) if i else float("nan")
        rows.append(
            (
                step.dofs,
                step.max_von_mises / 1e6,
                abs(step.max_von_mises / true - 1.0),
                estimate / step.max_von_mises,
            )
        )
    head = ("unknowns", "peak, MPa", "true error", "estimated error")
    return table(head, rows)
