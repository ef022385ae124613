"""Reading of a study file into validated tables in SI units, with every cross-reference checked."""

from __future__ import annotations

import copy
import hashlib
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape
from itertools import islice
from pathlib import Path
from typing import Any

from loads import MB, TableError
from pinbase.keys import key_part
from pinstress.study.reading.content import system_of, table_of
from pinstress.study.reading.counted_twice import counted_twice
from pinstress.study.reading.damage import Damage
from pinstress.study.reading.errors import InputError, Wrong, study_error
from pinstress.study.reading.file_names import same_files
from pinstress.study.reading.limits import control_characters, texts
from pinstress.study.reading.materials import StoredMaterial, looked_up, with_materials
from pinstress.study.reading.plausible import questions
from pinstress.study.reading.toml_text import read_text, read_toml
from pinstress.study.reading.unused import unused
from pinstress.study.schema.materials import MaterialTable
from pinstress.study.schema.shown import MAX_LISTED_NAMES, as_text, cut, in_toml
from pinstress.study.schema.tables import StudyTable
from pinstress.study.schema.types import PROVENANCE_KINDS
from pinstress.study.schema.units import UNIT_SYSTEMS, UnitSystem

MAX_STUDY_SIZE = 16 * MB
MAX_PATH_LENGTH = 4096  # the limit of Linux
# Errors that concern a file as a whole (loads.read_regular), not one of its lines
UNREADABLE_FILE_CODES = "no-such-file", "folder", "not-regular", "too-large"
MAX_LIST_ITEMS = 200_000  # limit for each list
MAY_BE_EMPTY = "title", "report."  # beginnings of the keys whose texts may be empty
CHECKED_NAMES = "pin", "case", "sequence"  # tables whose names the schema checks
MAX_KEY_LENGTH = 200  # characters; limits names, which messages show in full


@dataclass(frozen=True)
class Sourced:
    """The source of a number of the study.

    value: as the study writes it; for a whole table, its numbers with their keys.
    """

    key: str
    kind: str
    note: str
    value: str = ""


@dataclass(frozen=True)
class Remainder:
    """The valid parts of a study with errors, and what was removed from it."""

    study: Study
    damage: Damage


@dataclass(frozen=True, repr=False)
class Study:
    """A valid study.

    table: its content in SI units.
    questions: implausible values and keys without effect, each text beginning with its key.
    located: whether messages give lines of the text. They do not for a study built in Python, whose
    text the user did not write.
    """

    path: Path
    text: str
    table: StudyTable
    provenance: tuple[Sourced, ...]
    questions: tuple[str, ...] = ()
    located: bool = True

    def __repr__(self) -> str:
        parts = f"pins: {len(self.table.pin)}, cases: {len(self.table.case)}, {self.table.units}"
        return f"<Study {self.table.title!r} ({self.path}): {parts}>"

    def _repr_html_(self) -> str:
        """Return the pins with their connections, clamps and material as an HTML table."""
        lines = [("pin", "connections", "clamps", "material")]
        for name, pin in self.table.pin.items():
            lines.append(
                (name, ", ".join(self.connections(name)), ", ".join(pin.clamp), pin.material)
            )
        body = "".join(
            f"<tr>{''.join(f'<td>{escape(x)}</td>' for x in line)}</tr>" for line in lines
        )
        cases = f"cases: {', '.join(self.table.case)}; units: {self.table.units}"
        title = f"<p><b>{escape(self.table.title)}</b> ({escape(str(self.path))})</p>"
        return f"{title}<p>{escape(cases)}</p><table>{body}</table>"

    @property
    def warnings(self) -> tuple[str, ...]:
        """The questions, each with its line: the first ones, and the number of the others."""
        if not self.questions:
            return ()
        errors = self.errors([Wrong(question) for question in self.questions])
        return errors.lines + ((f"{self.path}: and {errors.more:,} more",) if errors.more else ())

    @property
    def system(self) -> UnitSystem:
        """The study's unit system."""
        return UNIT_SYSTEMS[self.table.units]

    @property
    def name(self) -> str:
        """The file's name without its suffix."""
        return self.path.stem

    @property
    def sha256(self) -> str:
        """Hash of the study file."""
        return hashlib.sha256(self.text.encode()).hexdigest()

    def path_to(self, name: str) -> Path:
        """Return the path of a file that the study refers to.

        Raises: InputError for an impossible name.
        """
        if "\0" in name or len(name) > MAX_PATH_LENGTH:
            raise self.error(f"{as_text(name)} is not a file name", code="not-a-file-name")
        return self.path.parent / name

    def error(self, message: str, at: str = "", code: str = "") -> InputError:
        """Return an error of this study, with the line of the key that the message begins with, or
        of the key `at`.
        """
        return self.errors([Wrong(message, at=at, code=code)])

    def errors(self, wrong: Sequence[Wrong]) -> InputError:
        """Return several errors of this study as one."""
        return study_error(self.path, self._lines, wrong)

    def table_error(self, key: str, error: TableError) -> InputError:
        """Return the error of a table that is named at `key`; with the line of this key if the
        table cannot be read at all.
        """
        if error.code in UNREADABLE_FILE_CODES:
            return self.error(f"{key}: {error}", code=error.code)
        return InputError(str(error), code=error.code)

    @property
    def _lines(self) -> str:
        return self.text if self.located else ""

    def clamps(self, pin: str, case: str) -> tuple[str, ...]:
        """Return the clamped surfaces of a pin in a case, as named in the study."""
        return tuple(self.table.case[case].clamp.get(pin, self.table.pin[pin].clamp))

    def material_of(self, pin: str) -> MaterialTable:
        """Return the table of the material of a pin."""
        return self.table.material[self.table.pin[pin].material]

    def connections(self, pin: str) -> tuple[str, ...]:
        """Return the connections that bear on a pin."""
        return tuple(name for _, name in self.table.pin[pin].connections)


def load_study(path: str | os.PathLike[str]) -> Study:
    """Read and validate a study file.

    Raises: InputError, which names the file, the keys and what would be right.
    """
    if not isinstance(path, str | os.PathLike):
        raise InputError(
            f"{as_text(path)} is not the path of a study file; give a string or a Path",
            code="not-a-path",
        )
    path = Path(path)
    if any("\ud800" <= letter <= "\udfff" for letter in path.name):  # bytes that are not UTF-8
        raise InputError(
            f"{path}: the name of this file is not UTF-8 text, and results name it; rename it",
            code="unusable-name",
        )
    return parse_study(path, read_text(path, MAX_STUDY_SIZE))


def parse_study(path: Path, text: str, located: bool = True) -> Study:
    """Validate the text of a study file at `path`.

    located: as in Study.

    Raises: InputError as load_study.
    """
    lines = text if located else ""
    provenance: list[Sourced] = []
    unreadable: list[Wrong] = []
    raw = unwrapped(with_materials(path, read_toml(path, text)), "", provenance, unreadable)
    if unreadable:
        raise study_error(path, lines, unreadable)
    wrong = [
        Wrong(
            f"{s.key}: provenance must be given, derived, fitted or assumed, not {as_text(s.kind)}",
            code="not-a-choice",
        )
        for s in provenance
        if s.kind not in PROVENANCE_KINDS
    ]
    damage = Damage(raw)
    table = table_of(path, raw, damage, wrong)
    wrong += control_characters([*texts(raw), *((s.key, s.note) for s in provenance)])
    notes = {s.key: s.note for s in provenance}
    beyond = any(w.code == "too-large" for w in wrong)
    doubtful: tuple[str, ...] = ()
    if table is not None and not damage:
        doubtful = questions(table, raw, system_of(raw)) + counted_twice(table.analysis, notes)
    if beyond:
        # A wrong unit may be the cause.
        wrong += [Wrong(text, code="doubtful") for text in doubtful]
    if table is not None and not wrong:
        same = same_files(table.pin, table.case)
        wrong += [Wrong(text, code="same-file-names") for text in same]
    if table is None or wrong:
        error = study_error(path, lines, wrong)
        if table is not None and not beyond:
            remainder = Study(path, text, table, (), located=located)
            error.remainder = Remainder(remainder, damage)
        raise error
    doubtful += tuple(unused(table))
    return Study(path, text, table, tuple(provenance), doubtful, located)


def raw_study(study: Study) -> dict[str, Any]:
    """Return the content of the study's file without provenance and notes, including the materials
    that the study only names.
    """
    raw = with_materials(study.path, read_toml(study.path, study.text))
    plain: dict[str, Any] = unwrapped(raw, "", [], [])
    return plain


def named_materials(study: Study) -> tuple[StoredMaterial, ...]:
    """Return the materials that a study names without defining them."""
    return tuple(looked_up(study.path, read_toml(study.path, study.text)).values())


def with_value(raw: Mapping[str, Any], path: Sequence[str | int], value: Any) -> dict[str, Any]:
    """Return a copy of a study's raw content with another value at a path; unchanged parts are
    shared.

    Missing tables of lugs are added. A single number for both ends becomes two.
    """
    content: dict[str, Any] = dict(raw)
    here: Any = content
    for part in path[:-1]:
        missing = isinstance(here, dict) and part not in here
        inner = {} if missing else here[part]
        here[part] = copy.copy(inner) if isinstance(inner, dict | list) else [inner, inner]
        here = here[part]
    if replaces_fit(path):
        here.pop("fit", None)
    here[path[-1]] = value
    return content


def replaces_fit(path: Sequence[str | int]) -> bool:
    """Return whether a value is the clearance of a lug, which replaces the fit."""
    return path[0] == "pin" and "lug" in path and path[-1] == "clearance"


def with_raw(study: Study, raw: Mapping[str, Any]) -> Study:
    """Return the study with changed content, as `raw_study` returns it, validated without writing
    text.

    Implausible values are not searched.

    Raises: InputError as load_study.
    """
    lines = study.text if study.located else ""
    wrong: list[Wrong] = []
    table = table_of(study.path, raw, Damage(raw), wrong)
    if table is None or wrong:
        raise study_error(study.path, lines, wrong)
    return replace(study, table=table, questions=())


def _written(value: Any) -> str:
    """Return a value as the study writes it, shortened; for a table, its values with their keys."""
    if isinstance(value, dict):
        numbers = ((k, v) for k, v in value.items() if not isinstance(v, dict))
        return ", ".join(f"{cut(k)} {_written(v)}" for k, v in islice(numbers, MAX_LISTED_NAMES))
    if isinstance(value, list):
        more = ", ..." * (len(value) > MAX_LISTED_NAMES)
        return f"[{', '.join(map(_written, value[:MAX_LISTED_NAMES]))}{more}]"
    if isinstance(value, float):
        return f"{value:.6g}"
    return cut(value) if isinstance(value, str) else in_toml(value)


def unwrapped(node: Any, key: str, sourced: list[Sourced], wrong: list[Wrong]) -> Any:
    """Return the tree without provenance and notes, which are added to `sourced`.

    A table { value, provenance, note } is replaced by its value.

    wrong: receives the errors for keys and lists that are too long, for notes that are not texts,
    and for blank texts and names.
    """
    if isinstance(node, list):
        if len(node) > MAX_LIST_ITEMS:
            wrong.append(
                Wrong(
                    f"{key}: {len(node):,} elements; the limit is {MAX_LIST_ITEMS:,}",
                    code="too-many",
                )
            )
            return []
        return [unwrapped(v, f"{key}[{i}]", sourced, wrong) for i, v in enumerate(node, 1)]
    if isinstance(node, str) and not node.strip() and not key.startswith(MAY_BE_EMPTY):
        text = f"{key}: is empty; write something between the quotes, or leave the key out"
        wrong.append(Wrong(text, code="empty"))
    if not isinstance(node, dict):
        return node
    if key not in CHECKED_NAMES and any(not name.strip() for name in node):
        wrong.append(Wrong(f"{key}: a name is empty; write something in quotes", code="empty"))
    if isinstance(node.get("provenance"), str):
        kind, note = node["provenance"], node.get("note", "")
        if not isinstance(note, str):
            where = f"{key}.note".removeprefix(".")
            text = f"{where}: must be a text in quotes, not {in_toml(note)}"
            wrong.append(Wrong(text, code="not-a-text"))
            note = ""
        node = {k: v for k, v in node.items() if k not in ("provenance", "note")}
        sourced.append(Sourced(key, kind, note, _written(node.get("value", node))))
        if set(node) == {"value"}:
            return unwrapped(node["value"], key, sourced, wrong)
    wrong += [
        Wrong(f"{key}{': ' * bool(key)}the name {as_text(k)} has {len(k):,} characters; the limit "
              f"is {MAX_KEY_LENGTH}", code="too-long")
        for k in node if len(k) > MAX_KEY_LENGTH
    ]  # fmt: skip
    inner = {
        k: f"{key}.{key_part(k)}" if key else key_part(k) for k in node if len(k) <= MAX_KEY_LENGTH
    }
    return {k: unwrapped(node[k], place, sourced, wrong) for k, place in inner.items()}
