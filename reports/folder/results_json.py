"""results.json read back and checked: the parts that commands use."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field

from loads import MB
from pinbase.errors import Damaged
from reports.folder.damaged import JsonPart, strict_json, validated
from reports.folder.inside import read_inside
from reports.tables.json_results import RESULTS_SCHEMA

RESULTS_JSON = "results.json"
MAX_RESULTS_SIZE = 1024 * MB
MAX_MAGNITUDE = 1e60  # in any unit; products of larger numbers would overflow
SCHEMA_NAME, _, SCHEMA_VERSION = RESULTS_SCHEMA.partition("/")
PATH_SEPARATORS = "/\\\0"

Number = Annotated[float, Field(ge=-MAX_MAGNITUDE, le=MAX_MAGNITUDE, allow_inf_nan=False)]
Positive = Annotated[float, Field(ge=0.0, le=MAX_MAGNITUDE, allow_inf_nan=False)]


def _of_one_file(name: str) -> str:
    if not name or any(c in name for c in PATH_SEPARATORS):
        raise ValueError(f"{name!r} is no name of a pin or a case")
    return name


Name = Annotated[str, AfterValidator(_of_one_file)]
# Lists, because strict validation rejects a JSON list for a tuple.
Ends = Annotated[list[Number | None], Field(min_length=2, max_length=2)]
Place = Annotated[list[Number], Field(min_length=3, max_length=3)]


class _Units(JsonPart):
    length: str
    force: str
    stress: str
    time: str


class _AtPlace(JsonPart):
    max_von_mises: Positive
    error_estimate: Positive
    verdict: str


class _Band(JsonPart):
    name: str
    mean_pressure: Positive
    pressed: list[Annotated[list[Number], Field(min_length=4, max_length=4)]]


class _Contact(JsonPart):
    beneath: Positive
    beneath_error: Positive
    reach: Positive | None
    bands: list[_Band]


class _Row(JsonPart):
    pin: Name
    case: Name
    model: str
    max_von_mises: Positive | None
    max_von_mises_interval: Ends | None = None
    error_estimate: Positive | None
    verdict: str
    location: Place | None
    safety_factor: Positive | None
    yields: bool | None
    outcome: str
    governs: Literal["surface", "section", "core"] | None
    surface: _AtPlace | None = None
    section: _AtPlace | None = None
    contact: _Contact | None = None
    singular_at: list[dict[str, Any]]


class _Margin(JsonPart):
    pin: str
    case: str
    method: str
    margin: Number | None


class _Requirement(JsonPart):
    pin: str
    case: str
    level: str
    check: str
    required: Positive
    reached: Positive | None
    outcome: Literal["met", "missed", "depends", "not decided", "not checked"]
    stated: bool


class _Force(JsonPart):
    connection: str
    force: Number | None


class _Loads(JsonPart):
    case: str
    largest_forces: list[_Force]


class _Results(JsonPart):
    title: str
    units: _Units
    versions: dict[str, str]
    pins: list[_Row]
    loads: list[_Loads]
    margins: list[_Margin]
    requirements: list[_Requirement]
    inputs: dict[str, str]


def read_results(directory: Path) -> dict[str, Any]:
    """Return the content of results.json without characters that control a terminal.

    Raises: Damaged, FileNotFoundError, NotADirectoryError, OSError.
    """
    content = strict_json(read_inside(directory, RESULTS_JSON, MAX_RESULTS_SIZE), RESULTS_JSON)
    _require_schema(content)
    parts = validated(_Results, content, RESULTS_JSON)
    rows = Counter((row.pin, row.case) for row in parts.pins)
    if twice := next((row for row, count in rows.items() if count > 1), None):
        raise Damaged(
            f"{RESULTS_JSON} is damaged: pin {twice[0]} in {twice[1]} is there more than once"
        )
    printable: dict[str, Any] = _printable(content)
    return printable


def _require_schema(content: Any) -> None:
    schema = content.get("schema") if isinstance(content, dict) else None
    if schema == RESULTS_SCHEMA:
        return
    match = re.fullmatch(rf"{SCHEMA_NAME}/(\d{{1,9}})", str(schema))
    if match is None:
        raise Damaged(
            f"{RESULTS_JSON} was not written by pinstress (it has no schema {RESULTS_SCHEMA})"
        )
    newer = int(match[1]) > int(SCHEMA_VERSION)
    remedy = "use that version, or run the study again" if newer else "run the study again"
    raise Damaged(
        f"{RESULTS_JSON} was written by {'a newer' if newer else 'an older'} version of pinstress "
        f"(schema {schema}; this version reads {RESULTS_SCHEMA}): {remedy}"
    )


def _printable(node: Any) -> Any:
    """Return the values with control characters replaced; another program may have written them."""
    if isinstance(node, dict):
        return {_printable(key): _printable(value) for key, value in node.items()}
    if isinstance(node, list):
        return [_printable(value) for value in node]
    if isinstance(node, str):
        return "".join(c if c.isprintable() or c == "\n" else "\ufffd" for c in node)
    return node
