"""Shoulder fillets in tension: our harmonic model compared with CalculiX's axisymmetric elements
(CAX6).

CalculiX solves the mesh of our section and pulls at the end face; our model pulls at a band. The
shoulder is too far away for this to matter. Peterson's chart is far below both where the fillet is
small.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from assess.opinion.calculix import JOB_NAME, installed, seconds_of, stresses
from assess.opinion.calculix import run as run_calculix
from assess.opinion.calculix_deck import mesh_lines
from benchmarks.pins.shoulders import CHARTS, FINEST, KINDS, D, Run, run, shoulder
from benchmarks.random_pins import STEEL
from benchmarks.solids.calculix import MISSING
from benchmarks.timing import table
from fea.beam.stress_concentration import shoulder_factor
from fea.core.voigt import von_mises
from fea.harmonic.assembly import Section
from geometry import Pin
from geometry.mesh.section_mesh import MeridianMesh, SectionSize, meridian_mesh

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SHAPES = ((1.25, 0.0125), (3.0, 0.1))  # D/d, r/d; at the first we differ most from the chart
TENSION = KINDS.index("tension")
MIRRORED = [0, 2, 1, 5, 4, 3]  # CAX6: corners, then edges 01, 12, 20
SIDES = ((0, 1), (1, 2), (2, 0))
HEAD = (
    "D/d", "r/d", "unknowns", "K: ours", "CalculiX", "ours / CalculiX", "Peterson", "ours / chart",
    "von Mises: ours", "CalculiX", "ours / CalculiX",
)  # fmt: skip


@dataclass(frozen=True)
class Tension:
    """The maxima at a fillet under unit nominal tension.

    ours: our results (in column TENSION).
    principal, von_mises: CalculiX's largest principal and von Mises stress.
    chart: Peterson's factor.
    """

    ours: Run
    principal: float
    von_mises: float
    chart: float | None


def tension() -> str:
    """Return the table."""
    if not installed():
        return MISSING
    rows = []
    for shape in SHAPES:
        t = factors(*shape, FINEST)
        k, mises = float(t.ours.principal[TENSION]), float(t.ours.von_mises[TENSION])
        assert t.chart is not None
        rows.append(
            (*map(str, shape), t.ours.unknowns, f"{k:.4f}", f"{t.principal:.4f}",
             f"{k / t.principal:.4f}", f"{t.chart:.4f}", f"{k / t.chart:.3f}", f"{mises:.4f}",
             f"{t.von_mises:.4f}", f"{mises / t.von_mises:.4f}")
        )  # fmt: skip
    return (
        "Largest stress at the fillet over the nominal stress of the thin shaft; K is of the first "
        "principal stress:\n\n" + table(HEAD, rows)
    )


def factors(ratio: float, radius: float, size: SectionSize) -> Tension:
    """Return the maxima by both on meshes of one size.

    Raises: CalculixError.
    """
    pin = shoulder(ratio, radius)
    chart = shoulder_factor(CHARTS[TENSION], ratio * D, D, radius * D)
    return Tension(run(pin, size), *axisymmetric(pin, size), chart)


def axisymmetric(pin: Pin, size: SectionSize) -> tuple[float, float]:
    """Return CalculiX's largest principal and von Mises stress at the fillet, Pa.

    The start face is pulled by 1 Pa, the end face is held.
    """
    section = meridian_mesh(pin, size)
    space = Section(section)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / f"{JOB_NAME}.inp").write_text("\n".join(_deck(section, space)) + "\n")
        seconds_of(run_calculix(folder))
        stress = stresses(folder / f"{JOB_NAME}.frd")
    assert len(stress) == len(space.nodes)
    at = stress[np.unique(section.edges["fillet 2"])]
    tensor = at[:, [[0, 5, 4], [5, 1, 3], [4, 3, 2]]]
    return float(np.linalg.eigvalsh(tensor).max()), float(von_mises(at).max())


def _deck(section: MeridianMesh, space: Section) -> Iterator[str]:
    r, z = space.nodes.T
    nodes = np.stack([np.maximum(r, 0.0), z, np.zeros_like(r)], axis=1)
    elements = _turned(nodes, space.elements)
    yield from mesh_lines("CAX6", nodes, elements, STEEL)
    yield "*BOUNDARY"
    for node in np.unique(section.edges["end"]):
        yield f"{node + 1}, 1, 2"
    for node in np.setdiff1d(section.axis, section.edges["end"]):
        yield f"{node + 1}, 1"
    yield from ("*STEP", "*STATIC", "*DLOAD")
    pulled = {frozenset(ends) for ends in section.edges["start"][:, :2].tolist()}
    for number, element in enumerate(elements.tolist(), 1):
        for side, (a, b) in enumerate(SIDES, 1):
            if {element[a], element[b]} in pulled:
                yield f"{number}, P{side}, -1."
    yield from ("*EL FILE, OUTPUT=2D", "S", "*END STEP")


def _turned(nodes: Floats, elements: Ints) -> Ints:
    """Return the elements with their nodes in counter-clockwise order."""
    a, b, c = np.moveaxis(nodes[elements[:, :3], :2], 1, 0)
    first, second = b - a, c - a
    negative = first[:, 0] * second[:, 1] < first[:, 1] * second[:, 0]
    return np.where(negative[:, None], elements[:, MIRRORED], elements)
