"""The row of a pin with a hardened surface: that of its parts which has the least factor.

Each part of one yield strength has a largest stress of the field and one of sections, of its own
points. The stress field beneath the surface is the model's, so that in a fillet it falls with depth
as the notch has it; that of sections falls linearly.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from fea.core.hardened import StrengthPart, linear_strength
from fea.core.material import Material
from fea.core.mesh_result import Point
from fea.core.over_time import Between, over_time
from fea.core.peak import ErrorParts, Maximum, Reason
from fea.core.pin_loads import PinLoads
from fea.core.places import ContactPlace, PartPlace, Places
from fea.core.verdict import Evidence, judge
from fea.harmonic.field import HarmonicField
from fea.harmonic.part_field import PartField, Where
from fea.section.place import found_section
from fea.section.row import beside_singular
from fea.section.section_stress import SectionField
from fea.support.records import JointResult
from fea.support.support import StressReading
from geometry import Pin

# Of the difference between two meshes: as of fea.core.peak.discretisation_error.
TWO_MESH_FACTOR = 3.0
PART_REASONS = {
    part: Reason(f"; {text} governs", (f"{part}-governs",))
    for part, text in (
        ("case", "the hardened case"),
        ("core", "the core beneath the hardened case"),
        ("unhardened", "what is not hardened"),
    )
}


@dataclass(frozen=True)
class FoundPart:
    """The largest stress of a part, Pa, in the field ("surface") or in a section.

    errors: the parts of its error, Pa.
    location: (x, y, z), m. depth: there, m; None for what is not hardened.
    loads: at its instant.
    """

    part: StrengthPart
    place: Literal["surface", "section"]
    value: float
    errors: ErrorParts
    location: Point
    depth: float | None
    loads: PinLoads

    @property
    def time(self) -> float | None:
        """The time of the instant, s; None without a motion."""
        return self.loads.time()

    @property
    def use(self) -> float:
        """The stress over the yield strength."""
        return self.value / self.part.strength

    def ends(self, strength: float) -> tuple[float, float]:
        """The stress less and plus its error, Pa, as of a part of another strength with the same
        factor.
        """
        scale, error = strength / self.part.strength, self.errors.total
        return scale * max(0.0, self.value - error), scale * (self.value + error)

    @property
    def stated(self) -> PartPlace:
        """The part in the form of results."""
        return PartPlace(
            self.part.part, self.part.strength, self.place, self.value, self.errors.total,
            self.location, self.depth, self.time,
        )  # fmt: skip


@dataclass(frozen=True)
class PartSearch:
    """The fields in which the largest stresses of parts are looked for.

    reading: of the field. pin: as it is meshed. between: loads on the pin at any times.
    surface: the evidence of the surface, whose relative error that of other parts is at least.
    sections: of the pin. on_sections: loads for these, and between their instants.
    cells: relative errors of the cells of a contact: beneath the surface and of sections; None
    without contact.
    """

    reading: StressReading
    pin: Pin
    between: Between | None
    surface: Evidence
    sections: SectionField
    on_sections: tuple[PinLoads, Between | None]
    tolerance: float
    cells: tuple[float, float] | None = None

    def of(self, parts: Sequence[StrengthPart]) -> list[FoundPart]:
        """The largest stresses of all parts, of field and sections."""
        every = [place for part in parts for place in (self.in_field(part), self._in_section(part))]
        if self.reading.loads.pressed is not None:
            every += [self._beside_lugs(part) for part in parts if part.part == "core"]
        return every

    def _beside_lugs(self, part: StrengthPart) -> FoundPart:
        """The largest stress of a core beneath free surface, also beside lugs.

        There the field has the stress of contact, too, which is no part of a row: so it is at most
        that of the surface less what it falls linearly, which in a notch it does faster.
        """
        core, radius = self.in_field(part, "beside"), self.pin.largest_diameter / 2.0
        most = self.surface.value * (1.0 - part.least_depth / radius)
        if core.value <= most:
            return core
        return replace(core, value=most, errors=self._errors(part, most, 0.0, False))

    def in_field(self, part: StrengthPart, where: Where = "away") -> FoundPart:
        """The largest stress of a part in the field; where: as of PartField."""
        answer = self.reading.answer
        assert isinstance(answer, HarmonicField)
        field = PartField(answer, self.pin, part, where)
        loads, rise = over_time(field, self.reading.loads, self.between, self.tolerance)
        top = field.maximum(loads)
        now = loads.at(np.array([top.instant]))
        errors = self._errors(part, top.value, rise, where == "beneath")
        if isinstance(self.reading.coarser, HarmonicField):
            coarse = PartField(self.reading.coarser, self.pin, part, where).largest(now)[0]
            ratio = self.reading.mesh_ratio
            change = TWO_MESH_FACTOR * abs(top.value - coarse) / (ratio * ratio - 1.0)
            errors = replace(errors, mesh=max(errors.mesh, change))
        return FoundPart(part, "surface", top.value, errors, top.location, top.depth, now)

    def _errors(self, part: StrengthPart, value: float, rise: float, beneath: bool) -> ErrorParts:
        """The error of a stress, Pa, by that of the surface."""
        of, scale = self.surface.parts, value / (self.surface.value or 1.0)
        cells = of.cells * scale
        if self.cells is not None and (beneath or part.part == "core"):
            cells = max(cells, self.cells[0] * value)
        return ErrorParts(
            of.mesh * scale, rise, of.series * scale, of.model * scale, cells,
            of.truncation * scale,
        )  # fmt: skip

    def _in_section(self, part: StrengthPart) -> FoundPart:
        loads, between = self.on_sections
        cells = None if self.cells is None else self.cells[1]
        section = found_section(self.sections.of_part(part), loads, between, self.tolerance, cells)
        at = section.at
        depth = None if part.case is None else at.section.outer - at.r
        return FoundPart(
            part, "section", at.value, section.parts, at.location, depth, section.loads
        )


def hardened_row(
    pin: Pin,
    row: Maximum,
    surface: Evidence,
    found: Sequence[FoundPart],
    tolerance: float,
    governing: Callable[[FoundPart], PinLoads],
) -> Maximum:
    """The row of the part with the least factor.

    pin: as it is meshed.
    row: of surface and section as if all had one strength, which has their places.
    surface: its evidence.
    found: every part, in the field and in sections.
    governing: the loads at the instant of a part.
    """
    worst = max(found, key=lambda x: x.use)
    strength, of = worst.part.strength, worst.part.part
    others = [x.ends(strength) for x in found if x is not worst]
    bounds = max(low for low, _ in others), max(high for _, high in others)
    evidence = replace(
        surface,
        value=worst.value,
        parts=worst.errors,
        location=worst.location,
        governing=governing(worst),
        remarks=surface.remarks + PART_REASONS[of],
    )
    at_surface, places = judge(surface, tolerance), _places(pin, row.places, found)
    if at_surface.verdict != "singular":
        out = judge(evidence, tolerance, bounds)
    else:
        # Stress at a clamp or a corner has no bound, whatever lies beneath.
        own = worst.ends(strength)
        scale = strength / _strength_at(pin, found, at_surface.location)
        ends = scale * at_surface.lower_end, scale * at_surface.upper_end
        interval = max(own[0], bounds[0], ends[0]), max(own[1], bounds[1], ends[1])
        out = replace(
            beside_singular(at_surface, evidence, interval),
            note=at_surface.note + PART_REASONS[of].text,
            reasons=at_surface.reasons + PART_REASONS[of].codes,
        )
    governs = "core" if of == "core" else worst.place
    return replace(out, places=replace(places, governs=governs), strength=strength)


def _places(pin: Pin, places: Places | None, found: Sequence[FoundPart]) -> Places:
    """The places with the strengths that they have, and the parts, the worst first."""
    assert places is not None
    stated: dict[StrengthPart, FoundPart] = {}
    for x in found:
        if x.part not in stated or x.value > stated[x.part].value:
            stated[x.part] = x
    parts = tuple(x.stated for x in sorted(stated.values(), key=lambda x: -x.use))
    surface, section = places.surface, places.section
    surface = replace(surface, strength=_strength_at(pin, found, surface.location))
    if section is not None:
        outer = max(_of_z(found, section.z), key=lambda part: part.strength)
        section = replace(section, strength=outer.strength)
    return replace(places, surface=surface, section=section, hardened=parts)


def _of_z(found: Sequence[FoundPart], z: float) -> Iterator[StrengthPart]:
    return (x.part for x in found if x.part.along(np.array([z]))[0])


def _strength_at(pin: Pin, found: Sequence[FoundPart], location: Point | None) -> float:
    """The yield strength at a place of the surface, Pa; the least of those that meet there."""
    assert location is not None
    r, z = math.hypot(*location[:2]), location[2]
    at = np.array([[r, z]])
    return min(x.part.strength for x in found if x.part.holds(pin, at)[0])


def in_core(place: ContactPlace, search: PartSearch, parts: Sequence[StrengthPart]) -> ContactPlace:
    """The place of contact with the largest stress beneath it of what has the strength of a core,
    or of what is not hardened, by its strength.
    """
    softer = [part for part in parts if part.part != "case"]
    deepest = max((search.in_field(part, "beneath") for part in softer), key=lambda x: x.use)
    error = place.beneath_error / place.beneath if place.beneath else 0.0
    return replace(
        place,
        beneath=deepest.value,
        beneath_error=max(error * deepest.value, deepest.errors.total),
        beneath_location=deepest.location,
        beneath_time=deepest.time,
        strength=deepest.part.strength,
    )


def range_of_row(
    joint: JointResult | None, row: Maximum, material: Material, pin: Pin
) -> JointResult | None:
    """A range of the stress at the surface, which foundations give, as of the part that governs a
    row: the stress over which case or core yield if it falls linearly to the axis. In notches it
    falls faster, so that this is safe.
    """
    if joint is None or joint.range is None or row.strength is None:
        return joint
    parts = material.strength_parts(pin.length)
    times = row.strength / linear_strength(parts, pin.largest_diameter / 2.0)

    def ends(of: tuple[float, float]) -> tuple[float, float]:
        return times * of[0], times * of[1]

    over = tuple(
        replace(
            x, max_von_mises=times * x.max_von_mises,
            interval=None if x.interval is None else ends(x.interval),
        )
        for x in joint.range.variations
    )  # fmt: skip
    span = ends(joint.range.max_von_mises)
    return replace(joint, range=replace(joint.range, max_von_mises=span, variations=over))
