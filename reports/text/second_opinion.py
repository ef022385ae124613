"""CalculiX's second opinion in sentences, and as tables on the terminal."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from assess.opinion.opinions import (
    MAX_DISPLACEMENT_DIFFERENCE,
    MAX_LOAD_DIFFERENCE,
    MAX_MAXIMUM_DIFFERENCE,
    MAX_MOMENT_DIFFERENCE,
    MAX_STRESS_DIFFERENCE,
    ContactOpinion,
    Opinion,
)
from reports.data.results import Results
from reports.data.row import Units
from reports.format.numbers import DASH, engineering, percent
from reports.tables.column import Column, Table, read_only, texts
from reports.tables.stress.calculix import opinions_of, over_answer
from reports.text.fitted_table import fitted_table

if TYPE_CHECKING:
    from rich.console import Console

AGREES, DIFFERS, NOT_COMPARED = "agrees", "differs", "not compared"
OUTCOME_COLOURS = {AGREES: "green", DIFFERS: "red", NOT_COMPARED: "yellow"}


def outcome_of(opinion: Opinion) -> str:
    """Return the outcome in one word or two."""
    if opinion.failure:
        return NOT_COMPARED
    return DIFFERS if opinion.complaint else AGREES


def sentences(opinion: Opinion, units: Units) -> list[str]:
    """Return sentences on CalculiX's result for a row, and its agreement."""
    if opinion.failure:
        return [f"Not compared with CalculiX: {opinion.failure}."]
    said = _contact(opinion, units) if opinion.contact else [_same_mesh(opinion, units)]
    if opinion.complaint:
        return [*said, f"Beyond the limits: {opinion.complaint}."]
    return said


def _same_mesh(o: Opinion, units: Units) -> str:
    largest = f"{engineering(o.theirs)} {units.stress}"
    return (
        f"On our mesh of the solid model ({o.unknowns:,} unknowns) CalculiX's displacements differ "
        f"from ours by {_small(o.displacement)} and its von Mises stresses by {_small(o.stress)} "
        f"of the largest; its maximum there is {largest} ({_signed(o.deviation)} from the result)."
    )


def _contact(o: Opinion, units: Units) -> list[str]:
    c = o.contact
    assert c is not None
    moment = f"{units.force}·{units.length}"
    worst = max(c.bands, key=lambda band: band.elsewhere, default=None)
    loads = ""
    if worst is not None:
        others = "; in the other lugs it is less" if len(c.bands) > 1 else ""
        loads = (
            f" Of the load of {worst.name} {percent(worst.elsewhere)} acts elsewhere along the lug "
            f"according to CalculiX{others}."
        )
    said = [
        f"CalculiX, with contact in three dimensions ({o.unknowns:,} unknowns): largest bending "
        f"moment {engineering(c.moment)} {moment}, ours {engineering(c.our_moment)} "
        f"({_signed(c.moment_difference)}); von Mises stress at the point of our maximum "
        f"{engineering(o.theirs)} {units.stress}, ours {engineering(o.answer)} "
        f"({_signed(o.deviation)}).{loads}",
        _meshes(o, c),
    ]
    if c.tension:
        said.append(
            "CalculiX found tension in the contact and repeated an increment without load, which "
            "makes its answer less accurate."
        )
    return said


def _meshes(o: Opinion, c: ContactOpinion) -> str:
    """Return a sentence on whether CalculiX's mesh explains the difference in stress."""
    change, error, difference = abs(c.stress_change), o.own_error, abs(o.deviation or 0.0)
    text = (
        f"From its coarser mesh ({c.coarser:,} unknowns) to this one CalculiX's stress there "
        f"changed by {percent(change)} and its moment by {percent(abs(c.moment_change))}; the "
        f"error of our stress is estimated at {percent(error)}."
    )
    if difference > change + error:
        return text + " The meshes do not explain the whole difference."
    return text + (" Its mesh is the larger part of the difference." if change > error else "")


def print_second_opinion(results: Results, console: Console) -> None:
    """Print a table of the rows on the same mesh, one of those in contact, and a summary."""
    from rich.text import Text

    opinions, units = opinions_of(results), results.units
    pressed = [o for o in opinions if o.contact or _in_lugs(results, o)]
    others = [o for o in opinions if o not in pressed]
    for rows, columns in ((others, MESH_COLUMNS), (pressed, CONTACT_COLUMNS)):
        if rows:
            table = Table("second_opinion", [*NAMES, *columns, WORD], rows)
            tints = [OUTCOME_COLOURS[outcome_of(o)] for o in rows]
            colours = {"Pin": ["bold"] * len(rows), WORD.heading.strip(): tints}
            console.print()
            console.print(fitted_table(table, units, console.width, colours, gap=1))
    console.print(Text(summary(others, pressed)))


def _in_lugs(results: Results, opinion: Opinion) -> bool:
    joint = results[opinion.pin, opinion.case].joint
    return joint is not None and joint.model != "prescribed"


def _small(value: float | None) -> str:
    return DASH if value is None else f"{value:.0e}"


def _signed(value: float | None) -> str:
    return DASH if value is None else f"{100.0 * value:+.1f} %"


def _in_contact(text: Callable[[ContactOpinion], str]) -> Callable[[Opinion], str]:
    return lambda o: text(o.contact) if o.contact else DASH


NAMES: list[Column[Opinion]] = [
    *texts("Pin=pin Case=case"),
]
WORD: Column[Opinion] = read_only(" ", lambda o: outcome_of(o))
STRESSES: list[Column[Opinion]] = [
    read_only("result\n", lambda o: o.answer, "stress"),
    read_only("±", lambda o: engineering(o.error, 2)),
    read_only("ratio", lambda o: engineering(over_answer(o), 3)),
]
MESH_COLUMNS: list[Column[Opinion]] = [
    read_only("unknowns", lambda o: str(o.unknowns or DASH)),
    read_only("displace-\nments\ndiffer", lambda o: _small(o.displacement)),
    read_only("von Mises\nstresses\ndiffer", lambda o: _small(o.stress)),
    read_only("CalculiX's\nmaximum\n", lambda o: o.theirs, "stress"),
    *STRESSES,
]
CONTACT_COLUMNS: list[Column[Opinion]] = [
    read_only("unknowns", lambda o: str(o.unknowns) if o.contact else DASH),
    read_only("CalculiX's\nmoment\n", lambda o: o.contact and o.contact.moment, "moment"),
    read_only("over\nours", _in_contact(lambda c: engineering(1.0 + c.moment_difference, 3))),
    read_only("load\nelsewhere", _in_contact(lambda c: percent(c.elsewhere))),
    read_only("stress at\nour point\n", lambda o: o.theirs if o.contact else None, "stress"),
    *STRESSES,
    read_only("its mesh\nchanges it", _in_contact(lambda c: percent(abs(c.stress_change)))),
]


def summary(others: Sequence[Opinion], pressed: Sequence[Opinion]) -> str:
    """Return the number of rows in which CalculiX agrees, and the limits."""
    every = (*others, *pressed)
    if not every:
        return "Second opinion: no row was solved, so CalculiX was not run."
    agree = sum(not o.complaint for o in every)
    text = f"Second opinion: CalculiX agrees in {agree} of {len(every)} rows."
    if others:
        text += (
            f" Limits: on the same mesh, {MAX_DISPLACEMENT_DIFFERENCE:.0e} of the largest "
            f"displacement and {MAX_STRESS_DIFFERENCE:.0e} of the largest von Mises stress; its "
            f"maximum, from that mesh only, {MAX_MAXIMUM_DIFFERENCE:.0%} plus the error from our "
            "result."
        )
    if pressed:
        text += (
            f" Limits for contact: {MAX_MOMENT_DIFFERENCE:.0%} of the largest bending moment and "
            f"{MAX_MAXIMUM_DIFFERENCE:.0%} of the stress at the point of our maximum, each plus "
            f"the error; {MAX_LOAD_DIFFERENCE:.0%} of the load of a lug elsewhere along it."
        )
    return text
