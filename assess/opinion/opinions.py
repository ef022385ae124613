"""CalculiX's results for a pin in one load case, compared with our own."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from fea.support.records import Couple, LineLoad
from pinbase.dimensions import Length, Stress

MAX_DISPLACEMENT_DIFFERENCE = 1e-5  # relative to the largest; CalculiX prints 7 digits
MAX_STRESS_DIFFERENCE = 1e-4  # relative to the largest; CalculiX prints 6 digits of each component
# Allowed deviation from the run's answer, in addition to its error. The first mesh of the solid
# model deviates at a fillet or where a singularity ends (at most 22 % in studies/grenier2008.toml),
# so this limit only detects gross mistakes.
MAX_MAXIMUM_DIFFERENCE = 0.30
# Limits for contact with lugs, on meshes that CalculiX solves in minutes: on random joints moments
# differ by at most 3.5 % and loads by at most 6 %.
MAX_MOMENT_DIFFERENCE, MAX_LOAD_DIFFERENCE = 0.05, 0.10


@dataclass(frozen=True)
class BandOpinion:
    """The load per length along a band, in the direction of its total force, ours and CalculiX's.

    ends: the ends of the parts of the band. ours, theirs: the mean load per length over each part.
    """

    name: str
    ends: tuple[Length, ...]
    ours: tuple[LineLoad, ...]
    theirs: tuple[LineLoad, ...]

    @property
    def elsewhere(self) -> float:
        """The fraction of the load that the two programs place in different parts of the band."""
        lengths = [b - a for a, b in zip(self.ends, self.ends[1:], strict=False)]
        rows = list(zip(self.ours, self.theirs, lengths, strict=True))
        whole = sum(abs(theirs) * length for _, theirs, length in rows)
        return sum(abs(ours - theirs) * length for ours, theirs, length in rows) / whole / 2.0


@dataclass(frozen=True)
class ContactOpinion:
    """The comparison of the contact with lugs.

    our_moment, moment: the largest bending moment, ours and CalculiX's.
    bands: the loaded bands.
    coarser: unknowns of CalculiX's coarser mesh.
    moment_change, stress_change: relative change of CalculiX's results from the coarser to the
    finer mesh.
    tension: whether CalculiX found tension in the contact and repeated the contact search.
    """

    bands: tuple[BandOpinion, ...]
    our_moment: Couple
    moment: Couple
    coarser: int
    moment_change: float
    stress_change: float
    tension: bool = False

    @property
    def moment_difference(self) -> float:
        """The relative difference of CalculiX's largest bending moment from ours."""
        return self.moment / self.our_moment - 1.0

    @property
    def elsewhere(self) -> float:
        """The largest `elsewhere` of all bands."""
        return max((band.elsewhere for band in self.bands), default=0.0)


@dataclass(frozen=True)
class Opinion:
    """The opinion on one pin in one load case: both programs on one mesh of `unknowns`, and the
    answer of the run.

    displacement, stress: largest differences, relative to the largest displacement and von Mises
    stress.
    ours, theirs: largest von Mises stress outside the singular zones, averaged at the nodes in both
    programs, Pa.
    answer, error: maximum and error of the run, Pa.
    failure: the reason why there is no comparison, or empty.
    contact: the comparison of a pin in its lugs, which CalculiX solves on its own mesh of
    `unknowns`; `theirs` is then CalculiX's stress at the point of our maximum.
    """

    pin: str
    case: str
    answer: Stress | None
    error: Stress | None
    unknowns: int = 0
    displacement: float | None = None
    stress: float | None = None
    ours: Stress | None = None
    theirs: Stress | None = None
    failure: str = ""
    contact: ContactOpinion | None = None

    @property
    def deviation(self) -> float | None:
        """The relative deviation of CalculiX's maximum from the run's answer."""
        if self.theirs is None or not self.answer:
            return None
        return self.theirs / self.answer - 1.0

    @property
    def own_error(self) -> float:
        """The relative error of the run's answer."""
        return (self.error or 0.0) / self.answer if self.answer else 0.0

    @property
    def complaint(self) -> str:
        """The differences beyond their limits, in words, or the failure; empty if both programs
        agree.
        """
        said = self._contact() if self.contact else self._same_mesh()
        return self.failure or "; ".join(said)

    def _same_mesh(self) -> Iterator[str]:
        for what, value, limit in (
            ("displacements", self.displacement, MAX_DISPLACEMENT_DIFFERENCE),
            ("von Mises stresses", self.stress, MAX_STRESS_DIFFERENCE),
        ):
            if value is None or not value <= limit:
                yield f"{what} on the same mesh differ by {value:.1e}, allowed {limit:.0e}"
        yield from _beyond(
            "its maximum is", self.deviation, MAX_MAXIMUM_DIFFERENCE + self.own_error
        )

    def _contact(self) -> Iterator[str]:
        assert self.contact is not None
        limit = MAX_MOMENT_DIFFERENCE + self.own_error
        yield from _beyond("its largest bending moment is", self.contact.moment_difference, limit)
        yield from _beyond(
            "its stress at the point of our maximum is",
            self.deviation,
            MAX_MAXIMUM_DIFFERENCE + self.own_error,
        )
        for band in self.contact.bands:
            if not band.elsewhere <= MAX_LOAD_DIFFERENCE:
                yield (
                    f"{band.elsewhere:.1%} of the load of {band.name} acts at other places, "
                    f"allowed {MAX_LOAD_DIFFERENCE:.0%}"
                )


def _beyond(what: str, difference: float | None, limit: float) -> Iterator[str]:
    if difference is not None and not abs(difference) <= limit:
        yield f"{what} {difference:+.1%} from the answer, allowed {limit:.1%}"
