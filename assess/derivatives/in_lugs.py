"""Derivatives of the largest stress of a pin in contact with its lugs: by shape, material, loads.

As long as the same cells are in contact, the contact pressures are a smooth function of all
parameters, and the stress is a smooth function of pressures and parameters. Three adjoint solutions
serve all parameters: the adjoint of the stress under given pressures
(assess.derivatives.pressed_stress), on the mesh of the maximum or for a section by its forces; the
adjoint of the contact problem (assess.derivatives.held_contact); and the displacements of pin and
lugs under the pressures and under the adjoint pressures (assess.derivatives.ring_work), on the
meshes of their flexibilities. The result is the derivative of the maximum on all moved meshes, with
the contact cells of the solution.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from assess.derivatives.governing import By
from assess.derivatives.held_contact import FixedContact
from assess.derivatives.in_section import OTHER_EDGES_REASON
from assess.derivatives.pressed_stress import JointStep, OfSections, OfSurface, PressedStress
from assess.derivatives.records import SolvedCase
from assess.derivatives.ring_work import RingWork
from assess.derivatives.virtual_work import Interior
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.places import Place
from fea.harmonic.assembly import elasticity
from fea.support.contact.pressure_loads import others_along
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Lug
from geometry import ArgumentError, GeometryError, Pin
from geometry.mesh.outline_motion import (
    DIFFERENCE_STEPS,
    RELATIVE_STEPS,
    OtherShapeError,
    OutlineNodes,
    rate_of,
)
from pinbase.arrays import Floats

JOINT_FORCE_STEP = 1e-4  # difference step, relative to the largest force; contact is linear in it
TRANSVERSE_AXES = "xy"
SHAPE_ROUND_OFF = 1e-13  # relative to the size: smaller motions are round-off
Joint = tuple[Pin, Material, tuple[Lug, ...]]


@dataclass(frozen=True)
class JointParameter:
    """A parameter of a pin in its lugs.

    scale: the steps of differences are parts of this.
    changed: a function that returns the joint with another value of the parameter.
    """

    key: str
    value: float
    scale: float
    changed: Callable[[float], Joint]


@dataclass(frozen=True)
class JointDerivatives:
    """Derivatives of the largest stress `maximum`, Pa, of a pin in its lugs.

    by_parameter: Pa per unit of the parameter, by its key.
    without: for each parameter without a derivative, the reason.
    by_force: Pa/N, for the force of each link, by connection and axis of the pin. The links share
    the imbalance that a changed force leaves.
    by_moment: Pa/(N m), for moments about the pin's axis, and transverse ones where links state
    moments.
    tied_places, tied_times: as in assess.derivatives.records.Derivatives.
    changing: number of contact cells that are about to open or to close. If there are any, the
    derivatives are one-sided.
    """

    maximum: float
    by_parameter: dict[str, float]
    without: dict[str, str]
    by_force: By
    by_moment: By
    tied_places: tuple[tuple[float, float], ...] = ()
    tied_times: tuple[float, ...] = ()
    changing: int = 0


def joint_derivatives(
    solved: SolvedCase,
    model: ContactModel,
    links: PinLoads,
    parameters: Iterable[JointParameter] = (),
    *,
    alone: bool = False,
    place: Place = "surface",
) -> JointDerivatives:
    """Return the derivatives of the largest stress under contact pressures at one instant.

    solved: the pin with its bands cut into rings.
    links: the loads that the rings carry.
    alone: whether to differentiate by the parameters only, without loads and ties.
    place: the maximum of the surface or of the sections.

    Raises: MeshError, SolveError.
    """
    of = OfSections if place == "section" else OfSurface
    joint = _InLugs(of(solved, model, links), model, links)
    return joint.derivatives(tuple(parameters), alone)


class _InLugs:
    """The adjoints of a pin in its lugs."""

    def __init__(self, stress: PressedStress, model: ContactModel, links: PinLoads) -> None:
        self.stress, self.model, self.links = stress, model, links
        self.contact = FixedContact(model, links, stress.by_pressures())

    def derivatives(self, parameters: tuple[JointParameter, ...], alone: bool) -> JointDerivatives:
        """Return the derivatives by parameters and, unless `alone`, by loads, with ties."""
        changes, without = [], {}
        for parameter in parameters:
            try:
                changes.append(self._change(parameter))
            except OtherShapeError:
                without[parameter.key] = OTHER_EDGES_REASON
        stress = self.stress
        if alone:
            return JointDerivatives(stress.maximum, self._by(changes), without, {}, {})
        return JointDerivatives(
            stress.maximum,
            self._by(changes),
            without,
            self._by_forces(),
            self._by_moments(),
            stress.tied_places,
            stress.tied_times,
            self.contact.changing,
        )

    @cached_property
    def pin_work(self) -> RingWork:
        return RingWork(self.model.on_pin, {"": tuple(self.contact.pairs())})

    @cached_property
    def lug_works(self) -> dict[str, RingWork]:
        """The work of each lug's flexibility, by connection; identical lugs share a `RingWork`."""
        model, out = self.model, dict[str, RingWork]()
        for key, equal in model.equal_lugs().items():
            pairs = {x.connection: tuple(self.contact.pairs(rings)) for rings, x, _ in equal}
            out |= dict.fromkeys(pairs, RingWork(model.on_lugs[key], pairs))
        return out

    @cached_property
    def _flexible(self) -> OutlineNodes:
        """The nodes on the outline of the mesh for the pin's flexibility."""
        return OutlineNodes(self.pin_work.space.section, self.model.pin)

    def _change(self, parameter: JointParameter) -> JointStep:
        """Return the joint at the difference steps of a parameter.

        Raises: OtherShapeError if every step changes the topology of the joint or its mesh.
        """
        model, key = self.model, parameter.key
        # Try the largest step first, then smaller ones where the joint or its mesh would differ in
        # topology.
        for part in RELATIVE_STEPS:
            step = part * parameter.scale
            values = [parameter.value + x * step for x in DIFFERENCE_STEPS]
            try:
                models = tuple(model.reshaped(*parameter.changed(value)) for value in values)
            except (ArgumentError, GeometryError):
                continue
            if any(one.rings != model.rings for one in models):
                continue
            change = JointStep(key, models, step, None)
            pins = tuple(one.pin for one in models)
            try:
                if any(pin != model.pin for pin in pins):
                    change = replace(change, flexible=self._flexible.among(key, pins, step))
                self.stress.require(change)
            except OtherShapeError:
                continue
            return change
        raise OtherShapeError

    def _by(self, changes: Sequence[JointStep]) -> dict[str, float]:
        """Return the derivatives by the key of each parameter."""
        # First the derivatives under fixed pressures. Then add the terms that change the pressures:
        # the flexibility of the pin by shape and material, the gaps and the equilibrium, and the
        # flexibility of the lugs.
        out = self.stress.at_fixed_pressures(changes)
        shapes = [x.flexible for x in changes if x.flexible is not None]
        if shapes:
            moved = np.stack([motion.velocity for motion in shapes], axis=2)
            interior = Interior(self.pin_work.space, self._flexible.rows)
            velocities = np.moveaxis(interior.velocity(moved), 2, 0)
            for motion, velocity in zip(shapes, velocities, strict=True):
                out[motion.key] += self.pin_work.by_shape("", velocity)
        for change in changes:
            total = float(change.rate(self.contact.with_fixed_cells))
            if any(one.material != self.model.material for one in change.models):
                D = change.rate(lambda one: elasticity(one.material))
                total += self.pin_work.by_material("", [D])
            total += sum(self._by_lug(change, lug) for lug in self.model.lugs)
            out[change.key] += total
        return out

    def _acts(self, what: str) -> bool:
        """Whether any axial force (`what` is "forces") or axial moment ("moments") acts."""
        return bool(getattr(self.links, what)[..., 2].any())

    def _by_lug(self, change: JointStep, lug: Lug) -> float:
        """Return the contribution of a lug's elasticity to the derivative, Pa per unit."""
        name = lug.connection
        number = self.model.lugs.index(lug)
        others = [one.lugs[number] for one in change.models]
        work, total = self.lug_works[name], 0.0
        if any(one.materials != lug.materials for one in others):
            elasticities = [[elasticity(part) for part in one.materials] for one in others]
            rates = [rate_of(parts, change.step) for parts in zip(*elasticities, strict=True)]
            total += work.by_material(name, rates)
        at = _knots(self.model, lug)
        knots = [_knots(*both) for both in zip(change.models, others, strict=True)]
        if all(
            np.abs(x - y).max() <= SHAPE_ROUND_OFF * y[-1]
            for one in knots
            for x, y in zip(one, at, strict=True)
        ):
            return total
        moved = [rate_of([one[k] for one in knots], change.step) for k in (0, 1)]
        # Nodes keep their relative positions between the radii and stations of the lug, so their
        # velocities are interpolated.
        nodes = work.space.nodes
        each_way = [np.interp(nodes[:, k], at[k], moved[k]) for k in (0, 1)]
        velocity, lengths = np.stack(each_way, axis=1), [float(z[-1]) for _, z in knots]
        total += work.by_shape(name, velocity)
        return total + work.by_reaction(name, velocity, lengths, change.step)

    def _by_forces(self) -> By:
        """Return the derivatives by transverse link forces, and by axial ones if any act."""
        links, out = self.links, dict[tuple[str, str], float]()
        step = JOINT_FORCE_STEP * float(np.abs(links.forces).max())
        before = self.contact.by_loads(links)
        for c, surface in enumerate(links.surfaces):
            for a, axis in enumerate(TRANSVERSE_AXES):
                one = np.zeros_like(links.forces)
                one[:, c, a] = step
                changed = replace(links, forces=links.forces + one)
                out[surface, axis] = (self.contact.by_loads(changed) - before) / step
            if self._acts("forces"):
                out[surface, "z"] = self._by_axial("forces", c)
        return out

    def _by_moments(self) -> By:
        """Return the derivatives by axial moments, if any act, and by stated transverse moments."""
        links, length = self.links, self.model.pin.length
        tilting = links.tilting_links(length)
        links = replace(links, tilting=tilting)
        turns = enumerate(links.surfaces if self._acts("moments") else ())
        out = {(surface, "z"): self._by_axial("moments", c) for c, surface in turns}
        scale = max(np.abs(links.forces).max() * length, np.abs(links.moments).max())
        step, before = JOINT_FORCE_STEP * float(scale), self.contact.by_loads(links)
        for surface in tilting:
            for a, axis in enumerate(TRANSVERSE_AXES):
                one = np.zeros_like(links.moments)
                one[:, links.surfaces.index(surface), a] = step
                changed = replace(links, moments=links.moments + one)
                out[surface, axis] = (self.contact.by_loads(changed) - before) / step
        return out

    def _by_axial(self, what: str, c: int) -> float:
        """Return the derivative by the axial force or axial moment of link c.

        what: "forces" or "moments".
        """
        none = np.zeros_like(self.links.forces)
        one = none.copy()
        # The sign of an axial force decides on which side of its lug the force bears.
        way = -1.0 if what == "forces" and self.links.forces[0, c, 2] < 0.0 else 1.0
        one[:, c, 2] = way
        both = (one, none) if what == "forces" else (none, one)
        unit = replace(self.links, forces=both[0], moments=both[1], body=none[:, 0])
        along = others_along(self.model.pin, self.model.rings, unit).coefficients()
        return self.stress.of_amounts({load: way * both[0] for load, both in along.items()})


def _knots(model: ContactModel, lug: Lug) -> tuple[Floats, Floats]:
    """Return the radii and the z (m) of a lug between which mesh nodes keep their relative
    positions.
    """
    bore, ends = model.whole.band(lug.connection).radius, model.ends[lug.connection]
    between = [] if lug.bushing is None else [bore + lug.bushing.thickness]
    return np.array([bore, *between, 0.5 * lug.outer_diameter]), ends - ends[0]
