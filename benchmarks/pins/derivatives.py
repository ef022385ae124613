"""Derivatives of the largest stress: their cost compared with that of the solution, and their
accuracy.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

import numpy as np

from assess.derivatives.derivatives import derivatives
from assess.derivatives.records import Derivatives, SolvedCase
from assess.derivatives.virtual_work import Interior
from benchmarks.random_pins import STEEL, Trial, trials
from benchmarks.timing import table
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.harmonic.assembly import Section
from fea.harmonic.field import HarmonicField
from fea.harmonic.free_surface import reader
from fea.harmonic.model import HarmonicModel
from fea.harmonic.section_solution import _ends, _rims
from fea.singular.singularities import singularities_of
from fea.solve.solve import solve_pin
from geometry import Pin
from geometry.mesh.outline_motion import OutlineNodes, Reach
from geometry.shape.dimensions import Dimension, dimensions
from pinbase.arrays import Floats

T = TypeVar("T")
PINS = 10
STEP = 1e-3  # of the differences, over the dimension
FINE = 0.005  # tolerance of the meshes that give the true values


def price() -> str:
    """Return the cost and the errors for random pins with fillets."""
    rows = [_row(trial) for trial in trials(PINS, seed=22)]
    head = (
        "pin",
        "unknowns",
        "dimensions",
        "solution, s",
        "derivatives, s",
        "price",
        "off Richardson's",
        "off finer meshes",
    )
    ratio = float(np.median([row[-3] for row in rows]))
    return (
        "Random pins with fillets, processor times: all derivatives of a case (dimensions, loads, "
        f"material) take {ratio:.2g} of the solution (median). Differences are central, "
        "extrapolated by Richardson, of the same mesh moved as a whole; finer meshes are those of "
        f"a tolerance of {FINE:.1%}. Both errors are the largest over all dimensions p, of "
        "p dσ/dp relative to its largest:\n\n" + table(head, rows)
    )


def _row(trial: Trial) -> tuple[object, ...]:
    solution, solving = timed(lambda: _solved(trial, Requirement(model="harmonic")))
    every = list(dimensions(trial.pin))
    ours, deriving = timed(lambda: derivatives(solution, every))
    scale = max(abs(one.value * ours.by_dimension[one.key]) for one in every)
    fine = derivatives(_solved(trial, Requirement(FINE, model="harmonic")), every)
    theirs = by_differences(solution)
    off = max(abs(one.value * (ours.by_dimension[one.key] - theirs[one.key])) for one in every)
    return (
        trial.pin.name,
        f"{solution.solution.fields.unknowns:,}",
        len(every),
        solving,
        deriving,
        deriving / solving,
        f"{off / scale:.0e}",
        f"{_apart(ours, fine, every):.1%}",
    )


def _apart(ours: Derivatives, fine: Derivatives, every: list[Dimension]) -> float:
    one, other = (
        np.array([p.value * x.by_dimension[p.key] for p in every]) / x.maximum for x in (ours, fine)
    )
    return float(np.abs(one - other).max() / np.abs(other).max())


def timed(work: Callable[[], T]) -> tuple[T, float]:
    """Return the result of `work` and its processor time, s."""
    start = time.process_time()
    made = work()
    return made, time.process_time() - start


def _solved(trial: Trial, requirement: Requirement) -> SolvedCase:
    (found,) = solve_pin(trial.pin, STEEL, trial.clamps, (trial.loads,), requirement)
    assert isinstance(found.answer, HarmonicField)
    assert found.peak.governing is not None
    zones = found.answer.singularities
    loads = found.peak.governing
    return SolvedCase(trial.pin, STEEL, trial.clamps, loads, found.answer.solution, zones)


def velocities(of: SolvedCase) -> tuple[list[Dimension], Floats]:
    """Return the dimensions, and the velocities (N, 2, P) of the nodes of the mesh with each of
    them.
    """
    reaches = [Reach((p.r, p.z), p.radius) for p in of.zones]
    nodes = OutlineNodes(of.solution.mesh, of.pin, reaches)
    every = list(dimensions(of.pin))
    moved = np.stack([nodes.motion(each).velocity for each in every], axis=2)
    return every, Interior(Section(of.solution.mesh), nodes.rows).velocity(moved)


def moved_maximum(
    of: SolvedCase,
    pin: Pin,
    moved: Floats,
    material: Material,
    loads: PinLoads | None = None,
    point: int | None = None,
) -> float:
    """Return the stress, Pa, at the governing point, or at another one by its number, on the moved
    mesh.

    moved: displacements of the nodes (N, 2); everything is solved again.
    loads: other loads than those of the case, if any.
    """
    loads = loads or of.loads
    mesh = of.solution.mesh
    mesh = replace(mesh, nodes=mesh.nodes + moved)
    zones = singularities_of(pin, material, of.clamps, (loads,))
    units = tuple(loads.coefficients())
    ends = _ends(pin, of.clamps, units)
    fields = HarmonicModel(pin, mesh, material, of.clamps).solve(units, _rims(pin, zones), ends)
    if point is None:
        before = reader(of.solution.fields, of.loads, of.material.poisson_ratio)
        point = before.top(before.fields.outside(of.zones)).point
    read = reader(fields, loads, material.poisson_ratio)
    value, _ = read.largest_over_angle(np.array([point]), np.array([0]))
    return float(value[0])


def by_differences(of: SolvedCase, some: slice = slice(None)) -> dict[str, float]:
    """Return the derivatives of this stress by some of the dimensions, Pa/m."""
    every, velocity = velocities(of)
    out = {}
    for k in range(len(every))[some]:
        one = every[k]

        def at(x: float, one: Dimension = one, k: int = k) -> float:
            pin = one.changed(one.value + x)
            return moved_maximum(of, pin, x * velocity[:, :, k], of.material)

        out[one.key] = richardson(at, STEP * one.value)
    return out


def richardson(at: Callable[[float], float], step: float) -> float:
    """Return the derivative at 0 by central differences with a step and with half of it,
    extrapolated.
    """

    def central(h: float) -> float:
        return (at(h) - at(-h)) / (2.0 * h)

    return (4.0 * central(step / 2.0) - central(step)) / 3.0
