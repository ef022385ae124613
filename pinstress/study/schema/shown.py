"""Names and values of an input as messages show them: always shortened."""

from __future__ import annotations

import datetime
import difflib
import reprlib
from collections.abc import Iterable
from itertools import islice

MAX_TEXT_LENGTH = 80  # characters of a name or value in a message
MAX_COMPARED_NAMES = 1000  # names compared for a hint, which must be quick
MAX_HINT_CANDIDATES = 5  # similar names that are examined for a hint
MIN_PART_LETTERS = 3  # least length of a name that matches as a part of another
MAX_LISTED_NAMES = 20  # names that a message lists
ELLIPSIS = "…"

_SHORT_REPR = reprlib.Repr()
_SHORT_REPR.maxlong = _SHORT_REPR.maxstring = _SHORT_REPR.maxother = MAX_TEXT_LENGTH


def cut(text: str, most: int = MAX_TEXT_LENGTH) -> str:
    """Return the text, or its beginning and an ellipsis."""
    return text if len(text) <= most else text[: most - 1] + ELLIPSIS


def printable(text: str) -> str:
    """Return the text with its unprintable characters escaped as in Python. Unescaped, they could
    reorder a message or control a terminal.
    """
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)


def as_text(value: object) -> str:
    """Return a value as Python writes it, shortened; even an integer that is too long for Python to
    write.
    """
    if isinstance(value, str):
        return repr(cut(value))
    if isinstance(value, int) and value.bit_length() > 4 * MAX_TEXT_LENGTH:
        return "a whole number of more than 80 digits"
    return cut(_SHORT_REPR.repr(value))


def listed(names: Iterable[object]) -> str:
    """Return names separated by commas: the first few, and the number of the others."""
    names = list(names)
    more = f" and {len(names) - MAX_LISTED_NAMES:,} more" if len(names) > MAX_LISTED_NAMES else ""
    return (", ".join(cut(str(name)) for name in names[:MAX_LISTED_NAMES]) or "none") + more


def nearest(name: object, known: Iterable[str], cutoff: float = 0.6) -> str | None:
    """Return the known name that is most similar to a name; None if they merely have some letters
    in common.

    A name that differs only in capitals comes first.
    """
    wanted, among = cut(str(name)), [cut(k) for k in islice(known, MAX_COMPARED_NAMES)]
    for candidate in among:
        if candidate.casefold() == wanted.casefold():
            return candidate
    close = difflib.get_close_matches(wanted, among, n=MAX_HINT_CANDIDATES, cutoff=cutoff)
    return next((one for one in close if _misspelt(wanted.casefold(), one.casefold())), None)


def _misspelt(a: str, b: str) -> bool:
    """Return whether one text is a part of the other, or at most a third of the letters are wrong,
    missing, added or swapped with the next.
    """
    if min(len(a), len(b)) >= MIN_PART_LETTERS and (a in b or b in a):
        return True
    return _mistakes(a, b) <= max(1, max(len(a), len(b)) // 3)


def _mistakes(a: str, b: str) -> int:
    """Return the number of wrong, missing, added or swapped letters (the optimal string alignment
    distance).
    """
    before: list[int] = []
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, 1):
        last, before, row = before, row, [i]
        for j, y in enumerate(b, 1):
            best = min(before[j] + 1, row[j - 1] + 1, before[j - 1] + (x != y))
            if i > 1 and j > 1 and x == b[j - 2] and a[i - 2] == y:
                best = min(best, last[j - 2] + 1)
            row.append(best)
    return row[-1]


def near(name: object, known: Iterable[str]) -> str:
    """Return a hint for an unknown name."""
    known = list(known)
    suggestion = nearest(name, known)
    return f"did you mean {suggestion!r}?" if suggestion else f"there are {listed(known)}"


def in_toml(value: object) -> str:
    """Return a value as the study file spells it, or the kind of value it is."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, list):
        return "a list"
    if isinstance(value, datetime.date | datetime.time):
        return f"the date or time {value.isoformat()}"
    return as_text(value)
