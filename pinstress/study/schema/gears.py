"""Keys of gears and racks in a study file."""

import math
from typing import Annotated

from pydantic import AfterValidator, Field

from pinbase.errors import ArgumentError
from pinstress.study.schema.rules import both_or_none, condition, exactly_one, require_one
from pinstress.study.schema.types import (
    Angle,
    Point3,
    PositiveLength,
    Side,
    StrictTable,
    Switch,
    Whole,
)

Count = Annotated[Whole, Field(ge=1, le=100_000)]  # number of teeth
STANDARD_PRESSURE_ANGLE = math.radians(20.0)


def _below_45(value: float) -> float:
    if not 0.0 <= value <= math.radians(45.0):
        raise ArgumentError("must be between 0 and 45 deg", "out-of-range")
    return value


PressureAngle = Annotated[
    Angle, AfterValidator(_below_45), Field(json_schema_extra={"default": "20 deg"})
]


class GearTable(StrictTable):
    """Two bodies whose teeth mesh, each turning on a joint that a third body, the carrier, shares
    with it.
    """

    bodies: tuple[str, str]
    """The two bodies that mesh; one may be "ground", a fixed ring."""
    joints: tuple[str, str]
    """The joint at the centre of each. The body on both joints is the carrier: the ground, or the
    arm of a planetary train."""
    teeth: tuple[Count, Count] | None = None
    """Numbers of teeth. Give either `teeth` or `radii`."""
    radii: tuple[PositiveLength, PositiveLength] | None = None
    """Radii of the pitch circles, which must touch."""
    module: PositiveLength | None = None
    """Module of the teeth; it only serves to check the distance of the centres."""
    internal: Switch = False
    """Whether the larger one is a ring with its teeth inside."""
    pressure_angle: PressureAngle = STANDARD_PRESSURE_ANGLE
    """Pressure angle at the pitch circles. The teeth push each other apart with its tangent times
    the force along the pitch circle, on whichever flank they touch."""

    @condition
    def _one_size(self) -> None:
        require_one("either teeth or radii", self.teeth, self.radii)
        if self.module is not None and self.teeth is None:
            raise ArgumentError("module needs teeth", "give-both")


class PinionTable(StrictTable):
    """The gear that meshes with a rack."""

    pinion: str
    """The body that is the gear."""
    joint: str
    """The joint at its centre."""
    side: Side
    """Side of the gear's centre on which the rack is, looking along the slider's direction."""
    radius: PositiveLength | None = None
    """Radius of the pitch circle. Give either `radius`, or `teeth` and `module`."""
    teeth: Count | None = None
    """Number of teeth of the gear."""
    module: PositiveLength | None = None
    """Module of the teeth."""
    pressure_angle: PressureAngle = STANDARD_PRESSURE_ANGLE
    """Pressure angle."""

    _one_size = exactly_one("either radius, or teeth and module", "radius", "teeth")
    _whole_size = both_or_none("teeth", "module")

    @property
    def pitch_radius(self) -> float:
        """Radius of the pitch circle, m."""
        return self.radius or 0.5 * (self.module or 0.0) * (self.teeth or 0)


class RackTable(PinionTable):
    """A gear and a rack: one of the two bodies of a slider is the rack, the other has the joint on
    which the gear turns.
    """

    slider: str
    """The slider that guides the rack on the body with that joint, or that body on the rack."""


def _below_60(value: float) -> float:
    if abs(value) > math.radians(60.0):
        raise ArgumentError("must be between -60 and 60 deg", "out-of-range")
    return value


HelixAngle = Annotated[Angle, AfterValidator(_below_60)]


class SpaceGearTable(GearTable):
    """Two bodies whose teeth mesh, each turning on a revolute joint that a third body, the carrier,
    shares with it: spur or helical gears where the joints are parallel, bevel gears where their
    axes meet.
    """

    joints: tuple[str, str]
    """The revolute joint of each. The body on both joints is the carrier: the ground, or the arm of
    a planetary train."""
    radii: tuple[PositiveLength, PositiveLength] | None = None
    """Radii of the pitch circles; for bevel gears, in the middle of the teeth. Circles about
    parallel axes must touch."""
    module: PositiveLength | None = None
    """Module of the teeth: for parallel axes, it only serves to check their distance; for bevel
    gears, it gives the size in the middle of the teeth."""
    at: Point3 | None = None
    """A point in the middle of the meshing teeth. For parallel axes, its position along them counts
    (default: midway between the joints); for bevel gears, its side and, without radii and module,
    its distance from the intersection of the axes."""
    helix_angle: HelixAngle = 0.0
    """Helix angle (for bevel gears, spiral angle) of the first gear, positive right-handed. The
    pressure angle is that across the teeth."""


class SpaceRackTable(PinionTable):
    """A gear and a rack: one of the two bodies of a prismatic joint is the rack, the other has the
    revolute joint on which the gear turns.
    """

    joint: str
    """The revolute joint of the gear, at a right angle to the rack."""
    side: Side
    """Side of the gear's centre on which the rack is, looking along the axis of the prismatic joint
    with that of the gear's joint upwards."""
    slide: str
    """The prismatic joint that guides the rack on the body with that joint, or that body on the
    rack."""
    at: Point3 | None = None
    """A point in the middle of the meshing teeth, whose position along the gear's axis counts.
    Default: the joint."""
    helix_angle: HelixAngle = 0.0
    """Helix angle of the gear, positive right-handed."""
