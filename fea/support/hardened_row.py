"""The row of a pin with a hardened surface, which is that of the part with the least factor.

A part has one yield strength. Its largest stress in the field and its largest stress in sections
are read at its own points. The stress field beneath the surface is that of the model, so that
stress in a fillet falls with depth like that of a notch. Stress in sections falls linearly.
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

# Safety factor on the difference between two meshes, as in fea.core.peak.discretisation_error.
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
    """The largest stress of a part.

    place: "surface" for the stress field, "section" for sections.
    value: the stress, Pa.
    errors: the parts of its error, Pa.
    location: (x, y, z), m.
    depth: of the location, m; None for a part that is not hardened.
    loads: at the instant of the largest stress.
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
        """The stress divided by the yield strength."""
        return self.value / self.part.strength

    def ends(self, strength: float) -> tuple[float, float]:
        """The bounds of the stress with its error, Pa, converted to a part of another strength with
        the same factors.
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
    """The fields in which the largest stresses of parts are searched for.

    reading: result of the stress field.
    pin: as it is meshed.
    between: loads on the pin at any times.
    surface: evidence of the surface; other parts have at least its relative error.
    sections: stress field of the sections.
    on_sections: loads for the sections, and these at any times.
    tolerance: of the maximum, relative.
    cells: relative errors of the cells of contact, beneath the surface and of sections; None
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
        """The largest stresses of all parts, in the field and in sections."""
        every = [place for part in parts for place in (self.in_field(part), self._in_section(part))]
        if self.reading.loads.pressed is not None:
            every += [self._beside_lugs(part) for part in parts if part.part == "core"]
        return every

    def _beside_lugs(self, part: StrengthPart) -> FoundPart:
        """The largest stress of a core beneath the free surface, also beside lugs.

        Beside lugs the field includes the stress of contact, which does not belong to a row. The
        value is therefore limited to the stress of the surface, reduced as if it fell linearly to
        the axis; in a notch stress falls faster.
        """
        core, radius = self.in_field(part, "beside"), self.pin.largest_diameter / 2.0
        most = self.surface.value * (1.0 - part.least_depth / radius)
        if core.value <= most:
            return core
        return replace(core, value=most, errors=self._errors(part, most, 0.0, False))

    def in_field(self, part: StrengthPart, where: Where = "away") -> FoundPart:
        """The largest stress of a part in the field. where: as in PartField."""
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
        """The error of a stress in proportion to that of the surface.

        value: the stress, Pa.
        rise: possible rise of the stress between instants, Pa.
        beneath: whether the stress is beneath contact.
        """
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
    row: the row of surface and section as if the whole pin had one strength.
    surface: evidence of the surface.
    found: the largest stresses of all parts, in the field and in sections.
    governing: returns the loads at the instant of a part's largest stress.
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
        # Stress at a clamp or a sharp corner is unbounded, whatever the stress beneath.
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
    """The places with their yield strengths, and the parts in order of decreasing use."""
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
    """The yield strength at a location of the surface, Pa; the least where parts meet."""
    assert location is not None
    r, z = math.hypot(*location[:2]), location[2]
    at = np.array([[r, z]])
    return min(x.part.strength for x in found if x.part.holds(pin, at)[0])


def in_core(place: ContactPlace, search: PartSearch, parts: Sequence[StrengthPart]) -> ContactPlace:
    """The place of contact with the stress beneath contact in the core or in an unhardened part,
    whichever uses more of its strength.
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
    """The joint with its range converted from the stress at the surface, which foundations give, to
    the stress of the part that governs the row.

    Both are related by the surface stress at which case or core yield if the stress falls linearly
    to the axis. In notches it falls faster, so that this is safe.
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
