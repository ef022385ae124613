"""Pins with cuts inside lugs: which cuts are in which lugs, and the error of contact there.

Contact sees cuts by whole cells (fea.support.contact.seen_cuts). The force of a cell that is
removed in part acts on its remainder. Local solids move the pressure that would act on the mouth of
a cut to the band around it (fea.cut.lost_loads). The peak of pressure at the edge of a mouth is
resolved only by cells.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from fea.core.peak import Reason
from fea.core.verdict import Evidence
from geometry import CutPin
from geometry.shape.band_cuts import is_inside

# Relative error of the maximum of a pin with cuts in lugs, by kind of cut, since contact sees cuts
# only by cells. Tuned by contact of whole solids on the clevis of docs/lugs.md: at most 0.017 with
# a flat and three through holes under the pressure of the eye and across it, the flat also without
# clearance; 0.034 with three blind holes (the whole solids are accurate to 0.05). With six keyways,
# whose walls divide a cell under pressure, the solids give 0.03 to 0.18 more stress. A recess may
# be like keyways.
CUT_CONTACT_ERROR = {"flat": 0.03, "hole": 0.03, "slot": 0.25, "passage": 0.0, "recess": 0.25}


def cuts_in_lugs(cut: CutPin, lugs: Iterable[str]) -> dict[str, str]:
    """The connection of the lug into which each cut opens, by the cut's name, for cuts in lugs."""
    ends = {name: (cut.profile.band(name).z0, cut.profile.band(name).z1) for name in lugs}
    return {
        name: lug
        for name, one in cut.cuts.items()
        for lug, (low, high) in ends.items()
        if is_inside(one, cut.profile, low, high)
    }


def error_of(places: Mapping[str, str]) -> float:
    """The relative error of contact at cuts: the largest over the kinds of these cuts.

    places: the lug of each cut (cuts_in_lugs).
    """
    kinds = (name.split()[0] for name in places)
    return max((CUT_CONTACT_ERROR[kind] for kind in kinds), default=0.0)


def with_cuts_in_lugs(evidence: Evidence, places: Mapping[str, str]) -> Evidence:
    """The evidence with the error of contact at cuts as a part of its error, and with a remark.

    places: the lug of each cut (cuts_in_lugs).
    """
    if not places:
        return evidence
    where = ", ".join(f"{name} in lug {lug}" for name, lug in places.items())
    its = "its" if len(places) == 1 else "their"
    note = Reason(f"; {where}: pressure at {its} edges is not resolved", ("cut-in-lug",))
    return evidence.with_parts(model=error_of(places) * evidence.value).remarked(note)
