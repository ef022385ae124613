"""Singular zones: numbered along each pin, as a table and as text."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import hypot

from fea.core.peak import SingularZone
from reports.data.results import Results
from reports.data.row import PinResult
from reports.format.numbers import engineering
from reports.tables.column import (
    PIN_AND_CASE,
    Column,
    PinRow,
    Table,
    fields,
    headed,
    in_order,
    or_dash,
    texts,
    unit_columns,
)


@dataclass(frozen=True)
class ShownZone:
    """A zone with its number on the pin; zones on the same circle have the same number in all
    cases.
    """

    number: int
    place: SingularZone

    @property
    def z(self) -> float:
        return self.place.location[2]

    @property
    def r(self) -> float:
        return hypot(*self.place.location[:2])

    @property
    def between(self) -> str:
        return " / ".join(self.place.between)

    @property
    def exponents(self) -> str:
        """The measured and the theoretical exponent; at the edge of a load theory gives a
        logarithm.
        """
        theory = self.place.exponent_theory
        known = "logarithm" if theory == 0.0 else engineering(theory, 3)
        return f"{engineering(self.place.exponent, 3)} / {known}"

    @property
    def short_kind(self) -> str:
        """The kind without its article, for a drawing."""
        head, _, rest = self.place.kind.partition(" ")
        return rest if rest and head in ("a", "an", "the") else self.place.kind


def pin_zones(results: Results, pin: str) -> dict[str, list[ShownZone]]:
    """Return the zones of a pin by case, numbered from the start of the pin."""
    cases = [p for p in results.pins if p.pin == pin]
    every = [zone for p in cases for zone in p.singular_at]
    # Cases may differ in the point on the circle of a zone, but not in the circle.
    order = sorted({_circle(z): z.location[2] for z in every}.items(), key=lambda item: item[1])
    numbers = {circle: i for i, (circle, _) in enumerate(order, start=1)}
    return {p.case: [ShownZone(numbers[_circle(z)], z) for z in p.singular_at] for p in cases}


def circles(zones: Iterable[ShownZone]) -> list[ShownZone]:
    """Return one zone per number, preferably from a case in which it governs."""
    by_number: dict[int, ShownZone] = {}
    for zone in zones:
        if zone.number not in by_number or zone.place.governs:
            by_number[zone.number] = zone
    return [by_number[number] for number in sorted(by_number)]


def _circle(zone: SingularZone) -> tuple[str, tuple[str, str], str, str]:
    x, y, z = zone.location
    return zone.kind, zone.between, engineering(z, 5), engineering(hypot(x, y), 5)


COLUMNS: list[Column[PinRow[ShownZone]]] = [
    *PIN_AND_CASE,
    *headed("zone=of.number", show=str),
    *headed("z=of.place.location.2", "length"),
    *headed("radius=of.r", "length"),
    *fields("x=of.place.location.0 y=of.place.location.1", "length"),
    *texts("of.between", show=or_dash),
    *texts("of.place.kind"),
    *headed("of.place.exponent", text=lambda row: row.of.exponents),
    *fields("of.place.exponent_theory"),
    *fields("excluded_radius=of.place.excluded", "length", heading="excluded distance"),
    *texts("of.place.governs"),
    *fields("of.place.max_von_mises", "stress", heading="maximum inside"),
    *fields("of.place.advice", heading="remedy", numeric=False),
    *fields("pin.verdict"),
    *unit_columns("length stress"),
    *fields("strength=of.place.strength?.along", "stress"),
    *fields("strength_exponent=of.place.strength?.exponent"),
    *fields("notch_stress_intensity=of.place.strength?.notch"),
]
ZONE_COLUMN_ORDER = (
    "zone z radius between kind exponent excluded_radius max_von_mises strength governs advice"
)


def zones_table(results: Results) -> Table[PinRow[ShownZone]]:
    """Return every zone of every pin and case."""
    numbered = {pin: pin_zones(results, pin) for pin in dict.fromkeys(p.pin for p in results.pins)}
    rows = [PinRow(pin, zone) for pin in results.pins for zone in numbered[pin.pin][pin.case]]
    return Table("singular_zones", COLUMNS, rows)


def shown_zones(pin: PinResult, zones: list[ShownZone]) -> Table[PinRow[ShownZone]]:
    """Return the zones of a pin in a case, for people."""
    heading = f"strength [{pin.units.stress} {pin.units.length}^exponent]"
    columns = [
        replace(c, heading=heading, dimension="") if c.key == "strength" else c for c in COLUMNS
    ]
    rows = [PinRow(pin, zone) for zone in sorted(zones, key=lambda zone: zone.number)]
    return Table("singular_zones", in_order(columns, ZONE_COLUMN_ORDER), rows)
