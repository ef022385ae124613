"""Forces on a linkage, from a study's loads, springs and tables."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from loads import (
    Applied,
    ArgumentError,
    Clock,
    Distance,
    ForceLaw,
    ForceTable,
    Linkage,
    LinkageError,
    Measure,
    Motion,
    Position,
    Slider,
    Spring,
    TableError,
    Turn,
    Varying,
    read_table,
)
from loads.linkage.parts import Point
from loads.space.out_of_plane import SideLoad
from pinbase.keys import key_part
from pinstress.study.model.mechanism.drives import mechanism_of
from pinstress.study.model.mechanism.parts import knows_centre
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import ApplyTable
from pinstress.study.schema.forces import (
    CurveTable,
    ForceLawTable,
    LineLawTable,
    LineSpringTable,
    TorsionLawTable,
    TorsionSpringTable,
)
from pinstress.study.schema.mechanism import MechanismTable
from pinstress.study.schema.types import JointOrPoint
from pinstress.study.schema.units import to_si

RADIANS_PER_DEGREE = math.pi / 180.0


@dataclass(frozen=True)
class TableColumn:
    """A column of a table: its name in a file, its dimension, the SI value of the file's unit, and
    the name of the unit in messages.
    """

    name: str
    dimension: str
    factor: float
    unit: str


def column(study: Study, name: str, dimension: str) -> TableColumn:
    """Return a column of a dimension, in the study's units."""
    return TableColumn(
        name, dimension, study.system.factor(dimension), study.system.unit(dimension)
    )


def angle_column(name: str) -> TableColumn:
    """Return a column of angles, in degrees."""
    return TableColumn(name, "angle", RADIANS_PER_DEGREE, "deg")


def curve(
    study: Study, where: str, given: CurveTable | None, x: TableColumn, value: tuple[str, str]
) -> ForceTable | None:
    """Return a table as a function; None if none is given.

    where: the key of the table.
    x: the argument.
    value: name and dimension of the value.

    Raises: InputError for a table that cannot be used.
    """
    if given is None:
        return None
    y = column(study, *value)
    try:
        rows = _rows(study, given, x, y)
        at, values = zip(*rows, strict=True)
        unit = (x.unit, x.factor)
        return ForceTable(at, values, given.interpolation, given.outside, where, unit)
    except TableError as error:
        raise study.table_error(f"{where}.table", error) from None
    except LinkageError as error:
        raise study.error(str(error), code=error.code) from None
    except ArgumentError as error:
        raise study.error(f"{where}.points: {error}", code=error.code) from None


def _rows(
    study: Study, given: CurveTable, x: TableColumn, y: TableColumn
) -> list[tuple[float, float]]:
    if given.table is None:
        return [
            (to_si(a, x.dimension, study.system), to_si(b, y.dimension, study.system))
            for a, b in given.points or ()
        ]
    rows = read_table(study.path_to(given.table), (x.name, y.name), ())
    return [(row.number(x.name) * x.factor, row.number(y.name) * y.factor) for row in rows]


def springs(study: Study, mechanism: Linkage) -> tuple[Spring, ...]:
    """Return the springs and dampers of a mechanism.

    Raises: InputError.
    """
    table = study.table.mechanism
    assert isinstance(table, MechanismTable)
    lines = (_spring(study, mechanism, *item) for item in table.spring.items())
    turns = (_torsion(study, *item) for item in table.torsion_spring.items())
    return (*lines, *turns)


def _spring(study: Study, mechanism: Linkage, name: str, table: LineSpringTable) -> Spring:
    between: Distance | Position
    if table.slider is not None:
        slider = next(s for s in mechanism.sliders if s.name == table.slider)
        between, drawn = Position(slider), slider.drawn
    else:
        assert table.bodies is not None
        assert table.joints is not None
        ends = (_at(mechanism, table.joints[0]), _at(mechanism, table.joints[1]))
        between, drawn = Distance(table.bodies, ends), math.dist(*ends)
    return Spring(name, between, line_law(study, name, table, drawn))


def _torsion(study: Study, name: str, table: TorsionSpringTable) -> Spring:
    base, body = table.bodies
    turn = Turn(name, body, 0.0, base)
    return Spring(name, Position(turn), torsion_law(study, name, table))


def line_law(study: Study, name: str, table: LineLawTable, drawn: float) -> ForceLaw:
    """Return the law of a spring that acts along a length. drawn: the length as drawn, m."""
    where, value = f"mechanism.spring.{key_part(name)}", ("force", "force")
    length, velocity = column(study, "length", "length"), column(study, "velocity", "velocity")
    return ForceLaw(
        table.preload,
        table.stiffness,
        drawn if table.reference is None else table.reference,
        table.damping,
        curve(study, f"{where}.force", table.force, length, value),
        curve(study, f"{where}.damper", table.damper, velocity, value),
    )


def torsion_law(study: Study, name: str, table: TorsionLawTable) -> ForceLaw:
    """Return the law of a torsion spring, whose angle is zero as drawn."""
    where, value = f"mechanism.torsion_spring.{key_part(name)}", ("moment", "moment")
    rate = TableColumn("angular_velocity", "angular velocity", 1.0, "rad/s")
    return ForceLaw(
        table.preload,
        table.stiffness,
        table.reference,
        table.damping,
        curve(study, f"{where}.couple", table.couple, angle_column("angle_deg"), value),
        curve(study, f"{where}.damper", table.damper, rate, value),
    )


def _at(mechanism: Linkage, place: JointOrPoint) -> Point:
    return mechanism.joint(place).at if isinstance(place, str) else place


def require_centre(study: Study, where: str, body: str) -> None:
    """Raise InputError for a force at the centre of mass of a body, if that is unknown.

    where: the key of the load.
    """
    if not knows_centre(mechanism_of(study), body):
        text = f"{where}: give at; the centre of mass of {body}, where it would act, is not stated"
        raise study.error(text, code="missing-key")


def load(
    study: Study, where: str, table: ApplyTable, force: Sequence[float], mechanism: Linkage
) -> tuple[SideLoad, ...]:
    """Return a load of a case; a load that varies is split into its force and its couple.

    force: (fx, fy[, fz]) N; with `force_law`, a unit vector.

    Raises: InputError.
    """
    if table.at is None:
        if any(force):
            require_centre(study, where, table.body)
        at, z = next(b.centre for b in mechanism.bodies if b.name == table.body), None
    elif isinstance(table.at, str):
        at, z = mechanism.joint(table.at).at, None
    else:
        (x, y), z = table.at[:2], table.at[2] if len(table.at) > 2 else None
        at = (x, y)
    mx, my, mz = table.moments
    fx, fy, fz = (*force, 0.0)[:3]
    applied = Applied(
        table.body,
        at,
        (fx, fy),
        mz,
        table.follows,
        begin=table.begin or -math.inf,
        end=math.inf if table.end is None else table.end,
    )
    one = SideLoad(applied, z, fz, (mx, my))
    if table.force_law is None and table.couple_law is None:
        return (one,)
    by_force = _varying(study, f"{where}.force_law", table.force_law, mechanism, "force")
    by_couple = _varying(study, f"{where}.couple_law", table.couple_law, mechanism, "moment")
    turned = 1.0 if by_couple else mz
    couple = replace(applied, force=(0.0, 0.0), couple=turned, times=by_couple)
    return (
        SideLoad(replace(applied, couple=0.0, times=by_force), z, fz),
        SideLoad(couple, z, 0.0, (mx, my)),
    )


def _varying(
    study: Study, where: str, law: ForceLawTable | None, mechanism: Linkage, value: str
) -> Varying[Motion] | None:
    if law is None:
        return None
    measure, x = _argument(study, law, mechanism)
    table = curve(study, where, law, x, (value, value))
    return None if table is None else Varying(measure, table)


def _argument(
    study: Study, law: ForceLawTable, mechanism: Linkage
) -> tuple[Measure[Motion], TableColumn]:
    if law.length_between is not None:
        joints = [mechanism.joint(name) for name in law.length_between]
        (a, b), (p, q) = (mechanism.carrier(j) for j in joints), (j.at for j in joints)
        return Distance((a, b), (p, q)), column(study, "length", "length")
    if law.position_of is None:
        return Clock(), column(study, "time", "time")
    sources: dict[str, Slider | Turn] = {s.name: s for s in mechanism.sliders}
    of = (sources | {t.name: t for t in mechanism.turns})[law.position_of]
    if isinstance(of, Turn):
        return Position(of), angle_column("position_deg")
    return Position(of), column(study, "position", "length")
