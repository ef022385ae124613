"""Comparison with CalculiX for every row, as tables and JSON."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from itertools import pairwise
from typing import Any

from assess.opinion.opinions import Opinion
from reports.data.results import Results
from reports.format.files.csv import Cell
from reports.format.numbers import finite
from reports.tables.table import Table

COLUMNS = (
    *("pin", "case", "unknowns", "displacement_difference", "von_mises_difference"),
    *("max_von_mises_same_mesh", "max_von_mises_calculix", "max_von_mises", "error_estimate"),
    *("calculix_over_answer", "agrees", "unit", "note"),
    *("bending_moment", "bending_moment_calculix", "load_elsewhere", "mesh_change"),
    *("force_unit", "length_unit"),
)
OPINION_LOAD_COLUMNS = (
    *("pin", "case", "connection", "z_start", "z_end", "line_load", "line_load_calculix"),
    *("length_unit", "force_unit"),
)


def opinions_of(results: Results) -> list[Opinion]:
    """All that there are, in the order of the rows."""
    return [pin.second_opinion for pin in results.pins if pin.second_opinion]


def opinion_tables(results: Results) -> list[Table]:
    """A row per pin and case, and the loads per length of those in contact."""
    return [
        Table.of("second_opinion", COLUMNS, _rows(results)),
        Table.of("second_opinion_loads", OPINION_LOAD_COLUMNS, _loads(results)),
    ]


def opinion_json(opinion: Opinion | None) -> dict[str, Any] | None:
    """As results.json has it."""
    if opinion is None:
        return None
    contact = opinion.contact
    return {
        "unknowns": opinion.unknowns,
        "displacement_difference": finite(opinion.displacement),
        "von_mises_difference": finite(opinion.stress),
        "max_von_mises_same_mesh": finite(opinion.ours),
        "max_von_mises_calculix": finite(opinion.theirs),
        "agrees": not opinion.complaint,
        "note": opinion.complaint,
        "contact": contact
        and {
            "bending_moment": finite(contact.our_moment),
            "bending_moment_calculix": finite(contact.moment),
            "load_elsewhere": finite(contact.elsewhere),
            "mesh_change": finite(contact.stress_change),
            "bands": [asdict(band) for band in contact.bands],
        },
    }


def _rows(results: Results) -> Iterator[list[Cell]]:
    u = results.units
    for o in opinions_of(results):
        ratio = None if o.deviation is None else 1.0 + o.deviation
        c = o.contact
        own: list[Cell] = [None] * 6
        if c:
            own = [c.our_moment, c.moment, c.elsewhere, c.stress_change, u.force, u.length]
        yield [
            *(o.pin, o.case, o.unknowns or None, o.displacement, o.stress, o.ours, o.theirs),
            *(o.answer, o.error, ratio, not o.complaint, u.stress, o.complaint, *own),
        ]


def _loads(results: Results) -> Iterator[list[Cell]]:
    u = results.units
    for o in opinions_of(results):
        for band in o.contact.bands if o.contact else ():
            for (start, end), ours, theirs in zip(
                pairwise(band.ends), band.ours, band.theirs, strict=True
            ):
                yield [o.pin, o.case, band.name, start, end, ours, theirs, u.length, u.force]
