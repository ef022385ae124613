"""The largest stress of a pin's sections over all instants of a case, with its error."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fea.core.over_time import Between, over_time
from fea.core.peak import ErrorParts
from fea.core.pin_loads import PinLoads
from fea.core.places import SectionPlace
from fea.section.section_stress import AtSection, SectionField

# Of stress by the forces of a contact, by the meshes of the flexibilities of pin and lugs: elements
# half as long change it by 0.0002 at most (benchmarks/joints/cells.py).
FLEXIBILITY_ERROR = 0.001


@dataclass(frozen=True)
class FoundSection:
    """The largest stress of sections, the parts of its error, Pa, and the loads at its instant."""

    at: AtSection
    parts: ErrorParts
    loads: PinLoads

    @property
    def time(self) -> float | None:
        """The time of the instant, s; None without a motion."""
        return self.loads.time()

    @property
    def lower_end(self) -> float:
        """The stress less its error, Pa."""
        return max(0.0, self.at.value - self.parts.total)

    @property
    def upper_end(self) -> float:
        """The stress plus its error, Pa."""
        return self.at.value + self.parts.total

    def known(self, tolerance: float) -> bool:
        """Return whether the error is within a tolerance, relative."""
        return self.parts.total <= tolerance * self.at.value

    def place(self, tolerance: float, used: float | None) -> SectionPlace:
        """The largest stress of sections as a place of the results.

        used: part of the fully plastic section that is used.
        """
        at = self.at
        return SectionPlace(
            at.value, self.parts.total, "converged" if self.known(tolerance) else "unconverged",
            at.z, self.time, at.axial_force, at.shear_force, at.bending_moment, abs(at.torque),
            used, at.course,
        )  # fmt: skip


def found_section(
    answer: SectionField,
    loads: PinLoads,
    between: Between | None,
    tolerance: float,
    cells: float | None = None,
) -> FoundSection:
    """The largest stress of sections over a case, also between its instants where it is a motion.

    cells: relative error from the contact cells that the forces come from; None where the forces
    are given. Statics alone gives those exactly; between two clamps they have the error of a beam.
    """
    loads, rise = over_time(answer, loads, between, tolerance)
    at = answer.place(loads)
    parts = ErrorParts(mesh=0.0, time=rise, model=answer.held_twice(at) * at.value)
    if cells is not None:
        parts = replace(parts, mesh=FLEXIBILITY_ERROR * at.value, cells=cells * at.value)
    return FoundSection(at, parts, loads.at(np.array([at.instant])))
