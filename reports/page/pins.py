"""The data of each pin and each case on the page."""

from __future__ import annotations

from dataclasses import dataclass

from reports.data.results import PinResult, Results
from reports.format.numbers import ratio
from reports.page.joint import JointPart, joint_part
from reports.page.loads import loads_at
from reports.page.places import PlacesPart, places_part
from reports.page.second_opinion import OpinionPart, opinion_part
from reports.page.viewer import PinView, pin_views
from reports.tables.column import Grid, grid_of
from reports.tables.strength.hand_checks import pin_checks
from reports.tables.strength.margins import pin_margins
from reports.tables.stress.singular_zones import pin_zones, shown_zones
from reports.text.pin_sentence import drawing_caption, pin_sentence


@dataclass(frozen=True)
class PinCase:
    """A pin in one case on the page.

    checks: hand checks. margins: of safety. places: where stress is read. joint: contact with lugs.
    opinion: of CalculiX. ratio: computed maximum over the published one.
    """

    result: PinResult
    outcome: str
    sentence: str
    zones: Grid | None
    checks: Grid | None
    margins: Grid | None
    loads: Grid | None
    places: PlacesPart | None
    joint: JointPart | None
    opinion: OpinionPart | None
    ratio: float | None


@dataclass(frozen=True)
class PinPart:
    """One pin on the page.

    anchor: on the page. drawing, caption: of the pin. moving: cases with a motion. views: in 3D.
    """

    pin: str
    anchor: str
    caption: str
    drawing: str
    cases: tuple[PinCase, ...]
    moving: tuple[str, ...]
    views: list[PinView]


def pin_parts(results: Results, drawings: dict[str, str]) -> list[PinPart]:
    """Return the pins in the order of the results, then those that were not solved."""
    shapes = {shape.pin: shape for shape in results.shapes}
    names = dict.fromkeys([p.pin for p in results.pins] + list(shapes))
    zones = {name: pin_zones(results, name) for name in names}
    return [
        PinPart(
            pin=name,
            anchor=f"pin-{number}",
            caption=drawing_caption(shapes[name], results.units, any(zones[name].values()))
            if name in shapes
            else "",
            drawing=drawings.get(name, ""),
            cases=tuple(
                PinCase(
                    p,
                    p.outcome,
                    pin_sentence(p, results.units),
                    grid_of(shown_zones(p, zones[name][p.case], results.units), results.units),
                    pin_checks(p, results.units).grid(results.units) if p.hand_checks else None,
                    grid_of(pin_margins(results, p), results.units),
                    loads_at(p, results.units),
                    places_part(p, results.units),
                    joint_part(p, results.units),
                    opinion_part(p.second_opinion, results.units),
                    ratio(p.max_von_mises, p.published_max_von_mises),
                )
                for p in results.pins
                if p.pin == name
            ),
            moving=tuple(
                t.case for t in results.reactions if t.times is not None and name in t.pins
            ),
            views=pin_views(results, name),
        )
        for number, name in enumerate(names, start=1)
    ]
