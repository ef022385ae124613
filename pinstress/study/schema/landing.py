"""Keys of a landing as a drop, and of ground loads by rule, in a study file."""

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag, field_validator

from loads.landing.requirements import RULES_OF_PART
from pinbase.errors import ArgumentError
from pinstress.study.schema.cases import CaseTable, Coordinates
from pinstress.study.schema.rules import condition, exactly_one
from pinstress.study.schema.types import (
    NOT_NEGATIVE,
    ONE_OR_SEVERAL,
    POSITIVE,
    Density,
    Direction,
    Duration,
    Force,
    Inertia,
    JointOrPoint3,
    Length,
    Mass,
    Number,
    Quantity,
    Stress,
    StrictTable,
    Switch,
    Velocity,
    Weight,
    Whole,
)

Positive = Annotated[Length, POSITIVE]
Area = Annotated[Annotated[float, Quantity("area")], POSITIVE]
Volume = Annotated[Annotated[float, Quantity("volume")], POSITIVE]
Stiffness = Annotated[Annotated[float, Quantity("stiffness")], POSITIVE]
Pressure = Annotated[Annotated[float, Quantity("stress")], NOT_NEGATIVE]


class GasTable(StrictTable):
    """The gas of a strut: A ((p + b) (v0 / (v0 - A s))^n - b) at stroke s."""

    pressure: Stress
    """Pressure p of the extended strut above ambient."""
    volume: Volume
    """Gas volume v0 of the extended strut."""
    area: Area
    """Area A on which the gas acts."""
    exponent: Annotated[Number, Field(ge=1.0, le=2.0)] = 1.1
    """Polytropic exponent n: 1 isothermal, 1.4 adiabatic."""
    ambient: Pressure = 0.0
    """Ambient pressure b. Default: 0, for which p is the gauge pressure throughout, as in NACA TR
    1154."""


class SpringTable(StrictTable):
    """A leaf or coil spring instead of gas."""

    stiffness: Stiffness
    """Force per stroke."""
    preload: Weight = 0.0
    """Force of the extended strut."""


class OilTable(StrictTable):
    """An orifice: rho A_h^3 / (2 (Cd A_n)^2) times the square of the strut's speed."""

    density: Density
    """Density rho of the oil."""
    area: Area
    """Hydraulic area A_h."""
    orifice: Area
    """Area A_n of the orifice."""
    discharge: Annotated[Number, Field(gt=0.0, le=1.0)] = 0.9
    """Discharge coefficient Cd."""
    rebound: Area | None = None
    """Area of the orifice while the strut extends. Default: the same."""


class StrutTable(StrictTable):
    """A shock strut."""

    drive: str
    """Name of the slider's drive in the mechanism that shortens by the stroke."""
    stroke: Positive
    """Stroke at which the strut bottoms."""
    gas: GasTable | None = None
    """Gas spring. Give either `gas` or `spring`."""
    spring: SpringTable | None = None
    """Linear spring."""
    oil: OilTable | None = None
    """Damping. Default: none."""
    friction: Weight = 0.0
    """Friction of bearings and seals, a constant force."""

    _one_spring = exactly_one("either gas or spring", "gas", "spring")


class TyreTable(StrictTable):
    """Vertical force of a tyre over its deflection: a table, or a power law through one point."""

    deflection: Annotated[list[Length], Field(max_length=1000)] | None = None
    """Deflections of a table, from 0 on. Give either `deflection` and `force` or `at`."""
    force: Annotated[list[Force], Field(max_length=1000)] | None = None
    """Forces at these deflections, from 0 on."""
    at: tuple[Positive, Annotated[Force, POSITIVE]] | None = None
    """A deflection and the force at it, for a power law."""
    exponent: Annotated[Number, Field(ge=0.5, le=3.0)] = 1.0
    """Exponent of the power law."""
    damping: Annotated[Number, Field(ge=0.0, le=100.0)] = 0.0
    """Relative increase of the force per speed of deflection, s/m."""

    @condition
    def _one_law(self) -> None:
        if (self.deflection is None) != (self.force is None):
            raise ArgumentError("give both deflection and force", "give-both")
        if (self.deflection is None) == (self.at is None):
            raise ArgumentError(
                "give either deflection = [...] and force = [...] or at = [deflection, force]",
                "give-one",
            )
        if len(self.deflection or ()) != len(self.force or ()):
            raise ArgumentError("give one force for each deflection", "lengths-differ")


class WheelTable(StrictTable):
    """A wheel that does not rotate before touch-down, for spin-up and spring-back."""

    inertia: Annotated[Inertia, POSITIVE]
    """Moment of inertia about the axle."""
    radius: Positive
    """Rolling radius of the loaded tyre."""
    speed: Annotated[Velocity, POSITIVE]
    """Speed over ground."""
    friction: Annotated[Number, Field(gt=0.0, le=2.0)] = 0.8
    """Coefficient of sliding friction; 14 CFR requires no more than 0.8."""
    stiffness: Stiffness | None = None
    """Fore-and-aft stiffness of the leg at the axle. Default: rigid, without spring-back."""
    mass: Mass | None = None
    """Mass that moves fore and aft with the axle. Default: the unsprung mass of the case."""
    damping: Annotated[Number, Field(ge=0.0, lt=1.0)] = 0.0
    """Damping of the fore-and-aft bending, relative to critical damping."""


Forward = Annotated[
    Annotated[Literal["left", "right"], Tag("<side>")] | Annotated[Direction, Tag("<direction>")],
    Discriminator(lambda value: "<direction>" if isinstance(value, list | tuple) else "<side>"),
]


class AtWheel(CaseTable):
    """Keys of cases in which the ground pushes on a wheel."""

    body: str
    """Body on which the ground pushes."""
    at: JointOrPoint3
    """Joint at the axle, where the forces act; in space a joint or [x, y, z] as drawn."""
    forward: Forward = "left"
    """Direction of travel: in a plane "left" or "right", with gravity downwards; in space [x, y,
    z], of which the horizontal part counts."""
    position: Coordinates | None = None
    """Position of the drives, with a strut extended; as in a static case."""

    @property
    def joint(self) -> str:
        """The joint at the axle, for a planar mechanism."""
        assert isinstance(self.at, str)
        return self.at


class DropCase(AtWheel):
    """A landing as a drop of one leg: two masses, strut, tyre and wheel."""

    kind: Literal["drop"]
    """Kind of case."""
    rule: (
        Literal[
            "25.473-landing-weight", "25.473-take-off-weight", "25.723-reserve-energy", "23.473"
        ]
        | None
    ) = None
    """Section of 14 CFR, from which the velocity and the lift follow if they are not given."""
    weight: Weight | None = None
    """Weight on this leg, the unsprung part included. Give either `weight` or `mass`."""
    mass: Mass | None = None
    """Mass on this leg, the unsprung part included."""
    unsprung: Annotated[Mass, POSITIVE] | None = None
    """Mass below the strut: wheel, tyre, axle, piston. Default: that of the mechanism, whose bodies
    have as much kinetic energy while the strut closes as this mass at the axle. Without a strut it
    must be given."""
    velocity: Annotated[Velocity, POSITIVE] | None = None
    """Velocity of descent. Default: that of the rule."""
    wing_loading: Stress | None = None
    """Weight of the aircraft over the area of its wing, for rule "23.473"."""
    lift: Annotated[Number, Field(ge=0.0, le=1.0)] | None = None
    """Lift over weight. Default: the most that the rule allows; 0 without a rule."""
    strut: StrutTable | None = None
    """Shock strut. Default: none, a rigid leg."""
    tyre: TyreTable
    """Tyre."""
    wheel: WheelTable | None = None
    """Wheel, for spin-up and spring-back. Default: no drag."""
    duration: Duration = 0.5
    """Time from touch-down to the end of the case."""
    samples: Annotated[Whole, Field(ge=2, le=100_001)] = 201
    """Number of equally spaced instants."""
    impulse_time: Duration = 0.15
    """Time of the impulse estimate with which the drop is compared."""

    _one_mass = exactly_one("either mass or weight", "mass", "weight")

    @condition
    def _complete_drop(self) -> None:
        if self.rule is None and self.velocity is None:
            raise ArgumentError("give velocity, or a rule that prescribes it", "no-velocity")


Side = Literal["left", "right", "inboard", "outboard"]


class FactorTable(StrictTable):
    """A load on a wheel as multiples of a reference load, defined by the user."""

    name: str = ""
    """What replaces the * in the case's name; not needed for a single load."""
    clause: Annotated[str, Field(max_length=300)]
    """The paragraph or the report that demands it, cited with the results."""
    vertical: Annotated[Number, Field(ge=0.0)]
    """Upward force over the reference load."""
    drag: Number = 0.0
    """Force aft over the reference load; negative: forward."""
    side: Annotated[Number, Field(ge=0.0)] = 0.0
    """Force across the mechanism over the reference load."""
    toward: Side | None = None
    """The side to which the side load acts. Default: that of the case; with a * in the case's name
    a case for each side."""
    reference: Annotated[Force, POSITIVE] | None = None
    """Reference load. Default: that of the case."""
    deflection: Annotated[Number, Field(ge=0.0, le=1.0)] = 1.0
    """With `drop`: stroke of the strut over that at the largest vertical reaction."""
    braked: Switch = False
    """Whether the wheel cannot turn, so that drag acts at the ground contact; it needs `radius` of
    the case."""

    @field_validator("clause")
    @classmethod
    def _cited(cls, value: str) -> str:
        if not value.strip():
            raise ArgumentError("is empty; name the paragraph or report of this load", "empty")
        return value


class SpinUpTable(StrictTable):
    """The data from which appendix D to part 23 finds the spin-up drag."""

    inertia: Annotated[Inertia, POSITIVE]
    """Moment of inertia of the wheel about the axle."""
    radius: Positive
    """Rolling radius of the loaded tyre."""
    speed: Annotated[Velocity, POSITIVE]
    """Speed over ground minus the speed of the tyre by pre-rotation."""
    time: Annotated[Duration, POSITIVE]
    """Time from touch-down to the largest vertical reaction."""


class GroundCase(AtWheel):
    """Loads on a wheel as multiples of a reference load, by 14 CFR or by the user, with the leg at
    rest.
    """

    kind: Literal["ground"]
    """Kind of case."""
    rule: (
        Literal[
            "25.473-spin-up",
            "25.473-spring-back",
            "25.479-drag",
            "25.479-drift",
            "23.D-spin-up",
            "23.D-spring-back",
            "23.479-drag",
            "23.499-aft",
            "23.499-forward",
            "23.499-side",
        ]
        | None
    ) = None
    """Section of 14 CFR, for a single case."""
    part: Literal["23", "25"] | None = None
    """Part of 14 CFR: one case for each of its rules above, side loads to both sides. The case's
    name has a *, which the names of the rules replace."""
    factors: Annotated[list[FactorTable], Field(max_length=100), ONE_OR_SEVERAL] = []
    """Other loads: one table, or several `[[case."NAME *".factors]]` with names."""
    reference: Annotated[Force, POSITIVE] | None = None
    """The largest vertical reaction (25.473, 25.479, 23.479), the static load (23.499), or the load
    to which `factors` refer. Give either `reference` or, unless it is a static load, `drop`."""
    drop: str | None = None
    """A case of kind "drop". Its largest vertical reaction is the reference, and the strut has its
    stroke at that instant; for 25.479-drift, 75 % of that stroke."""
    leg: Literal["left", "right", "nose"] | None = None
    """Position of the leg on the aircraft, which distinguishes inboard from outboard. Default:
    left; nose for 23.499."""
    toward: Side | None = None
    """The side to which a side load acts. Default: inboard; left for a nose wheel."""
    radius: Positive | None = None
    """Radius of the loaded tyre: side loads, and drag of a braked wheel, act at the ground, this
    far beneath the axle. Default: at the axle."""
    hold: Annotated[list[str], Field(min_length=1)] | None = None
    """Names of the drives, sliders and stops that hold the leg. Default: the drives."""
    spin_up: SpinUpTable | None = None
    """Data for the drag of spin-up and spring-back. Default: the wheel of the drop; without either,
    the largest drag that is required, 0.8 of the vertical reaction."""

    @property
    def stands(self) -> Literal["left", "right", "nose"]:
        """The position of the leg on the aircraft."""
        return self.leg or ("nose" if (self.rule or "").startswith("23.499") else "left")

    @property
    def rules(self) -> tuple[str, ...]:
        """The built-in rules of the case or, with a part, of all its cases."""
        if self.part is not None:
            return RULES_OF_PART[self.part, "nose" if self.stands == "nose" else "main"]
        return (self.rule,) if self.rule is not None else ()

    @condition
    def _what_acts(self) -> None:
        if not (self.rule or self.part or self.factors) or (
            self.rule and (self.part or self.factors)
        ):
            raise ArgumentError(
                "give rule, or part for all rules of a part of 14 CFR, or factors of your own; "
                "part and factors may stand together",
                "give-one",
            )
        if self.part is not None and not self.rules:
            raise ArgumentError(
                f"of part {self.part} no load of a nose wheel is built in: state its factors",
                "no-rule",
            )
        if (self.part or len(self.factors) > 1) and not all(row.name for row in self.factors):
            raise ArgumentError("give each of the factors a name", "missing-key")
        for side in (self.toward, *(row.toward for row in self.factors)):
            if self.stands == "nose" and side in ("inboard", "outboard"):
                raise ArgumentError(
                    "toward: a nose wheel has no inboard side; use left or right", "no-inboard"
                )
        if self.radius is None and any(row.braked for row in self.factors):
            raise ArgumentError(
                "give radius: the drag of a braked wheel acts at the ground", "no-radius"
            )

    @condition
    def _one_reference(self) -> None:
        given = (self.reference is not None) + (self.drop is not None)
        needed = bool(self.rules) or any(row.reference is None for row in self.factors)
        if given > 1 or given < needed:
            raise ArgumentError("give either reference or drop", "give-one")
        static = next((rule for rule in self.rules if rule.startswith("23.499")), None)
        if self.drop is not None and static is not None:
            raise ArgumentError(
                f"rule {static} refers to the static load on the wheel: give reference",
                "key-not-applicable",
            )
