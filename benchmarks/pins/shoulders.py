"""Shoulder fillets: maxima of the harmonic model compared with a much finer mesh and with
Peterson's charts, and their times.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from benchmarks.random_pins import STEEL
from benchmarks.timing import table
from fea.beam.stress_concentration import BENDING_FIT, TENSION_FIT, TORSION_FIT, shoulder_factor
from fea.core.pin_loads import Floats, PinLoads
from fea.core.voigt import TENSOR_TO_VOIGT
from fea.harmonic.fields import MeridianFields
from fea.harmonic.model import HarmonicModel
from fea.harmonic.superposition import Circumference
from geometry import Pin, Segment
from geometry.mesh.section_mesh import SectionSize, meridian_mesh

D = 0.05
SHAPES = (
    (1.05, 0.0125),
    (1.05, 0.025),
    (1.1, 0.025),
    (1.1, 0.05),
    (1.25, 0.0125),
    (1.25, 0.05),
    (1.5, 0.025),
    (1.5, 0.1),
    (2.0, 0.05),
    (2.0, 0.2),
    (3.0, 0.1),
    (3.0, 0.3),
)  # D/d, r/d
KINDS = ("bending", "tension", "torsion")
CHARTS = (BENDING_FIT, TENSION_FIT, TORSION_FIT)
QUICK = SectionSize(2.8, 5.6, 0.6)  # error of 1 %
GOOD = SectionSize(6.0, 14.0, 0.3)  # error of 0.3 %
FINEST = SectionSize(20.0, 44.0, 0.1)  # ten times the unknowns of GOOD
RUNS = 3
AWAY = 1.5  # diameters from the loaded band to the shoulder


@dataclass(frozen=True)
class Run:
    """The maxima at a fillet over the nominal stress of the thin shaft, by kind of load.

    von_mises, principal: von Mises and first principal stress.
    unknowns: of the mesh. seconds: time, meshing included.
    """

    von_mises: Floats
    principal: Floats
    unknowns: int
    seconds: float


def shoulder(ratio: float, radius: float) -> Pin:
    """Return a shaft of diameter D with a shoulder `ratio` times as thick and a fillet of `radius`
    D.
    """
    thin = Segment(AWAY * D, D)
    segments = (Segment(0.5 * D, D, connection="A"), thin, Segment(1.5 * ratio * D, ratio * D))
    return Pin("shoulder", segments, radius * D)


def loads(kind: str) -> PinLoads:
    """Return loads of a kind that give unit nominal stress in the thin shaft."""
    area, modulus = np.pi * D**2 / 4.0, np.pi * D**3 / 32.0
    force, moment = np.zeros((1, 1, 3)), np.zeros((1, 1, 3))
    if kind == "tension":
        force[0, 0, 2] = -area  # a pull at the start
    elif kind == "bending":
        moment[0, 0, 1] = modulus
    else:
        moment[0, 0, 2] = 2.0 * modulus
    return PinLoads(kind, ("A",), force, moment)


def run(pin: Pin, size: SectionSize, kinds: tuple[str, ...] = KINDS) -> Run:
    """Return the maxima on one mesh for all kinds of load, or some."""
    start = time.perf_counter()
    cases = [loads(kind) for kind in kinds]
    units = tuple(load for case in cases for load in case.coefficients())
    fields = HarmonicModel(pin, meridian_mesh(pin, size), STEEL, ("end",)).solve(units)
    found = [_peaks(pin, fields, case) for case in cases]
    spent = time.perf_counter() - start
    von_mises, principal = np.array(found).T
    return Run(von_mises, principal, fields.unknowns, spent)


def _peaks(pin: Pin, fields: MeridianFields, case: PinLoads) -> tuple[float, float]:
    r, z = fields.points.T
    rho = pin.fillet
    near = (np.abs(z - pin.stations[2]) < 1.2 * rho) & (r < D / 2 + 1.2 * rho)
    near &= np.arange(len(r)) < fields.skin
    around = Circumference(fields, case)
    top = around.top(near)
    at = np.flatnonzero(near)
    s = around.stress(at, 0, np.array([top.angle]))[:, 0]
    return top.value, float(np.abs(np.linalg.eigvalsh(s[:, TENSOR_TO_VOIGT])).max())


def shoulders() -> str:
    """Return the table."""
    run(shoulder(*SHAPES[0]), QUICK)  # not timed: loads the libraries
    lines = []
    worst, quick_worst, times = 0.0, 0.0, []
    alone: list[float] = []
    for shape in SHAPES:
        pin = shoulder(*shape)
        quick, good, finest = (run(pin, size) for size in (QUICK, GOOD, FINEST))
        error = 100.0 * (good.von_mises / finest.von_mises - 1.0)
        rough = 100.0 * (quick.von_mises / finest.von_mises - 1.0)
        worst, quick_worst = max(worst, *np.abs(error)), max(quick_worst, *np.abs(rough))
        times.append(quick.seconds)
        alone += [min(run(pin, QUICK, (kind,)).seconds for _ in range(RUNS)) for kind in KINDS]
        for k, kind in enumerate(KINDS):
            chart = shoulder_factor(CHARTS[k], shape[0] * D, D, shape[1] * D)
            factor = finest.principal[k]
            lines.append(
                (
                    kind,
                    str(shape[0]),
                    str(shape[1]),
                    f"{finest.von_mises[k]:.3f}",
                    f"{error[k]:+.2f}",
                    f"{rough[k]:+.2f}",
                    f"{factor:.3f}",
                    "" if chart is None else f"{factor / chart:.3f}",
                )
            )
    head = (
        "load", "D/d", "r/d", "von Mises / nominal", "error [%]", "error, coarse mesh [%]",
        "K_t", "K_t / Peterson",
    )  # fmt: skip
    return (
        "Largest von Mises stress at the fillet over the nominal stress; errors relative to a mesh "
        "of ten times the unknowns; K_t from the first principal stress, and over Peterson's "
        "(Pilkey's fit).\n\n"
        + table(head, sorted(lines, key=lambda line: KINDS.index(line[0])))
        + f"\n\nLargest error {worst:.2f} %, on the coarse mesh {quick_worst:.2f} %. Median time "
        f"of the coarse mesh, meshing included: {1e3 * np.median(times):.0f} ms for all three "
        f"loads, {1e3 * np.median(alone):.0f} ms for one (least of {RUNS} runs)."
    )
