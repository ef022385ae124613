"""Tables of a study file, with the unit, domain and description of every key."""

import datetime
from typing import Annotated, Any, Literal

from pydantic import (
    BeforeValidator,
    Discriminator,
    Field,
    Tag,
    ValidationError,
    ValidationInfo,
    field_validator,
    model_validator,
)

from assess.codes import RECOMMENDED, AiscDesign, Code
from pinbase.errors import ArgumentError
from pinstress.study.schema.cases import GivenCase, InstantCase, MotionCase, StaticCase
from pinstress.study.schema.fatigue import FatigueTable
from pinstress.study.schema.landing import DropCase, GroundCase
from pinstress.study.schema.lugs import LugTable, with_lug_defaults
from pinstress.study.schema.materials import MaterialTable
from pinstress.study.schema.mechanism import MechanismTable
from pinstress.study.schema.pins import PinTable
from pinstress.study.schema.require import RequireTable
from pinstress.study.schema.rules import condition
from pinstress.study.schema.sequence import SequenceTable
from pinstress.study.schema.shown import as_text, in_toml
from pinstress.study.schema.size import SizeTable
from pinstress.study.schema.space import SpaceMechanismTable
from pinstress.study.schema.types import (
    ANY_CASE,
    ONE_OR_BOTH,
    CaseName,
    LimitLoads,
    Name,
    Number,
    PositiveLength,
    StrictTable,
    Temperature,
)
from pinstress.study.schema.vary import ReliabilityTable, VaryTable


def _plane_or_space(value: object) -> str:
    """The tag of a mechanism by its dimension; if that is neither 2 nor 3, by the coordinates of
    its points.
    """
    dimension = value.get("dimension", 2) if isinstance(value, dict) else 2
    if not isinstance(value, dict) or dimension in (2, 3):
        return "<space>" if dimension == 3 else "<plane>"
    joints = value.get("joint")
    tables = joints.values() if isinstance(joints, dict) else ()
    points = [table.get("at") for table in tables if isinstance(table, dict)]
    in_space = any(isinstance(at, list) and len(at) == 3 for at in points)
    return "<space>" if in_space else "<plane>"


AnyMechanism = Annotated[
    Annotated[MechanismTable, Tag("<plane>")] | Annotated[SpaceMechanismTable, Tag("<space>")],
    Discriminator(_plane_or_space),
]
AnyCase = GivenCase | MotionCase | StaticCase | InstantCase | DropCase | GroundCase


class PartialFactorsTable(StrictTable):
    """Partial factors of EN 1993-1-8, as a national annex states them."""

    M0: Annotated[Number, Field(ge=0.5)] = RECOMMENDED.M0
    """Factor for the resistance of cross-sections: bearing and bending of pins."""
    M2: Annotated[Number, Field(ge=0.5)] = RECOMMENDED.M2
    """Factor for shear of pins."""
    M6_ser: Annotated[Number, Field(ge=0.5)] = RECOMMENDED.M6_ser
    """Factor for replaceable pins under service loads."""


class AnalysisTable(StrictTable):
    """Requirements on the analysis."""

    model: Literal["auto", "beam", "harmonic", "solid"] = "auto"
    """The model; "auto" uses the simplest that is accurate enough."""
    joints: Literal["auto", "contact", "foundation", "prescribed"] = "auto"
    """How links load the pins: by contact with elastic lugs ("contact"), by lugs as elastic
    foundations of a beam, which is quick but has a model error ("foundation"), or by prescribed
    clamps and load distributions ("prescribed"). "auto" uses contact for the pins that have a
    `lug`, or the beam where its error is within the tolerance and bending governs."""
    goal: Literal["value", "decide"] = "value"
    """Refine until the maximum is within the tolerance ("value"), or only until it is decided
    whether the required safety factor is met ("decide", which needs a yield strength)."""
    tolerance: Annotated[Number, Field(gt=0.0, lt=1.0)] = 0.02
    """Largest relative error of the maximum von Mises stress."""
    excluded_distance: Annotated[Number, Field(ge=0.01, le=0.5)] = 0.1
    """Distance from a stress singularity within which stress is not evaluated, as a fraction of the
    local diameter."""
    limit_load: LimitLoads = "auto"
    """Rows for which the load is computed at which the pin collapses. "auto": those that yield, by
    a beam if that decides whether they carry their loads, otherwise by an elastic-plastic solid;
    each has 20 s of processor time, with `run --limit-load` no limit. "always", or a list of pins:
    all rows, or those of these pins, by the solid, without a limit of time. "never": none. If more
    than "auto" is requested, limit loads of lugs with a `shank` are computed, too."""
    required_safety_factor: Annotated[Number, Field(gt=0.0)] | None = None
    """Safety factor that every pin must reach: yield strength over stress under the loads of the
    study, without the factors below. A [[require]] on yield at limit load replaces it for its pins
    and cases. Default: no comparison."""
    limit_factor: Annotated[Number, Field(gt=0.0)] = 1.0
    """Factor on the loads of the study for checks at limit load, against yield."""
    ultimate_factor: Annotated[Number, Field(gt=0.0)] = 1.5
    """Factor on the loads of the study for checks at ultimate load, against rupture and collapse.
    The default is that of 14 CFR 25.303."""
    fitting_factor: Annotated[Number, Field(ge=1.0)] = 1.0
    """Additional factor of all checks of margins, for fittings whose strength no test proves; 14
    CFR 25.625 demands 1.15, which is the default of the code "aircraft"."""
    code: Annotated[
        Annotated[Code, Tag("<one>")] | Annotated[list[Code], Field(min_length=1), Tag("<both>")],
        ONE_OR_BOTH,
    ] = "general"
    """The checks of strength for pins and lugs: textbooks and EN 1993-1-8 ("general");
    AFFDL-TR-69-42, Melcon and Hoblit, Ekvall, Cozzone ("aircraft"); ASME BTH-1 ("lifting"); EN
    1993-1-8, EN 1993-1-1 and ANSI/AISC 360, D5 ("civil"). A list shows them side by side."""
    design_factor: Annotated[Number, Field(ge=1.0)] | None = None
    """Design factor N_d of ASME BTH-1, by the design category of the device, for the code
    "lifting"."""

    partial_factors: PartialFactorsTable = PartialFactorsTable()
    """Partial factors of EN 1993-1-8, for checks of "general" and "civil"."""
    aisc: AiscDesign = "LRFD"
    """How plates are designed by ANSI/AISC 360, for the code "civil": by load and resistance
    factors at ultimate load ("LRFD"), or by allowable strengths at limit load ("ASD")."""
    reference_temperature: Annotated[
        Temperature, Field(json_schema_extra={"default": "20 degC"})
    ] = 293.15
    """Temperature at which the dimensions, clearances and interferences of the study hold."""
    bending_moment: Literal["joint", "formula"] = "joint"
    """The bending moments and shear forces that checks of pins in solved joints use: those of the
    joint model ("joint") or those of even loads on the bands ("formula"). The others are listed for
    comparison, but those of the joint model also govern where even loads leave a couple unbalanced.
    Pins without a joint model always use the formulas."""

    @property
    def codes(self) -> tuple[Code, ...]:
        """The chosen sets of checks, each once."""
        return (self.code,) if isinstance(self.code, str) else tuple(dict.fromkeys(self.code))

    @condition
    def _ultimate_is_more(self) -> None:
        if self.ultimate_factor < self.limit_factor:
            raise ArgumentError(
                f"ultimate_factor {self.ultimate_factor:g} is less than limit_factor "
                f"{self.limit_factor:g}; ultimate loads are limit loads or more",
                "factors-out-of-order",
            )


class BeamCheckTable(StrictTable):
    """Compare a cantilever pin's axial stress with beam theory, with the load on its surface and on
    a thin bore.
    """

    pin: str
    """A pin clamped at its start face, loaded on one band."""
    case: str
    """A case without moments on the pin."""
    axis_bore: PositiveLength
    """Diameter of the thin bore that carries the load."""


class MotionCheckTable(StrictTable):
    """Compare a joint's speed and acceleration with the closed form of a lever: the joint turns
    about a fixed pivot with the moving end of the driven slider.
    """

    case: str
    """A case of kind "motion"."""
    joint: str
    """The joint that turns."""
    pivot: str
    """The joint about which it turns."""


class PublishedTable(StrictTable):
    """Published values for comparison, in CSV files in the study's folder."""

    source: str
    """Source of the values."""
    peaks: str | None = None
    """CSV file with the columns pin,case,max_von_mises,safety_factor. Only for a study with the
    publication's geometry, since maxima of other shapes cannot be compared."""
    reactions: str | None = None
    """CSV file with the columns case,connection,force."""
    motion: str | None = None
    """CSV file with the columns time,speed,acceleration, of the joint in `motion_check`."""
    values: str | None = None
    """CSV file with the columns case,time,quantity,name,published,reason."""


def _date(value: object) -> object:
    """Return a date that is given as a date or as text. Numbers are rejected: pydantic would read
    them as seconds since 1970.
    """
    text = value.isoformat() if type(value) is datetime.date else value
    try:
        return datetime.date.fromisoformat(text if isinstance(text, str) else "")
    except ValueError:
        raise ArgumentError(
            f"must be a date such as 2026-03-31, without quotes, not {in_toml(value)}",
            "not-a-date",
        ) from None


class ReportTable(StrictTable):
    """The title block of the report; what is not given is left blank."""

    revision: Annotated[str, Field(max_length=100)] = ""
    """Revision, as "B"."""
    date: Annotated[datetime.date, BeforeValidator(_date)] | None = None
    """Date of the revision, as 2026-03-31 without quotes; also the PDF's date of creation."""
    prepared: Annotated[str, Field(max_length=100)] = ""
    """Name of the person who prepared the report."""
    checked: Annotated[str, Field(max_length=100)] = ""
    """Name of the person who checked the report."""
    approved: Annotated[str, Field(max_length=100)] = ""
    """Name of the person who approved the report."""


class StudyTable(StrictTable):
    """A study: pins, their materials, their loads and the requirements on the analysis."""

    title: Annotated[str, Field(max_length=1000)]
    """Title of the report and of every table."""
    units: Literal["in-lbf-s", "mm-N-s", "m-N-s"]
    """The unit system of numbers without a unit, and of the results."""
    material: dict[str, MaterialTable] = {}
    """Materials by name. Others that are named are those of `materials` or of the library (see
    `pinstress materials`)."""
    materials: str | None = None
    """A TOML file with further `[material.NAME]`, in the study's folder; its quantities have
    units."""
    lug_defaults: LugTable | None = None
    """Keys of every lug, unless its own table states them. With this table, pins that are not
    clamped have a lug at every connection (see `pin.NAME.lugs`)."""
    pin: dict[Name, PinTable] = {}
    """Pins by name; without pins only `pinstress loads` can be used."""
    case: Annotated[
        dict[
            CaseName,
            Annotated[AnyCase, Field(discriminator="kind")],
        ],
        Field(min_length=1),
    ]
    """Load cases by name; each is run for the pins that it loads. A name with a * stands for
    several cases, whose names replace the *: for kind "given" the names in the column `case` of the
    table, for kind "ground" the rules of the `part` and the `factors`."""
    sequence: dict[Name, SequenceTable] = {}
    """Duty cycles by name: cases one after the other."""
    mechanism: AnyMechanism | None = None
    """The linkage, for cases of kind "motion", "static", "instant", and in a plane "drop" and
    "ground"."""
    analysis: AnalysisTable = AnalysisTable()
    """Requirements on the analysis."""
    require: list[RequireTable] = []
    """Requirements on checks, besides the required safety factor."""
    fatigue: FatigueTable | None = None
    """How often cases occur, for damage and life. Default: fatigue is not assessed."""
    beam_check: BeamCheckTable | None = None
    """A comparison with beam theory."""
    motion_check: MotionCheckTable | None = None
    """A comparison with the closed form of a lever."""
    published: PublishedTable | None = None
    """Published values for comparison."""
    vary: VaryTable | None = None
    """Numbers that `pinstress sweep` varies; `run` ignores them."""
    reliability: ReliabilityTable = ReliabilityTable()
    """Settings of `pinstress reliability`; `run` ignores them."""
    size: SizeTable = SizeTable()
    """Limits for `pinstress size`; `run` ignores them."""
    report: ReportTable = ReportTable()
    """The title block of the report."""
    assumptions: list[str] = []
    """Assumptions, as sentences for the report."""

    @model_validator(mode="before")
    @classmethod
    def _complete_lugs(cls, data: Any, info: ValidationInfo) -> Any:
        if not isinstance(data, dict) or "lug_defaults" not in data:
            return data
        try:
            LugTable.model_validate(data["lug_defaults"], context=info.context)
        except ValidationError:
            return data  # the errors of lug_defaults are reported once, for that table
        return with_lug_defaults(data)

    @field_validator("case", mode="before")
    @classmethod
    def _tables_of_cases(cls, value: Any) -> Any:
        for name, case in value.items() if isinstance(value, dict) else ():
            content: dict[str, Any] = case if isinstance(case, dict) else {}
            several = content.get("kind") == "given" and "table" in content
            factors = content.get("factors", [])
            loads = isinstance(factors, list) and len(factors) > 1
            if content.get("kind") == "ground":
                several = "factors" in content or "part" in content
                if ("part" in content or loads) and ANY_CASE not in str(name):
                    raise ArgumentError(
                        f"{as_text(name)}: several cases; put a * into the name, which theirs "
                        f'replace: [case."{name} *"]',
                        "unusable-name",
                    )
            if ANY_CASE in str(name) and not several:
                raise ArgumentError(
                    f"{as_text(name)}: a name with a * stands for several cases; give kind = "
                    '"given" and table = "file.csv", or kind = "ground" and part or factors',
                    "unusable-name",
                )
        return value
