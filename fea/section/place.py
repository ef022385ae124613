"""The largest stress of a pin's sections over all instants of a load case, with its error."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fea.core.over_time import Between, over_time
from fea.core.peak import ErrorParts
from fea.core.pin_loads import PinLoads
from fea.core.places import SectionPlace
from fea.section.section_stress import AtSection, SectionField

# Relative error of the stress in contact from the meshes on which flexibilities are computed.
# Elements half as long change the stress by at most 0.0002 (benchmarks/joints/cells.py).
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
        """The stress minus its error, Pa."""
        return max(0.0, self.at.value - self.parts.total)

    @property
    def upper_end(self) -> float:
        """The stress plus its error, Pa."""
        return self.at.value + self.parts.total

    def known(self, tolerance: float) -> bool:
        """Return whether the error is within a relative tolerance."""
        return self.parts.total <= tolerance * self.at.value

    def place(self, tolerance: float, used: float | None) -> SectionPlace:
        """The largest stress of sections in the form of results.

        used: fraction of the fully plastic resistance that is used.
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
    """The largest stress of sections over a case; for a motion also between its instants.

    cells: relative error from the cells of contact, if contact gives the forces; None where the
    forces are given. Statics determines given forces exactly, except between two clamps, where they
    have the error of a beam.
    """
    loads, rise = over_time(answer, loads, between, tolerance)
    at = answer.place(loads)
    parts = ErrorParts(mesh=0.0, time=rise, model=answer.error_between_clamps(at) * at.value)
    if cells is not None:
        parts = replace(parts, mesh=FLEXIBILITY_ERROR * at.value, cells=cells * at.value)
    return FoundSection(at, parts, loads.at(np.array([at.instant])))
