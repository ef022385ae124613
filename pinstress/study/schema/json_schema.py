"""The JSON Schema of the study file for editors; it accepts everything that the reader accepts."""

from __future__ import annotations

from typing import Any

from pinstress.study.schema.tables import StudyTable
from pinstress.study.schema.types import PROVENANCE_PROPERTIES, sourced

DIALECT = "https://json-schema.org/draft/2020-12/schema"
WORDS = ("description", "default", "title")  # belong to a key, whatever the form of its value


def editor_schema() -> dict[str, Any]:
    """Return the JSON Schema, in which every value may also be { value, provenance, note }."""
    schema = StudyTable.model_json_schema()
    return {"$schema": DIALECT, **_in_table(schema)}


def _in_table(table: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of a study or of a table, in which `note` requires `provenance`."""
    inner = {name: _in_table(x) for name, x in table.get("$defs", {}).items()}
    properties = {
        key: x if key in PROVENANCE_PROPERTIES else _value(x)
        for key, x in table.get("properties", {}).items()
    }
    return _form(
        {
            **table,
            **({"$defs": inner} if inner else {}),
            "properties": properties,
            "dependentRequired": {"note": ["provenance"]},
        }
    )


def _value(schema: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of a value that may have provenance."""
    if "dimension" in schema:  # a quantity, whose schema includes provenance
        return schema
    form = _form(schema)
    if "$ref" in form:  # a table, which has the keys for provenance
        return form
    one = [_form(form["items"])] if form.pop("one_or_several", False) else []
    words = {key: form.pop(key) for key in WORDS if key in form}
    return {"anyOf": [*one, form, sourced([*one, form])], **words}


def _form(schema: dict[str, Any]) -> dict[str, Any]:
    """Return a schema whose inner values may have provenance, and whose alternatives may both
    apply: "guided" is a text, and so may be a quantity.
    """
    out = dict(schema)
    alternatives = [*out.pop("oneOf", []), *out.pop("anyOf", [])]
    if alternatives:
        out.pop("discriminator", None)
        out["anyOf"] = [x if "dimension" in x else _form(x) for x in alternatives]
    if "prefixItems" in out:
        out["prefixItems"] = [_value(x) for x in out["prefixItems"]]
    for key in ("items", "additionalProperties"):
        if isinstance(out.get(key), dict):
            out[key] = _value(out[key])
    if isinstance(out.get("additionalProperties"), dict) and "properties" not in out:
        out["properties"] = PROVENANCE_PROPERTIES  # provenance of the whole table of named values
    return out
