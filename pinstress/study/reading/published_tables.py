"""Tables of published values, read before solving."""

from __future__ import annotations

from dataclasses import dataclass, field

from loads import TableError, read_table
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study


@dataclass(frozen=True)
class PublishedRow:
    """A published value of a quantity of the item `name`.

    where: file and line.
    """

    case: str
    time: float | None
    quantity: str
    name: str
    value: float
    reason: str
    where: str


@dataclass(frozen=True)
class Published:
    """Published values in the study's units.

    peaks: (maximum von Mises, safety factor) by pin and case.
    reactions: magnitude by case and connection.
    motion: rows of time, speed, acceleration.
    values: single quantities.
    """

    peaks: dict[tuple[str, str], tuple[float, float]] = field(default_factory=dict)
    reactions: dict[tuple[str, str], float] = field(default_factory=dict)
    motion: tuple[tuple[float, float, float], ...] = ()
    values: tuple[PublishedRow, ...] = ()


def read_published(study: Study) -> Published:
    """Return the study's tables of published values.

    Raises: InputError.
    """
    named = study.table.published
    if named is None:
        return Published()
    peaks = _rows(study, named.peaks, ("pin", "case"), ("max_von_mises", "safety_factor"))
    reactions = _rows(study, named.reactions, ("case", "connection"), ("force",))
    motion = _rows(study, named.motion, (), ("time", "speed", "acceleration"))
    return Published(
        peaks={(names[0], names[1]): (v[0], v[1]) for _, names, v in peaks},
        reactions={(names[0], names[1]): v[0] for _, names, v in reactions},
        motion=tuple((v[0], v[1], v[2]) for _, _, v in motion),
        values=_values(study, named.values),
    )


def _values(study: Study, name: str | None) -> tuple[PublishedRow, ...]:
    columns = ("case", "time", "quantity", "name", "reason")
    rows = []
    for where, text, (value,) in _rows(study, name, columns, ("published",)):
        case, when, quantity, what, reason = text
        if case not in study.table.case:
            raise InputError(f"{where}: the study has no case {case!r}", code="unknown-case")
        try:
            time = float(when) if when else None
        except ValueError:
            raise InputError(
                f"{where}: time {when!r} is not a number", code="not-a-number"
            ) from None
        rows.append(PublishedRow(case, time, quantity, what, value, reason, where))
    return tuple(rows)


def _rows(
    study: Study, name: str | None, names: tuple[str, ...], numbers: tuple[str, ...]
) -> list[tuple[str, list[str], list[float]]]:
    """Return the rows of a table, each as its file and line, its names and its numbers."""
    if name is None:
        return []
    rows = []
    try:
        for row in read_table(study.path_to(name), (*names, *numbers)):
            cells = [row.cells[c] for c in names]
            rows.append((row.where, cells, [row.number(c) for c in numbers]))
    except TableError as error:
        raise study.table_error("published", error) from None
    return rows
