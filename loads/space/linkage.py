"""A linkage in space as data, with rigid bodies, joints between pairs of them, and coordinates."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from loads.linkage.linkage import Contradiction, LinkageError, parallel_contradictions
from loads.linkage.parts import GROUND, Parallel, Sharing
from loads.space.kinds import KINDS, Kind
from loads.space.stiffness import LinkStiffness
from pinbase.arrays import Floats

Vector = tuple[float, float, float]
Inertia = tuple[Vector, Vector, Vector]

MIN_DIRECTION = 1e-9  # length of a vector, up to which it defines no direction
MAX_COSINE = 1.0 - 1e-9  # cosine of the angle between two axes, above which they are parallel
RIGHT_ANGLE_TOLERANCE = 1e-6  # largest cosine of the angle between the axes of a universal joint
INERTIA_ROUND_OFF = 1e-9  # relative to the largest element of an inertia tensor


@dataclass(frozen=True)
class RigidBody:
    """A rigid body in the drawn position.

    mass: kg.
    centre: centre of mass in world axes, m.
    inertia: inertia tensor about the centre of mass, along world axes as drawn, kg m^2.
    """

    name: str
    mass: float
    centre: Vector
    inertia: Inertia = ((0.0, 0.0, 0.0),) * 3


@dataclass(frozen=True)
class SpaceJoint:
    """A joint between two bodies, and the name of the wrench that it transmits.

    base, moving: names of the two bodies, or GROUND.
    at: point of the joint as drawn, m. The joint's moment is stated about the point of the moving
    body, which travels with this body along a cylindrical, prismatic or planar joint or a line.
    axis: direction as drawn: the axis of a revolute, cylindrical or prismatic joint; the axis of a
    universal joint that is fixed in the base; the normal of a planar joint; or the line, fixed in
    the base, of a point on a line.
    second_axis: axis of a universal joint that is fixed in the moving body, perpendicular to
    `axis`.
    friction: radius of the friction circle of a revolute joint, m.
    """

    name: str
    kind: Kind
    base: str
    moving: str
    at: Vector
    axis: Vector | None = None
    second_axis: Vector | None = None
    friction: float = 0.0


@dataclass(frozen=True)
class JointAngle:
    """The angle of a revolute or cylindrical joint about its axis, right-handed.

    drawn: angle as drawn, rad.
    """

    name: str
    joint: str
    drawn: float = 0.0


@dataclass(frozen=True)
class JointTravel:
    """The travel of a prismatic or cylindrical joint along its axis.

    drawn: travel as drawn, m.
    """

    name: str
    joint: str
    drawn: float = 0.0


@dataclass(frozen=True)
class PointDistance:
    """The distance between a point of one body and a point of another.

    bodies: the two bodies, or GROUND.
    ends: the points as drawn, m.
    """

    name: str
    bodies: tuple[str, str]
    ends: tuple[Vector, Vector]

    @property
    def drawn(self) -> float:
        """Distance as drawn, m."""
        return float(np.linalg.norm(np.subtract(self.ends[1], self.ends[0])))


@dataclass(frozen=True)
class BodyAngle:
    """The angle of a body relative to another about an axis; the bodies need not share a joint.

    The axis keeps its direction in both bodies, as in a planar linkage. Examples are a crank
    relative to the ground through a chain of links, or a gear relative to its carrier.

    axis: direction as drawn.
    drawn: angle as drawn, rad.
    """

    name: str
    base: str
    moving: str
    axis: Vector
    drawn: float = 0.0


Measured = JointAngle | JointTravel | PointDistance | BodyAngle


@dataclass(frozen=True)
class ToothContact:
    """The place at which the teeth of two bodies push each other.

    bodies: names of the two bodies; forces are those on the first.
    carrier: name of the body in which the pitch point is fixed.
    at: pitch point as drawn, m.
    along: force as drawn per newton tangential to the pitch circles; for helical teeth it has an
    additional component along the teeth, in which they do not slide.
    normal: unit vector as drawn, out of the first body into the second.
    spread: force that pushes the teeth apart, per newton tangential to the pitch circles.
    """

    bodies: tuple[str, str]
    carrier: str
    at: Vector
    along: Vector
    normal: Vector
    spread: float = 0.0


@dataclass(frozen=True)
class Ratio:
    """A pair of gears, or a rack and gear: measured coordinates in a fixed linear relation.

    weights: weight of each coordinate, m per rad or m per m. The weighted sum of the changes since
    the drawing, the distance by which the first body's teeth are ahead of the second's, vanishes.
    teeth: place of the teeth; None if couples and forces along the coordinates alone keep the
    relation.
    """

    name: str
    measured: tuple[str, ...]
    weights: tuple[float, ...]
    teeth: ToothContact | None = None


@dataclass(frozen=True)
class SpaceLinkage:
    """Bodies, joints and measured coordinates in the position in which they are drawn.

    measured: coordinates to which drives, gears, springs or loads refer.
    driven: names of the measured coordinates that drives prescribe; a structure has none.
    gravity: acceleration of free fall, world axes, m/s^2.
    sharing: rules by which joints share statically indeterminate loads, as springs do.
    parallel: rules by which coordinates in parallel, of which one is driven, divide its force.
    stiffness: stiffness of bodies, by name; it determines the forces that these rules leave open.

    Raises: LinkageError where the parts contradict each other.
    """

    bodies: tuple[RigidBody, ...]
    joints: tuple[SpaceJoint, ...]
    measured: tuple[Measured, ...] = ()
    driven: tuple[str, ...] = ()
    gravity: Vector = (0.0, 0.0, 0.0)
    ratios: tuple[Ratio, ...] = ()
    sharing: tuple[Sharing, ...] = ()
    parallel: tuple[Parallel, ...] = ()
    stiffness: Mapping[str, LinkStiffness] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if errors := [LinkageError(*contradiction) for contradiction in _contradictions(self)]:
            raise LinkageError.all(errors)

    @cached_property
    def index(self) -> dict[str, int]:
        """Number of each body by its name; the ground comes after the last body."""
        return {name: i for i, name in enumerate([*(b.name for b in self.bodies), GROUND])}

    @cached_property
    def drives(self) -> tuple[Measured, ...]:
        """The measured coordinates that drives prescribe, in the order of `driven`."""
        known = {m.name: m for m in self.measured}
        return tuple(known[name] for name in self.driven)

    @cached_property
    def teeth(self) -> tuple[tuple[int, Ratio, ToothContact], ...]:
        """The number of each ratio that has teeth, the ratio and its teeth."""
        meshing = enumerate(self.ratios)
        return tuple((k, r, r.teeth) for k, r in meshing if r.teeth is not None)

    @cached_property
    def forces(self) -> tuple[tuple[str, str], ...]:
        """Name and exerting body of every force between bodies: joints, then teeth."""
        joints = tuple((j.name, j.moving) for j in self.joints)
        return joints + tuple((r.name, t.bodies[0]) for _, r, t in self.teeth)

    def joint(self, name: str) -> SpaceJoint:
        """The joint of this name."""
        return self._joints[name]

    @cached_property
    def _joints(self) -> dict[str, SpaceJoint]:
        return {j.name: j for j in self.joints}

    @cached_property
    def length_scale(self) -> float:
        """A typical distance between joints, m, which makes angles comparable to lengths."""
        spans = [end for m in self.measured if isinstance(m, PointDistance) for end in m.ends]
        at = np.array([*(j.at for j in self.joints), *spans])
        return float(np.linalg.norm(at - at.mean(axis=0), axis=1).mean()) or 1.0


def unit(vector: Vector) -> Floats:
    """The unit vector (3,) along a vector that is not zero."""
    v = np.asarray(vector, dtype=float)
    return np.asarray(v / np.linalg.norm(v))


def _has_direction(vector: Vector) -> bool:
    """Whether a vector is finite and not zero."""
    return bool(MIN_DIRECTION < np.linalg.norm(vector) < np.inf)


def _contradictions(linkage: SpaceLinkage) -> Iterator[Contradiction]:
    """All contradictions between the parts of a linkage."""
    if not linkage.joints:
        yield "the linkage has no joints", "no-joints", ()
    bodies = {b.name: b for b in linkage.bodies}
    measured = {m.name for m in linkage.measured}
    for kind, names in (
        ("body", [b.name for b in linkage.bodies]),
        ("joint or gear", [*(j.name for j in linkage.joints), *(r.name for r in linkage.ratios)]),
        ("coordinate", [m.name for m in linkage.measured]),
        ("drive", list(linkage.driven)),
    ):
        for name in sorted({n for n in names if names.count(n) > 1}):
            yield f"{kind} {name!r} is named twice; names must be unique", "duplicate-name", ()
    if GROUND in bodies:
        text = f"body {GROUND!r}: this name is reserved for the fixed frame; rename the body"
        yield text, "reserved-name", ("body", GROUND)
    for joint in linkage.joints:
        yield from _joint_contradictions(joint, {*bodies, GROUND})
    for body in linkage.bodies:
        yield from _body_contradictions(body)
    for m in linkage.measured:
        yield from _measured_contradictions(m, linkage)
    for name in linkage.driven:
        if name not in measured:
            yield f"drive {name!r} is no measured coordinate", "unknown-coordinate", ("drive", name)
    for ratio in linkage.ratios:
        if len(ratio.weights) != len(ratio.measured) or not set(ratio.measured) <= measured:
            yield f"gear {ratio.name}: its coordinates are not known", "unknown-coordinate", ()
    for rule in linkage.parallel:
        yield from parallel_contradictions(rule, linkage.parallel, linkage.driven, measured)


def _joint_contradictions(joint: SpaceJoint, known: set[str]) -> Iterator[Contradiction]:
    """Contradictions of one joint: its bodies, and the directions that its kind needs."""
    at = ("joint", joint.name)
    for body in (joint.base, joint.moving):
        if body not in known:
            yield f"joint {joint.name}: there is no body {body!r}", "unknown-body", at
    if joint.base == joint.moving:
        yield f"joint {joint.name} connects {joint.base} to itself", "same-body", at
    kind = KINDS[joint.kind]
    needed = {"axis": kind.axes > 0, "second_axis": kind.axes > 1}
    for key, needs in needed.items():
        given = getattr(joint, key)
        if needs and given is None:
            yield (
                f"joint {joint.name}: a {joint.kind} joint needs {key} = [x, y, z]",
                "no-direction",
                at,
            )
        elif given is not None and not needs:
            yield f"joint {joint.name}: a {joint.kind} joint has no {key}", "no-direction", at
        elif given is not None and not _has_direction(given):
            yield (
                f"joint {joint.name}: {key} = {list(given)} is no direction; give a vector that is "
                "finite and not zero",
                "no-direction",
                at,
            )
    if kind.axes > 1 and joint.axis is not None and joint.second_axis is not None:
        if not (_has_direction(joint.axis) and _has_direction(joint.second_axis)):
            return
        cosine = abs(float(unit(joint.axis) @ unit(joint.second_axis)))
        if cosine > RIGHT_ANGLE_TOLERANCE:
            parallel = "parallel" if cosine > MAX_COSINE else "not at a right angle"
            yield (
                f"joint {joint.name}: the axes of a universal joint are {parallel}; they are those "
                "of its cross, at a right angle to each other",
                "axes-not-square",
                at,
            )
    if joint.friction and joint.kind != "revolute":
        text = f"joint {joint.name}: only revolute joints can have friction, not {joint.kind} ones"
        yield text, "friction-kind", at


def _body_contradictions(body: RigidBody) -> Iterator[Contradiction]:
    """Contradictions of one body: an inertia tensor that no distribution of mass can have."""
    tensor = np.asarray(body.inertia, dtype=float)
    moments = np.linalg.eigvalsh(0.5 * (tensor + tensor.T))
    largest = float(np.abs(tensor).max())
    slack = INERTIA_ROUND_OFF * largest
    at = ("body", body.name)
    if np.abs(tensor - tensor.T).max() > slack:
        yield f"body {body.name}: its inertia is not symmetric", "bad-inertia", at
    elif moments[0] < -slack or moments[0] + moments[1] < moments[2] - slack:
        yield (
            f"body {body.name}: no distribution of mass has this inertia (principal moments in "
            f"the ratio {' : '.join(f'{m / largest:.4g}' for m in moments)}; each is at most the "
            "sum of the other two, and none is negative)",
            "bad-inertia",
            at,
        )


def _measured_contradictions(m: Measured, linkage: SpaceLinkage) -> Iterator[Contradiction]:
    """Contradictions of one measured coordinate."""
    at = ("drive", m.name)
    if isinstance(m, PointDistance | BodyAngle):
        for body in m.bodies if isinstance(m, PointDistance) else (m.base, m.moving):
            if body not in linkage.index:
                yield f"{m.name}: there is no body {body!r}", "unknown-body", at
    if isinstance(m, PointDistance):
        if m.drawn <= MIN_DIRECTION:
            yield f"{m.name}: its two points coincide as drawn", "no-direction", at
        return
    if isinstance(m, BodyAngle):
        if m.base == m.moving:
            yield f"{m.name}: {m.base} cannot turn against itself", "same-body", at
        if not _has_direction(m.axis):
            yield f"{m.name}: axis = {list(m.axis)} is no direction", "no-direction", at
        return
    joint = next((j for j in linkage.joints if j.name == m.joint), None)
    if joint is None:
        yield f"{m.name}: there is no joint {m.joint!r}", "unknown-joint", at
        return
    kind, wanted = KINDS[joint.kind], "angle" if isinstance(m, JointAngle) else "travel"
    if not getattr(kind, wanted):
        kinds = " or ".join(name for name, k in KINDS.items() if getattr(k, wanted))
        yield (
            f"{m.name}: joint {m.joint} is {joint.kind} and has no {wanted}; drive a {kinds} joint",
            "joint-kind",
            at,
        )
