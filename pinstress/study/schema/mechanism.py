"""Keys of a planar mechanism in a study file."""

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag, field_validator, model_validator

from loads.linkage.parts import Sign
from pinbase.errors import ArgumentError
from pinstress.study.schema.drives import RotaryDrive, SliderDrive
from pinstress.study.schema.forces import LineSpringTable, TorsionSpringTable
from pinstress.study.schema.gears import GearTable, RackTable
from pinstress.study.schema.rules import both_or_none, condition, exactly_one, require_one
from pinstress.study.schema.types import (
    NOT_NEGATIVE,
    ONE_OR_SEVERAL,
    POSITIVE,
    Acceleration,
    Angle,
    Density,
    Inertia,
    JointOrPoint,
    Length,
    Mass,
    Number,
    Point,
    PositiveLength,
    Quantity,
    Side,
    Stress,
    StrictTable,
    Switch,
    Weight,
    of_usual_length,
)


class Polar(StrictTable):
    """A point at a distance from a joint, in a direction counter-clockwise from x."""

    origin: str
    """A joint."""
    distance: PositiveLength
    """Distance from the joint."""
    angle: Angle
    """Counter-clockwise from x."""


class Dyad(StrictTable):
    """A point at distances from two joints, on one side of the line from the first to the second:
    the two sides are the two branches in which a four-bar can be assembled.
    """

    origins: tuple[str, str]
    """The two joints."""
    distances: tuple[PositiveLength, PositiveLength]
    """Distances from the first and the second joint."""
    side: Side
    """Side of the line from the first joint to the second."""


def _way_of_placing(value: object) -> str:
    if isinstance(value, dict):
        return "<dyad>" if "origins" in value else "<polar>"
    return "<point>"


Place = Annotated[
    Annotated[Point, Tag("<point>")]
    | Annotated[Polar, Tag("<polar>")]
    | Annotated[Dyad, Tag("<dyad>")],
    Discriminator(_way_of_placing),
]


SPACE_KEYS = ("kind", "axis", "second_axis", "pin_axis")  # of joints


class JointTable(StrictTable):
    """A pin of the mechanism as drawn, and the body on each of its connections."""

    at: Place
    """Position in the drawing: [x, y], { origin, distance, angle } or { origins, distances, side
    }."""
    connections: Annotated[dict[str, str], Field(min_length=1)]
    """For each connection, the body that turns on the pin. Names of connections are unique in the
    study."""
    fixed_in: str | None = None
    """The body that carries the pin, or "ground". Default: none, a floating pin."""
    weight: Weight | None = None
    """Weight of a floating pin. Default: the weight of its profile."""
    friction: Annotated[Number, Field(ge=0.0, le=10.0)] | None = None
    """Coefficient of Coulomb friction between the pin and the bodies that turn on it; needs
    `diameter` and `fixed_in`."""
    diameter: PositiveLength | None = None
    """Diameter of the pin, for friction."""
    z: Length | None = None
    """Position along z of the start of the pin's profile: links lie at the middles of their bands,
    and at `z` where the pin has none. It matters in cases with loads out of the plane, and in all
    once it is stated. Default: such that links are straight."""

    @model_validator(mode="before")
    @classmethod
    def _in_a_plane(cls, data: Any) -> Any:
        for key in SPACE_KEYS if isinstance(data, dict) else ():
            if key in data:
                text = f"{key} is for linkages in space; for one write mechanism.dimension = 3"
                raise ArgumentError(text, "wrong-dimension")
        if isinstance(data, dict) and isinstance(at := data.get("at"), list) and len(at) == 3:
            raise ArgumentError(
                "at has three numbers, but the linkage is in a plane: give at = [x, y], or write "
                "mechanism.dimension = 3",
                "wrong-dimension",
            )
        return data

    _with_diameter = both_or_none("friction", "diameter")

    @property
    def origins(self) -> tuple[str, ...]:
        """The joints from which the position of the joint is measured."""
        if isinstance(self.at, Polar):
            return (self.at.origin,)
        return self.at.origins if isinstance(self.at, Dyad) else ()


class BarTable(StrictTable):
    """A uniform straight bar between two joints, round or rectangular."""

    joints: tuple[str, str]
    """The joints at its ends."""
    diameter: PositiveLength | None = None
    """Diameter of a round bar. Give either `diameter` or `section`."""
    section: tuple[PositiveLength, PositiveLength] | None = None
    """Section of a rectangular bar: [depth in the plane, width across it]."""
    density: Density
    """Density of the material."""

    _one_section = exactly_one("either diameter or section = [depth, width]", "diameter", "section")


def require_single_mass(mass: object, weight: object, bar: object, centre: object) -> None:
    """Raise ArgumentError if two keys give the mass of a body, or two its centre."""
    if [mass, weight, bar].count(None) < 2:
        raise ArgumentError("give one of weight, mass or bar", "give-one")
    if bar is not None and centre is not None:
        raise ArgumentError(
            "centre cannot be used with bar, whose centre is its middle; give mass or weight "
            "instead",
            "key-not-applicable",
        )


class BodyTable(StrictTable):
    """A rigid body."""

    weight: Weight | None = None
    """Weight in the gravity of the study. Give one of `weight`, `mass` or `bar`, unless gravity is
    off and all cases are static."""
    mass: Mass | None = None
    """Mass."""
    bar: BarTable | None = None
    """A uniform straight bar, which determines mass, centre and inertia."""
    centre: Point | None = None
    """Centre of mass in the drawn position. Default: midway between the joints, if there are two;
    at the only joint of a gear, of a point mass, or of a body that slides without rotating (inertia
    = 0)."""
    inertia: Inertia | None = None
    """Moment of inertia about the centre of mass. Default: that of the bar; without a bar the body
    is a particle, which has one connection or slides on the ground. Static cases need none."""
    welded_to: str | None = None
    """Body, or "ground", to which it is fixed. Forces in the weld are not computed."""

    @condition
    def _one_mass(self) -> None:
        require_single_mass(self.mass, self.weight, self.bar, self.centre)


class SliderTable(StrictTable):
    """One body sliding on another, or on the ground, without turning on it."""

    bodies: tuple[str, str]
    """[base, moving]; the base may be "ground"."""
    joints: tuple[JointOrPoint, JointOrPoint]
    """A point of the base and one of the moving body, each a joint or [x, y]. Their distance along
    the direction is the length of the slider."""
    direction: tuple[Number, Number] | None = None
    """Direction of the axis in the drawing; it rotates with the base. Default: from the first point
    to the second."""
    friction: Annotated[Number, Field(ge=0.0, le=10.0)] = 0.0
    """Coefficient of Coulomb friction."""
    bearing: Annotated[Length, POSITIVE] | None = None
    """Distance between the two pads that carry the couple, centred on the second point. Default:
    the couple is carried without friction."""

    @field_validator("direction")
    @classmethod
    def _not_zero(cls, value: tuple[float, float] | None) -> tuple[float, float] | None:
        if value is not None and not any(value):
            raise ArgumentError("must not be zero", "no-direction")
        return value if value is None else of_usual_length(value)


AnyDrive = Annotated[
    Annotated[SliderDrive, Tag("<slider>")] | Annotated[RotaryDrive, Tag("<rotary>")],
    Discriminator(lambda v: "<slider>" if isinstance(v, dict) and "slider" in v else "<rotary>"),
]


Ratios = Annotated[list[Annotated[Number, Field(ge=1e-18, le=1e18)]], Field(min_length=1)]


class SharingTable(StrictTable):
    """Springs in parallel, by which redundant connections share their load, or by which drives in
    parallel (two lift cylinders), of which one is driven, share their force.
    """

    connections: Annotated[list[str], Field(min_length=1)] | None = None
    """The redundant connections, gears and racks. Give either `connections` or `parallel`."""
    parallel: Annotated[list[str], Field(min_length=2)] | None = None
    """Drives, sliders or stops in parallel (in space drives or stops); exactly one of them is
    driven."""
    stiffness: Ratios | None = None
    """Stiffness of each; only the ratios matter."""
    areas: Ratios | None = None
    """Piston area of each of the `parallel`, under the same pressure; only the ratios matter. Equal
    areas: equal forces."""

    @condition
    def _one_rule(self) -> None:
        require_one("either connections or parallel", self.connections, self.parallel)
        if self.connections is not None and self.areas is not None:
            raise ArgumentError("areas is for parallel drives only", "key-not-applicable")
        require_one("stiffness (of parallel drives: or areas)", self.stiffness, self.areas)
        names = self.connections or self.parallel or []
        if len(names) != len(self.stiffness or self.areas or []):
            raise ArgumentError("give one number for each name", "lengths-differ")


class PointTable(StrictTable):
    """A point whose path is written to paths.csv and drawn in the animation (a coupler curve)."""

    body: str
    """The body to which it belongs."""
    at: JointOrPoint
    """A joint, or [x, y] as drawn."""


class StopTable(StrictTable):
    """A stop or lock, which can keep a body from turning against another in cases whose `hold`
    names it.
    """

    bodies: tuple[str, str]
    """[base, body]; the base may be "ground"."""
    carries: Sign = "both"
    """Couples on the body, counter-clockwise positive, that it can carry: "both" for a lock, one
    sign for a stop, which opens under the other."""


class LinkStiffnessTable(StrictTable):
    """The section of a link, for its stiffness where links share loads out of the plane. A `bar`
    has its own section by default.
    """

    diameter: PositiveLength | None = None
    """Diameter of a round link. Give one of `diameter`, `section`, `stiffness` or `rigid`."""
    bore: Annotated[Length, NOT_NEGATIVE] = 0.0
    """Bore of a tube."""
    section: tuple[PositiveLength, PositiveLength] | None = None
    """Section of a rectangular link: [depth in the plane, width across it]."""
    youngs_modulus: Annotated[Stress, Field(json_schema_extra={"default": "210 GPa"})] = 210e9
    """Young's modulus; only ratios between links matter."""
    stiffness: Annotated[Annotated[float, Quantity("stiffness")], POSITIVE] | None = None
    """For a link that is not a bar: the force across it at the joint farthest from its centre of
    mass, divided by the deflection there, with the link held at the centre of mass. The link
    deflects like the round bar of this stiffness."""
    rigid: Switch = False
    """Whether the link is rigid compared with the others."""

    @condition
    def _one_section(self) -> None:
        given = [self.diameter, self.section, self.stiffness, self.rigid or None]
        if given.count(None) != len(given) - 1:
            raise ArgumentError(
                "give one of diameter, section = [depth, width], stiffness or rigid = true",
                "give-one",
            )
        if self.bore and (self.diameter is None or self.bore >= self.diameter):
            raise ArgumentError("bore must be less than the diameter", "out-of-range")


class MechanismTable(StrictTable):
    """A planar linkage, drawn in one position, with one or several drives, or a structure."""

    dimension: Literal[2] = 2
    """A linkage in a plane; 3 for one in space."""
    gravity: Annotated[
        tuple[Acceleration, Acceleration],
        Field(json_schema_extra={"default": ["0 m/s^2", "-9.80665 m/s^2"]}),
    ] = (0.0, -9.80665)
    """Acceleration of gravity [gx, gy]; [0, 0] switches it off."""
    joint: Annotated[dict[str, JointTable], Field(min_length=1)]
    """Joints by name."""
    body: Annotated[dict[str, BodyTable], Field(min_length=1)]
    """Bodies by name, except the ground."""
    slider: dict[str, SliderTable] = {}
    """Sliders by name."""
    drive: Annotated[list[AnyDrive], ONE_OR_SEVERAL] = []
    """One table, or several `[[mechanism.drive]]`: as many as there are degrees of freedom; none
    for a structure, and where `hold` names the locks of every case."""
    gear: dict[str, GearTable] = {}
    """Pairs of gears by name, which is also the name of the force between their teeth."""
    rack: dict[str, RackTable] = {}
    """Racks with their gears by name, which is also the name of the force between their teeth."""
    point: dict[str, PointTable] = {}
    """Points whose paths are of interest, by name."""
    stop: dict[str, StopTable] = {}
    """Stops and locks by name."""
    spring: dict[str, LineSpringTable] = {}
    """Springs and dampers by name; they act in all cases."""
    torsion_spring: dict[str, TorsionSpringTable] = {}
    """Torsion springs and dampers by name; they act in all cases."""
    sharing: list[SharingTable] = []
    """Redundant connections, and how they share their load."""
    fit_within: Annotated[Length, POSITIVE] | None = None
    """Distance by which joints may be moved so that the loops of redundant links close in motion:
    the tolerance of the drawing. The sum of squares of the movements is minimised. Default: joints
    stay as drawn, and links that do not fit are rejected."""
    link_stiffness: dict[str, LinkStiffnessTable] = {}
    """Sections of links, by body. By their stiffness, links share loads out of the plane. Rows of a
    case with such loads have a range over the stiffness of links without a stated section."""
