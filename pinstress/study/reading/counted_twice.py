"""Factors that a study gives twice, in its required safety factor and for its margins.

The required factor compares yield with the stress under the loads of the study as they are. Limit,
ultimate and fitting factors multiply these loads in the margins of safety. A study whose required
factor includes one of these counts the factor twice: 14 CFR 25.305 allows a pin to yield beyond
limit load.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping

from pinstress.study.schema.tables import AnalysisTable

REQUIRED_FACTOR_KEY = "analysis.required_safety_factor"
LEVEL_FACTOR_KEYS = "limit_factor", "ultimate_factor"
FITTING_FACTOR_KEY = "fitting_factor"
USUAL_FITTING_FACTOR = 1.15  # 14 CFR 25.625, 23.625
FACTOR_DIFFERENCE_TOLERANCE = 0.005  # relative: factors that differ by no more are equal
FACTOR_WORDS = {
    "ultimate_factor": re.compile(r"ultimate (load|factor)|\b2[3579]\.303\b", re.IGNORECASE),
    FITTING_FACTOR_KEY: re.compile(r"\bfitting\b|\b2[3579]\.625\b", re.IGNORECASE),
}


def counted_twice(table: AnalysisTable, notes: Mapping[str, str]) -> tuple[str, ...]:
    """Return a sentence on the factors of margins that the required factor seems to contain.

    notes: the source of each number, by key. A note on the required factor that mentions none of
    these factors settles the question.
    """
    required, note = table.required_safety_factor, notes.get(REQUIRED_FACTOR_KEY, "")
    if required is None or required <= 1.0:
        return ()
    keys = _in_words(table, note) if note else _in_numbers(table, required)
    if not keys:
        return ()
    values = {key: getattr(table, key) for key in keys}
    factors = [f"{key} {value:g}" for key, value in values.items()]
    rest = required / math.prod(values.values())
    times = [] if note or abs(rest - 1.0) <= FACTOR_DIFFERENCE_TOLERANCE else [f"{rest:.3g}"]
    statement = f"{'contains' if note else 'is'} {' times '.join(factors + times)}"
    return (
        f"{REQUIRED_FACTOR_KEY}: {required:g} {statement}{' by its note' * bool(note)}, and the "
        f"margins of safety already contain {' and '.join(keys)}; the required factor compares "
        "yield with the stress under the loads of the study as they are (1: no yielding at limit "
        "load); if it is another factor, say in its note where it comes from",
    )


def _in_words(table: AnalysisTable, note: str) -> list[str]:
    """Return the factors that a note names and margins contain."""
    return [
        k for k, words in FACTOR_WORDS.items() if words.search(note) and getattr(table, k) > 1.0
    ]


def _in_numbers(table: AnalysisTable, required: float) -> list[str]:
    """Return the factors whose product is the required one, at least one of them stated."""
    stated = table.model_fields_set
    fits = [
        keys
        for keys, value in _products(table)
        if abs(required / value - 1.0) <= FACTOR_DIFFERENCE_TOLERANCE
    ]
    return max((x for x in fits if stated & set(x)), key=lambda x: len(stated & set(x)), default=[])


def _products(table: AnalysisTable) -> Iterator[tuple[list[str], float]]:
    """Yield the products of the limit or ultimate factor and the fitting factor, as far as they
    exceed 1.

    If margins have no fitting factor, the usual one is tried, too.
    """
    fitting = table.fitting_factor
    if fitting > 1.0:
        yield [FITTING_FACTOR_KEY], fitting
    for level in LEVEL_FACTOR_KEYS:
        value: float = getattr(table, level)
        if value > 1.0:
            yield [level], value
            yield ([level, FITTING_FACTOR_KEY], value * fitting) if fitting > 1.0 else (
                [level], value * USUAL_FITTING_FACTOR,
            )  # fmt: skip
