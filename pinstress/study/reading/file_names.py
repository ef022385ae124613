"""Names of the files written for pins and cases, and a check that they differ."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable

from pinbase.keys import key_part


def field_name(pin: str, case: str) -> str:
    """Return the name, without suffix, of the files written for a pin in a case."""
    return f"{pin}_{case}"


def same_files(pins: Iterable[str], cases: Iterable[str]) -> Iterable[str]:
    """Yield errors for names that give the same file name, including on systems that ignore
    case.
    """
    cases = list(cases)
    owners: dict[str, str] = {}
    for kind, names in (("pin", pins := list(pins)), ("case", cases)):
        seen: dict[str, str] = {}
        for name in names:
            other = seen.setdefault(_folded(name), name)
            if other != name:
                yield f"{kind}.{name}: its files would replace those of {kind}.{other}; rename one"
    for pin in pins:
        for case in cases:
            owner = f"pin.{key_part(pin)} in case.{key_part(case)}"
            other = owners.setdefault(_folded(field_name(pin, case)), owner)
            if other != owner:
                yield f"{owner}: its files would replace those of {other}; rename one"


def _folded(name: str) -> str:
    return unicodedata.normalize("NFKC", name).casefold()
