"""Materials that a study names without defining them, from a file of the user or from the library
that ships with the program.

A file of materials has tables [material.NAME] like those of a study, whose quantities have units.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from loads import MB
from pinbase.keys import key_part
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.toml_text import read_text, read_toml
from pinstress.study.reading.validation import explain
from pinstress.study.schema.materials import MaterialTable
from pinstress.study.schema.shown import as_text
from pinstress.study.schema.units import UNIT_SYSTEMS

LIBRARY_PATH = Path(__file__).parents[1] / "materials.toml"
LIBRARY_NAME = "the library of pinstress"
MAX_MATERIALS_SIZE = 16 * MB
SOURCE_KEYS = "provenance", "note"


@dataclass(frozen=True)
class StoredMaterial:
    """A material from a file: its table as written, with sources, and the name of the file."""

    name: str
    table: dict[str, Any]
    file: str

    @property
    def source(self) -> str:
        """Return the document from which the values are."""
        return str(self.table.get("note", "")) or self.file

    @property
    def values(self) -> dict[str, Any]:
        """Return the values by key, as written, without their sources."""
        return {k: _value(v) for k, v in self.table.items() if k not in SOURCE_KEYS}

    @property
    def missing(self) -> tuple[str, ...]:
        """Return the keys that every material needs but this one lacks."""
        needed = (k for k, field in MaterialTable.model_fields.items() if field.is_required())
        return tuple(key for key in needed if key not in self.table)

    def require_valid(self) -> None:
        """Raise InputError for a material that no study can use as it is."""
        if self.missing:
            keys = " and ".join(self.missing)
            raise InputError(
                f"material {as_text(self.name)} of {self.file} has no {keys}, which its source "
                f'({self.source}) does not state; define [material."{self.name}"] in the study',
                code="missing-key",
            )
        tables = []
        for system in ("mm-N-s", "in-lbf-s"):
            try:
                context = {"system": UNIT_SYSTEMS[system]}
                tables.append(MaterialTable.model_validate(self.values, context=context))
            except ValidationError as error:
                first = explain(error)[0]
                dot = "." if error.errors()[0]["loc"] else ": "
                text = (
                    f"{self.file}: material.{key_part(self.name)}{dot}{first.message}{first.hint()}"
                )
                raise InputError(text, code=first.code) from None
        one, other = tables
        bare = [key for key in self.values if getattr(one, key) != getattr(other, key)]
        if bare:
            raise InputError(
                f"{self.file}: material.{key_part(self.name)}.{bare[0]}: a quantity has "
                "no unit; write for "
                'instance "210 GPa", as a file of materials has no unit system',
                code="no-unit",
            )


def read_materials(path: Path) -> dict[str, StoredMaterial]:
    """Return the materials of a file by name.

    Raises: InputError.
    """
    return _materials(path, read_text(path, MAX_MATERIALS_SIZE), path.name)


def _materials(path: Path, text: str, file: str) -> dict[str, StoredMaterial]:
    document = read_toml(path, text)
    tables = document.pop("material", None)
    if document or not isinstance(tables, dict):
        odd = f", not {as_text(next(iter(document)))}" if document else ""
        raise InputError(
            f"{path}: a file of materials has tables [material.NAME]{odd}", code="not-materials"
        )
    for name, table in tables.items():
        if not isinstance(table, dict):
            raise InputError(
                f"{path}: material.{key_part(name)}: must be a table", code="not-a-table"
            )
    return {name: StoredMaterial(name, table, file) for name, table in tables.items()}


@cache
def library() -> dict[str, StoredMaterial]:
    """Return the materials that ship with the program, by name."""
    return _materials(LIBRARY_PATH, LIBRARY_PATH.read_text(encoding="utf-8"), LIBRARY_NAME)


def looked_up(path: Path, raw: dict[str, Any]) -> dict[str, StoredMaterial]:
    """Return the known materials that a study names without defining them.

    path: of the study. raw: its content with sources, not validated.

    Raises: InputError for a file of materials that cannot be read.
    """
    file, own = raw.get("materials"), raw.get("material", {})
    names = dict.fromkeys(_named(raw)) if isinstance(own, dict) else {}
    wanted = [name for name in names if name not in own]
    if not wanted:
        return {}
    given = read_materials(path.parent / file) if isinstance(file, str) else {}
    known = {**library(), **given}
    return {name: known[name] for name in wanted if name in known}


def with_materials(path: Path, raw: dict[str, Any]) -> dict[str, Any]:
    """Return a study's content with the materials that it names without defining them.

    path, raw: as in `looked_up`.

    Raises: InputError for a file or a material that cannot be used.
    """
    added = looked_up(path, raw)
    for stored in added.values():
        try:
            stored.require_valid()
        except InputError as error:
            raise InputError(f"{path}: {error}", code=error.code) from None
    if not added:
        return raw
    return {
        **raw,
        "material": {**raw.get("material", {}), **{k: x.table for k, x in added.items()}},
    }


def _named(raw: dict[str, Any]) -> Iterator[str]:
    """Yield the names of materials in a study that is not validated."""
    tables = [raw.get("lug_defaults")]
    for pin in _tables(raw.get("pin")):
        tables += [pin, *_tables(pin.get("lug"))]
    tables += [table.get("bushing") for table in tables if isinstance(table, dict)]
    for table in tables:
        name = _value(table.get("material")) if isinstance(table, dict) else None
        if isinstance(name, str):
            yield name


def _tables(node: Any) -> list[dict[str, Any]]:
    inner = node.values() if isinstance(node, dict) else ()
    return [table for table in inner if isinstance(table, dict)]


def _value(node: Any) -> Any:
    return node["value"] if isinstance(node, dict) and "value" in node else node
