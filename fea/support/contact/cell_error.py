"""The error of stress from the cells of contact, by comparison with cells twice as large."""

from __future__ import annotations

from dataclasses import dataclass

from geometry.shape.rings import USUAL_RING_COUNT

# Fraction of the tolerance that the error of the cells may use. Chosen by judgement; the rest is
# for meshes and instants (MIN_TOLERANCE_SHARE of fea.core.requirement).
CELL_ERROR_SHARE = 0.6
# Orders of convergence in the length of cells: of the surface and beneath it, and of sections. They
# are tuned on the random pins of benchmarks/joints/cells.py: the error there is at most 0.52, 0.66
# and 0.25 of the change by cells twice as large, where that change is noticeable.
SURFACE_CELL_ORDER, SECTION_CELL_ORDER = 1.4, 2.0
# Products of the half angle of contact and the number of harmonics. Below the first, the harmonics
# do not follow the pressure around the pin. Below the second, the change by cells twice as large is
# itself the error.
MIN_HARMONICS_PER_ARC, MIN_HARMONICS_OF_ORDER = 6.0, 2.5
# Where the harmonics do not follow the pressure, the error is at least the first number (surface)
# or the second (beneath contact) over the square of that product, provided that cells twice as
# large change the stress by more than the third. Tuned on the four joints of
# benchmarks/joints/narrow_arcs.py: the surface of the worst is 164, 74, 25 and 15 % off where the
# product is 1.2, 1.9, 2.5 and 3.1, and the stress beneath contact 50, 17, 7 and 6 %.
UNRESOLVED_ARC_ERROR, UNRESOLVED_BENEATH_ERROR, NOTICED_CHANGE = 2.7, 0.8, 0.01
UNRESOLVED = {"surface": UNRESOLVED_ARC_ERROR, "beneath": UNRESOLVED_BENEATH_ERROR}
# Relative scatter of the stress beside lug edges with where rings happen to end, for the usual
# number of rings; it falls with more rings. Two sets of cells need not show this scatter. With it
# the estimate covers the error of all 24 pins of benchmarks/joints/cells.py
# (docs/measured/cells.md).
RING_SCATTER = 0.01
# Smallest relative error of cells larger than the usual ones. Two such sets can agree by chance: on
# pin D of the landing gear they agree to 2 %, while both are 4 to 5 % off.
MIN_CELL_ERROR = 0.06


@dataclass(frozen=True)
class AtPlaces:
    """Stress of the surface, of sections and beneath the contact, Pa; or their errors, relative."""

    surface: float
    section: float
    beneath: float

    @property
    def row(self) -> float:
        """The larger of surface and section."""
        return max(self.surface, self.section)

    def over(self, other: AtPlaces) -> tuple[float, float, float]:
        """The ratios of the row, the surface and the stress beneath contact to those of another; a
        value divided by zero is kept as it is.
        """
        pairs = ((getattr(self, x), getattr(other, x)) for x in ("row", "surface", "beneath"))
        row, surface, deep = (a / (b or 1.0) for a, b in pairs)
        return row, surface, deep


NOWHERE = AtPlaces(0.0, 0.0, 0.0)


def by_cells(stress: AtPlaces, coarse: AtPlaces, rings: int, per_arc: float) -> AtPlaces:
    """The relative error of the cells, from the stress on them and on cells twice as large.

    rings: number on a band with sharp edges (Resolution.rings).
    per_arc: number of harmonics that the cells follow, times the half angle of contact in rad.
    """
    # By Richardson's estimate the error is the change over (2^q - 1), where q is the order of
    # convergence in the length of cells. It has floors, since two sets can agree by chance.
    agreement_floor = MIN_CELL_ERROR * (rings < USUAL_RING_COUNT)
    surface_floor = max(RING_SCATTER * USUAL_RING_COUNT / rings, agreement_floor)

    def error(name: str, order: float, least: float) -> float:
        x, y = getattr(stress, name), getattr(coarse, name)
        if not (x and y):
            return 0.0
        change = float(abs(y / x - 1.0))
        if name != "section" and per_arc < MIN_HARMONICS_OF_ORDER:
            order = 1.0
        if name in UNRESOLVED and change > NOTICED_CHANGE:
            least = max(least, unresolved(per_arc, UNRESOLVED[name]))
        return float(max(change / (2.0**order - 1.0), least))

    return AtPlaces(
        error("surface", SURFACE_CELL_ORDER, surface_floor),
        error("section", SECTION_CELL_ORDER, agreement_floor),
        error("beneath", SURFACE_CELL_ORDER, surface_floor),
    )


def unresolved(per_arc: float, most: float = UNRESOLVED_ARC_ERROR) -> float:
    """The least relative error of a stress that depends on the pressure over an arc of contact; 0
    where the harmonics follow that pressure.

    per_arc: number of harmonics that the cells follow, times the half angle of contact in rad.
    most: the error where that product is one; by default that of the surface.
    """
    return most / per_arc**2 if per_arc < MIN_HARMONICS_PER_ARC else 0.0
