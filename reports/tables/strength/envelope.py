"""The envelope of all cases: a row per pin, case and connection, and the matrix of the page."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from reports.data.envelope import EnvelopeCell, case_names, envelope, omitted_note
from reports.data.results import Results
from reports.format.files.csv import Cell
from reports.format.numbers import DASH, finite
from reports.tables.table import Table

COLUMNS = (
    *("pin", "case", "connection", "force", "moment"),
    *("max_von_mises", "safety_factor", "utilisation_high", "outcome", "governs"),
    *("force_unit", "length_unit", "stress_unit"),
)
FULL_COLOUR_UTILISATION = 1.0  # utilisation at which a cell has its full colour
ENVELOPE_NOTE = (
    "Utilisation of each pin in each case: required over actual factor of safety (1 where none is "
    "required), the upper end of a range. The worst case of each pin is framed. Forces, moments "
    "and stresses are in envelope.csv."
)


def envelope_table(results: Results) -> Table:
    """The largest force and moment on each connection, with the pin's results in the case."""
    units = (results.units.force, results.units.length, results.units.stress)
    rows = []
    for cell in envelope(results):
        r = cell.result
        answer = (
            *(finite(r.max_von_mises), finite(r.safety_factor), finite(cell.used)),
            *(cell.outcome, "yes" if cell.governs else "no"),
        )
        loads: list[tuple[Cell, ...]] = [(x.connection, x.force, x.moment) for x in cell.largest]
        for load in loads or [("", None, None)]:
            rows.append((r.pin, r.case, *load, *answer, *units))
    return Table.of("envelope", COLUMNS, rows)


@dataclass(frozen=True)
class Matrix:
    """Cases by pins: pins, the rows as case and cells (None where a pin is not loaded), and what to
    say of what the report leaves out.
    """

    pins: list[str]
    rows: list[tuple[str, list[EnvelopeCell | None]]]
    note: str


def matrix(results: Results) -> Matrix | None:
    """None of a single case."""
    cases = case_names(results)
    if len(cases) < 2:
        return None
    cells = {(cell.result.pin, cell.result.case): cell for cell in envelope(results)}
    pins = list(dict.fromkeys(pin for pin, _ in cells))
    rows = [(case, [cells.get((pin, case)) for pin in pins]) for case in cases]
    return Matrix(pins, rows, omitted_note(results))


def heat(cell: EnvelopeCell) -> float:
    """Share of a cell's full colour, in per cent."""
    return (
        0.0
        if cell.used is None
        else 100.0 * min(cell.used, FULL_COLOUR_UTILISATION) / FULL_COLOUR_UTILISATION
    )


def cell_text(cell: EnvelopeCell) -> str:
    """Its utilisation."""
    if cell.used is None:
        return DASH
    return "∞" if cell.used == inf else f"{cell.used:.2f}"
