"""Methods of stress recovery at a fillet from the same displacements: errors of the maximum by
mesh.
"""

from __future__ import annotations

import numpy as np
from skfem import ElementTriP2

from benchmarks.pins.accuracy import FILLET, LOAD, PIN, STEEL, peak, truth
from benchmarks.timing import table
from fea.core.local_fit import continuation, nodal_extrapolation
from fea.core.voigt import von_mises
from fea.harmonic.fields import MeridianFields
from fea.harmonic.model import HarmonicModel, polar
from fea.solid.model import SolidModel, acting
from fea.solid.stress_recovery import nodal_stress
from geometry.mesh.section_mesh import SectionSize, meridian_mesh
from geometry.mesh.solid_mesh import MeshSize, solid_mesh

FINER = (1.0, 1.4, 2.0, 2.8)
SECTION = SectionSize(3.0, 6.0, 0.5)
SOLID = MeshSize(across=3.0, arc=1.5)


def recovery() -> str:
    """Return the table of errors of the largest von Mises stress in the fillet, %."""
    true = truth()

    def row(model: str, unknowns: int, *peaks: float | None) -> tuple[object, ...]:
        errors = ("" if p is None else f"{100.0 * (p / true - 1.0):+.2f}" for p in peaks)
        return model, f"{unknowns:,}", *errors

    rows = []
    for factor in FINER:
        size = SECTION.finer(factor)
        rows.append(row("section", *_section(size)))
    for factor in FINER:
        unknowns, averaged, known = _solid(SOLID.finer(factor))
        rows.append(row("solid", unknowns, averaged, None, known))
    head = (
        "mesh",
        "unknowns",
        "averages of extrapolated stress, %",
        "fitted to samples, %",
        "with the known traction, %",
    )
    return (
        "Peak at a fillet in bending compared with that of a much finer section mesh. The known "
        "traction is used on a section together with the strains along the surface, on a solid as "
        "a correction:\n\n" + table(head, rows)
    )


def _section(size: SectionSize) -> tuple[int, float, float, float]:
    """Return unknowns and maxima, Pa: by averages, by fits, and by the harmonic model's own values
    on the skin.
    """
    (load,) = LOAD.coefficients()
    model = HarmonicModel(PIN, meridian_mesh(PIN, size), STEEL, ("start",))
    fields = model.solve((load,))
    space = model.space
    u = polar(model.displace(load.n, model._applied(load.n, [load])[0]))
    stress = space.sampled_stress(STEEL, load.n, u)
    sampled = stress.reshape(-1, 6)
    averaged, fitted = (
        (matrix @ sampled)[:, :, None]
        for matrix in (
            nodal_extrapolation(space.elements, space.sampled_at, ElementTriP2.doflocs.T),
            continuation(space.samples, space.nodes),
        )
    )
    still = np.zeros((len(averaged), 3, 1))
    plain = [
        peak(MeridianFields(space.nodes, (load,), at_nodes, still, 0, space.unknowns))
        for at_nodes in (averaged, fitted)
    ]
    return space.unknowns, plain[0], plain[1], peak(fields)


def _solid(size: MeshSize) -> tuple[int, float, float]:
    """Return unknowns and maxima, Pa: by averages, and with the known traction."""
    mesh = solid_mesh(PIN, size, (PIN.stations[1], PIN.length))
    model = SolidModel(PIN, mesh, STEEL, ("start",))
    fields = model.solve(acting([LOAD]))
    c = fields.coefficients(LOAD)[0]
    x = fields.space.nodes
    near = (x[:, 2] >= FILLET[0]) & (x[:, 2] <= FILLET[1])
    near &= np.isin(np.arange(len(x)), fields.surface.nodes)
    averaged = nodal_stress(fields.space, STEEL, fields.displacement) @ c
    known = fields.stress @ c
    peaks = [float(von_mises(stress[near]).max()) for stress in (averaged, known)]
    return model.space.unknowns, peaks[0], peaks[1]
