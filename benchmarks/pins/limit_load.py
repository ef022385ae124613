"""Limit loads: in closed form, by CalculiX on the same mesh, and by the 10-node tetrahedron."""

from __future__ import annotations

import math
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from assess.opinion.calculix import installed
from assess.plastic.body import Elements, FlowingBody, untied
from assess.plastic.flow import FlowRule
from assess.plastic.limit_load import MeshBracket, limit_on_mesh
from assess.plastic.mechanism import RefinedElements
from assess.plastic.pin_body import PinBody, acting_at, pin_body, refine
from benchmarks.pins.calculix_plastic import factor_reached
from benchmarks.timing import table
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.solid.assembly import Discretisation
from fea.solid.boundary import clamped_nodes, surface
from fea.solid.nodal_loads import nodal_loads
from geometry import Pin, Segment
from geometry.imported.meshing import solid_mesh
from geometry.mesh.hexahedra import HexSize
from geometry.mesh.solid_mesh import MeshSize

YIELD, D = 250e6, 0.02
RULE = FlowRule(Material("steel", 200e9, 0.3, None, YIELD))
SIZES = HexSize(2, 0.5), HexSize(4, 0.25)
TETRAHEDRA = MeshSize(2.0, 1.0), MeshSize(3.0, 1.0)
HEAD = (
    "pin", "elements", "unknowns", "reached", "upper", "CalculiX", "change of volume", "steps",
    "iterations", "s", "s of CalculiX",
)  # fmt: skip


@dataclass(frozen=True)
class Problem:
    """A pin with loads. exact: the limit load factor of these loads; None where it is not known."""

    name: str
    pin: Pin
    clamps: tuple[str, ...]
    loads: PinLoads
    exact: float | None = None


def limit_load() -> str:
    """Return the table; factors are over the exact one, or without one over that reached on the
    first mesh.
    """
    rows: list[tuple[str, ...]] = []
    for problem in _problems():
        one = problem.exact
        for size in SIZES:
            begin = time.perf_counter()
            acting = acting_at(problem.loads, 0)
            made = pin_body(problem.pin, RULE, problem.clamps, acting, size)
            found = limit_on_mesh(made.body, made.forces, refine(made.body.elements))
            one = one or found.reached
            theirs = (
                _calculix(made, found)
                if size is SIZES[0] and problem.clamps and installed()
                else None
            )
            spent = time.perf_counter() - begin - (theirs[1] if theirs else 0.0)
            rows.append(_row(problem.name, "hexahedra", found, one, spent, theirs))
        if problem.clamps:
            rows += [_tetrahedra(problem, size, one or 1.0) for size in TETRAHEDRA]
    return table(HEAD, rows)


def _problems() -> tuple[Problem, ...]:
    plastic = 4.0 / 3.0 * YIELD * (D / 2.0) ** 3
    twisted = math.pi / 12.0 * YIELD / math.sqrt(3.0) * D**3
    short = Pin("p", (Segment(2.0 * D, D), Segment(0.5 * D, D, connection="a")))
    push = PinLoads("push", ("a",), np.array([[[1e3, 0.0, 0.0]]]))
    return (
        Problem("bar, bending", _bar(0.0), (), _couples(1), plastic),
        Problem("tube, bending", _bar(0.5), (), _couples(1), plastic * (1.0 - 0.5**3)),
        Problem("bar, torsion", _bar(0.0), (), _couples(2), twisted),
        Problem("cantilever", short, ("start",), push),
    )


def _bar(bore: float) -> Pin:
    a, b = (Segment(2.0 * D, D, bore * D, connection=name) for name in "ab")
    return Pin("bar", (a, Segment(4.0 * D, D, bore * D), b))


def _couples(axis: int) -> PinLoads:
    moments = np.zeros((1, 2, 3))
    moments[0, :, axis] = 1.0, -1.0
    return PinLoads("couples", ("a", "b"), np.zeros((1, 2, 3)), moments)


def _calculix(made: PinBody, found: MeshBracket) -> tuple[float, float]:
    """Return CalculiX's load factor and its wall time, s."""
    begin = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        factor = factor_reached(made, 1.05 * found.reached, Path(folder))
    return factor, time.perf_counter() - begin


def _tetrahedra(problem: Problem, size: MeshSize, one: float) -> tuple[str, ...]:
    begin = time.perf_counter()
    space = Discretisation(solid_mesh(problem.pin, size).mesh)
    units = tuple((load, phase) for load, phase, _ in acting_at(problem.loads, 0))
    amounts = [amount for _, _, amount in acting_at(problem.loads, 0)]
    boundary = surface(space)
    forces = nodal_loads(problem.pin, RULE.material, space, boundary, units).forces @ amounts
    nodes = clamped_nodes(space, problem.clamps)
    ties = untied(len(space.nodes)).without((3 * nodes[:, None] + np.arange(3)).ravel())
    elements = Elements(space.nodes, space.elements, space.gradients, space.weights)
    body = FlowingBody(elements, ties, RULE)
    same = RefinedElements(elements, np.eye(elements.weights.shape[1]))
    found = limit_on_mesh(body, np.asarray(ties.matrix.T @ forces.ravel()), same)
    spent = time.perf_counter() - begin
    return _row(problem.name, "tetrahedra, 10 nodes", found, one, spent, None)


def _row(
    name: str,
    kind: str,
    found: MeshBracket,
    one: float,
    seconds: float,
    theirs: tuple[float, float] | None,
) -> tuple[str, ...]:
    factor, slow = (f"{theirs[0] / one:.4f}", f"{theirs[1]:.0f}") if theirs else ("", "")
    return (
        name,
        kind,
        str(found.unknowns),
        f"{found.reached / one:.4f}",
        f"{found.above.factor / one:.4f}",
        factor,
        f"{found.above.volume:.3f}",
        str(found.steps),
        str(found.iterations),
        f"{seconds:.1f}",
        slow,
    )
