"""Derivatives of pins in contact: all that may change, and differences of whole solutions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.derivatives import moved_maximum, richardson
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.derivatives.in_lugs import Joint, JointParameter
from fea.derivatives.records import SolvedCase
from fea.derivatives.virtual_work import Interior
from fea.harmonic.assembly import Section
from fea.harmonic.evaluate import SectionProblem, harmonic_solution
from fea.harmonic.model import HarmonicBody
from fea.joint.contact import Pressed, rotation
from fea.joint.flexibility import RingBody
from fea.joint.lugs.lug import Bushing, Lug
from fea.joint.solve_joint import Cells, JointModel
from fea.refine import singularities_of
from geometry import Pin
from geometry.arrays import Floats
from geometry.mesh.outline_motion import OutlineNodes, Reach
from geometry.mesh.section_mesh import MeridianMesh
from geometry.shape.dimensions import dimensions

ALL = 1e-15  # what a pattern of pressures must add
STEP = 1e-4  # of a parameter


def parameters(pin: Pin, material: Material, lugs: Sequence[Lug]) -> Iterator[JointParameter]:
    """All lengths and moduli of a joint, each by itself."""
    given = tuple(lugs)
    for d in dimensions(pin):
        changed = d.changed
        yield JointParameter(d.key, d.value, d.value, lambda x, c=changed: (c(x), material, given))
    for k, lug in enumerate(given):
        for key, value in (
            ("clearance", lug.clearance),
            ("outer_diameter", lug.outer_diameter),
            ("edge_radius", lug.edge_radius),
        ):
            if value or key == "clearance":
                scale = value or 1e-3 * pin.band(lug.connection).radius
                name = f"lug.{lug.connection}.{key}"
                yield JointParameter(
                    name,
                    value,
                    scale,
                    lambda x, k=k, key=key: (pin, material, _with(given, k, **{key: x})),
                )
        if lug.bushing is not None:
            ring = lug.bushing
            yield JointParameter(
                f"lug.{lug.connection}.bushing.thickness",
                ring.thickness,
                ring.thickness,
                lambda x, k=k, ring=ring: (
                    pin,
                    material,
                    _with(given, k, bushing=replace(ring, thickness=x)),
                ),
            )
    every = {material, *(x.material for x in given), *(x.bearing for x in given)}
    for one in sorted(every, key=lambda m: m.name):
        for key in ("youngs_modulus", "poisson_ratio", "density"):
            value = getattr(one, key)
            if value:
                yield JointParameter(
                    f"material.{one.name}.{key}",
                    value,
                    value,
                    lambda x, one=one, key=key: _made_of(
                        (pin, material, given), one, replace(one, **{key: x})
                    ),
                )


def _with(lugs: tuple[Lug, ...], k: int, **changed: object) -> tuple[Lug, ...]:
    return tuple(replace(x, **changed) if i == k else x for i, x in enumerate(lugs))


def _made_of(joint: Joint, old: Material, new: Material) -> Joint:
    pin, material, lugs = joint

    def made(one: Material) -> Material:
        return new if one == old else one

    def of(ring: Bushing | None) -> Bushing | None:
        return ring and replace(ring, material=made(ring.material))

    found = tuple(replace(x, material=made(x.material), bushing=of(x.bushing)) for x in lugs)
    return pin, made(material), found


@dataclass(frozen=True)
class WholeJoint:
    """A joint, its maximum on the meshes of a solution as they are moved."""

    solved: SolvedCase
    model: JointModel
    links: PinLoads

    def maximum(self, parameter: JointParameter, value: float) -> float:
        """With another value of a parameter, all of it found anew."""
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
            was = model.on_lugs[model.likeness(old, before)]
            eye = other.eye(lug, ends)
            space = was.body.space
            mesh = space.section
            nodes = np.stack(
                [
                    np.interp(space.nodes[:, k], one, two)
                    for k, (one, two) in enumerate(
                        zip(_knots(model.eye(old, before), old), _knots(eye, lug), strict=True)
                    )
                ]
            )
            mesh = replace(mesh, mesh=replace(mesh.mesh, doflocs=nodes))
            both = lug.material if lug.bushing is None else (lug.bushing.material, lug.material)
            body = HarmonicBody(eye, Section(mesh, space.parts), both, pivot=0.5)
            found = RingBody(body, was.rings, was.pushed, guided=True).flexibility(highest)
            other.of_lugs[:, own, own], other.wavy[:, :, own, own] = found, other.wavy_of(lug, ends)
        waves = other.waves([self._pressed(other)])
        loads = other.patterns([(waves, ALL)]).loads(waves, links)
        mesh = self.solved.solution.mesh
        reaches = [Reach((p.r, p.z), p.radius) for p in self.solved.zones]
        shift = _moved(mesh, model.pin, other.pin, reaches).mesh.doflocs - mesh.mesh.doflocs
        return moved_maximum(self.solved, other.pin, shift.T, material, loads)

    def _pressed(self, model: JointModel) -> Pressed:
        """With the cells where they are."""
        (before,) = self.model.pressed(self.links)
        turn = rotation(before.angle)
        x, y = (model.couples(self.links)[0] @ turn).tolist()
        forces = model.forces(self.links)[0] @ turn
        return model.contact.solve(forces, (x, y), before.active).turned(before.angle)

    def derivative(self, parameter: JointParameter) -> float:
        """By differences."""
        return richardson(
            lambda x: self.maximum(parameter, parameter.value + x), STEP * parameter.scale
        )


def whole_joint(
    pin: Pin, material: Material, lugs: Sequence[Lug], links: PinLoads, cells: Cells
) -> WholeJoint:
    """Solved on its first mesh, with all harmonics of contact."""
    model = JointModel(pin, material, lugs, cells)
    waves = model.waves(model.pressed(links))
    loads = model.patterns([(waves, ALL)]).loads(waves, links)
    zones = singularities_of(model.pin, material, (), (loads,))
    problem = SectionProblem(model.pin, material, (), (loads,), zones, model.first)
    section = harmonic_solution(problem, 0, 1.0)
    return WholeJoint(SolvedCase(model.pin, material, (), loads, section, zones), model, links)


def _knots(eye: Pin, lug: Lug) -> tuple[Floats, Floats]:
    bore, outer = eye.segments[0].bore / 2.0, eye.segments[0].diameter / 2.0
    between = [] if lug.bushing is None else [bore + lug.bushing.thickness]
    return np.array([bore, *between, outer]), np.array(eye.stations)


def _moved(
    mesh: MeridianMesh, before: Pin, after: Pin, reaches: Sequence[Reach] = ()
) -> MeridianMesh:
    """A mesh with its outline where that of another pin is."""
    nodes = OutlineNodes(mesh, before, reaches)
    space = Section(mesh)
    shift = nodes.at(after) - space.nodes[nodes.rows]
    every = Interior(space, nodes.rows).velocity(shift[:, :, None])[:, :, 0]
    return replace(mesh, mesh=replace(mesh.mesh, doflocs=mesh.mesh.doflocs + every.T))
