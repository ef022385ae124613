"""A validator of JSON Schema for the keywords that the schema of the study file uses."""

from __future__ import annotations

import datetime
from typing import Any

TYPES: dict[str, type | tuple[type, ...]] = {
    "object": dict,
    "array": list,
    "string": (str, datetime.date),
    "boolean": bool,
    "integer": int,
    "number": (int, float),
    "null": (),
}
PASSED = {
    *("$schema", "$defs", "description", "default", "title", "examples", "domain", "dimension"),
    "format",
}


def mistakes(value: Any, schema: dict[str, Any], whole: dict[str, Any], at: str = "") -> list[str]:
    """Return the places at which a value does not conform to its schema, with what each violates.

    whole: the schema with the definitions.
    """
    out: list[str] = []
    for keyword, told in schema.items():
        if keyword in PASSED:
            continue
        out += _of_keyword(keyword, told, value, schema, whole, at)
    return out


def _of_keyword(
    keyword: str, told: Any, value: Any, schema: dict[str, Any], whole: dict[str, Any], at: str
) -> list[str]:
    entries = value if isinstance(value, dict) else {}
    items = value if isinstance(value, list) else []
    number = isinstance(value, int | float)
    match keyword:
        case "$ref":
            return mistakes(value, whole["$defs"][told.rsplit("/", 1)[1]], whole, at)
        case "anyOf":
            options = [mistakes(value, option, whole, at) for option in told]
            return min(options, key=len)
        case "type":
            right = isinstance(value, TYPES[told]) and (told == "boolean") == isinstance(
                value, bool
            )
        case "const":
            right = value == told
        case "enum":
            right = value in told
        case "required":
            right = not isinstance(value, dict) or set(told) <= set(value)
        case "dependentRequired":
            right = all(set(also) <= set(entries) for key, also in told.items() if key in entries)
        case "properties":
            known = ((k, v) for k, v in entries.items() if k in told)
            return [x for k, v in known for x in mistakes(v, told[k], whole, f"{at}.{k}")]
        case "additionalProperties":
            others = {k: v for k, v in entries.items() if k not in schema.get("properties", {})}
            if isinstance(told, dict):
                return [x for k, v in others.items() for x in mistakes(v, told, whole, f"{at}.{k}")]
            right = told or not others
        case "prefixItems":
            pairs = list(zip(items, told, strict=False))
            return [
                x for k, (v, s) in enumerate(pairs) for x in mistakes(v, s, whole, f"{at}[{k}]")
            ]
        case "items":
            return [x for k, v in enumerate(items) for x in mistakes(v, told, whole, f"{at}[{k}]")]
        case "minItems" | "minProperties":
            right = not isinstance(value, list | dict) or len(value) >= told
        case "maxItems" | "maxProperties":
            right = not isinstance(value, list | dict) or len(value) <= told
        case "maxLength":
            right = not isinstance(value, str) or len(value) <= told
        case "minimum":
            right = not number or value >= told
        case "maximum":
            right = not number or value <= told
        case "exclusiveMinimum":
            right = not number or value > told
        case "exclusiveMaximum":
            right = not number or value < told
        case _:
            raise AssertionError(f"an editor may not know {keyword}")
    return [] if right else [f"{at}: {keyword} {str(told)[:80]}, not {str(value)[:80]}"]
