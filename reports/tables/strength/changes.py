"""Changes by which a pin reaches its factor, each sufficient alone, for pins below their factor."""

from __future__ import annotations

from collections.abc import Iterable

from fea.core.peak import SingularZone
from pinbase.grouped import grouped
from pinbase.rounding import rounded_down, rounded_up
from reports.data.changes import Remedy, unsized
from reports.data.results import Results
from reports.format.numbers import DASH, engineering, short
from reports.tables.column import Column, Table, read_only, texts

REMEDIES_NOTE = (
    "Each of these alone brings the pin to the required factor in the worst of its cases, if "
    "nothing else is changed. Larger diameters, with bores and fillets, are estimated to a few per "
    "cent on one mesh, under the same loads."
)
CONTACT_NOTE = (
    "In contact with lugs stress is not quite proportional to loads: take the load as an estimate."
)
BENEATH_NOTE = "What lies beneath contact is larger than surface and section, and counts: {}."
ROUND_OFF_FACTOR = 1.0 - 1e-9
SINGULAR_ROWS_NOTE = (
    "Of singular rows the factor is reached only outside the excluded zones: first {}."
)
SPREAD_REMEDY = 'spread the load by distribution = "cosine", a pressure without such an edge'
SINGULARITY_REMEDIES = {
    "sharp corner": "give the sharp corner a radius",
    "edge of a clamp": "replace the clamp by its hub, or by loads in equilibrium",
}


COLUMNS: tuple[Column[Remedy], ...] = (
    *texts("pin case"),
    read_only("× diameters", lambda c: engineering(c.diameter_factor, 3), drop_if_empty=True),
    read_only(
        "yield strength", lambda c: rounded_up(c.yield_strength, 4), "stress", drop_if_empty=True
    ),
    read_only("× loads", lambda c: _loads(c), drop_if_empty=True),
    read_only("impulse time", lambda c: _time(c), "time", rank=1, drop_if_empty=True),
)


def changes_table(results: Results) -> Table[Remedy]:
    """Return the table with a row for each pin, the worst first."""
    return Table("changes", COLUMNS, results.changes)


def change_notes(results: Results) -> list[str]:
    """Return the notes on the changes, each of a sentence or two."""
    left_out = unsized(results.changes)
    sized = (change for change in results.changes if change not in left_out)
    notes = notes_of_pins((change.diameter_note, change.pin) for change in sized)
    notes += unsized_notes(results)
    notes += [CONTACT_NOTE] * any(not c.proportional for c in results.changes)
    by_contact = [c.pin for c in results.changes if _by_contact(results, c)]
    notes += [BENEATH_NOTE.format(", ".join(by_contact))] * bool(by_contact)
    remedies = _remedies(results)
    return notes + [SINGULAR_ROWS_NOTE.format("; ".join(remedies))] * bool(remedies)


def unsized_notes(results: Results) -> list[str]:
    """Return a sentence on the pins that reach their factor with no diameter, with the reason for
    the worst of them; nothing without such pins.
    """
    if not (left_out := unsized(results.changes)):
        return []
    worst, pins = left_out[0], [change.pin for change in left_out]
    sized = len(pins) < len(results.changes)
    reason = f"{worst.pin}: {worst.diameter_note}" if pins[1:] else worst.diameter_note
    out = ", so the command leaves them out" if sized else ""
    return [f"Larger diameters are no remedy for {', '.join(pins)}{out} ({reason})."]


def notes_of_pins(notes: Iterable[tuple[str, str]]) -> list[str]:
    """Return each different note with the pins to which it applies.

    notes: pairs of a note, which may be empty, and a pin.
    """
    pins = grouped(pair for pair in notes if pair[0])
    return [f"{'Pins' if of[1:] else 'Pin'} {', '.join(of)}: {note}." for note, of in pins.items()]


def _by_contact(results: Results, change: Remedy) -> bool:
    """Return whether the stress beneath contact determines the required strength."""
    row = next(p for p in results.pins if (p.pin, p.case) == (change.pin, change.case))
    contact = row.places.contact if row.places else None
    needed = ROUND_OFF_FACTOR * change.yield_strength / change.required
    return contact is not None and contact.upper_end >= needed


def _remedies(results: Results) -> list[str]:
    """Return the remedy of each singularity that governs one of the rows."""
    rows = {(c.pin, c.case) for c in results.changes if c.singular}
    zones = [z for p in results.pins if (p.pin, p.case) in rows for z in p.singular_at if z.governs]
    return singularity_remedies(zones)


def singularity_remedies(zones: Iterable[SingularZone]) -> list[str]:
    """Return the remedy of each kind of singularity; for the edges of loads the advice of each
    load.
    """
    zones = list(zones)
    remedies = [
        text
        for kind, text in SINGULARITY_REMEDIES.items()
        if any(z.kind.endswith(kind) for z in zones)
    ]
    of_loads = [z.advice for z in zones if z.kind.endswith("edge of a load")]
    spread = [SPREAD_REMEDY if text.startswith("use distribution") else text for text in of_loads]
    return [*remedies, *dict.fromkeys(spread)]


def _loads(change: Remedy) -> str:
    about = "" if change.proportional else "≈ "
    return f"{about}{engineering(rounded_down(change.load_factor), 3)}"


def _time(change: Remedy) -> str:
    if change.given_time is None or change.impulse_time is None:
        return DASH
    return f"{short(change.given_time)} → {engineering(rounded_up(change.impulse_time), 3)}"
