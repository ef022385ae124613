"""Pins with cuts in their lugs: which cuts are in which lugs, and the error that is left there.

Contact sees cuts by whole cells (fea.support.contact.seen_cuts). A cell that is taken in part
presses with its force on what is left, of which the local solids put the part that would act on a
mouth on the band about it (fea.cut.lost_loads), and the peak of pressure at a mouth's edge is that
of a cell.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from fea.core.peak import Reason
from fea.core.verdict import Evidence
from geometry import CutPin
from geometry.shape.band_cuts import is_inside

# Relative error of the maximum of a pin with cuts in lugs by what contact does not see of them, by
# kind of cut. Tuned on contact of whole solids on the clevis of docs/lugs.md: at most 0.017 with a
# flat and three through holes under the pressure of the eye and across it, the flat also without
# clearance; 0.034 with three blind holes (the whole solids are right to 0.05). With six keyways,
# whose walls part a cell under pressure, the solids have 0.03 to 0.18 more than ours. A recess
# may be like these.
CUT_CONTACT_ERROR = {"flat": 0.03, "hole": 0.03, "slot": 0.25, "passage": 0.0, "recess": 0.25}


def cuts_in_lugs(cut: CutPin, lugs: Iterable[str]) -> dict[str, str]:
    """The lug, by its connection, that each cut in one opens into, by the cut's name."""
    ends = {name: (cut.profile.band(name).z0, cut.profile.band(name).z1) for name in lugs}
    return {
        name: lug
        for name, one in cut.cuts.items()
        for lug, (low, high) in ends.items()
        if is_inside(one, cut.profile, low, high)
    }


def error_of(places: Mapping[str, str]) -> float:
    """The relative error by contact at the cuts in some places: the largest of their kinds."""
    kinds = (name.split()[0] for name in places)
    return max((CUT_CONTACT_ERROR[kind] for kind in kinds), default=0.0)


def with_cuts_in_lugs(evidence: Evidence, places: Mapping[str, str]) -> Evidence:
    """The evidence with the error of contact at cuts among the parts of its error, and a remark.

    places: the lug of each cut (cuts_in_lugs).
    """
    if not places:
        return evidence
    where = ", ".join(f"{name} in lug {lug}" for name, lug in places.items())
    its = "its" if len(places) == 1 else "their"
    note = Reason(f"; {where}: pressure at {its} edges is not resolved", ("cut-in-lug",))
    return evidence.with_parts(model=error_of(places) * evidence.value).remarked(note)
