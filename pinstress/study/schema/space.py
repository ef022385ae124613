"""Keys of a mechanism in space in a study file."""

import math
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Discriminator, Field, Tag, model_validator

from loads.linkage.parts import Sign
from loads.space.conditions import directions
from loads.space.kinds import KINDS, Kind
from loads.space.linkage import RIGHT_ANGLE_TOLERANCE
from pinbase.errors import ArgumentError
from pinstress.study.schema.drives import SlidingDrive, TurningDrive
from pinstress.study.schema.forces import LineLawTable, TorsionLawTable
from pinstress.study.schema.gears import SpaceGearTable, SpaceRackTable
from pinstress.study.schema.mechanism import (
    BarTable,
    LinkStiffnessTable,
    SharingTable,
    require_single_mass,
)
from pinstress.study.schema.rules import both_or_none, condition, exactly_one, not_zero
from pinstress.study.schema.types import (
    ONE_OR_SEVERAL,
    Acceleration,
    Direction,
    JointOrPoint3,
    Length,
    Mass,
    Number,
    Point3,
    PositiveLength,
    SignedInertia,
    StrictTable,
    Weight,
)

# Axes of a universal joint closer to each other than this do not show which second axis was meant.
MAX_COSINE_OF_SKEW = math.cos(math.radians(1.0))
PLANAR_PARTS = {  # parts of a planar mechanism, and their replacement in space
    "slider": 'use a joint of kind = "prismatic" between its two bodies',
    "point": "remove it: bodies.csv has the motion of every body",
}


def _with_three(data: Any, *keys: str) -> None:
    """Raise ArgumentError for a key that is text, or has two numbers instead of three."""
    for key in keys:
        value = data.get(key) if isinstance(data, dict) else None
        if isinstance(value, str):
            text = f"{key} is a vector, not {value!r}; give {key} = [x, y, z]"
            raise ArgumentError(text, "not-a-list")
        if isinstance(value, list) and len(value) == 2:
            text = f"{key} has two numbers; in space (dimension = 3) give {key} = [x, y, z]"
            raise ArgumentError(text, "wrong-dimension")


class SpaceJointTable(StrictTable):
    """A pin, ball or slide of a mechanism in space as drawn, and the body on each of its
    connections.
    """

    at: Point3
    """Position in the drawing, about which the moments of its connections are stated."""
    kind: Kind = "revolute"
    """Which motions it leaves free: "revolute" (about its axis), "spherical" (any rotation),
    "universal" (about two axes, a cross), "cylindrical" (about and along its axis), "prismatic"
    (along its axis), "planar" (in the plane across its axis), "point-on-line" (any rotation, and
    along its axis), or none ("fixed")."""
    axis: Direction | None = None
    """Its axis as drawn; a vector of any length but 0. Of a universal joint the axis of the cross
    that is fixed in the body that carries the pin; of a planar joint the normal. Spherical and
    fixed joints have none."""
    second_axis: Direction | None = None
    """The other axis of a universal joint, in the bodies of its connections, at a right angle to
    `axis`."""
    pin_axis: Direction | None = None
    """Direction of the z of the pin as drawn. Default: `axis`, or else the world's z. The pin's x
    is the world's x less its part along z (the world's y where z is within 1 degree of the world's
    x); all three turn with the body that carries the pin."""
    connections: Annotated[dict[str, str], Field(min_length=1)]
    """For each connection, the body that moves on the pin. Names of connections are unique in the
    study."""
    fixed_in: str | None = None
    """The body that carries the pin, or "ground". Default: none, a floating pin, which is fixed in
    the body of its first connection."""
    weight: Weight | None = None
    """Weight of a floating pin. Default: the weight of its profile."""
    z: Length | None = None
    """Position of the start of the pin's profile along the pin's z, from `at`: every link then
    moves about the middle of its band, about which its moment is stated. Default: all links at
    `at`."""
    friction: Annotated[Number, Field(ge=0.0, le=10.0)] | None = None
    """Coefficient of Coulomb friction between the pin and the bodies that turn on it; needs
    `diameter` and `fixed_in`, of a revolute joint."""
    diameter: PositiveLength | None = None
    """Diameter of the pin, for friction."""

    _with_diameter = both_or_none("friction", "diameter")
    _directed = not_zero("axis", "second_axis", "pin_axis")

    @model_validator(mode="before")
    @classmethod
    def _in_space(cls, data: Any) -> Any:
        _with_three(data, "at", "axis", "second_axis", "pin_axis")
        if isinstance(data, dict) and isinstance(data.get("at"), dict):
            raise ArgumentError("at: in space (dimension = 3) give [x, y, z]", "wrong-dimension")
        return data

    @condition
    def _complete(self) -> None:
        if self.friction and self.fixed_in is None:
            raise ArgumentError(
                "a floating pin cannot have friction; give fixed_in", "friction-floats"
            )
        if self.fixed_in is None and len(self.connections) < 2:
            raise ArgumentError(
                "a floating pin needs two connections or more; give fixed_in, or another one",
                "too-few-connections",
            )
        _require_axes(self)


def _require_axes(joint: SpaceJointTable) -> None:
    """Raise ArgumentError unless a joint has the directions that its kind needs."""
    axes = {"axis": joint.axis, "second_axis": joint.second_axis}
    for (key, given), need in zip(axes.items(), (1, 2), strict=True):
        needs = KINDS[joint.kind].axes >= need
        if needs and given is None:
            raise ArgumentError(f"a {joint.kind} joint needs {key} = [x, y, z]", "no-direction")
        if given is not None and not needs:
            raise ArgumentError(f"a {joint.kind} joint has no {key}; remove it", "no-direction")
    if joint.axis is not None and joint.second_axis is not None:
        product = sum(a * b for a, b in zip(joint.axis, joint.second_axis, strict=True))
        size = math.hypot(*joint.axis)
        cosine = product / (size * math.hypot(*joint.second_axis))
        if abs(cosine) > RIGHT_ANGLE_TOLERANCE:
            square = np.subtract(joint.second_axis, np.multiply(product / size**2, joint.axis))
            if abs(cosine) > MAX_COSINE_OF_SKEW:
                square = directions(joint.axis)["u"]
            square = square / np.abs(square).max()
            instead = ", ".join(f"{float(x):.9g}" for x in square + 0.0)
            raise ArgumentError(
                f"axis and second_axis of a universal joint are those of its cross, at a right "
                f"angle; they are {math.degrees(math.acos(max(-1.0, min(1.0, cosine)))):.4g} deg "
                f"apart; give for instance second_axis = [{instead}]",
                "axes-not-square",
            )


def _depth_of(what: str) -> Any:
    """Return the validator of a rectangular section, which must state the direction of its
    depth.
    """

    def check(table: Any) -> None:
        section, along = table.section, table.depth_along
        if (section is None) != (along is None) or not any(along or (1.0,)):
            raise ArgumentError(
                f"a rectangular {what} needs depth_along = [x, y, z], the direction of its depth; "
                "a round one has none",
                "give-both",
            )

    return condition(check)


class SpaceBarTable(BarTable):
    """A uniform straight bar in space between two joints, round or rectangular."""

    depth_along: Direction | None = None
    """Direction of the depth of a rectangular bar as drawn; its part across the bar counts."""

    _known_depth = _depth_of("bar")


class SpaceLinkStiffnessTable(LinkStiffnessTable):
    """The section of a link, for its stiffness where joints are redundant. A `bar` has its own
    section by default.
    """

    section: tuple[PositiveLength, PositiveLength] | None = None
    """Section of a rectangular link: [depth, width]."""
    depth_along: Direction | None = None
    """Direction of the depth of a rectangular link as drawn; its part across the line from the
    centre of mass to a joint counts."""

    _known_depth = _depth_of("link")


class SpaceBodyTable(StrictTable):
    """A rigid body in space."""

    weight: Weight | None = None
    """Weight in the gravity of the study. Give one of `weight`, `mass` or `bar`, unless gravity is
    off and all cases are static."""
    mass: Mass | None = None
    """Mass."""
    bar: SpaceBarTable | None = None
    """A uniform straight bar, which determines mass, centre and inertia."""
    centre: Point3 | None = None
    """Centre of mass in the drawn position. Default: midway between the joints, if there are two;
    at the only joint of a gear."""
    inertia: Annotated[list[SignedInertia], Field(min_length=3, max_length=6)] | None = None
    """Inertia about the centre of mass along the world's axes as drawn: [xx, yy, zz] or [xx, yy,
    zz, xy, xz, yz], the entries of the tensor, so that xy is minus the integral of x y dm. Default:
    that of the bar; without a bar, none: the mass is at the centre."""
    welded_to: str | None = None
    """Body, or "ground", to which it is fixed."""

    @model_validator(mode="before")
    @classmethod
    def _in_space(cls, data: Any) -> Any:
        _with_three(data, "centre")
        if isinstance(data, dict) and "inertia" in data and not isinstance(data["inertia"], list):
            raise ArgumentError(
                "inertia: in space (dimension = 3) give [xx, yy, zz] or [xx, yy, zz, xy, xz, yz]",
                "wrong-dimension",
            )
        return data

    @condition
    def _one_mass(self) -> None:
        require_single_mass(self.mass, self.weight, self.bar, self.centre)
        if self.inertia is not None and len(self.inertia) not in (3, 6):
            raise ArgumentError(
                "inertia: give 3 moments, [xx, yy, zz], or 6 numbers, [xx, yy, zz, xy, xz, yz]",
                "bad-shape",
            )


class AngleDrive(TurningDrive):
    """A drive of the angle of a revolute or cylindrical joint: of the body on a connection about
    the joint's axis, right-handed, zero as drawn.
    """

    joint: str
    """The joint."""
    connection: str | None = None
    """The connection that is driven. Default: the only one that moves on the pin."""


class TravelDrive(SlidingDrive):
    """A drive of the travel of a prismatic or cylindrical joint: of the body on a connection along
    the joint's axis, zero as drawn.
    """

    slide: str
    """The joint."""
    connection: str | None = None
    """The connection that is driven. Default: the only one that moves on the pin."""


class LengthDrive(SlidingDrive):
    """A drive of the distance between two points of two bodies, between which it pulls and pushes.
    An actuator whose pins are of interest has bodies and joints of its own, and drives its travel.
    """

    between: tuple[JointOrPoint3, JointOrPoint3]
    """A point of each body, a joint or [x, y, z]; pins are not loaded at these joints."""
    bodies: tuple[str, str]
    """The two bodies; one may be "ground"."""

    @condition
    def _named(self) -> None:
        if self.name is None:
            raise ArgumentError("a drive between two points needs a name", "missing-key")


SpaceDrive = AngleDrive | TravelDrive | LengthDrive
_KEYS_OF_DRIVES = {"slide": "<travel>", "between": "<length>"}


def _kind_of_drive(value: object) -> str:
    keys = value if isinstance(value, dict) else {}
    return next((tag for key, tag in _KEYS_OF_DRIVES.items() if key in keys), "<angle>")


AnySpaceDrive = Annotated[
    Annotated[AngleDrive, Tag("<angle>")]
    | Annotated[TravelDrive, Tag("<travel>")]
    | Annotated[LengthDrive, Tag("<length>")],
    Discriminator(_kind_of_drive),
]


class SpaceSpringTable(LineLawTable):
    """A spring, damper or gas spring along a joint's axis, or between two points. Its force,
    positive where it pushes them apart, is preload - stiffness (length - reference) - damping
    velocity, and what the tables add.
    """

    slide: str | None = None
    """The prismatic or cylindrical joint along which it acts, its length being the travel. Give
    either `slide`, or `bodies` and `joints`."""
    bodies: tuple[str, str] | None = None
    """The two bodies between which it acts; one may be "ground"."""
    joints: tuple[JointOrPoint3, JointOrPoint3] | None = None
    """A point of each, a joint or [x, y, z]; pins are not loaded at these joints."""

    _between = exactly_one("either slide, or bodies and joints", "slide", "bodies")
    _ends = both_or_none("bodies", "joints")


class SpaceTorsionSpringTable(TorsionLawTable):
    """A spring or damper about the axis of a revolute or cylindrical joint. Its couple on the body
    of the connection, right-handed about the axis, is preload - stiffness (angle - reference) -
    damping angular velocity, and what the tables add; the angle is zero as drawn.
    """

    joint: str
    """The joint."""
    connection: str | None = None
    """The connection concerned. Default: the only one that moves on the pin."""


class SpaceStopTable(StrictTable):
    """A lock or stop of a joint or of a distance, which can keep it as it is in cases whose `hold`
    names it.
    """

    joint: str | None = None
    """The revolute or cylindrical joint whose angle it keeps. Give one of `joint`, `slide` or
    `between`."""
    slide: str | None = None
    """The prismatic or cylindrical joint whose travel it keeps."""
    connection: str | None = None
    """The connection concerned. Default: the only one that moves on the pin."""
    between: tuple[JointOrPoint3, JointOrPoint3] | None = None
    """The points of two bodies whose distance it keeps, joints or [x, y, z]; pins are not loaded at
    these joints."""
    bodies: tuple[str, str] | None = None
    """The two bodies of `between`; one may be "ground"."""
    carries: Sign = "both"
    """Couples about the joint's axis, right-handed, or forces along it, on the body of the
    connection, or forces that push points apart, that it can carry: "both" for a lock, one sign for
    a stop, which opens under the other."""

    _one = exactly_one("one of joint, slide or between", "joint", "slide", "between")
    _ends = both_or_none("bodies", "between")


class SpaceMechanismTable(StrictTable):
    """A linkage in space, drawn in one position, with one or several drives, or a structure."""

    dimension: Literal[3]
    """A linkage in space; without this key it is in a plane."""
    gravity: Annotated[
        tuple[Acceleration, Acceleration, Acceleration],
        Field(json_schema_extra={"default": ["0 m/s^2", "0 m/s^2", "-9.80665 m/s^2"]}),
    ] = (0.0, 0.0, -9.80665)
    """Acceleration of gravity [gx, gy, gz]; [0, 0, 0] switches it off."""
    joint: Annotated[dict[str, SpaceJointTable], Field(min_length=1)]
    """Joints by name."""
    body: Annotated[dict[str, SpaceBodyTable], Field(min_length=1)]
    """Bodies by name, except the ground."""
    drive: Annotated[list[AnySpaceDrive], ONE_OR_SEVERAL] = []
    """One table, or several `[[mechanism.drive]]`: as many as there are degrees of freedom; none
    for a structure, and where `hold` names the locks of every case."""
    gear: dict[str, SpaceGearTable] = {}
    """Pairs of gears by name, which is also the name of the force between their teeth."""
    rack: dict[str, SpaceRackTable] = {}
    """Racks with their gears by name, which is also the name of the force between their teeth."""
    stop: dict[str, SpaceStopTable] = {}
    """Stops and locks by name."""
    spring: dict[str, SpaceSpringTable] = {}
    """Springs and dampers by name; they act in all cases."""
    torsion_spring: dict[str, SpaceTorsionSpringTable] = {}
    """Torsion springs and dampers by name; they act in all cases."""
    sharing: list[SharingTable] = []
    """Redundant connections, and how they share their load (default: by the stiffness of links);
    and drives in parallel."""
    link_stiffness: dict[str, SpaceLinkStiffnessTable] = {}
    """Sections of links, by body. By their stiffness, links share the forces that statics and
    `sharing` leave undetermined. A link without a stated section is as stiff as the mean of the
    others, and rows have a range over each such link a tenth and ten times as stiff."""

    @model_validator(mode="before")
    @classmethod
    def _parts_in_space(cls, data: Any) -> Any:
        for key, instead in PLANAR_PARTS.items():
            if isinstance(data, dict) and key in data:
                text = f"{key} is for linkages in a plane; in space (dimension = 3) {instead}"
                raise ArgumentError(text, "wrong-dimension")
        _with_three(data, "gravity")
        return data


def drivable(joint: SpaceJointTable) -> list[str]:
    """Return the connections of a joint that move on its pin: all but the first of a floating pin,
    which is fixed in the body of that connection.
    """
    return list(joint.connections)[joint.fixed_in is None :]


def has_motion(kind: Kind, slides: bool) -> bool:
    """Return whether joints of a kind have a travel (if `slides`) or an angle."""
    return KINDS[kind].travel if slides else KINDS[kind].angle
