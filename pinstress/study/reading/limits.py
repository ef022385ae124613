"""Limits on the size of a study; larger studies would take hours, or more memory than machines
have.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sized
from typing import Any

from pinbase.keys import key_part
from pinstress.study.reading.errors import Wrong
from pinstress.study.schema.tables import StudyTable

# All control characters except tab and line ends
CONTROL_CHARACTER_PATTERN = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f]")

MAX_PINS = MAX_CASES = 1000
PIN_PARTS = {"profile": "segments", "meridian": "corners", "bore_meridian": "corners"} | {
    key: f"{key}s" for key in ("hole", "flat", "slot", "passage", "band")
}
MAX_PIN_PARTS = 1000  # limit for each pin: a profile with as many segments takes half a minute
MAX_CASE_LOADS = 1000  # limit for each case
MAX_SLENDERNESS = 1000.0  # length over diameter; beyond it the solution fails, after many minutes
MAX_DIAMETER_RATIO = 3000.0  # largest diameter over smallest
MAX_BODIES = 500  # of joints, sliders and drives, too; each body adds unknowns to dense equations


def texts(node: Any, key: str = "") -> Iterator[tuple[str, str]]:
    """Yield the texts of a study, each with its key."""
    if isinstance(node, str):
        yield key, node
    elif isinstance(node, list):
        for i, item in enumerate(node, 1):
            yield from texts(item, f"{key}[{i}]")
    elif isinstance(node, dict):
        for name, item in node.items():
            yield from texts(item, f"{key}.{key_part(name)}" if key else key_part(name))


def control_characters(named_texts: Iterable[tuple[str, str]]) -> Iterator[Wrong]:
    """Yield errors for texts with characters that control terminals or that PDF and XML cannot
    show.
    """
    for key, text in named_texts:
        if bad := CONTROL_CHARACTER_PATTERN.search(text):
            what = f"has the control character U+{ord(bad[0]):04X}"
            yield Wrong(f"{key}: {what}; remove it", code="control-character")


def too_many(table: StudyTable) -> Iterator[str]:
    """Yield errors for everything that exceeds a limit."""
    for key, what, items, most in _counted(table):
        if len(items) > most:
            yield f"{key}: {len(items):,} {what}; the limit is {most:,}"
    for name, pin in table.pin.items():
        diameters = [d for d in pin.diameters if d]
        if not diameters:
            continue
        key = f"pin.{key_part(name)}.{'meridian' if pin.profile is None else 'profile'}"
        length = pin.meridian[-1][0] if pin.meridian else sum(s.length for s in pin.profile or ())
        slender = length / max(diameters)
        if slender > MAX_SLENDERNESS:
            yield f"{key}: {_odd('as long as it is wide', slender, MAX_SLENDERNESS)}"
        stepped = max(diameters) / min(diameters)
        if stepped > MAX_DIAMETER_RATIO:
            yield f"{key}: {_odd('as wide as elsewhere', stepped, MAX_DIAMETER_RATIO)}"


def _odd(what: str, ratio: float, most: float) -> str:
    return f"the pin is {ratio:,.0f} times {what}; the limit is {most:,.0f}; check the units"


def _counted(table: StudyTable) -> Iterator[tuple[str, str, Sized, int]]:
    yield "pin", "pins", table.pin, MAX_PINS
    yield "case", "cases", table.case, MAX_CASES
    for name, pin in table.pin.items():
        for key, what in PIN_PARTS.items():
            yield f"pin.{key_part(name)}.{key}", what, getattr(pin, key) or (), MAX_PIN_PARTS
    for name, case in table.case.items():
        yield f"case.{key_part(name)}.apply", "loads", getattr(case, "apply", ()), MAX_CASE_LOADS
    if (mechanism := table.mechanism) is not None:
        yield "mechanism.joint", "joints", mechanism.joint, MAX_BODIES
        yield "mechanism.body", "bodies", mechanism.body, MAX_BODIES
        yield "mechanism.slider", "sliders", getattr(mechanism, "slider", ()), MAX_BODIES
        yield "mechanism.drive", "drives", mechanism.drive, MAX_BODIES
