"""Newton-Euler equations of every body and pin, at all instants at once.

By virtual work the few multipliers f of the loop and drive equations balance the forces that the
bodies require, J^T f = partials . (m a - weight - applied); the forces in all members follow from
them. With more equations than coordinates rigid-body statics leaves the forces along the null
vectors of J^T undetermined; the linkage's sharing rule determines them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Literal

import numpy as np

from loads.forces.acting import Load, balance
from loads.forces.holding import holding, require_closed
from loads.forces.reactions import Reactions
from loads.forces.sharing import shares
from loads.linkage.friction import MAX_ENUMERATED_CONTACTS, JammingError, contact_sizes
from loads.linkage.linkage import LinkageError
from loads.linkage.parts import GROUND, Point, Slider, Turn
from loads.motion.joint_forces import connection_members, slider_couple, slider_members
from loads.motion.loop_equations import cross, number, pairs
from loads.motion.motion import Motion, side_by_side
from pinbase.arrays import Complex, Floats

MIN_SLIDING_SPEED = 1e-13  # of the fastest coordinate of the course: a slider this slow is at rest


@dataclass(frozen=True)
class SliderForces:
    """Forces of the base on the moving body of every slider, (T, S) each.

    normal: N, positive to the left of the axis.
    couple: N m, about the slider's end.
    friction: N, along the axis.
    """

    normal: Floats
    couple: Floats
    friction: Floats


@dataclass(frozen=True)
class Dynamics:
    """Reactions, with the forces of the drives and the loads.

    actuators: the A actuators that hold the linkage, its drives first.
    drive: (T, A) forces, N, positive where they extend a slider; torques, N m, counter-clockwise.
    applied: the loads.
    sliders: forces in the sliders.
    pin_friction: (T, C) N m, couple of each pin on the body that turns on it.
    needed, couples: (T, items) forces (complex, N) and couples (N m) that joints and drives must
    exert on each item.
    shared: connections whose forces follow the sharing rule.
    """

    reactions: Reactions
    actuators: tuple[Slider | Turn, ...]
    drive: Floats
    motion: Motion
    applied: tuple[Load, ...]
    sliders: SliderForces
    pin_friction: Floats
    needed: Complex
    couples: Floats
    shared: tuple[str, ...]

    @property
    def power(self) -> Floats:
        """Power of every actuator, (T, A) W."""
        return self.drive * self.course[1]

    @property
    def course(self) -> tuple[Floats, Floats, Floats]:
        """Position (m or rad) of every actuator and its rates, (T, A) each."""
        return side_by_side([self.motion.coordinate(a) for a in self.actuators], len(self.motion))

    def shaking(self, about: Point) -> tuple[Floats, Floats]:
        """Shaking force (T, 2) N and moment (T,) N m of the linkage on its ground.

        about: the point of the moment, m.
        """
        centres, _, _ = self.motion.centres
        moment = self.couples + cross(centres - number(about), self.needed)
        return -pairs(self.needed.sum(axis=1)), -moment.sum(axis=1)


def motion_reactions(
    case: str,
    motion: Motion,
    applied: Sequence[Load] = (),
    timed: bool = True,
    hold: Sequence[str] = (),
    friction: bool = True,
) -> Dynamics:
    """Reactions of a driven motion under gravity, applied loads and friction.

    case: name, for messages.
    timed: whether the instants follow each other in time.
    hold: names of the sliders and turns that hold the linkage, by default its drives.
    friction: whether friction acts.

    Raises: LinkageError when connections share forces without a rule or the linkage is not held;
    JammingError.
    """
    loads = tuple(applied)
    solved = (_Balance(part, loads, hold, friction).dynamics(case, timed) for part in motion.parts)
    # Each batch's motion, with its matrices, is released before the next is solved.
    parts = [replace(dynamics, motion=motion) for dynamics in solved]
    return parts[0] if len(parts) == 1 else _joined(parts)


def _joined(parts: Sequence[Any]) -> Any:
    """One result from those of successive batches in time.

    Arrays are joined along time, also those inside dataclasses; anything else is the same in all.
    """
    first: Any = parts[0]
    if isinstance(first, np.ndarray):
        return np.concatenate(parts)
    if isinstance(first, (Reactions, SliderForces, Dynamics)):
        keys = [field.name for field in fields(first)]
        return replace(first, **{key: _joined([getattr(p, key) for p in parts]) for key in keys})
    return first


@dataclass(frozen=True)
class _Source:
    """A force (couple) in proportion to the magnitude of a contact force.

    It is the friction of a slider or pin, or the radial force of teeth.
    which: number of the slider, connection or pair of teeth.
    share: (T,) per newton of the contact force; m for a pin.
    f: (T, rows) multipliers that one newton (newton metre) of it brings about.
    couples: (T, items) couples that items require in addition, per newton metre.
    spread: (T, teeth) radial forces of teeth, per newton.
    """

    name: str
    kind: Literal["slider", "pin", "teeth"]
    which: int
    share: Floats
    f: Floats
    couples: Floats
    spread: Floats


class _Balance:
    """The balance of forces of one motion, linear in the forces that the bodies require."""

    def __init__(
        self, motion: Motion, applied: tuple[Load, ...], hold: Sequence[str], rubs: bool
    ) -> None:
        self.motion, self.applied, self.loops = motion, applied, motion.loops
        self.rubs = rubs
        self.held = holding(motion, hold)
        self.connections = connection_members(self.loops)
        self.slides = slider_members(self.loops)
        self.shared = motion.mobility.shared
        self.needed, self.couples = self._needs()
        self.no_forces, self.no_couples = np.zeros_like(self.needed), np.zeros_like(self.couples)
        self.no_spread = np.zeros((len(motion), len(motion.linkage.teeth)))

    def dynamics(self, case: str, timed: bool) -> Dynamics:
        """Reactions and drive forces; `case` and `timed` as of `motion_reactions`."""
        linkage = self.motion.linkage
        # Without friction and radial forces of teeth; these are added in proportion to contacts.
        f = self._multipliers(self._generalised(self.needed, self.couples), self.needed)
        sizes = (len(linkage.sliders), len(linkage.connections), len(linkage.teeth))
        friction, on_pins, spread = (np.zeros((len(f), n)) for n in sizes)
        by_kind = {"slider": friction, "pin": on_pins, "teeth": spread}
        couples = self.couples
        if sources := self._sources():
            amounts, f = self._with_contacts(f, sources)
            for i, s in enumerate(sources):
                by_kind[s.kind][:, s.which] = amounts[:, i]
                couples = couples + amounts[:, i, None] * s.couples
        drive = self._drives(f)
        require_closed(self.held, drive)
        normal, couple = self._slider_forces(self._closing(f, spread), f, self.needed, couples)
        return Dynamics(
            reactions=self._reactions(case, self._closing(f, spread), timed),
            actuators=self.held.actuators,
            drive=drive,
            motion=self.motion,
            applied=self.applied,
            sliders=SliderForces(normal, couple, friction),
            pin_friction=on_pins,
            needed=self.needed,
            couples=self.couples,
            shared=self.shared,
        )

    def _needs(self) -> tuple[Complex, Floats]:
        """Required forces, m a - weight - applied force, and couples about the centres, (T, items).

        Forces are in N, complex; couples in N m.
        """
        motion = self.motion
        _, _, acceleration = motion.centres
        needed = motion.masses * (acceleration - number(motion.linkage.gravity))
        couples = motion.inertias * motion.spin_rate
        for i, force, couple in balance(motion, self.applied):
            needed[:, i] -= force
            couples[:, i] -= couple
        return needed, couples

    def _generalised(self, needed: Complex, couples: Floats) -> Floats:
        """The required forces and couples as generalised forces, (T, n) N (N m for angles)."""
        loops = self.loops
        out = loops.along_coordinates(self.motion.pose, needed, loops.centres)
        for i in range(len(loops.linkage.items)):
            if f := loops.frame[i]:
                out[:, f - 1] += couples[:, i]
        return out

    def _closing(self, f: Floats, spread: Floats | None = None) -> Complex:
        """Forces (T, closing and teeth) N at the members that close loops, and at teeth."""
        return self.loops.closing_forces(self.motion.pose, f, spread)

    def _drives(self, f: Floats) -> Floats:
        """Forces (N) and torques (N m) of the actuators, (T, A)."""
        return self.held.forces(f[:, f.shape[1] - self.held.weights.shape[2] :])

    def _multipliers(
        self, generalised: Floats, needed: Complex, spread: Floats | None = None
    ) -> Floats:
        """Multipliers (T, rows) that balance generalised forces, by the sharing rules.

        generalised: (T, n) N (N m for angles).
        needed: (T, items) N, the forces from which they come.
        spread: (T, teeth) N, radial forces of teeth.
        """
        factors = self.held.factors
        f = factors.solve_transposed(generalised / self.loops.scale)
        if not self.shared:
            return f
        # Null vectors of J^T are self-equilibrated: add them in the amounts that the rules demand.
        null = factors.null
        no_forces = np.zeros((1, needed.shape[1]), dtype=complex)
        closing = [self._closing(null[:, :, i]) for i in range(null.shape[2])]
        loose = np.stack([self._everywhere(no_forces, c) for c in closing], axis=2)
        forces = self._everywhere(needed, self._closing(f, spread))
        amounts = shares(self.loops.linkage, forces, loose, self.motion.mobility)
        return f + (null @ amounts[..., None])[..., 0]

    def _everywhere(self, needed: Complex, closing: Complex) -> Complex:
        """Forces on the bodies at all connections and teeth, (T, connections and teeth) N."""
        teeth = closing[:, len(self.loops.closing) :]
        return np.concatenate([self.connections.forces(needed, closing), teeth], axis=1)

    def _slider_forces(
        self, closing: Complex, f: Floats, needed: Complex, couples: Floats
    ) -> tuple[Floats, Floats]:
        """Normal force (N) and couple (N m) at every slider, (T, S) each."""
        loops, pose = self.loops, self.motion.pose
        sliders = loops.linkage.sliders
        if not sliders:
            return np.zeros((len(f), 0)), np.zeros((len(f), 0))
        force = self.slides.forces(needed, closing)
        normal = np.real(np.conj(1j * pose.axis) * force)
        centres, _, _ = self.motion.centres
        closing_at = loops.place(pose, loops.closing_points)
        forces = zip(self.held.actuators, self._drives(f).T, strict=True)
        torques = [(a, force) for a, force in forces if isinstance(a, Turn)]
        couple = np.stack(
            [
                slider_couple(
                    loops, k, self._end(s), centres, needed, couples, closing_at, closing, torques
                )
                for k, s in enumerate(sliders)
            ],
            axis=1,
        )
        return normal, couple

    def _end(self, slider: Slider) -> Complex:
        """Position of a slider's end, (T,) m."""
        index = self.loops.linkage.index
        item, at = np.array([index[slider.moving]]), np.array([number(slider.end)])
        return self.loops.place(self.motion.pose, self.loops.points(item, at))[:, 0]

    def _sources(self) -> list[_Source]:
        """Everything in proportion to a contact force: friction, and radial forces of teeth."""
        rubbing = [*self._rubbing_sliders(), *self._rubbing_pins()] if self.rubs else []
        return [*rubbing, *self._teeth()]

    def _opposing(self, speed: Floats) -> Floats:
        """Sign of friction at a sliding speed (T,) m/s: against it, 0 at rest."""
        return np.where(np.abs(speed) > MIN_SLIDING_SPEED * self.motion.pace, -np.sign(speed), 0.0)

    def _rubbing_sliders(self) -> Iterator[_Source]:
        """The friction of each slider that has some."""
        motion, first = self.motion, self.loops.frames - 1
        for k, s in enumerate(motion.linkage.sliders):
            if s.friction:
                push = np.zeros_like(motion.q)
                push[:, first + k] = -1.0
                share = s.friction * self._opposing(motion.v[:, first + k])
                f = self._multipliers(push, self.no_forces)
                yield _Source(
                    f"slider {s.name}", "slider", k, share, f, self.no_couples, self.no_spread
                )

    def _rubbing_pins(self) -> Iterator[_Source]:
        """The friction couple of each pin that has some."""
        linkage, motion = self.motion.linkage, self.motion
        for c, (joint, connection) in enumerate(linkage.connections):
            if connection.friction:
                couples = self.no_couples.copy()
                for name, sign in ((connection.body, -1.0), (linkage.carrier(joint), 1.0)):
                    if (i := linkage.index[name]) < couples.shape[1]:  # not the ground
                        couples[:, i] = sign
                f = self._multipliers(self._generalised(self.no_forces, couples), self.no_forces)
                speed = motion.turning(joint, connection) * linkage.length_scale
                share = connection.friction * self._opposing(speed)
                name = f"pin {joint.name} at {connection.name}"
                yield _Source(name, "pin", c, share, f, couples, self.no_spread)

    def _teeth(self) -> Iterator[_Source]:
        """The radial force of each pair of teeth."""
        for g, teeth in enumerate(self.motion.linkage.teeth):
            spread = self.no_spread.copy()
            spread[:, g] = 1.0
            f = self._multipliers(np.zeros_like(self.motion.q), self.no_forces, spread)
            share = np.full(len(f), np.tan(teeth.pressure_angle))
            yield _Source(f"teeth {teeth.name}", "teeth", g, share, f, self.no_couples, spread)

    def _contact_forces(
        self, sources: list[_Source], f: Floats, needed: Complex, of: _Source | None = None
    ) -> list[Complex]:
        """Contact forces of each source, (T, contacts) N.

        They are those of pads along their normal, of pins in the plane, and of teeth along the
        pitch circle.
        f, needed: multipliers and required forces, from which they follow.
        of: the source that brings them about; None: the forces that the bodies require.
        """
        couples, spread = (of.couples, of.spread) if of else (self.couples, None)
        closing = self._closing(f, spread)
        slides = any(s.kind == "slider" for s in sources)
        normal, couple = self._slider_forces(closing, f, needed, couples) if slides else (f, f)
        pins = self.connections.forces(needed, closing)
        tangential = f[:, 2 * len(self.loops.closing) : self.loops.guides]
        out = []
        for s in sources:
            if s.kind == "pin":
                out.append(pins[:, [s.which]])
            elif s.kind == "teeth":
                out.append(tangential[:, [s.which]].astype(complex))
            else:
                # Two pads at a distance carry the couple by a pair of forces.
                n, bearing = normal[:, s.which], self.loops.linkage.sliders[s.which].bearing
                pads = [n]
                if bearing is not None:
                    pads = [n / 2 + sign * couple[:, s.which] / bearing for sign in (1.0, -1.0)]
                out.append(np.stack(pads, axis=1).astype(complex))
        return out

    def _with_contacts(self, f: Floats, sources: list[_Source]) -> tuple[Floats, Floats]:
        """Forces (couples) of the sources, (T, sources), and the multipliers with them.

        f: (T, rows) multipliers without the sources.

        Raises: LinkageError for too many contacts with friction; JammingError.
        """
        free = self._contact_forces(sources, f, self.needed)
        owner = [i for i, contacts in enumerate(free) for _ in range(contacts.shape[1])]
        rubbing = sum(sources[i].kind != "teeth" for i in owner)
        if rubbing > MAX_ENUMERATED_CONTACTS:
            raise LinkageError(
                f"{rubbing} contacts have friction; at most {MAX_ENUMERATED_CONTACTS} can be "
                "solved",
                "too-many-contacts",
            )
        # Contact forces that one unit of each source brings about; then sources in proportion.
        unit = [
            np.concatenate(self._contact_forces(sources, s.f, self.no_forces, s), 1)
            for s in sources
        ]
        response = np.stack([unit[i] * sources[i].share[:, None] for i in owner], axis=2)
        try:
            sizes = contact_sizes(np.concatenate(free, axis=1), response)
        except JammingError as error:
            raise self._named(error, response, [sources[i].name for i in owner]) from None
        amounts = np.zeros((len(f), len(sources)))
        for k, i in enumerate(owner):
            amounts[:, i] += sources[i].share * sizes[:, k]
        for i, s in enumerate(sources):
            f = f + amounts[:, i, None] * s.f
        return amounts, f

    def _named(self, error: JammingError, response: Complex, names: list[str]) -> JammingError:
        """The same error, which also names the time and what rubs."""
        t = int(error.instants[0])
        grips = np.abs(np.diagonal(response[t]))
        when = f"t = {self.motion.times[t]:.6g} s" if len(self.motion) > 1 else ""
        return JammingError(
            error.instants, error.none, error.grip, when, names[int(grips.argmax())]
        )

    def _reactions(self, case: str, closing: Complex, timed: bool) -> Reactions:
        """Forces of the bodies on the pins, from those at closures and teeth."""
        motion, linkage = self.motion, self.motion.linkage
        on_body = self._everywhere(self.needed, closing)
        on_pin = np.zeros((*on_body.shape, 3))
        on_pin[..., 0], on_pin[..., 1] = -on_body.real, -on_body.imag
        # A pin's own axes turn with what it is fixed in; those of a floating pin are the world's.
        carriers = [j.fixed_in or GROUND for j, _ in linkage.connections]
        carriers += [t.carrier for t in linkage.teeth]
        turn = np.stack([motion.angle(item) for item in carriers], axis=1)
        names, bodies = zip(*linkage.forces, strict=True)
        return Reactions(
            case=case,
            times=motion.times if timed else None,
            connections=names,
            bodies=bodies,
            forces=on_pin,
            moments=np.zeros_like(on_pin),
            turn=turn,
        )
