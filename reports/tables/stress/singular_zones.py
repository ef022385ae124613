"""Singular zones: numbered along each pin, as a table and as text."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import hypot

from fea.core.peak import SingularZone
from reports.data.results import Results
from reports.data.row import PinResult, Units
from reports.format.numbers import DASH, engineering
from reports.tables.column import PIN_AND_CASE, Column, Table, fields, in_order, texts, unit_columns


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


@dataclass(frozen=True)
class ZoneRow:
    """A zone of a pin in a case, with the units of the results."""

    pin: PinResult
    zone: ShownZone
    units: Units


COLUMNS: list[Column[ZoneRow]] = [
    *PIN_AND_CASE,
    Column("zone", lambda row: row.zone.number, "", "zone", lambda row: str(row.zone.number)),
    *fields("z=zone.place.location.2", "length", heading="z"),
    Column("radius", lambda row: row.zone.r, "length", "radius"),
    *fields("x=zone.place.location.0 y=zone.place.location.1", "length"),
    Column("between", lambda row: row.zone.between, "", "between",
           lambda row: row.zone.between or DASH, numeric=False),
    *texts("zone.place.kind"),
    Column("exponent", lambda row: row.zone.place.exponent, "", "exponent",
           lambda row: row.zone.exponents),
    *fields("zone.place.exponent_theory"),
    Column("excluded_radius", lambda row: row.zone.place.excluded, "length", "excluded distance"),
    *texts("zone.place.governs"),
    Column("max_von_mises", lambda row: row.zone.place.max_von_mises, "stress", "maximum inside"),
    Column("advice", lambda row: row.zone.place.advice, heading="remedy", numeric=False),
    *fields("pin.verdict"),
    *unit_columns("length stress"),
    *fields("strength=zone.place.strength?.along", "stress"),
    *fields("strength_exponent=zone.place.strength?.exponent"),
    *fields("notch_stress_intensity=zone.place.strength?.notch"),
]  # fmt: skip
ZONE_COLUMN_ORDER = (
    "zone z radius between kind exponent excluded_radius max_von_mises strength governs advice"
)


def zones_table(results: Results) -> Table[ZoneRow]:
    """Return every zone of every pin and case."""
    numbered = {pin: pin_zones(results, pin) for pin in dict.fromkeys(p.pin for p in results.pins)}
    rows = [
        ZoneRow(pin, zone, results.units)
        for pin in results.pins
        for zone in numbered[pin.pin][pin.case]
    ]
    return Table("singular_zones", COLUMNS, rows)


def shown_zones(pin: PinResult, zones: list[ShownZone], units: Units) -> Table[ZoneRow]:
    """Return the zones of a pin in a case, for people."""
    heading = f"strength [{units.stress} {units.length}^exponent]"
    columns = [
        replace(c, heading=heading, dimension="") if c.key == "strength" else c for c in COLUMNS
    ]
    rows = [ZoneRow(pin, zone, units) for zone in sorted(zones, key=lambda zone: zone.number)]
    return Table("singular_zones", in_order(columns, ZONE_COLUMN_ORDER), rows)
