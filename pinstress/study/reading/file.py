"""Reading of a study file: TOML, validated, in SI, with every cross-reference checked."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape
from itertools import islice
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from loads import MB, FileError, TableError, read_regular, table_cases
from pinstress.study.reading.counted_twice import counted_twice
from pinstress.study.reading.errors import InputError, Wrong, study_error
from pinstress.study.reading.file_names import same_files
from pinstress.study.reading.limits import control_characters, texts, too_many
from pinstress.study.reading.plausible import questions
from pinstress.study.reading.references import cross_references
from pinstress.study.reading.toml_text import read_toml
from pinstress.study.reading.validation import explain
from pinstress.study.schema.cases import GivenCase
from pinstress.study.schema.shown import MAX_LISTED_NAMES, as_text, cut, in_toml
from pinstress.study.schema.tables import StudyTable
from pinstress.study.schema.types import ANY_CASE, PROVENANCE_KINDS, usable_name
from pinstress.study.schema.units import UNIT_SYSTEMS, UnitSystem

MAX_STUDY_SIZE = 16 * MB
MAX_PATH_LENGTH = 4096  # as Linux has it
MAX_LIST_ITEMS = 200_000  # of a list
MAX_KEY_LENGTH = 200  # characters; no name is longer, and messages have it in full


@dataclass(frozen=True)
class Sourced:
    """The source of a number of the study.

    value: as the study writes it; of a whole table its numbers with their keys.
    """

    key: str
    kind: str
    note: str
    value: str = ""


@dataclass(frozen=True, repr=False)
class Study:
    """A valid study.

    table: its content in SI.
    questions: implausible values, each after its key.
    located: whether messages give lines of its text, which the user did not write if the study was
    built in Python.
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
        """Implausible values, each with its line: the first ones, and the number of others."""
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
        """Return an error of this study, with the line of the key that the message begins with,
        or of the key `at`.
        """
        return self.errors([Wrong(message, at=at, code=code)])

    def errors(self, wrong: Sequence[Wrong]) -> InputError:
        """Return several errors of this study as one."""
        return study_error(self.path, self._lines, wrong)

    def table_error(self, key: str, error: TableError) -> InputError:
        """Return the error of a table that is named at `key`; a missing table gets the line of
        this key.
        """
        if error.code == "no-such-file":
            return self.error(f"{key}: {error}", code=error.code)
        return InputError(str(error), code=error.code)

    @property
    def _lines(self) -> str:
        return self.text if self.located else ""

    def clamps(self, pin: str, case: str) -> tuple[str, ...]:
        """Return the clamped surfaces of a pin in a case, as named in the study."""
        return tuple(self.table.case[case].clamp.get(pin, self.table.pin[pin].clamp))

    def connections(self, pin: str) -> tuple[str, ...]:
        """Return the connections that bear on a pin."""
        return tuple(name for _, name in self.table.pin[pin].connections)


def load_study(path: str | os.PathLike[str]) -> Study:
    """Read and validate a study file.

    Raises: InputError naming the file, the keys and what would be right.
    """
    if not isinstance(path, str | os.PathLike):
        raise InputError(
            f"{as_text(path)} is not the path of a study file; give a string or a Path",
            code="not-a-path",
        )
    path = Path(path)
    try:
        text = read_regular(path, MAX_STUDY_SIZE).decode("utf-8-sig")
        text = text.replace("\r\n", "\n").replace("\r", "\n")
    except FileNotFoundError:
        raise InputError(f"{path}: no such file", code="no-such-file") from None
    except FileError as error:
        raise InputError(f"{path}: {error}", code=error.code) from None
    except UnicodeDecodeError as error:
        raise InputError(
            f"{path}: is not UTF-8 text ({error}); save it with this encoding", code="unreadable"
        ) from None
    except (OSError, ValueError) as error:  # ValueError: no file's name
        raise InputError(f"{path}: cannot be read ({error})", code="unreadable") from None
    return parse_study(path, text)


def parse_study(path: Path, text: str, located: bool = True) -> Study:
    """Validate the text of a study file at `path`.

    located: as in Study.

    Raises: InputError as load_study.
    """
    lines = text if located else ""
    provenance: list[Sourced] = []
    long: list[Wrong] = []
    raw = unwrapped(read_toml(path, text), "", provenance, long)
    if long:
        raise study_error(path, lines, long)
    wrong = [
        Wrong(
            f"{s.key}: provenance must be given, derived, fitted or assumed, not {as_text(s.kind)}",
            code="not-a-choice",
        )
        for s in provenance
        if s.kind not in PROVENANCE_KINDS
    ]
    table = _table(path, lines, raw, wrong)
    wrong += control_characters([*texts(raw), *((s.key, s.note) for s in provenance)])
    notes = {s.key: s.note for s in provenance}
    doubtful = questions(table, raw, _system(raw)) + counted_twice(table.analysis, notes)
    if beyond := list(too_many(table)):
        wrong += [Wrong(text, code="too-large") for text in beyond]
        wrong += [Wrong(text, code="doubtful") for text in doubtful]  # a wrong unit may be why
    if not wrong:
        same = same_files(table.pin, table.case)
        wrong += [Wrong(text, code="same-file-names") for text in same]
    if wrong:
        raise study_error(path, lines, wrong)
    return Study(path, text, table, tuple(provenance), doubtful, located)


def raw_study(study: Study) -> dict[str, Any]:
    """Return the content of the study's file, without provenance and notes."""
    raw: dict[str, Any] = unwrapped(read_toml(study.path, study.text), "", [], [])
    return raw


def with_raw(study: Study, raw: Mapping[str, Any]) -> Study:
    """Return the study with other numbers in what `raw_study` returned, validated directly.

    Implausible values are not looked for.

    Raises: InputError as load_study.
    """
    lines = study.text if study.located else ""
    wrong: list[Wrong] = []
    table = _table(study.path, lines, raw, wrong)
    wrong += [Wrong(text, code="too-large") for text in too_many(table)]
    if wrong:
        raise study_error(study.path, lines, wrong)
    return replace(study, table=table, questions=())


def _system(raw: Mapping[str, Any]) -> UnitSystem:
    units = raw.get("units")
    return UNIT_SYSTEMS.get(units if isinstance(units, str) else "", UNIT_SYSTEMS["m-N-s"])


def _table(path: Path, lines: str, raw: Mapping[str, Any], wrong: list[Wrong]) -> StudyTable:
    """Return the content in SI.

    wrong: earlier errors, to which those of references are added.

    Raises: InputError for content of the wrong form.
    """
    try:
        table = StudyTable.model_validate(raw, context={"system": _system(raw)})
    except ValidationError as error:
        raise study_error(path, lines, wrong + explain(error)) from None
    table = _with_cases_of_tables(table, path.parent, wrong)
    wrong += cross_references(table)
    return table


def _written(value: Any) -> str:
    """Return a value as the study writes it, shortened; for a table its values with their keys."""
    if isinstance(value, dict):
        numbers = ((k, v) for k, v in value.items() if not isinstance(v, dict))
        return ", ".join(f"{cut(k)} {_written(v)}" for k, v in islice(numbers, MAX_LISTED_NAMES))
    if isinstance(value, list):
        more = ", ..." * (len(value) > MAX_LISTED_NAMES)
        return f"[{', '.join(map(_written, value[:MAX_LISTED_NAMES]))}{more}]"
    if isinstance(value, float):
        return f"{value:.6g}"
    return cut(value) if isinstance(value, str) else in_toml(value)


def unwrapped(node: Any, key: str, sourced: list[Sourced], long: list[Wrong]) -> Any:
    """Return the tree without provenance and notes, which are added to `sourced`.

    The value remains of { value, provenance, note }.

    long: receives the errors for keys that are too long.
    """
    if isinstance(node, list):
        if len(node) > MAX_LIST_ITEMS:
            long.append(
                Wrong(
                    f"{key}: {len(node):,} elements; the limit is {MAX_LIST_ITEMS:,}",
                    code="too-many",
                )
            )
            return []
        return [unwrapped(v, f"{key}[{i}]", sourced, long) for i, v in enumerate(node, 1)]
    if not isinstance(node, dict):
        return node
    if isinstance(node.get("provenance"), str):
        kind, note = node["provenance"], str(node.get("note", ""))
        node = {k: v for k, v in node.items() if k not in ("provenance", "note")}
        sourced.append(Sourced(key, kind, note, _written(node.get("value", node))))
        if set(node) == {"value"}:
            return node["value"]
    long += [
        Wrong(f"{key}{': ' * bool(key)}the name {as_text(k)} has {len(k):,} characters; the limit "
              f"is {MAX_KEY_LENGTH}", code="too-long")
        for k in node if len(k) > MAX_KEY_LENGTH
    ]  # fmt: skip
    inner = {k: f"{key}.{k}" if key else k for k in node if len(k) <= MAX_KEY_LENGTH}
    return {k: unwrapped(node[k], place, sourced, long) for k, place in inner.items()}


def _with_cases_of_tables(table: StudyTable, folder: Path, wrong: list[Wrong]) -> StudyTable:
    """Return the study with the cases of tables: sections whose name has a *.

    Such a section gives a case for every name in the column `case` of its table, which replaces the
    *.

    folder: of the tables.
    wrong: receives the errors.

    Raises: InputError for an unusable table.
    """
    if not any(ANY_CASE in name for name in table.case):
        return table
    cases = {name: case for name, case in table.case.items() if ANY_CASE not in name}
    for section, case in table.case.items():
        if ANY_CASE not in section:
            continue
        key = f"case.{section}"
        assert isinstance(case, GivenCase)
        assert case.table is not None
        if section.count(ANY_CASE) > 1:
            wrong.append(Wrong(f"{key}: a name needs no second *", code="unusable-name"))
        elif case.table_case is not None:
            text = f"{key}.table_case: the name with a * already stands for every case of the table"
            wrong.append(Wrong(text, code="give-one"))
        else:
            for name in _table_case_names(folder / case.table, case):
                ours = section.replace(ANY_CASE, name)
                wrong += _table_case_mistakes(key, ours, case.table, ours in cases)
                cases[ours] = case.model_copy(update={"table_case": name})
    return table.model_copy(update={"case": cases})


def _table_case_names(path: Path, case: GivenCase) -> list[str]:
    try:
        return table_cases(path, case.columns)
    except TableError as error:
        raise InputError(str(error), code=error.code) from None


def _table_case_mistakes(key: str, name: str, table: str, known: bool) -> Iterator[Wrong]:
    if known:
        text = f"{key}: case {name!r} of {table} exists already; rename one, or this section"
        yield Wrong(text, code="duplicate-case")
    try:
        usable_name(name)
    except ValueError as error:
        yield Wrong(f"{key}: case {name!r} of {table}: {error}", code=getattr(error, "code", ""))
