"""Validation errors of pydantic in the words of this program; pydantic's own messages never reach a
user.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from typing import Any

from pydantic import ValidationError

from pinbase.keys import key_part
from pinstress.study.reading.damage import Damage, stand_in
from pinstress.study.reading.errors import Wrong
from pinstress.study.reading.toml_lines import Place
from pinstress.study.schema.shown import in_toml, nearest, printable
from pinstress.study.schema.types import UNKNOWN_KEY_ERROR, hint_for_key

# Code and remedy by pydantic's type of error. Other types of error need a type of field that no
# table has; a test tries every kind of mistake at every key.
MISTAKE_MESSAGES = {
    "missing": ("missing-key", "is missing"),
    "string_type": ("not-a-text", "must be a text in quotes"),
    "string_too_long": ("too-long", "must have at most {max_length} characters"),
    "bool_type": ("not-true-or-false", "must be true or false, without quotes"),
    "int_type": ("not-a-whole-number", "must be a whole number"),
    "int_from_float": ("not-a-whole-number", "must be a whole number"),
    "int_parsing_size": ("not-a-whole-number", "must be a smaller whole number"),
    "float_type": ("not-a-number", "must be a number without a unit or quotes"),
    "finite_number": ("not-finite", "must be a finite number"),
    "greater_than": ("out-of-range", "must be greater than {gt:g}"),
    "greater_than_equal": ("out-of-range", "must be at least {ge:g}"),
    "less_than": ("out-of-range", "must be less than {lt:g}"),
    "less_than_equal": ("out-of-range", "must be at most {le:,}"),
    "literal_error": ("not-a-choice", "must be {expected}"),
    "list_type": ("not-a-list", "must be a list in brackets: [a, b, ...]"),
    "tuple_type": ("not-a-list", "must be a list in brackets: [a, b]"),
    "too_short": ("list-too-short", "must have at least {min_length}"),
    "too_long": ("list-too-long", "must have at most {max_length}"),
    "dict_type": ("not-a-table", "must be a table: {{ key = value, ... }}"),
    "model_type": ("not-a-table", "must be a table: {{ key = value, ... }}"),
    "model_attributes_type": ("not-a-table", "must be a table: {{ key = value, ... }}"),
    "union_tag_not_found": ("missing-key", 'is missing; write for instance kind = "given"'),
    "union_tag_invalid": ("not-a-choice", "must be one of {expected_tags}"),
}
DIMENSION: Place = ("mechanism", "dimension")
OTHER_MISTAKE = ("not-valid", "cannot have this value")


def explain(error: ValidationError) -> list[Wrong]:
    """Return all errors, each with its key."""
    return [_explained(dict(item)) for item in error.errors(include_url=False)]


def remove_wrong(error: ValidationError, tree: Any, damage: Damage) -> list[Wrong]:
    """Remove the wrong parts from the remainder of a study, and return the errors that do not
    follow from earlier removals.

    tree: the remainder of the study.
    """
    wrong, removals = [], []
    for item in error.errors(include_url=False):
        place = _place(item["loc"], tree)
        there = damage.original(place)
        if not _follows(dict(item), there, damage):
            wrong.append(damage.renumbered(_explained(dict(item)), place))
        if item["type"] == UNKNOWN_KEY_ERROR:
            there = (*there, item["ctx"]["key"])
        elif item["type"] == "missing" and stand_in(there) is None:
            there = there[:-1]  # the table or list is useless without the missing part
        removals.append(there)
    for there in removals:
        damage.remove(there)
    return wrong


def _place(loc: tuple[int | str, ...], tree: Any) -> Place:
    """Return the place of an error, without the tags that pydantic adds for unions."""
    place: Place = ()
    node = tree
    for i, part in enumerate(loc):
        if str(part).startswith(("<", "[key]")) or (i == 2 and loc[0] == "case"):
            continue
        if isinstance(part, int) and not isinstance(node, list):
            continue  # index of a single table that is written without a list
        place += (part,)
        try:
            node = node[part]
        except (KeyError, IndexError, TypeError):
            node = None
    return place


def _follows(item: dict[str, Any], place: Place, damage: Damage) -> bool:
    """Return whether an error may follow from parts that were removed from the same table or list.

    place: of the error, in the study.
    """
    if damage.touches(DIMENSION) and place[:1] == DIMENSION[:1]:
        return True  # the linkage may have been read for the wrong dimension
    table = place[:-1] if item["type"] == "missing" else place
    removed = [*damage.children(table), *damage.reduced(table, item["type"] == "value_error")]
    if place in damage.places or any(isinstance(child, int) for child in removed):
        return True
    if not removed:
        return False
    if item["type"] == "missing":
        return any(nearest(child, [str(place[-1])], cutoff=0.5) for child in removed)
    if item["type"] == "value_error":
        message = str(item["ctx"]["error"])
        words = re.findall(r"\w+", message)
        return any(child in words or nearest(child, words) for child in removed)
    return item["type"] in ("too_short", "too_long")


def _explained(item: dict[str, Any]) -> Wrong:
    kind, context, value = item["type"], item.get("ctx", {}), item.get("input")
    key = _key(item["loc"], kind)
    hint: Callable[[], str] = str
    if kind == UNKNOWN_KEY_ERROR:
        code, message = "unknown-key", item["msg"]
        hint = partial(hint_for_key, context["key"], context["known"])
    elif kind == "value_error":
        mistake = context["error"]
        code, message = getattr(mistake, "code", ""), str(mistake)
    else:
        code, right = MISTAKE_MESSAGES.get(kind, OTHER_MISTAKE)
        message = right.format(**context) + _found(kind, context, value)
    return Wrong(f"{key}: {message}" if key else message, hint, code=code)


def _key(loc: tuple[int | str, ...], kind: str) -> str:
    """Return the key as messages spell it, without the tags that pydantic adds for unions."""
    key = ""
    for i, part in enumerate(loc):
        if str(part).startswith(("<", "[key]")) or (i == 2 and loc[0] == "case"):
            continue
        key += (
            f"[{part + 1}]"
            if isinstance(part, int)
            else f"{'.' if key else ''}{printable(key_part(part))}"
        )
    return f"{key}.kind" if kind.startswith("union_tag") else key


def _found(kind: str, context: dict[str, Any], value: object) -> str:
    """Return the actual value, as the end of a message."""
    if kind in ("too_short", "too_long"):
        most = context.get("min_length", context.get("max_length"))
        what = "entry" if context["field_type"] == "Dictionary" else "element"
        many = "entries" if what == "entry" else "elements"
        return f" {what if most == 1 else many}, not {context['actual_length']}"
    if kind == "union_tag_invalid":
        return f", not {in_toml(value['kind'])}" if isinstance(value, dict) else ""
    return "" if kind in ("missing", "union_tag_not_found") else f", not {in_toml(value)}"
