"""Cases of a linkage in space, solved for the forces and moments on its pins in pin axes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import chain

import numpy as np

from loads import Effort, Law, PeakForces, Reactions, StateDrive
from loads.forces.corners import corners_of
from loads.forces.holding import OPENING_FORCE_TOLERANCE, require_pressed
from loads.forces.over_time import Extremum, lowest_angles
from loads.space.acting import SpaceLoad
from loads.space.dynamics import SpaceDynamics, space_reactions
from loads.space.ground import BodyMomenta, GroundInertia, body_momenta
from loads.space.holding import held, held_as_drawn
from loads.space.linkage import SpaceLinkage
from loads.space.motion import SpaceCourse, space_move
from loads.space.over_time import SpaceOverTime, space_over_time
from loads.space.transmission import transmission_angles_in_space
from pinbase.arrays import Floats
from pinstress.study.model.ground import Grounded
from pinstress.study.model.impulses import impulse_notes
from pinstress.study.model.mechanism.space import SpacePin, pins_in_space, space_mechanism
from pinstress.study.model.moving_loads import Acting, MovingLoads
from pinstress.study.model.space_forces import (
    applied_in_space,
    ground_inertia,
    load_in_space,
    springs_in_space,
)
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import InstantCase, MotionCase, StaticCase
from pinstress.study.schema.landing import GroundCase

MAX_POSTURES = 200_000  # limit of `postures_of`; longer motions get no transmission angles
POWER_BALANCE = 1e-6  # relative to the largest power of a drive: a larger violation is noted


@dataclass(frozen=True)
class InSpace:
    """A case of a linkage in space, solved at some instants.

    dynamics: of all joints. pins: by connection.
    reactions: at the pins only, in the study's order.
    ground: the inertia forces due to the motion of the ground, if it moves.
    note: the origin of the loads.
    peaks, efforts: over the whole motion, with every drive's work at the instants.
    frictionless: the results over the motion without friction, if there is friction.
    others: the reactions with other stiffnesses of links, by the difference in stiffness.
    held: what holds the linkage, and whether that slides; None if its drives do.
    violation: of the power balance over the whole motion, relative to the largest power of a drive.
    transmission: smallest transmission angles (rad) over the motion, by link and joint of the
    linkage.
    """

    dynamics: SpaceDynamics
    pins: dict[str, SpacePin]
    reactions: Reactions
    ground: GroundInertia | None = None
    note: str = ""
    peaks: PeakForces | None = None
    efforts: tuple[Effort, ...] | None = None
    frictionless: SpaceOverTime | None = None
    others: Mapping[str, Reactions] = field(default_factory=dict)
    held: tuple[tuple[str, bool], ...] | None = None
    violation: float | None = None
    transmission: Mapping[tuple[str, str], Extremum] = field(default_factory=dict)

    @property
    def gravity(self) -> Floats:
        """Acceleration of free fall, (3,) m/s^2."""
        return np.array(self.dynamics.motion.linkage.gravity)

    @property
    def accelerations(self) -> Floats:
        """Accelerations of the pins at all connections, (T, C, 3) m/s^2.

        Gravity minus these is the body force per mass on a pin, even on a moving ground.
        """
        motion = self.dynamics.motion
        each = [motion.point(pin.carrier, pin.at) for pin in self.pins.values()]
        place, velocity, acceleration = (np.stack(x, axis=1) for x in zip(*each, strict=True))
        if self.ground is None:
            return acceleration
        return np.asarray(acceleration - self.ground.felt(motion, place, velocity))

    @property
    def bodies(self) -> BodyMomenta:
        """Motion and momenta of all bodies relative to a fixed frame, in the mechanism's axes."""
        return body_momenta(self.dynamics.motion, self.ground.ground if self.ground else None)

    @property
    def energies(self) -> tuple[Floats, Floats]:
        """Kinetic and potential energy, (T,) J each."""
        motion = self.dynamics.motion
        heights = motion.pose.centre[:, :-1] @ self.gravity
        return motion.kinetic_energy, -heights @ motion.masses


def _at_pins(
    dynamics: SpaceDynamics, pins: dict[str, SpacePin], ground: GroundInertia | None, note: str
) -> InSpace:
    """Return a solved case with the reactions of the connections and the axes of their pins."""
    which = [pin.joint for pin in pins.values()]
    # In batches, so that the poses of all instants are not in memory at once.
    turns = [
        np.stack([part.rotation(pin.carrier) @ pin.axes for pin in pins.values()], axis=1)
        for part in dynamics.motion.parts
    ]
    turn = np.concatenate(turns)

    def of_pins(r: Reactions) -> Reactions:
        bodies, every = tuple(r.bodies[k] for k in which), which == [*range(len(r.bodies))]
        forces, moments = (x if every else x[:, which] for x in (r.forces, r.moments))
        return Reactions(r.case, r.times, tuple(pins), bodies, forces, moments, turn)

    others = {text: of_pins(r) for text, r in dynamics.range.items()}
    return InSpace(dynamics, pins, of_pins(dynamics.reactions), ground, note, others=others)


def postures_of(linkage: SpaceLinkage, instants: int) -> int:
    """Return the number of velocities from which transmission angles follow: one for every body,
    drive and instant.
    """
    return len(linkage.bodies) * max(1, len(linkage.driven)) * instants


@dataclass(frozen=True)
class MovedInSpace:
    """A motion in space at any times (T,) s.

    This is a class instead of closures, because it is sent to processes that are not forked.
    """

    name: str
    course: SpaceCourse
    loads: tuple[SpaceLoad, ...]
    pins: dict[str, SpacePin]
    ground: GroundInertia | None
    note: str
    friction: bool = True

    def solve(self, times: Floats, variants: bool = False) -> InSpace:
        """Return the case at times (T,) s.

        variants: whether to add the reactions for other stiffnesses of links.
        """
        loads = (*self.loads, *((self.ground,) if self.ground else ()))
        at = self.course.at(times)
        dynamics = space_reactions(self.name, at, loads, friction=self.friction, variants=variants)
        return _at_pins(dynamics, self.pins, self.ground, self.note)

    def acting(self, times: Floats) -> Acting:
        """Return the reactions, and the accelerations of the pins (T, C, 3) m/s^2, at times
        (T,) s.
        """
        solved = self.solve(times)
        return solved.reactions, solved.accelerations

    @cached_property
    def corners(self) -> Floats:
        """Times at which a force may jump or has a kink, s."""
        course = self.course
        nodes = np.unique([course.first, *course.path.nodes, course.last])
        return corners_of(course, self.loads, nodes)

    def solved(self, samples: int, extremes: bool) -> InSpace:
        """Return the case at equally spaced instants; extremes: with those over the whole
        motion.
        """
        instants = np.linspace(self.course.first, self.course.last, samples)
        solved = self.solve(instants, variants=True)
        if not extremes:
            self.solve(self.course.path.nodes)
            return solved
        over = self._over(solved)
        lowest: dict[tuple[str, str], Extremum] = {}
        if postures_of(self.course.space.linkage, len(over.nodes)) <= MAX_POSTURES:
            lowest, _ = lowest_angles(self.course, over.nodes, transmission_angles_in_space)
        free = None
        if any(joint.friction for joint in self.course.space.linkage.joints):
            smooth = replace(self, friction=False)
            free = smooth._over(smooth.solve(solved.dynamics.motion.times))
        note = self.note
        if over.violation > POWER_BALANCE:
            note += f" The balance of power is violated by {over.violation:.1e} of the largest."
        return replace(
            solved,
            peaks=over.peaks,
            efforts=over.drives,
            frictionless=free,
            violation=over.violation,
            transmission=lowest,
            note=note.strip(),
        )

    def _over(self, samples: InSpace) -> SpaceOverTime:
        return space_over_time(self.course, self.solve, samples, self.corners)


def motion_in_space(
    study: Study,
    name: str,
    case: MotionCase,
    linkage: SpaceLinkage,
    laws: Sequence[Law],
    end: float,
) -> MovedInSpace:
    """Return the motion of a case under the laws of its drives, until `end`, s."""
    course = SpaceCourse(linkage, laws, 0.0, end)
    applied = chain.from_iterable(applied_in_space(study, name, case, linkage))
    loads: tuple[SpaceLoad, ...] = (*springs_in_space(study, linkage), *applied)
    note = impulse_notes(study, case)
    pins, ground = pins_in_space(study, linkage), ground_inertia(case)
    return MovedInSpace(name, course, loads, pins, ground, note)


def moving_in_space(moved: MovedInSpace, solved: InSpace) -> MovingLoads:
    """Return the loads on the pins at any time."""
    return MovingLoads(moved.acting, solved.dynamics.motion.times, moved.corners)


def at_rest_in_space(
    study: Study,
    name: str,
    case: StaticCase | InstantCase | GroundCase,
    linkage: SpaceLinkage,
    states: Sequence[tuple[float, float, float]],
    grounded: Grounded | None = None,
) -> Callable[..., InSpace]:
    """Return a function that solves a case at one instant: `solve()` as stated, `solve(which,
    size)` with an impulse of another size (N) in the load of index `which`.

    states: position, velocity and acceleration of every drive, in SI units.
    grounded: the forces of the ground, for a case that has no other loads.
    """
    stated = case.hold if isinstance(case, StaticCase | GroundCase) else None
    hold = tuple(dict.fromkeys(stated or ()))
    if hold and not linkage.driven:
        motion = held_as_drawn(linkage, hold)
    else:
        motion = space_move(linkage, [StateDrive(*values) for values in states], np.zeros(1))
        motion = held(motion, hold) if hold else motion
    equations = motion.equations
    by = [(name, equations.slides(name)) for name in equations.actuators]
    held_by = tuple(by) if hold else None
    springs, pins = springs_in_space(study, linkage), pins_in_space(study, linkage)
    ground: GroundInertia | None = None
    if isinstance(case, GroundCase):
        assert grounded is not None
        applied, note = [grounded.loads_in_space(study, case)], grounded.note(study)
    else:
        applied = applied_in_space(study, name, case, linkage)
        note, ground = impulse_notes(study, case), ground_inertia(case)

    def solve(which: int | None = None, size: float | None = None) -> InSpace:
        loads = list(applied)
        if which is not None:
            assert not isinstance(case, GroundCase)
            loads[which] = load_in_space(study, name, which, case.apply[which], linkage, size)
        every: list[SpaceLoad] = [*springs, *chain.from_iterable(loads)]
        every += [ground] if ground else []
        dynamics = space_reactions(name, motion, every, timed=False)
        if held_by is not None:
            _require_closed(study, dynamics, held_by)
        return replace(_at_pins(dynamics, pins, ground, note), held=held_by)

    return solve


def _require_closed(
    study: Study, dynamics: SpaceDynamics, held_by: Sequence[tuple[str, bool]]
) -> None:
    """Raise LinkageError if a stop would have to pull."""
    stops, forces = space_mechanism(study).stop, dynamics.drive
    units = [dynamics.motion.equations.unit_of(name) for name, _ in held_by]
    scale = np.array(units)  # makes forces and couples comparable
    least = OPENING_FORCE_TOLERANCE * float(np.abs(forces / scale).max())
    for k, (name, slides) in enumerate(held_by):
        if name in stops:
            stop = stops[name].carries
            require_pressed(name, stop, forces[:, k], least * float(scale[k]), slides)
