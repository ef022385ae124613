"""The face of a check of strength, and how a check is written as one function.

    @check("mean shear", "Shigley, 8-12", kind="hand", takes="section forces")
    def mean_shear(text: CheckText, s: Situation) -> list[Margin]:
        stress = s.forces.mean_shear()
        return text.at_levels(s, stress.stress, WorstPlace(stress.at, stress.z, stress.time), ...)

A check is one file here or in assess.strength, its line in assess.checks, and its test.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal, Protocol

from assess.margin import Kind, Level, Margin, skipped, strength_key
from assess.situation import Situation
from assess.work import Work, WorkQuantity
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from geometry import Band
from pinbase.arrays import Floats, first_largest

# By the number of a place: the work of the allowable there, and the dimension that would just pass,
# by the utilisation.
Passing = Callable[[float], WorkQuantity | None]
Shown = Callable[[int], tuple[Work, Passing]]
Takes = Literal["results", "loads", "statics", "section forces"]
Scope = Literal["case", "pin"]
Rupture = Literal["shear", "bearing", "ultimate"]


class Check(Protocol):
    """One check, in one file. It solves nothing: what is dear (limit load, histories, contact) is
    in the situation, and cached with the row.

    method: as printed. clause: where it is printed. kind: of what the check is made. scope: whether
    it is made of each case, or of all cases of a pin (fatigue).
    takes: what must be known of the pin for the check to be made at all: "results" of the model,
    which any body has; a profile and the "loads" of its links; the "statics", which are the loads
    on all bands; or "section forces", once for each way of finding these.
    """

    @property
    def method(self) -> str: ...
    @property
    def clause(self) -> str: ...
    @property
    def kind(self) -> Kind: ...
    @property
    def scope(self) -> Scope: ...
    @property
    def takes(self) -> Takes: ...

    def __call__(self, s: Situation) -> Sequence[Margin]:
        """A margin for each place and level. What the study lacks is `Margin.needs` (its key);
        nothing is raised. Empty: the check does not apply.
        """
        ...


@dataclass(frozen=True)
class WorstPlace:
    """The place and time of the largest demand: a band or segment, z there (m), and time (s)."""

    at: str = ""
    z: float | None = None
    time: float | None = None

    @staticmethod
    def at_band(band: Band, loads: PinLoads, instant: int) -> WorstPlace:
        """The middle of a band, at an instant of loads."""
        times = loads.times
        return WorstPlace(band.name, band.middle, None if times is None else float(times[instant]))


@dataclass(frozen=True)
class CheckText:
    """The text that is printed of a check, and the margins that carry it.

    level: at which the check is made, where `at_levels` does not make it at both. dimension: of its
    demand. scatter: of the method against tests. omits: what it does not cover.
    """

    method: str
    clause: str
    kind: Kind
    level: Level = "limit"
    dimension: str = "stress"
    scatter: str = ""
    omits: str = ""

    def margin(
        self,
        s: Situation,
        demand: float,
        allowable: float,
        place: WorstPlace,
        material: str = "",
        basis: str = "",
        work: tuple[Work, ...] = (),
        passing: WorkQuantity | None = None,
    ) -> Margin:
        """The margin of a demand at a place; arguments as in `Margin`."""
        return Margin(
            self.method, self.clause, self.kind, self.level, s.factors.at(self.level), demand,
            allowable, self.dimension, place.at, place.z, place.time, material, basis, work=work,
            passing=passing, scatter=self.scatter, omits=self.omits,
        )  # fmt: skip

    def at_levels(
        self,
        s: Situation,
        stress: float,
        place: WorstPlace,
        material: Material,
        strength: float | None,
        ruptures: Rupture | None = None,
        formula: str = "",
        basis: str = "",
        shown: tuple[Work, Passing] | None = None,
    ) -> list[Margin]:
        """One stress, Pa, against yield at limit load and against rupture at ultimate load.

        strength: that the stress reaches at yield, Pa. ruptures: the strength of the material that
        it reaches at rupture; None where it is no measure of that. shown: the work of the stress,
        and what would pass.
        """
        allowed: list[tuple[Level, str, float | None]] = [("limit", "yield", strength)]
        if ruptures is not None:
            allowed.append(("ultimate", ruptures, getattr(material, f"{ruptures}_strength")))
        margins = [
            Margin(
                self.method, self.clause, self.kind, level, s.factors.at(level), stress, allowable,
                at=place.at, z=place.z, time=place.time, material=material.name, basis=basis,
                formula=formula, omits=self.omits,
                needs=strength_key(material.name, which) if allowable is None else "",
            )
            for level, which, allowable in allowed
        ]  # fmt: skip
        return margins if shown is None else [_with_work(margin, *shown) for margin in margins]

    def worst(
        self,
        s: Situation,
        demand: Floats,
        allowable: Floats,
        at: tuple[str, ...],
        basis: str = "",
        shown: Shown | None = None,
    ) -> Margin:
        """The worst of demands (T, S) with allowables (S,) at S places, called `at`, at the
        instants of the loads. shown: the work of the allowable at a place, by its number.
        """
        return self._worst(s, s.loads.times, demand, allowable, at, basis, shown)

    def _worst(
        self,
        s: Situation,
        times: Floats | None,
        demand: Floats,
        allowable: Floats,
        at: tuple[str, ...],
        basis: str,
        shown: Shown | None,
    ) -> Margin:
        used = demand / allowable
        t, k = first_largest(used)
        place = WorstPlace(at[k], time=None if times is None else float(times[t]))
        margin = self.margin(s, float(demand[t, k]), float(allowable[k]), place, basis=basis)
        return margin if shown is None else _with_work(margin, *shown(k))

    def along(
        self,
        s: Situation,
        demand: Floats,
        allowable: Floats,
        note: str = "",
        shown: Shown | None = None,
    ) -> Margin:
        """The worst of demands (T, S) with allowables (S,) at the stations of the section forces,
        or at one place that stands for all. shown: as in `worst`.
        """
        forces = s.forces
        at = forces.labels if demand.shape[1] == len(forces.labels) else ("",)
        basis = "; ".join(x for x in (forces.basis, note) if x)
        return self._worst(s, forces.times, demand, allowable, at, basis, shown)

    def lacks(self, s: Situation, *needs: str) -> Margin:
        """The margin of the check where it is not made, for want of something."""
        factor = s.factors.at(self.level)
        margin = skipped(self.method, self.clause, self.kind, self.level, factor, ", ".join(needs))
        return replace(margin, omits=self.omits)


def _with_work(margin: Margin, work: Work, passing: Passing) -> Margin:
    return replace(margin, work=(work,), passing=passing(margin.used))


Make = Callable[[CheckText, Situation], Sequence[Margin]]


@dataclass(frozen=True, kw_only=True)
class FunctionCheck(CheckText):
    """A check that is a function of its own text and of a situation. It is a `Check`."""

    takes: Takes
    scope: Scope
    make: Make

    def __call__(self, s: Situation) -> Sequence[Margin]:
        """The margins in a situation, as `Check`."""
        return self.make(self, s)


def check(
    method: str,
    clause: str,
    *,
    kind: Kind,
    takes: Takes,
    level: Level = "limit",
    dimension: str = "stress",
    scope: Scope = "case",
    scatter: str = "",
    omits: str = "",
) -> Callable[[Make], FunctionCheck]:
    """A decorator that makes a check of a function; arguments as in `Check` and `CheckText`."""
    return lambda make: FunctionCheck(
        method, clause, kind, level, dimension, scatter, omits, takes=takes, scope=scope, make=make
    )
