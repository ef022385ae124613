"""The error of contact's cells, from the stress on them and on cells twice as large."""

from __future__ import annotations

from dataclasses import dataclass

from geometry.shape.rings import USUAL_RING_COUNT

# Of the tolerance: the part that the cells may use. Chosen by judgement; the rest is for meshes and
# instants (MIN_TOLERANCE_SHARE of fea.core.requirement).
CELL_ERROR_SHARE = 0.6
# Orders of the error in the length of cells, on the surface and beneath, and in sections. They are
# tuned on the random pins of benchmarks/joints/cells.py: the error there is 0.52, 0.66 and 0.25 at
# most of the change by cells twice as large, where that is noticed.
SURFACE_CELL_ORDER, SECTION_CELL_ORDER = 1.4, 2.0
# Half angle of contact times the harmonics, below which these do not follow the pressure around the
# pin, and below which the change by cells twice as large is itself the error.
MIN_HARMONICS_PER_ARC, MIN_HARMONICS_OF_ORDER = 6.0, 2.5
# Over the square of that product: the least error, where cells do not follow the pressure, of a
# surface and of what lies beneath, if they notice it by a change of more than the third number.
# Tuned on the four joints of benchmarks/joints/narrow_arcs.py: the surface of the worst is 164, 74,
# 25 and 15 % off where the product is 1.2, 1.9, 2.5 and 3.1, the stress beneath by 50, 17, 7 and 6.
UNRESOLVED_ARC_ERROR, UNRESOLVED_BENEATH_ERROR, NOTICED_CHANGE = 2.7, 0.8, 0.01
UNRESOLVED = {"surface": UNRESOLVED_ARC_ERROR, "beneath": UNRESOLVED_BENEATH_ERROR}
# Relative, of the usual number of rings, and less of more: the stress beside the edges of lugs
# scatters by this much with where rings happen to end, whatever two sets of cells show. With it the
# estimate covers the error of all 24 pins of benchmarks/joints/cells.py (docs/measured/cells.md).
RING_SCATTER = 0.01
# Relative, the least error of cells larger than the usual ones. Two such sets can agree by chance:
# on pin D of the landing gear to 2 %, while both are 4 to 5 % off.
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
        """The ratios of the row, the surface and what lies beneath to others; as they are where
        those are 0.
        """
        pairs = ((getattr(self, x), getattr(other, x)) for x in ("row", "surface", "beneath"))
        row, surface, deep = (a / (b or 1.0) for a, b in pairs)
        return row, surface, deep


NOWHERE = AtPlaces(0.0, 0.0, 0.0)


def by_cells(stress: AtPlaces, coarse: AtPlaces, rings: int, per_arc: float) -> AtPlaces:
    """The relative error of the cells, from the stress on them and on cells twice as large.

    per_arc: harmonics that they follow, times the half angle of contact in rad.
    """
    # Richardson's estimate: the error is the change over (2^q - 1), q being its order in the length
    # of cells. It has floors, since two sets of cells can agree by chance.
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
    """The least relative error of stress that an arc of contact governs, 0 where it is followed.

    per_arc: harmonics that the cells follow, times the half angle of contact in rad.
    most: of a place, where that product is one; by default of the surface.
    """
    return most / per_arc**2 if per_arc < MIN_HARMONICS_PER_ARC else 0.0
