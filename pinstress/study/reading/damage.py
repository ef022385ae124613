"""The remainder of a study without its wrong parts, so that one reading reports all errors.

An error hides others: pydantic does not validate the rest of a table with an unknown key,
references are checked in valid tables only, and a linkage needs both. So each wrong part is removed
and the rest is read again, until it is valid. Errors that only follow from a removed part are not
reported.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from typing import Any

from pinbase.keys import key_part
from pinstress.study.reading.errors import Wrong
from pinstress.study.reading.toml_lines import Place, said

NO_CASE = "(none)"  # name of a case that replaces removed ones
# Replacements of removed parts without which nothing else could be read; * is any name
STAND_INS: Mapping[Place, Any] = {
    ("title",): "",
    ("units",): "m-N-s",
    ("case",): {NO_CASE: {"kind": "static"}},
    ("material", "*"): {"youngs_modulus": 1.0, "poisson_ratio": 0.0},
    ("mechanism", "drive"): {"body": "ground"},
    ("mechanism", "joint", "*", "at"): [0.0, 0.0],
    ("mechanism", "joint", "*", "connections"): {},
    ("require", "*", "check"): "yield",
    ("require", "*", "factor"): 1.0,
}
# Parts of a study whose removal may be the only cause of an error, by its code
CAUSES: Mapping[str, Collection[Place]] = {
    "no-mechanism": (("mechanism",),),
    "bearing-strength-without-lug": (("pin",),),
    "no-fatigue-data": (("material",), ("pin",)),
    "drive-without-motion": (("mechanism", "drive"),),
    "level-without-check": (("require",),),
    "duplicate-requirement": (("require",),),
}


class Damage:
    """The wrong parts of a study.

    raw: the content of the study, without provenance.
    places: the places of the removed parts, each with its replacement or None.
    names: all names in the removed parts; references to them are not errors.
    """

    def __init__(self, raw: Mapping[str, Any]) -> None:
        self.raw = raw
        self.places: dict[Place, Any] = {}
        self.names: set[str] = set()
        self._indices: dict[Place, list[int]] = {}  # of the remaining elements of lists

    def __bool__(self) -> bool:
        return bool(self.places)

    def remove(self, place: Place, value: Any = None) -> bool:
        """Remove a part, and return whether it was not removed before.

        value: its replacement.
        """
        if not place or place in self.places:
            return False
        self.places[place] = stand_in(place) if value is None else value
        self.names |= {str(place[-1]), *_names(self.part(place))}
        return True

    def part(self, place: Place) -> Any:
        """The part of the study at a place, or None."""
        node: Any = self.raw
        for key in place:
            try:
                node = node[key]
            except (KeyError, IndexError, TypeError):
                return None
        return node

    def touches(self, place: Place) -> bool:
        """Whether all or a part of the part at a place is removed."""
        return any(p[: len(place)] == place or place[: len(p)] == p for p in self.places)

    def children(self, place: Place) -> list[str | int]:
        """The removed keys of a table, or elements of a list."""
        return [p[-1] for p in self.places if p[:-1] == place]

    def reduced(self, place: Place, by_any: bool) -> list[str | int]:
        """The keys of a table, or elements of a list, that have lost all their content.

        by_any: also lists that have lost any element.
        """
        node = self.part(place)
        listed = dict(enumerate(node)) if isinstance(node, list) else {}
        return [
            k
            for k, v in (node if isinstance(node, dict) else listed).items()
            if (v and self._without(v, (*place, k)) in ({}, []))
            or (by_any and isinstance(v, list) and self.children((*place, k)))
        ]

    def remainder(self) -> Any:
        """The study without the removed parts."""
        self._indices = {}
        tree = self._without(self.raw, ())
        for place, value in self.places.items():
            if value is not None and self.part(place) is None:
                *parents, last = place
                table = tree
                for parent in parents:
                    table = table.get(parent) if isinstance(table, dict) else None
                if isinstance(table, dict):
                    table[last] = value
        return tree

    def _without(self, node: Any, place: Place) -> Any:
        """Return a part without the removed parts, or its replacement; None if nothing remains."""
        if place in self.places:
            return self.places[place]
        if isinstance(node, dict):
            inner = {k: self._without(v, (*place, k)) for k, v in node.items()}
            return {k: v for k, v in inner.items() if v is not None}
        if isinstance(node, list):
            elements = [self._without(v, (*place, i)) for i, v in enumerate(node)]
            self._indices[place] = [i for i, v in enumerate(elements) if v is not None]
            return [v for v in elements if v is not None]
        return node

    def original(self, place: Place) -> Place:
        """The place in the study that corresponds to a place in its remainder."""
        out: Place = ()
        for key in place:
            indices = self._indices.get(out, [])
            if isinstance(key, int) and key < len(indices):
                out += (indices[key],)
            elif isinstance(key, int) and indices:
                out += (key - len(indices) + len(self.part(out)),)
            else:
                out += (key,)
        return out

    def renumbered(self, wrong: Wrong, place: Place) -> Wrong:
        """Return an error of the remainder with the indices of the study.

        place: of the error, in the remainder.
        """
        here, there = said(place), said(self.original(place))
        if here == there or not wrong.message.startswith(here):
            return wrong
        return replace(wrong, message=there + wrong.message.removeprefix(here))

    def explains(self, wrong: Wrong, place: Place) -> bool:
        """Whether an error of the remainder may be only a consequence of what was removed.

        place: of the error, in the study.
        """
        if any(place[: len(p)] == p for p in self.places):
            return True
        if any(wrong.message.startswith(f"{said(p)} is missing") for p in self.places):
            return True  # the place of such an error is the table that lacks the part
        if wrong.name and wrong.name in self.names:
            return True
        return any(self.touches(cause) for cause in CAUSES.get(wrong.code, ()))


def stand_in(place: Place) -> Any:
    """Return the replacement of a removed part, or None."""
    for pattern, value in STAND_INS.items():
        if len(pattern) == len(place) and all(
            a in ("*", b) for a, b in zip(pattern, place, strict=True)
        ):
            # the name of a connection must be unique
            return {f"({place[2]})": "ground"} if pattern[-1] == "connections" else value
    return None


def _names(node: Any) -> Iterator[str]:
    """Yield all keys and texts of a part of a study."""
    if isinstance(node, str):
        yield node
    elif isinstance(node, dict):
        for key, value in node.items():
            yield str(key)
            yield from _names(value)
    elif isinstance(node, list):
        for value in node:
            yield from _names(value)


def place_of(tree: Any, message: str) -> Place:
    """Return the place of the key with which a message begins, as far as the tree contains it."""
    place: Place = ()
    node, rest = tree, message
    while True:
        key: str | int
        if isinstance(node, dict):
            rest = rest.removeprefix(".")
            ends = (*".[: ", "")
            said_names = {key_part(k): k for k in node}
            names = [s for s in said_names if rest.startswith(s) and rest[len(s) :][:1] in ends]
            if not names:
                return place
            spelled = max(names, key=len)
            key, rest = said_names[spelled], rest[len(spelled) :]
        elif isinstance(node, list) and (index := re.match(r"\[(\d+)\]", rest)):
            key, rest = int(index[1]) - 1, rest[index.end() :]
        elif isinstance(node, list) and len(node) == 1 and rest.startswith("."):
            key = 0
        else:
            return place
        if isinstance(key, int) and key >= len(node):
            return place
        place, node = (*place, key), node[key]
