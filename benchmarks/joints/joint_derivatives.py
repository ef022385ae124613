"""Derivatives of pins in contact by all parameters, compared with differences of whole
solutions.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from assess.derivatives.in_lugs import Joint, JointParameter, joint_derivatives
from assess.derivatives.records import SolvedCase
from assess.derivatives.virtual_work import Interior
from benchmarks.joints.random_joints import JointTrial, joint_trials
from benchmarks.pins.derivatives import moved_maximum, richardson, timed
from benchmarks.pins.derivatives import price as of_free_pins
from benchmarks.timing import table
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.places import Place
from fea.core.requirement import Requirement
from fea.harmonic.assembly import Section
from fea.harmonic.field import HarmonicField
from fea.harmonic.model import HarmonicBody
from fea.harmonic.section_solution import SectionProblem, harmonic_solution
from fea.section.section_stress import SectionField
from fea.singular.singularities import singularities_of
from fea.solve.solve import solve_in_lugs
from fea.support.contact.contact_state import ContactState
from fea.support.contact.flexibility import RingBody, lug_rings
from fea.support.contact.held import HeldContact
from fea.support.contact.resolution import Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Bushing, Lug
from fea.support.support import PinProblem, Solution
from geometry import Pin
from geometry.mesh.outline_motion import OutlineNodes, Reach
from geometry.mesh.section_mesh import MeridianMesh
from geometry.shape.dimensions import Dimension, dimensions
from pinbase.arrays import Floats

JOINTS = 4
CHECKED = 2  # the most important parameters of each joint, which are compared with differences
ROUGH = Resolution(4, 24, 8)  # of the whole solutions from which differences are taken
ALL = 1e-15  # least contribution of a pattern of pressures, so that all are included
STEP = 1e-4  # of the differences, over the scale of a parameter


def price() -> str:
    """Return the tables of the cost of derivatives, for pins without contact and for random pins in
    contact with their lugs.
    """
    rows = [_row(trial) for trial in joint_trials(JOINTS, seed=22)]
    head = (
        "joint",
        "rings",
        "unknowns",
        "parameters",
        "solution, s",
        "derivatives, s",
        "price",
        "off Richardson's",
    )
    ratio = float(np.median([row[-2] for row in rows]))
    return (
        f"{of_free_pins()}\n\nRandom pins in contact with their lugs, on the cells of their "
        "solution: all derivatives (dimensions of pin and lugs, clearances, moduli, loads) take "
        f"{ratio:.2g} of the solution (median). Differences are of whole solutions on "
        f"{ROUGH.rings} rings by {ROUGH.sectors} sectors, contact included, all meshes moved with "
        f"the parameter; the error is the largest over the {CHECKED} parameters p that matter "
        "most, of p dσ/dp relative to its largest:\n\n" + table(head, rows)
    )


def _row(trial: JointTrial) -> tuple[Any, ...]:
    pin, material = trial.pin, trial.material
    lugs = [
        replace(x, material=replace(x.material, name=f"lug {x.connection}")) for x in trial.lugs
    ]
    given = PinProblem(pin, material, tuple(lugs), (trial.loads,))
    (made,), solving = timed(lambda: solve_in_lugs(given, Requirement()))
    every = list(parameters(pin, material, lugs))
    places = made.peak.places
    assert places is not None
    found, deriving = timed(
        lambda: joint_derivatives(*solved_in_lugs(made, material), every, place=places.governs)
    )
    whole = whole_joint(pin, material, lugs, trial.loads, ROUGH)
    ours = joint_derivatives(whole.solved, whole.model, whole.links, every).by_parameter
    most = sorted((p for p in every if p.key in ours), key=lambda p: -abs(p.scale * ours[p.key]))[
        :CHECKED
    ]
    off = max(abs(p.scale * (ours[p.key] - whole.derivative(p))) for p in most)
    return (
        pin.name,
        len(made.held.model.rings) if isinstance(made.held, HeldContact) else 0,
        f"{made.peak.dofs:,}",
        len(found.by_parameter),
        solving,
        deriving,
        deriving / solving,
        f"{off / abs(most[0].scale * ours[most[0].key]):.0e}",
    )


def solved_in_lugs(made: Solution, material: Material) -> tuple[SolvedCase, ContactModel, PinLoads]:
    """Return the parts of a solution that are differentiated."""
    held, answer = made.held, made.answer
    assert isinstance(answer, HarmonicField)
    assert made.rings is not None
    assert isinstance(held, HeldContact)
    assert made.peak.governing is not None
    loads = made.loads.at(np.array([made.instant]))
    solved = SolvedCase(made.rings, material, (), loads, answer.solution, answer.singularities)
    return solved, held.model, made.peak.governing


def parameters(pin: Pin, material: Material, lugs: Sequence[Lug]) -> Iterator[JointParameter]:
    """Yield all lengths and moduli of a joint, each by itself; materials are distinguished by their
    names.
    """
    joint = pin, material, tuple(lugs)
    for d in dimensions(pin):
        yield JointParameter(d.key, d.value, d.value, partial(_of_pin, joint, d))
    for k, lug in enumerate(lugs):
        loose = 1e-3 * pin.band(lug.connection).radius
        thickness = 0.0 if lug.bushing is None else lug.bushing.thickness
        for key, value, scale in (
            ("clearance", lug.clearance, loose),
            ("outer_diameter", lug.outer_diameter, lug.outer_diameter),
            ("edge_radius", lug.edge_radius, lug.edge_radius),
            ("bushing.thickness", thickness, thickness),
        ):
            if scale:
                changed = partial(_of_lug, joint, k, key)
                yield JointParameter(f"lug.{lug.connection}.{key}", value, scale, changed)
    every = {x.name: x for lug in lugs for x in (lug.material, lug.bearing)}
    for one in (every | {material.name: material}).values():
        for key in ("youngs_modulus", "poisson_ratio", "density"):
            if value := getattr(one, key):
                changed = partial(_made_of, joint, one, key)
                yield JointParameter(f"material.{one.name}.{key}", value, value, changed)


def _of_pin(joint: Joint, dimension: Dimension, value: float) -> Joint:
    return dimension.changed(value), *joint[1:]


def _of_lug(joint: Joint, k: int, key: str, value: float) -> Joint:
    pin, material, lugs = joint
    if key == "bushing.thickness" and (ring := lugs[k].bushing) is not None:
        one = replace(lugs[k], bushing=replace(ring, thickness=value))
    else:
        changed: dict[str, Any] = {key: value}
        one = replace(lugs[k], **changed)
    return pin, material, (*lugs[:k], one, *lugs[k + 1 :])


def _made_of(joint: Joint, old: Material, key: str, value: float) -> Joint:
    pin, material, lugs = joint
    changed: dict[str, Any] = {key: value}

    def made(one: Material) -> Material:
        return replace(one, **changed) if one == old else one

    def of(ring: Bushing | None) -> Bushing | None:
        return ring and replace(ring, material=made(ring.material))

    found = (replace(x, material=made(x.material), bushing=of(x.bushing)) for x in lugs)
    return pin, made(material), tuple(found)


@dataclass(frozen=True)
class WholeJoint:
    """A joint and its maximum at one place, on the meshes of its solution, which move with a
    parameter.
    """

    solved: SolvedCase
    model: ContactModel
    links: PinLoads
    place: Place = "surface"

    def maximum(self, parameter: JointParameter, value: float) -> float:
        """Return the maximum for another value of a parameter, with contact and stress solved
        again.
        """
        model, links = self.model, self.links
        pin, material, lugs = parameter.changed(value)
        other = model.reshaped(pin, material, lugs)
        rings = model.on_pin
        moved = _moved(rings.body.space.section, model.pin, other.pin)
        on = HarmonicBody(other.pin, Section(moved), material, pivot=0.5)
        highest = model.cells.highest
        other.of_pin = RingBody(on, rings.rings, rings.pushed).flexibility(highest)
        other.of_lugs, other.wavy = np.zeros_like(model.of_lugs), np.zeros_like(model.wavy)
        for (own, lug, ends), (_, old, before) in zip(other.by_lug(), model.by_lug(), strict=True):
            was = lug_rings(model.eye(old, before), old, model.cells.across)
            eye = other.eye(lug, ends)
            space = was.body.space
            mesh = space.section
            nodes = np.stack(
                [
                    np.interp(space.nodes[:, k], one, two)
                    for k, (one, two) in enumerate(
                        zip(_knots(model.eye(old, before), old), _knots(eye, lug), strict=True)
                    )
                ],
                axis=1,
            )
            mesh = replace(mesh, nodes=nodes)
            both = lug.material if lug.bushing is None else (lug.bushing.material, lug.material)
            body = HarmonicBody(eye, Section(mesh, space.parts), both, pivot=0.5)
            found = RingBody(body, was.rings, was.pushed, guided=True).flexibility(highest)
            other.of_lugs[:, own, own], other.wavy[:, :, own, own] = found, other.wavy_of(lug, ends)
        waves = other.waves([self._pressed(other)])
        arcs = other.arcs(model.pressed(links))
        loads = other.patterns([(waves, ALL)]).loads(waves, links, arcs)
        if self.place == "section":
            on_rings = loads.on_rings
            return SectionField(other.pin, material, (), [on_rings]).place(on_rings).value
        mesh = self.solved.solution.mesh
        reaches = [Reach((p.r, p.z), p.radius) for p in self.solved.zones]
        shift = _moved(mesh, model.pin, other.pin, reaches).nodes - mesh.nodes
        return moved_maximum(self.solved, other.pin, shift, material, loads)

    def _pressed(self, model: ContactModel) -> ContactState:
        """Return the contact of a changed model, with the same active cells."""
        (before,) = self.model.pressed(self.links)
        acting = model.acting(self.links).turned([before.angle])
        x, y = acting.couples[0].tolist()
        contact, (forces,), (moments,) = model.freed(self.links), acting.forces, acting.moments
        return contact.solve(forces, (x, y), before.active, moments).turned(before.angle)

    def derivative(self, parameter: JointParameter) -> float:
        """Return the derivative by differences."""
        return richardson(
            lambda x: self.maximum(parameter, parameter.value + x), STEP * parameter.scale
        )


def whole_joint(
    pin: Pin,
    material: Material,
    lugs: Sequence[Lug],
    links: PinLoads,
    cells: Resolution,
    place: Place = "surface",
) -> WholeJoint:
    """Return a joint solved on its first mesh, with all harmonics of contact."""
    model = ContactModel(pin, material, lugs, cells)
    found = model.pressed(links)
    waves = model.waves(found)
    loads = model.patterns([(waves, ALL)]).loads(waves, links, model.arcs(found))
    zones = singularities_of(model.pin, material, (), (loads,))
    problem = SectionProblem(model.pin, material, (), (loads,), zones, model.first)
    section = harmonic_solution(problem, 0, 1.0)
    solved = SolvedCase(model.pin, material, (), loads, section, zones)
    return WholeJoint(solved, model, links, place)


def _knots(eye: Pin, lug: Lug) -> tuple[Floats, Floats]:
    bore, outer = eye.segments[0].bore / 2.0, eye.segments[0].diameter / 2.0
    between = [] if lug.bushing is None else [bore + lug.bushing.thickness]
    return np.array([bore, *between, outer]), np.array(eye.stations)


def _moved(
    mesh: MeridianMesh, before: Pin, after: Pin, reaches: Sequence[Reach] = ()
) -> MeridianMesh:
    """Return a mesh whose outline is moved to that of another pin."""
    nodes = OutlineNodes(mesh, before, reaches)
    space = Section(mesh)
    shift = nodes.at(after) - space.nodes[nodes.rows]
    every = Interior(space, nodes.rows).velocity(shift[:, :, None])[:, :, 0]
    return replace(mesh, nodes=mesh.nodes + every)
