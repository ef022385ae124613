"""Every key of the study file as Markdown, from its JSON Schema: the end of the page reference.md.

A Sphinx extension, so that the page is made with every build and cannot be older than the schema.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sphinx.application import Sphinx

PAGE = "reference"
EVERYWHERE = ("provenance", "note")
PLAIN = {"string": "string", "number": "number", "integer": "integer", "boolean": "true or false"}
BOUNDS = {"minimum": "≥", "exclusiveMinimum": ">", "maximum": "≤", "exclusiveMaximum": "<"}

IN_SPACE = ", dimension = 3"  # what tells the tables of a linkage in space from those in a plane

Schema = dict[str, Any]


@dataclass(frozen=True)
class Section:
    """A table of the study file. path: as a study writes it; which: of several that may stand
    there.
    """

    path: str
    which: str
    table: Schema

    @property
    def anchor(self) -> str:
        """Label of its heading."""
        words = re.findall(r"\w+", f"key {self.path}{self.which}")
        return "-".join(words)


def sections(study: Schema) -> Iterator[Section]:
    """The study itself and all tables below it, each once and before those that it holds."""
    yield Section("", "", study)
    seen = set()
    for section in _below(study, study, ""):
        if section.anchor not in seen:
            seen.add(section.anchor)
            yield section


def _keys(table: Schema) -> Iterator[tuple[str, Schema]]:
    """The keys of a table and what they take; NAME for keys that the user chooses."""
    yield from table["properties"].items()
    if table.get("additionalProperties"):
        yield "NAME", table["additionalProperties"]


def _below(study: Schema, table: Schema, path: str, within: str = "") -> Iterator[Section]:
    """The tables below one; within: which of several that is, if they have the same keys."""
    for key, value in _keys(table):
        if key in EVERYWHERE:
            continue
        for where, names in _places(value, f"{path}.{key}" if path else key):
            held = [study["$defs"][name] for name in names]
            for one in held:
                which = within + _which(one, held)
                yield Section(where, which, one)
                yield from _below(study, one, where, IN_SPACE if IN_SPACE in which else "")


def _places(value: Schema, path: str) -> Iterator[tuple[str, list[str]]]:
    """Where tables stand below a key, and the names of those that may."""
    if "additionalProperties" in value:
        if isinstance(value["additionalProperties"], dict):
            yield from _places(value["additionalProperties"], f"{path}.NAME")
    elif "items" in value:
        yield from _places(value["items"], f"{path}[]")
    else:
        options = value.get("oneOf") or value.get("anyOf") or [value]
        if names := [o["$ref"].rsplit("/", 1)[1] for o in options if "$ref" in o]:
            yield path, names
        for option in options:
            if option is not value and "$ref" not in option:
                yield from _places(option, path)


def _which(table: Schema, among: list[Schema]) -> str:
    """What tells it from the others: its kind or dimension, or the key that only it requires."""
    if len(among) == 1:
        return ""
    for key in ("kind", "dimension"):
        if value := table["properties"].get(key, {}).get("const"):
            return f", {key} = {json.dumps(value)}"
    others = {key for t in among if t is not table for key in t["properties"]}
    only = next(key for key in table["required"] if key not in others)
    return f", with {only}"


def takes(value: Schema) -> str:
    """What a key takes, in words: dimension and domain, choices, or the form."""
    if "dimension" in value:
        return f"{value['dimension']} {value.get('domain', '')}".strip()
    if "const" in value or "enum" in value:
        return ", ".join(f"`{json.dumps(v)}`" for v in value.get("enum") or [value["const"]])
    if "$ref" in value:
        return "table"
    if "oneOf" in value or "anyOf" in value:
        options = value.get("oneOf") or value["anyOf"]
        told = [takes(o) for o in options if o.get("type") != "null"]
        return " or ".join(dict.fromkeys(told))
    if "prefixItems" in value:
        return f"[{', '.join(takes(v) for v in value['prefixItems'])}]"
    if value.get("type") == "array":
        least, most = value.get("minItems"), value.get("maxItems")
        count = f"{f'{least} to' if least else 'up to'} {most} " if most else ""
        return f"list of {count}{takes(value['items'])}"
    if value.get("type") == "object":
        return f"by name: {takes(value['additionalProperties'])}"
    bounds = [f"{sign} {value[key]:g}" for key, sign in BOUNDS.items() if key in value]
    return f"{PLAIN[value['type']]} {', '.join(bounds)}".strip()


def _default(key: str, table: Schema) -> str:
    if key in table.get("required", []):
        return "**required**"
    default = table["properties"].get(key, {}).get("default")
    if default in (None, [], {}) or isinstance(default, dict):
        return "–"
    return f"`{json.dumps(default)}`"


def reference(study: Schema) -> str:
    """All sections as Markdown. study: the JSON Schema that `pinstress schema` prints."""
    every = list(sections(study))
    # Of several the first; without brackets, as a place may take a list or one.
    anchors = {s.path.removesuffix("[]") + _dimension(s): s.anchor for s in reversed(every)}
    return "\n".join(_written(section, anchors) for section in every)


def _dimension(section: Section) -> str:
    return IN_SPACE if IN_SPACE in section.which else ""


def _written(section: Section, anchors: dict[str, str]) -> str:
    title = f"`{section.path}`{section.which}" if section.path else "The study"
    table = section.table
    lines = [
        f"({section.anchor})=",
        f"## {title}",
        "",
        " ".join(table.get("description", "").split()),
        "",
        "| key | type | default | description |",
        "| --- | --- | --- | --- |",
    ]
    for key, value in _keys(table):
        if key not in EVERYWHERE:
            told = takes(value)
            places = _places(value, f"{section.path}.{key}" if section.path else key)
            # A table or a list of them: both have one section.
            held = {path.removesuffix("[]") for path, _ in places}
            for anchor in {anchors.get(p + _dimension(section)) or anchors[p] for p in held}:
                told = told.replace("table", f"[table](#{anchor})")
            lines.append(f"| `{key}` | {told} | {_default(key, table)} | {value['description']} |")
    return "\n".join([*lines, ""])


def _append(_: Sphinx, page: str, source: list[str]) -> None:
    from pinstress.study.schema.tables import StudyTable

    if page == PAGE:
        source[0] += "\n" + reference(StudyTable.model_json_schema())


def _outdated(*_: object) -> list[str]:
    return [PAGE]


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    app.connect("source-read", _append)
    app.connect("env-get-outdated", _outdated)
    return {"parallel_read_safe": True}
