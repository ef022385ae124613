"""The envelope of all cases: a row for each pin, case and connection, and the matrix of
the page.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

from pinbase.counted import counted
from pinbase.rounding import without_round_off
from reports.data.envelope import EnvelopeCell, case_names, envelope, omitted_note, paragraphs
from reports.data.mechanics import PeakReaction
from reports.data.results import Results
from reports.format.numbers import DASH, beside_limit
from reports.tables.column import Column, Table, fields, unit_columns

# With more cases, the terminal shows the matrix of the worst cases, and on the page each case that
# governs no pin has a line instead of cells.
MAX_CASES_IN_SENTENCES = 4
MAX_SHOWN_CASES, MAX_SHOWN_PINS = 4, 10  # on the terminal; more cases only if they govern pins
FULL_COLOUR_UTILISATION = 1.0  # utilisation at which a cell has its full colour
ENVELOPE_NOTE = (
    "Utilisation of each pin in each case: required over actual factor of safety (1 where none is "
    "required), the upper end of a range. The case that governs a pin is framed. Forces, moments "
    "and stresses are in envelope.csv."
)


@dataclass(frozen=True)
class EnvelopeRow:
    """A pin in a case, with the largest load on one of its connections, if it has any."""

    cell: EnvelopeCell
    load: PeakReaction | None


COLUMNS: tuple[Column[EnvelopeRow], ...] = (
    *fields("pin=cell.result.pin case=cell.result.case"),
    Column("connection", lambda row: row.load.connection if row.load else ""),
    *fields("load?.force", "force"),
    *fields("load?.moment", "moment"),
    *fields("cell.result.max_von_mises", "stress"),
    *fields("cell.result.safety_factor utilisation_high=cell.used cell.outcome cell.governs"),
    *unit_columns("force length stress", "cell.result"),
)


def envelope_table(results: Results) -> Table[EnvelopeRow]:
    """Return the largest force and moment on each connection, with the pin's results."""
    rows = [EnvelopeRow(x, load) for x in envelope(results) for load in x.largest or (None,)]
    return Table("envelope", COLUMNS, rows)


@dataclass(frozen=True)
class CaseRow:
    """A case, or several cases, with the cells by the name of the pin.

    paragraph: the paragraph of the regulation that demands the case.
    """

    case: str
    cells: dict[str, EnvelopeCell]
    paragraph: str = ""

    @property
    def governs(self) -> bool:
        """Whether the case is the worst case of any pin."""
        return any(cell.governs for cell in self.cells.values())

    @property
    def used(self) -> float:
        """The largest utilisation."""
        return max((cell.used or 0.0 for cell in self.cells.values()), default=0.0)

    @property
    def line(self) -> str:
        """The largest utilisation in words, for a case that governs no pin."""
        most = max(self.cells.values(), key=lambda cell: without_round_off(cell.used or 0.0))
        return f"governs no pin; largest {cell_text(most)}, pin {most.result.pin}"


@dataclass(frozen=True)
class Matrix:
    """A matrix of cases and pins.

    rows: the cases; if there are many, those that govern a pin, the worst first.
    quiet: the other cases.
    note: on what the report leaves out.
    """

    pins: list[str]
    rows: list[CaseRow]
    quiet: list[CaseRow]
    note: str


def matrix(results: Results) -> Matrix | None:
    """Return the matrix of cases and pins; None for a single case."""
    cases = case_names(results)
    if len(cases) < 2:
        return None
    by_case: dict[str, dict[str, EnvelopeCell]] = {case: {} for case in cases}
    for cell in envelope(results):
        by_case[cell.result.case][cell.result.pin] = cell
    cited = paragraphs(results)
    rows = [CaseRow(case, cells, cited.get(case, "")) for case, cells in by_case.items()]
    quiet: list[CaseRow] = []
    if len(rows) > MAX_CASES_IN_SENTENCES:
        rows.sort(key=lambda row: (row.governs, without_round_off(row.used)), reverse=True)
        quiet = [row for row in rows if not row.governs]
    pins = list(dict.fromkeys(row.pin for row in results.pins))
    return Matrix(pins, rows[: len(rows) - len(quiet)], quiet, omitted_note(results))


def worst_cases(results: Results, pins: Sequence[str]) -> Table[CaseRow] | None:
    """Return the matrix of the worst cases, with the other cases in one row; None for few cases.

    Cases that govern a pin come first, then those with the largest utilisation.
    pins: the pins that have a column, in this order; only the first MAX_SHOWN_PINS are shown.
    """
    every = matrix(results)
    if every is None or (not every.quiet and len(every.rows) <= MAX_CASES_IN_SENTENCES):
        return None
    by_case = [*every.rows, *every.quiet]
    shown = max(MAX_SHOWN_CASES, min(len(every.rows), MAX_SHOWN_PINS))
    rows, rest = by_case[:shown], by_case[shown:]
    if rest:
        worst: dict[str, EnvelopeCell] = {}
        for cell in (cell for row in reversed(rest) for cell in row.cells.values()):
            known = worst.get(cell.result.pin)
            if known is None or (cell.used or 0.0) >= (known.used or 0.0):
                worst[cell.result.pin] = cell
        rows.append(CaseRow(counted(len(rest), "other"), worst))
    columns = [
        Column("case", lambda row: row.case, "", "utilisation, * largest", numeric=False),
        *map(_of_pin, pins[:MAX_SHOWN_PINS]),
    ]
    return Table("worst_cases", columns, rows)


def _of_pin(pin: str) -> Column[CaseRow]:
    """Return the column of a pin; the cell of its governing case has a star."""

    def text(row: CaseRow) -> str:
        cell = row.cells.get(pin)
        return "" if cell is None else f"{cell_text(cell)}{'*' if cell.governs else ' '}"

    return Column(pin, text, "", f"{pin} ")


def heat(cell: EnvelopeCell) -> float:
    """Return the colour of a cell as a percentage of the full colour."""
    return (
        0.0
        if cell.used is None
        else 100.0 * min(cell.used, FULL_COLOUR_UTILISATION) / FULL_COLOUR_UTILISATION
    )


def cell_text(cell: EnvelopeCell) -> str:
    """Return the utilisation of a cell as text."""
    if cell.used is None:
        return DASH
    if cell.used == inf:
        return "∞"
    text = f"{cell.used:.2f}"
    hidden = cell.used > 1.0 >= float(text)
    return beside_limit(cell.used, 1.0, 3, at_most=True) if hidden else text
