"""Singular zones: numbered along each pin, as a table and as text."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import hypot

from reports.data.results import Results, SingularZone
from reports.format.files.csv import Cell
from reports.format.numbers import DASH, engineering
from reports.tables.table import Table

COLUMNS = (
    *("pin", "case", "zone", "z", "radius", "x", "y", "between", "kind"),
    *("exponent", "exponent_theory", "excluded_radius", "governs", "max_von_mises"),
    *("advice", "verdict", "length_unit", "stress_unit"),
    *("strength", "strength_exponent", "notch_stress_intensity"),
)


@dataclass(frozen=True)
class Zone:
    """A zone with its number on the pin (one circle has one number in all cases); r its radius."""

    number: int
    found: SingularZone

    @property
    def z(self) -> float:
        return self.found.location[2]

    @property
    def r(self) -> float:
        return hypot(*self.found.location[:2])

    @property
    def between(self) -> str:
        return " / ".join(self.found.between)

    @property
    def exponents(self) -> str:
        """Measured / theoretical; at the edge of a load the theory gives a logarithm."""
        theory = self.found.exponent_theory
        known = "logarithm" if theory == 0.0 else engineering(theory, 3)
        return f"{engineering(self.found.exponent, 3)} / {known}"

    @property
    def short_kind(self) -> str:
        """The kind without its article, for a drawing."""
        head, _, rest = self.found.kind.partition(" ")
        return rest if rest and head in ("a", "an", "the") else self.found.kind


def pin_zones(results: Results, pin: str) -> dict[str, list[Zone]]:
    """A pin's zones by case, numbered from its start."""
    cases = [p for p in results.pins if p.pin == pin]
    every = [zone for p in cases for zone in p.singular_at]
    # Cases differ in the point on the circle, not in the circle.
    order = sorted({_circle(z): z.location[2] for z in every}.items(), key=lambda item: item[1])
    numbers = {circle: i for i, (circle, _) in enumerate(order, start=1)}
    return {p.case: [Zone(numbers[_circle(z)], z) for z in p.singular_at] for p in cases}


def circles(zones: Iterable[Zone]) -> list[Zone]:
    """One zone per number, preferably from a case in which it governs."""
    found: dict[int, Zone] = {}
    for zone in zones:
        if zone.number not in found or zone.found.governs:
            found[zone.number] = zone
    return [found[number] for number in sorted(found)]


def _circle(zone: SingularZone) -> tuple[str, tuple[str, str], str, str]:
    x, y, z = zone.location
    return zone.kind, zone.between, engineering(z, 5), engineering(hypot(x, y), 5)


def zone_table(zones: list[Zone], length: str, stress: str) -> tuple[list[str], list[list[str]]]:
    """Head and rows for display, for one pin and case; four digits."""
    head = ["zone", f"z [{length}]", f"radius [{length}]", "between", "kind", "exponent"]
    head += [f"excluded distance [{length}]", f"maximum inside [{stress}]"]
    head += [f"strength [{stress} {length}^exponent]", "governs", "remedy"]
    rows = [
        [
            str(zone.number),
            engineering(zone.z),
            engineering(zone.r),
            zone.between or DASH,
            zone.found.kind,
            zone.exponents,
            engineering(zone.found.excluded),
            engineering(zone.found.max_von_mises),
            engineering(zone.found.strength.along if zone.found.strength else None),
            "yes" if zone.found.governs else "no",
            zone.found.advice,
        ]
        for zone in sorted(zones, key=lambda zone: zone.number)
    ]
    return head, rows


def zones_table(results: Results) -> Table:
    """Every zone of every pin and case."""
    return Table.of("singular_zones", COLUMNS, _rows(results))


def _rows(results: Results) -> Iterator[list[Cell]]:
    units = results.units
    for pin in results.pins:
        for zone in pin_zones(results, pin.pin)[pin.case]:
            (x, y, z), found = zone.found.location, zone.found
            s = found.strength
            strength = (s.along, s.exponent, s.notch) if s else (None, None, None)
            yield [
                *(pin.pin, pin.case, zone.number, z, zone.r, x, y, zone.between, found.kind),
                *(found.exponent, found.exponent_theory, found.excluded, found.governs),
                *(found.max_von_mises, found.advice, pin.verdict, units.length, units.stress),
                *strength,
            ]
