"""Forces on a linkage, from a study's loads, springs and tables."""

from __future__ import annotations

import math
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
    Position,
    Slider,
    Spring,
    TableError,
    Turn,
    Varying,
    read_table,
)
from loads.linkage.linkage import Point
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import ApplyTable
from pinstress.study.schema.forces import (
    CurveTable,
    ForceLawTable,
    LineSpringTable,
    TorsionSpringTable,
)
from pinstress.study.schema.types import JointOrPoint
from pinstress.study.schema.units import to_si

RADIANS_PER_DEGREE = math.pi / 180.0


@dataclass(frozen=True)
class _Column:
    """A column of a table: its name in a file, its dimension, SI value of the file's unit, and
    its unit in messages.
    """

    name: str
    dimension: str
    factor: float
    unit: str


def _column(study: Study, name: str, dimension: str) -> _Column:
    return _Column(name, dimension, study.system.factor(dimension), study.system.unit(dimension))


def _angle(name: str) -> _Column:
    return _Column(name, "angle", RADIANS_PER_DEGREE, "deg")


def curve(
    study: Study, where: str, given: CurveTable | None, x: _Column, value: tuple[str, str]
) -> ForceTable | None:
    """Return a table as a function.

    where: its key.
    x: its argument.
    value: name and dimension of its value.

    Raises: InputError for a table that cannot be used.
    """
    if given is None:
        return None
    y = _column(study, *value)
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


def _rows(study: Study, given: CurveTable, x: _Column, y: _Column) -> list[tuple[float, float]]:
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
    assert table is not None
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
    where, value = f"mechanism.spring.{name}", ("force", "force")
    length, velocity = _column(study, "length", "length"), _column(study, "velocity", "velocity")
    law = ForceLaw(
        table.preload,
        table.stiffness,
        drawn if table.reference is None else table.reference,
        table.damping,
        curve(study, f"{where}.force", table.force, length, value),
        curve(study, f"{where}.damper", table.damper, velocity, value),
    )
    return Spring(name, between, law)


def _torsion(study: Study, name: str, table: TorsionSpringTable) -> Spring:
    where, value = f"mechanism.torsion_spring.{name}", ("moment", "moment")
    rate = _Column("angular_velocity", "angular velocity", 1.0, "rad/s")
    law = ForceLaw(
        table.preload,
        table.stiffness,
        table.reference,
        table.damping,
        curve(study, f"{where}.couple", table.couple, _angle("angle_deg"), value),
        curve(study, f"{where}.damper", table.damper, rate, value),
    )
    base, body = table.bodies
    return Spring(name, Position(Turn(name, body, 0.0, base)), law)


def _at(mechanism: Linkage, place: JointOrPoint) -> Point:
    return mechanism.joint(place).at if isinstance(place, str) else place


def load(
    study: Study, where: str, table: ApplyTable, force: Point, mechanism: Linkage
) -> tuple[Applied, ...]:
    """Return a load of a case.

    force: N, along `force_law` of size one.

    Raises: InputError.
    """
    at = table.at
    if at is None:
        at = next(b.centre for b in mechanism.bodies if b.name == table.body)
    one = Applied(
        table.body,
        _at(mechanism, at),
        force,
        table.couple,
        table.follows,
        begin=table.begin or -math.inf,
        end=math.inf if table.end is None else table.end,
    )
    if table.force_law is None and table.couple_law is None:
        return (one,)
    by_force = _varying(study, f"{where}.force_law", table.force_law, mechanism, "force")
    by_couple = _varying(study, f"{where}.couple_law", table.couple_law, mechanism, "moment")
    turned = 1.0 if by_couple else table.couple
    return (
        replace(one, couple=0.0, times=by_force),
        replace(one, force=(0.0, 0.0), couple=turned, times=by_couple),
    )


def _varying(
    study: Study, where: str, law: ForceLawTable | None, mechanism: Linkage, value: str
) -> Varying | None:
    if law is None:
        return None
    measure, x = _argument(study, law, mechanism)
    table = curve(study, where, law, x, (value, value))
    return None if table is None else Varying(measure, table)


def _argument(study: Study, law: ForceLawTable, mechanism: Linkage) -> tuple[Measure, _Column]:
    if law.length_between is not None:
        joints = [mechanism.joint(name) for name in law.length_between]
        (a, b), (p, q) = (mechanism.carrier(j) for j in joints), (j.at for j in joints)
        return Distance((a, b), (p, q)), _column(study, "length", "length")
    if law.position_of is None:
        return Clock(), _column(study, "time", "time")
    sources: dict[str, Slider | Turn] = {s.name: s for s in mechanism.sliders}
    of = (sources | {t.name: t for t in mechanism.turns})[law.position_of]
    if isinstance(of, Turn):
        return Position(of), _angle("position_deg")
    return Position(of), _column(study, "position", "length")
