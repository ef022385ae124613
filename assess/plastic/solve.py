"""The limit load of a pin by the smallest model that decides whether the pin carries its loads.

beam     hinges and slip, if they decide beyond the error of the model   (assess.plastic.hinge)
solid    elastic-plastic, two meshes, a third if the bracket is wide     (assess.plastic.limit_load)
"""

from __future__ import annotations

import math
import time
from dataclasses import replace
from typing import Literal

import numpy as np
from skfem import ElementHexS2

from assess.plastic.budget import Budget, OutOfTimeError
from assess.plastic.flow import FlowRule
from assess.plastic.hinge import HINGE_ERROR, BeamBounds, beam_bounds
from assess.plastic.limit_load import EQUILIBRIUM_ALLOWANCE, MeshBracket, bracket, limit_on_mesh
from assess.plastic.path import State
from assess.plastic.pin_body import PinBody, acting_at, pin_body, plane_of, reading, refine
from assess.plastic.records import FlowField, LimitLoad, PlasticMesh
from fea.core.material import Material
from fea.core.memory import solid_memory
from fea.core.pin_loads import PinLoads
from fea.core.voigt import von_mises
from geometry import Pin, PinLike, body_of_revolution
from geometry.mesh.hexahedra import HexSize, twenty
from pinbase.arrays import Floats

Rung = Literal["auto", "solid"]

MESH_SIZES = HexSize(2, 0.5), HexSize(4, 0.25), HexSize(6, 1.0 / 6.0)
MAX_BRACKET = 0.05 + EQUILIBRIUM_ALLOWANCE  # width of a bracket relative to its middle
MAX_SOLID_UNKNOWNS = 60_000  # of the solid; takes a minute or two
# Rough estimates of processor time, chosen by judgement.
SECONDS_PER_UNKNOWN = 3e-3  # time of the first two meshes, s, per unknown of the first
TIME_EXPONENT = 1.5  # the time of a mesh grows at least with this power of its unknowns
# Largest load after which the permanent set is reported, relative to the limit load; chosen by
# judgement.
MAX_SET_LOAD_SHARE = 0.95
TETRAHEDRA_NOTE = (
    "only for pins of a profile without holes and flats: others need tetrahedra, which lock when "
    "the metal flows"
)
TIME_LIMIT_NOTE = (
    "limit load not computed, because it takes more than {:g} s of processor time: --limit-load "
    "computes it"
)
SIZE_LIMIT_NOTE = "the solid would need more than {:,} unknowns or the memory that is allowed"


def limit_load(
    pin: PinLike,
    material: Material,
    clamps: tuple[str, ...],
    loads: PinLoads,
    rung: Rung = "auto",
    memory: float | None = None,
    seconds: float = math.inf,
) -> LimitLoad:
    """Return the limit load of a pin under the loads of one instant.

    clamps: the names of the clamped surfaces.
    rung: "solid" to solve the solid even if the beam decides.
    memory: memory that may be used, MB; None for no limit.
    seconds: processor time that may be used; if it does not suffice, there is no result, not even a
    partial one.

    Raises: ArgumentError for a material without yield strength; SolveError.
    """
    begin, budget = time.perf_counter(), Budget(seconds)
    rule = FlowRule(material)
    profile = body_of_revolution(pin)
    if profile is None:
        return LimitLoad("none", note=TETRAHEDRA_NOTE)
    if not profile.stepped:
        return LimitLoad("none", note="only for pins of cylinders, without cones or rounded edges")
    # Try the beam first, which costs little; solve the solid only if the beam's error leaves the
    # question open.
    bounds = of_beam(profile, material, clamps, loads)
    if bounds is not None and rung == "auto":
        carries = decided(bounds)
        if carries is not None:
            return LimitLoad(
                "beam",
                float(bounds.lower[0]),
                float(bounds.upper[0]),
                carries,
                hardening=bool(material.hardening),
                seconds=time.perf_counter() - begin,
                note=f"the theorems for beams; that decides by more than {HINGE_ERROR:.0%}",
            )
    try:
        meshes, last, note = _meshes(profile, rule, clamps, loads, (memory, budget))
    except OutOfTimeError:
        spent, note = time.perf_counter() - begin, TIME_LIMIT_NOTE.format(seconds)
        return LimitLoad("none", seconds=spent, note=note, stopped=True)
    if last is None or len(meshes) < 2:
        return LimitLoad("none", seconds=time.perf_counter() - begin, note=note)
    flow = flow_field(last, meshes[-1].last, plane_of(loads, 0))
    limit = _of_solid(meshes, bounds, rule, note)
    return replace(limit, flow=flow, seconds=time.perf_counter() - begin)


def decided(bounds: BeamBounds) -> bool | None:
    """Whether a beam carries its loads at the first instant; None if its error leaves it open."""
    if bounds.lower[0] > 1.0 + HINGE_ERROR:
        return True
    return False if bounds.upper[0] < 1.0 - HINGE_ERROR else None


def of_beam(
    pin: Pin, material: Material, clamps: tuple[str, ...], loads: PinLoads
) -> BeamBounds | None:
    """Return the beam's bounds; None for contact pressures on rings, which a beam cannot carry."""
    if any(load.parts for load in loads.coefficients()):
        return None
    return beam_bounds(pin, material, clamps, loads)


def _meshes(
    pin: Pin,
    rule: FlowRule,
    clamps: tuple[str, ...],
    loads: PinLoads,
    most: tuple[float | None, Budget],
) -> tuple[list[MeshBracket], PinBody | None, str]:
    """Return the limit load on each mesh, the body on the last mesh, and a note.

    Meshes are refined until the bracket of the last two is narrow enough or the next mesh is too
    large; in the second case the note says so, and there may be fewer than two meshes.
    most: memory, MB, and the budget of time.

    Raises: SolveError; OutOfTimeError, also before a mesh that would take longer than the remaining
    budget. The time of the first two meshes is estimated from the number of unknowns, which is the
    same on every computer; that of a later mesh from the time of the mesh before it.
    """
    memory, budget = most
    meshes: list[MeshBracket] = []
    last: PinBody | None = None
    seconds = 0.0
    for size in MESH_SIZES:
        candidate = body_on(pin, rule, clamps, loads, size)
        too_much = memory is not None and solid_memory(candidate.body.size) > memory
        if candidate.body.size > MAX_SOLID_UNKNOWNS or too_much:
            return meshes, last, SIZE_LIMIT_NOTE.format(MAX_SOLID_UNKNOWNS)
        # Stop before a mesh that would exceed the budget.
        if last is None:
            budget.require(candidate.body.size * SECONDS_PER_UNKNOWN)
        else:
            budget.require(seconds * (candidate.body.size / last.body.size) ** TIME_EXPONENT)
        last, before = candidate, budget.spent
        meshes.append(
            limit_on_mesh(candidate.body, candidate.forces, refine(candidate.body.elements), budget)
        )
        seconds = budget.spent - before
        if len(meshes) > 1 and narrow_enough(*bracket(meshes)):
            break
    return meshes, last, ""


def body_on(
    pin: Pin, rule: FlowRule, clamps: tuple[str, ...], loads: PinLoads, size: HexSize
) -> PinBody:
    """Return the pin on a mesh, under the loads of the first instant.

    Raises: SolveError.
    """
    return pin_body(pin, rule, clamps, acting_at(loads, 0, -plane_of(loads, 0)), size)


def narrow_enough(lower: float, upper: float) -> bool:
    """Whether a bracket is narrow and decides whether the pin carries its loads."""
    return upper - lower <= MAX_BRACKET * (upper + lower) / 2.0 and not lower < 1.0 < upper


def _of_solid(
    meshes: list[MeshBracket], bounds: BeamBounds | None, rule: FlowRule, note: str
) -> LimitLoad:
    """Return the result of the meshes of the solid. If the beam's bound by slip is lower than the
    upper bound of the solid, the slip bound replaces it.
    """
    lower, upper = bracket(meshes)
    finest = meshes[-1]
    if bounds is not None and bounds.slip[0] < upper:
        upper, note = float(bounds.slip[0]), "slip of a section is the upper bound"
        lower = min(lower, 2.0 * upper - finest.reached)  # as far below as the mesh is above
    at = min(1.0, MAX_SET_LOAD_SHARE * lower)
    return LimitLoad(
        "solid",
        lower,
        upper,
        True if lower > 1.0 else False if upper < 1.0 else None,
        hardening=bool(rule.material.hardening),
        permanent_set=finest.permanent_at(at),
        permanent_at=at,
        meshes=tuple(
            PlasticMesh(
                m.unknowns,
                m.reached,
                m.above.factor,
                m.above.volume,
                m.above.charge,
                m.steps,
                m.iterations,
            )
            for m in meshes
        ),
        curve=finest.curve,
        note=note,
    )


def flow_field(pin: PinBody, state: State, angle: float) -> FlowField:
    """Return the flow field of a state in the pin's axes.

    angle: angle by which the axes of the state are rotated from the pin's axes, rad.
    """
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return FlowField(
        points=pin.mesh.nodes @ turn,
        cells=pin.mesh.elements[:, twenty()],
        displacement=pin.body.displacement(state.unknowns) @ turn,
        plastic_strain=np.maximum(_at_nodes(pin, state.flow.equivalent), 0.0),
        von_mises=_at_nodes(pin, von_mises(state.flow.stress)),
        factor=state.factor,
    )


def _at_nodes(pin: PinBody, values: Floats) -> Floats:
    """Return nodal values (N,): the mean of the values that the elements at a node extrapolate.

    values: (M, 8) at the quadrature points.
    """
    at_corners = values @ reading(np.asarray(ElementHexS2().doflocs)).T
    numbers = pin.mesh.elements.ravel()
    total = np.bincount(numbers, at_corners.ravel(), minlength=len(pin.mesh.nodes))
    return np.asarray(total / np.bincount(numbers, minlength=len(pin.mesh.nodes)))
