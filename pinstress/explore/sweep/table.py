"""The table of a sweep in Arrow and Parquet, in the study's units.

The table has a row for each design, pin and case. The file contains no times, program versions or
machine names, so that the same study gives the same bytes.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pinstress.explore.sweep.evaluate import DesignRow
from pinstress.explore.sweep.number import unit_of
from pinstress.explore.sweep.parameters import Parameter
from pinstress.study.model.lugs import with_given_lugs
from pinstress.study.model.requirements import checks_besides_yield, common_required_factor
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study
from pinstress.study.schema.units import UnitSystem
from reports.folder.inside import write_inside
from reports.tables.column import Column, fields

if TYPE_CHECKING:
    import pyarrow as pa

METADATA_KEY = b"pinstress"  # key of the schema's metadata, a JSON text
# Columns of a design's row, in SI; texts are not numeric. Columns for the page have a heading.
RESULT_COLUMNS: list[Column[DesignRow]] = [
    *fields("max_von_mises", "stress", heading="maximum von Mises"),
    *fields("error_estimate", "stress", heading="± of maximum"),
    *fields("safety_factor", heading="safety factor"),
    *fields("outcome depends_on verdict", numeric=False),
    *fields("governing_time", "time", heading="governing time"),
    *fields("mass", "mass", heading="mass"),
    *fields("reason code governs", numeric=False),
    *fields("surface", "stress", heading="surface von Mises"),
    *fields("section", "stress", heading="section von Mises"),
    *fields("beneath", "stress", heading="beneath contact"),
    *fields("beneath_error", "stress", heading="± of beneath contact"),
]


def table_of(
    study: Study,
    parameters: Sequence[Parameter],
    designs: Sequence[tuple[int, Sequence[float], Sequence[DesignRow]]],
) -> pa.Table:
    """Return the table of some designs.

    designs: the number of each design, counted from 1, its values (p,) in SI, and its rows.
    """
    import pyarrow as pa

    schema = _schema(study, parameters)
    flat = [(number, values, row) for number, values, rows in designs for row in rows]
    columns: list[list[Any]] = [
        [number for number, _, _ in flat],
        [row.pin for _, _, row in flat],
        [row.case for _, _, row in flat],
    ]
    for k, parameter in enumerate(parameters):
        columns.append([parameter.number.shown(float(values[k])) for _, values, _ in flat])
    for column in RESULT_COLUMNS:
        cells = [column.cell(row) for _, _, row in flat]
        if column.numeric:
            _, factor = _unit(study.system, str(column.dimension or ""))
            cells = [None if cell is None else cell / factor for cell in cells]
        columns.append(cells)
    arrays = [pa.array(c, f.type) for c, f in zip(columns, schema, strict=True)]
    return pa.Table.from_arrays(arrays, schema=schema)


def assembled(parts: Sequence[pa.Table]) -> pa.Table:
    """Return the table of all parts in the order of the designs."""
    import pyarrow as pa

    whole = pa.concat_tables(parts)
    order = sorted(range(len(parts)), key=lambda i: parts[i]["design"][0].as_py())
    rising = pa.concat_tables([parts[i] for i in order])["design"]
    if rising.to_pylist() == sorted(rising.to_pylist()):
        return pa.concat_tables([parts[i] for i in order]).combine_chunks()
    import pyarrow.compute as pc

    return whole.take(pc.sort_indices(whole["design"])).combine_chunks()


def write_table(table: pa.Table, path: Path) -> None:
    """Write a table; its file is either complete or absent.

    Raises: OSError, also for a link.
    """
    import pyarrow as pa
    from pyarrow import parquet

    content = pa.BufferOutputStream()
    parquet.write_table(table, content, compression="zstd", row_group_size=100_000)
    write_inside(path.parent, path.name, memoryview(content.getvalue()))


def read_table(path: Path) -> pa.Table:
    """Return a table that was written before.

    Raises: InputError if it cannot be read.
    """
    from pyarrow import ArrowException, parquet

    try:
        return parquet.read_table(path)
    except (ArrowException, OSError) as error:
        raise InputError(
            f"--resume: {path} cannot be read ({str(error).splitlines()[0][:200]}); leave out "
            "--resume, to sweep again",
            code="damaged-table",
        ) from None


def facts(table: pa.Table) -> dict[str, Any]:
    """Return the metadata of a sweep's table (study, hash, units, parameters and more); empty for
    any other table.
    """
    stated = (table.schema.metadata or {}).get(METADATA_KEY)
    metadata: dict[str, Any] = json.loads(stated) if stated else {}
    return metadata


def _schema(study: Study, parameters: Sequence[Parameter]) -> pa.Schema:
    import pyarrow as pa

    schema_fields = [
        _field("design", pa.int64()),
        _field("pin", pa.string()),
        _field("case", pa.string()),
    ]
    schema_fields += [_field(p.key, pa.float64(), p.number.unit) for p in parameters]
    for column in RESULT_COLUMNS:
        unit, _ = _unit(study.system, str(column.dimension or ""))
        kind = pa.float64() if column.numeric else pa.string()
        schema_fields.append(_field(column.key, kind, unit))
    stated = {
        "study": study.name,
        "title": study.table.title,
        "hash": study.sha256,
        "units": study.system.name,
        "parameters": {p.key: {"unit": p.number.unit, "law": p.law_text} for p in parameters},
        "required_safety_factor": common_required_factor(study),
        "pins_in_lugs": with_given_lugs(study, study.table.pin),
        "other_checks": checks_besides_yield(study),
    }
    return pa.schema(
        schema_fields, metadata={METADATA_KEY: json.dumps(stated, ensure_ascii=False).encode()}
    )


def _unit(system: UnitSystem, dimension: str) -> tuple[str, float]:
    """Return name and SI value of the unit of a result."""
    if dimension == "mass":
        return system.scales
    return (unit_of(system, dimension), system.factor(dimension)) if dimension else ("", 1.0)


def _field(name: str, kind: pa.DataType, unit: str = "") -> pa.Field:
    import pyarrow as pa

    return pa.field(name, kind, metadata={"unit": unit})
