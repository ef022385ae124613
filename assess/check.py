"""The interface of a strength check, and the decorator that makes one from a function.

    @check("mean shear", "Shigley, 8-12", kind="hand", takes="section forces")
    def mean_shear(text: CheckText, s: Situation) -> list[Margin]:
        stress = s.forces.mean_shear()
        return text.at_levels(s, stress.stress, WorstPlace(stress.at, stress.z, stress.time), ...)

A check is one file in assess.strength or assess.clauses, its line in assess.checks, and its test.
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

# From the utilisation of a place to the dimension that would just pass.
Passing = Callable[[float], WorkQuantity | None]
# From the number of a place to the work of the allowable there and its `Passing`.
Shown = Callable[[int], tuple[Work, Passing]]
Takes = Literal["results", "loads", "statics", "section forces"]
Scope = Literal["case", "pin"]
Rupture = Literal["shear", "bearing", "ultimate"]


class Check(Protocol):
    """One strength check, in one file. A check solves nothing: all expensive results (limit load,
    stress histories, contact) are in the situation and cached with the row.

    method: the name of the check as it is printed. clause: where the method is published. kind:
    what the check is based on (`Kind`). scope: whether the check is made for each load case, or
    once for all load cases of a pin (fatigue).
    takes: what must be known of the pin before the check can be made: "results" of the model, which
    any body has; "loads", a profile and the loads of its links; "statics", the loads on all bands;
    or "section forces". A check that takes section forces is made once with each way of finding
    them.
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
        """Return a margin for each place and level, or an empty list if the check does not apply.

        A key that the study lacks is reported in `Margin.needs`; no error is raised.
        """
        ...


@dataclass(frozen=True)
class WorstPlace:
    """The place and time of the largest demand: the band or segment by name, z (m), time (s)."""

    at: str = ""
    z: float | None = None
    time: float | None = None

    @staticmethod
    def at_band(band: Band, loads: PinLoads, instant: int) -> WorstPlace:
        """Return the middle of a band at an instant, which is given by its number in the loads."""
        times = loads.times
        return WorstPlace(band.name, band.middle, None if times is None else float(times[instant]))


@dataclass(frozen=True)
class CheckText:
    """The printed text of a check. Its methods make the margins that carry this text.

    level: the level at which the check is made; `at_levels` sets the level of its margins itself.
    dimension: of the demand. scatter: the scatter of the method against tests. omits: what the
    check does not cover.
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
        """Return the margin of a demand at a place; arguments as in `Margin`."""
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
        """Return the margins of one stress, Pa: against yield at limit load, and against rupture at
        ultimate load.

        strength: the stress at which the part yields, Pa; None where the material has no such
        value. ruptures: which strength of the material the stress reaches at rupture; None where
        this stress does not measure rupture, and only yield is checked. shown: the work of the
        stress, and the dimension that would just pass.
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
        """Return the margin with the highest utilisation among S places and T instants.

        demand: (T, S), at the instants of the loads. allowable: (S,). at: the names of the places.
        shown: the work of the allowable at each place, by the number of the place.
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
        """Return the margin with the highest utilisation among the stations of the section forces.

        demand: (T, S) with allowable (S,); S is the number of stations, or 1 for a check of the
        whole pin. note: is added to the basis. shown: as in `worst`.
        """
        forces = s.forces
        at = forces.labels if demand.shape[1] == len(forces.labels) else ("",)
        basis = "; ".join(x for x in (forces.basis, note) if x)
        return self._worst(s, forces.times, demand, allowable, at, basis, shown)

    def lacks(self, s: Situation, *needs: str) -> Margin:
        """Return the margin of a skipped check. needs: what is missing, as keys of the study."""
        factor = s.factors.at(self.level)
        margin = skipped(self.method, self.clause, self.kind, self.level, factor, ", ".join(needs))
        return replace(margin, omits=self.omits)


def _with_work(margin: Margin, work: Work, passing: Passing) -> Margin:
    return replace(margin, work=(work,), passing=passing(margin.used))


Make = Callable[[CheckText, Situation], Sequence[Margin]]


@dataclass(frozen=True, kw_only=True)
class FunctionCheck(CheckText):
    """A `Check` that is made by a function of its text and of a situation."""

    takes: Takes
    scope: Scope
    make: Make

    def __call__(self, s: Situation) -> Sequence[Margin]:
        """Return the margins in a situation, as `Check` describes."""
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
    """Return a decorator that makes a function a check; arguments as in `Check` and `CheckText`."""
    return lambda make: FunctionCheck(
        method, clause, kind, level, dimension, scatter, omits, takes=takes, scope=scope, make=make
    )
