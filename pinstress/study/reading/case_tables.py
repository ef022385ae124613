"""The layout of a case's tables of forces, as the reader of tables needs it."""

from __future__ import annotations

from loads import FileReading, JointAxes, Layout
from pinstress.study.schema.cases import GivenCase
from pinstress.study.schema.force_tables import ForceAxes, JointColumns, TableFile, matrix_of

NO_ROTATION = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def layout_of(case: GivenCase, table: TableFile, rows: str) -> Layout:
    """Return the meaning of a table's columns.

    rows: name of the case whose rows are read.
    """
    columns = case.columns or _columns(table)
    time = table.time
    return Layout(
        case=rows,
        columns=columns,
        labels=case.labels,
        step=case.time_step if time is None else time.step,
        offset=0.0 if time is None else time.offset,
        units=_units(table),
        unit_needed=frozenset() if case.table_units else _unit_needed(table),
        axes={"": _axes(table, table, None)}
        | {name: _axes(table, joint, joint) for name, joint in table.connections.items()},
        reading=FileReading(
            table.sheet,
            table.header_line,
            table.separator,
            table.decimal,
            table.encoding,
        ),
    )


def _columns(table: TableFile) -> dict[str, str | int]:
    """Return the stated columns by their meaning."""
    columns: dict[str, str | int] = {}
    if table.time is not None and table.time.column is not None:
        columns["time"] = table.time.column
    for name, joint in table.connections.items():
        columns |= {f"{name}.{component}": at for component, at in joint.columns.items()}
    return columns


def _units(table: TableFile) -> dict[str, str]:
    """Return the stated units, by dimension or by the meaning of a column."""
    time = table.time.unit if table.time is not None else None
    stated = {"time": time, "force": table.unit, "moment": table.moment_unit}
    for name, joint in table.connections.items():
        for component in joint.columns:
            unit = joint.unit if component.startswith("f") else joint.moment_unit
            stated[f"{name}.{component}"] = unit
    return {meaning: unit for meaning, unit in stated.items() if unit}


def _unit_needed(table: TableFile) -> frozenset[str]:
    """Return the columns that must have a unit because a unit is stated for those next to them."""
    needed = {"moment"} if table.unit else set()
    for name, joint in table.connections.items():
        if joint.unit:
            needed |= {f"{name}.{c}" for c in joint.columns if c.startswith("m")}
    return frozenset(needed)


def _axes(table: TableFile, own: ForceAxes, joint: JointColumns | None) -> JointAxes:
    """Return the axes, the sign and the reference point of a connection's forces, by its own keys
    or those of the table.
    """
    axes = own.axes or table.axes
    sign = -1.0 if (own.acts_on or table.acts_on) == "link" else 1.0
    rows = NO_ROTATION if axes is None else matrix_of(axes)
    turn = tuple((sign * a, sign * b, sign * c) for a, b, c in rows)
    arm = joint.moments_at if joint is not None and joint.moments_at else (0.0, 0.0, 0.0)
    return JointAxes(turn, arm)
