"""The stresses of a row that limit the size of a pin, each with its derivatives by the dimensions.

Without lugs these are the largest stress in both halves of each segment, and of the sections; in
lugs, the largest stress of the surface and of the sections. All surface stresses are multiplied by
the ratio of the surface stress that counts, with its error, to the largest of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from assess.derivatives.in_section import section_derivatives
from assess.derivatives.places import PartsOfSection, PartTop, halves
from assess.derivatives.records import Derivatives, SolvedCase
from fea.beam.error_model import CLAMPED_SPAN_ERROR
from fea.core.linear_solver import SolveError
from fea.core.requirement import Requirement
from fea.core.zone import DISTANCE_VARIATIONS
from fea.harmonic.field import HarmonicField
from fea.support.support import Solution
from geometry import body_of_revolution
from geometry.shape.dimensions import Dimension
from pinbase.arrays import Floats, Mask
from pinstress.analysis.remedies.sensitivities import differentiated
from pinstress.explore.size.contact_slopes import by_contact
from pinstress.explore.size.counted import surface_and_section
from pinstress.explore.size.pin_shape import VariedShape
from pinstress.explore.size.singular_places import DIAMETER_EXPONENT
from pinstress.study.model.tasks import Task
from pinstress.study.reading.file import Study


@dataclass(frozen=True)
class RowPart:
    """The largest stress of a part of a row, Pa, as it counts, and its derivatives.

    slopes: a function that returns the derivatives (n,) of the logarithm of the stress by the
    dimensions, 1/m.
    guess: estimate of the derivatives by the logarithms of the dimensions, until they are known.
    added_slopes: terms to be added to the derivatives by the logarithms of the dimensions.
    """

    name: str
    case: str
    stress: float
    slopes: Callable[[], Floats]
    guess: Floats | None = None
    added_slopes: Floats | float = 0.0


def no_slopes() -> Floats:
    """Return an empty array, for parts whose derivatives are not needed."""
    return np.zeros(0)


def parts_in_lugs(
    before: Study, study: Study, task: Task, solution: Solution, dimensions: tuple[Dimension, ...]
) -> list[RowPart]:
    """Return the surface and the sections of a row in contact; before: the study as given."""
    case = solution.peak.case
    return [
        RowPart(
            f"{case}, {place}", case, stress,
            partial(by_contact, before, study, (task, solution, place), dimensions),
        )
        for place, stress in surface_and_section(solution.peak)
        if stress
    ]  # fmt: skip


@dataclass(frozen=True)
class SizedRow:
    """A row of a body of revolution without lugs; requirement: requirements on its solution."""

    shape: VariedShape
    requirement: Requirement
    task: Task
    solution: Solution

    def parts(self, dimensions: tuple[Dimension, ...], of: PartsOfSection) -> list[RowPart]:
        """Return the sections and both halves of each segment, or a single part if a beam solved
        the row.

        of: reads the parts on the mesh.
        """
        peak, answer = self.solution.peak, self.solution.answer
        if not isinstance(answer, HarmonicField):
            return [RowPart(peak.case, peak.case, peak.upper_end, partial(self._whole, dimensions))]
        solved, loads = self._solved(answer), self.solution.loads
        masks = halves(solved.pin.stations, answer.fields.points)
        tops = of.tops(solved, loads, masks)
        ends = dict(surface_and_section(peak))
        times = ends["surface"] / max(top.top.value for top in tops)

        def slopes(top: PartTop, mask: Mask) -> Floats:
            return of.slopes(solved, loads, top, mask) / top.top.value

        section = []
        if stress := ends.get("section"):
            by = partial(self._of_section, solved, dimensions)
            name, added = f"{peak.case}, section", self._by_clamps(stress)
            section = [RowPart(name, peak.case, stress, by, added_slopes=added)]
        named = {name: (mask, k // 2) for k, (name, mask) in enumerate(masks)}
        return section + [
            RowPart(
                f"{peak.case}, {top.part}",
                peak.case,
                times * top.top.value,
                partial(slopes, top, named[top.part][0]),
                DIAMETER_EXPONENT * self.shape.part_of_diameter(named[top.part][1]),
            )
            for top in tops
            if top.top.value > 0.0
        ]

    def _solved(self, answer: HarmonicField) -> SolvedCase:
        """Return the row on its mesh, with the zones that give the upper end of the reported
        range.
        """
        peak, zones = self.solution.peak, answer.singularities
        if peak.verdict != "converged" and peak.interval is not None:
            zones = tuple(zone.varied(min(DISTANCE_VARIATIONS)) for zone in zones)
        task, pin = self.task, body_of_revolution(self.task.pin)
        assert pin is not None  # others are not differentiated
        clamps = tuple(pin.surface(name) for name in task.clamps)
        return SolvedCase(pin, task.material, clamps, self.solution.loads, answer.solution, zones)

    def _whole(self, dimensions: tuple[Dimension, ...]) -> Floats:
        """Return the derivatives of the row's maximum."""
        derivatives = differentiated(self.requirement, self.task, self.solution, dimensions)
        if derivatives is None:
            raise SolveError("no derivatives", "no-derivatives")
        return _relative(derivatives, dimensions)

    def _of_section(self, solved: SolvedCase, dimensions: tuple[Dimension, ...]) -> Floats:
        """Return the relative derivatives of the largest section stress, at its instant."""
        places, loads = self.solution.peak.places, self.solution.loads
        assert places is not None
        assert places.section is not None
        times, now = loads.times, places.section.time
        instant = 0 if times is None or now is None else int(np.abs(times - now).argmin())
        at = replace(solved, loads=loads.at(np.array([instant])), history=None)
        return _relative(section_derivatives(at, dimensions), dimensions)

    def _by_clamps(self, stress: float) -> Floats | float:
        """Return the derivatives that the clamped-span error adds to those of the logarithm of the
        section stress.

        The error of a beam between two clamps is proportional to the largest diameter until it
        reaches its limit.
        """
        places = self.solution.peak.places
        place = places.section if places else None
        error = stress / place.max_von_mises - 1.0 if place and place.max_von_mises else 0.0
        if len(self.task.clamps) < 2 or error >= CLAMPED_SPAN_ERROR:
            return 0.0
        outer = [max(s.diameters) for s in self.shape.pin.segments]
        thickest = int(np.argmax(outer))
        return error / (1.0 + error) * self.shape.part_of_diameter(thickest)


def _relative(derivatives: Derivatives, dimensions: tuple[Dimension, ...]) -> Floats:
    """Return the derivatives of the logarithm of a maximum by the dimensions."""
    slope = np.array([derivatives.by_dimension.get(d.key, 0.0) for d in dimensions])
    return slope / derivatives.maximum
