"""Newton-Euler equations of every body and pin, at all instants at once.

By virtual work the few multipliers f of the loop and drive equations balance the forces that the
bodies require, J^T f = partials . (m a - weight - applied). The forces in all members follow from
these multipliers. If there are more equations than coordinates, rigid-body statics leaves the
forces along the null vectors of J^T undetermined; the linkage's sharing rule determines them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from loads.forces.acting import Load
from loads.forces.contact_forces import sources_of, with_contacts
from loads.forces.force_balance import ForceBalance
from loads.forces.holding import require_closed
from loads.forces.reactions import Reactions, joined
from loads.linkage.parts import GROUND, Point, Slider, Turn
from loads.motion.complex_points import cross, number, pairs
from loads.motion.motion import Motion, side_by_side
from pinbase.arrays import Complex, Floats


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

    actuators: the A actuators that hold the linkage.
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
        """Shaking force (T, 2) N and moment (T,) N m of the linkage and its springs on the ground.

        about: point about which the moment is taken, m.
        """
        centres, _, _ = self.motion.centres
        moment = -(self.couples + cross(centres - number(about), self.needed)).sum(axis=1)
        force = -self.needed.sum(axis=1)
        for push in (p for load in self.applied for p in load.pushes(self.motion)):
            if push.item == GROUND:  # the end of a spring
                force = force + push.force
                moment = (
                    moment
                    + cross(np.array(number(push.at) - number(about)), push.force)
                    + push.couple
                )
        return pairs(force), moment


def motion_reactions(
    case: str,
    motion: Motion,
    applied: Sequence[Load] = (),
    timed: bool = True,
    hold: Sequence[str] = (),
    friction: bool = True,
) -> Dynamics:
    """Reactions of a driven motion under gravity, applied loads and friction.

    case: name of the load case, for messages.
    timed: whether the instants follow each other in time.
    hold: names of the sliders and turns that hold the linkage, by default its drives.
    friction: whether friction acts.

    Raises: LinkageError when connections share forces without a rule, or when the linkage is
    unconstrained; JammingError when friction jams.
    """
    loads = tuple(applied)
    solved = (
        _dynamics(ForceBalance(part, loads, hold, friction), case, timed) for part in motion.parts
    )
    # Each batch's motion, with its matrices, is released before the next is solved.
    parts = [replace(dynamics, motion=motion) for dynamics in solved]
    whole: Dynamics = joined(parts)
    return whole


def _dynamics(balance: ForceBalance, case: str, timed: bool) -> Dynamics:
    """Reactions and drive forces of a batch of instants; case, timed: as for `motion_reactions`."""
    linkage = balance.motion.linkage
    # First without friction and radial forces of teeth, which are then added in proportion to the
    # contact forces.
    f = balance.multipliers(balance.generalised(balance.needed, balance.couples), balance.needed)
    sizes = (len(linkage.sliders), len(linkage.connections), len(linkage.teeth))
    friction, on_pins, spread = (np.zeros((len(f), n)) for n in sizes)
    by_kind = {"slider": friction, "pin": on_pins, "teeth": spread}
    couples = balance.couples
    if sources := sources_of(balance):
        amounts, f = with_contacts(balance, f, sources)
        for i, s in enumerate(sources):
            by_kind[s.kind][:, s.which] = amounts[:, i]
            couples = couples + amounts[:, i, None] * s.couples
    drive = balance.drives(f)
    require_closed(balance.held, drive)
    normal, couple = balance.slider_forces(balance.closing(f, spread), f, balance.needed, couples)
    return Dynamics(
        reactions=_reactions(balance, case, balance.closing(f, spread), timed),
        actuators=balance.held.actuators,
        drive=drive,
        motion=balance.motion,
        applied=balance.applied,
        sliders=SliderForces(normal, couple, friction),
        pin_friction=on_pins,
        needed=balance.needed,
        couples=balance.couples,
        shared=balance.shared,
    )


def _reactions(balance: ForceBalance, case: str, closing: Complex, timed: bool) -> Reactions:
    """Forces of the bodies on the pins, from the forces `closing` at closures and teeth."""
    motion, linkage = balance.motion, balance.motion.linkage
    on_body = balance.everywhere(balance.needed, closing)
    on_pin = np.zeros((*on_body.shape, 3))
    on_pin[..., 0], on_pin[..., 1] = -on_body.real, -on_body.imag
    # The axes of a pin turn with the item in which it is fixed; a floating pin has world axes.
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
