"""The parts of a pin's joint that let go first: the load factors at which they yield, fail or
collapse.

A load factor multiplies all loads of the case. The load factor of a check is its allowable over its
demand. A demand that comes from contact with a clearance or with rounded edges does not grow in
proportion to the loads; the step then says so. Where a press fit stresses the part without any
load, this ratio is no load factor, and none is given.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from math import inf, isclose

from assess.margin import CUTS_NEEDED, JOINT_MODEL_BASIS, Margin
from assess.strength.lug_stress import METHOD as LUG_METHOD
from assess.strength.model_stress import CLAUSE, YIELD_METHOD
from assess.strength.press_fit import METHOD as PRESS_FIT_METHOD
from fea.support.records import LugStress
from pinbase.rounding import without_round_off
from reports.data.decision import factor_ends, worst_first
from reports.data.results import PinShape, Results
from reports.data.row import PinResult

LOCAL, YIELDS, PLASTIC = "begins to yield locally", "begins to yield", "is fully plastic"
COLLAPSES, ALLOWED = "collapses", "reaches what the clause allows"
BY_FORMULA = {"limit": "yields by formula", "ultimate": "ruptures by formula"}
ELASTIC_RUPTURE = "reaches the ultimate strength (elastic stress)"
UNDER_EDGE = "pin under the edge of a lug"
LIMIT_LOAD_NEED = 'analysis.limit_load = "always"'
PRESS_FIT_NEED = "a run at the larger loads, because a press fit stresses it without any"
SHARP_EDGE_NEED = "edge_radius of its lugs, because pressure has no bound at a sharp edge"
WALLS = {"bore": "bore of the lug", "bushing": "bushing", "hole": "hole of the lug"}
IN_LUG = (*WALLS.values(), LUG_METHOD)  # beginnings of the names of steps of a lug
SAME_FACTOR = 1e-3  # relative difference of load factors of places that share a step


@dataclass(frozen=True)
class LettingGo:
    """A part that lets go, and the factor on all loads of the case at which it does.

    what: the part or the check.
    at: its bands or segments.
    effect: what happens to the part.
    load_factor: None where it is not known.
    low, high: the ends of the load factor by the error of a stress, or by the bracket of a limit
    load.
    required: the factor that is required; None where none is.
    in_proportion: whether the demand grows in proportion to the loads; otherwise the factor assumes
    that it does.
    needs: what is missing for a load factor.
    """

    what: str
    at: str
    effect: str
    load_factor: float | None = None
    low: float | None = None
    high: float | None = None
    required: float | None = None
    in_proportion: bool = True
    clause: str = ""
    needs: str = ""

    @property
    def rank(self) -> float:
        """The load factor for sorting; steps without one come last."""
        return inf if self.load_factor is None else without_round_off(self.load_factor)

    @property
    def missed(self) -> bool:
        """Whether the part lets go before the required factor."""
        least = self.load_factor if self.low is None else self.low
        return None not in (least, self.required) and least < self.required  # type: ignore[operator]


@dataclass(frozen=True)
class PinSteps:
    """The steps of a pin in its governing case, in the order in which its parts let go.

    Steps without a load factor come last.
    """

    row: PinResult
    steps: tuple[LettingGo, ...]

    @property
    def known(self) -> tuple[LettingGo, ...]:
        """The steps with a load factor."""
        return tuple(step for step in self.steps if step.load_factor is not None)

    @property
    def unknown(self) -> tuple[LettingGo, ...]:
        """The steps without a load factor."""
        return tuple(step for step in self.steps if step.load_factor is None)


def lets_go(results: Results) -> list[PinSteps]:
    """Return the steps of every pin that was solved, in its governing case."""
    worst = {row.pin: row for row in reversed(worst_first(results))}
    shapes = {shape.pin: shape for shape in results.shapes}
    rows = [worst[pin] for pin in dict.fromkeys(row.pin for row in results.pins)]
    return [
        PinSteps(row, tuple(steps(row, shapes.get(row.pin)))) for row in rows if row.max_von_mises
    ]


def steps(row: PinResult, shape: PinShape | None) -> list[LettingGo]:
    """Return the steps of a row, the first to let go first."""
    joint = _Joint.of(row, shape)
    raw = [*_of_pin(row), *_of_lugs(row), *_of_margins(row)]
    merged = [*_merged(joint.judged(raw)), *_not_computed(row, joint)]
    return sorted(merged, key=lambda step: step.rank)


@dataclass(frozen=True)
class _Joint:
    """The way in which the stress of a pin in its lugs depends on the loads.

    solved: whether the joint was solved.
    proportional: whether contact grows in proportion to the loads: without clearance and with sharp
    edges.
    pressed: whether the pin is pressed into a lug.
    bushed: lugs with a pressed-in bushing, which stresses only the lug and the bushing.
    structure: lugs whose force is known only from the joint.
    """

    solved: bool
    proportional: bool
    pressed: bool
    bushed: frozenset[str]
    structure: frozenset[str]

    @staticmethod
    def of(row: PinResult, shape: PinShape | None) -> _Joint:
        lugs = shape.lugs if shape and row.joint and row.joint.bands else ()
        links = {label for *_, label, kind in shape.segments if kind == "band"} if shape else ()
        return _Joint(
            bool(lugs),
            all(lug.clearance == lug.edge_radius == 0.0 for lug in lugs),
            any(lug.clearance < 0.0 for lug in lugs),
            frozenset(lug.connection for lug in lugs if lug.interference > 0.0),
            frozenset(lug.connection for lug in lugs).difference(links),
        )

    def judged(self, steps: Iterable[tuple[LettingGo, bool]]) -> Iterator[LettingGo]:
        """Yield the steps with the effect of the joint on them.

        steps: each with whether its demand comes from the model of the joint.
        """
        for step, of_joint in steps:
            if not (of_joint and self.solved) and step.at not in self.structure:
                yield step
            elif self.pressed or (step.at in self.bushed and step.what.startswith(IN_LUG)):
                yield replace(step, load_factor=None, low=None, high=None, needs=PRESS_FIT_NEED)
            else:
                yield replace(step, in_proportion=self.proportional)


def _of_pin(row: PinResult) -> Iterator[tuple[LettingGo, bool]]:
    """Yield the steps of the surface, the section and the core of the pin, and of its material
    beneath contact and under the edges of lugs. Each comes with True: its stress is that of the
    joint.
    """
    strength, required = row.yield_strength, _required(row)
    if not strength:
        return
    places = row.places
    if places is None:
        low, high = factor_ends(row)
        step = LettingGo("pin", "", LOCAL, row.safety_factor, low, high, required, clause=CLAUSE)
        yield step, True
        return
    surface, outside = places.surface, places.surface.strength or strength
    at_surface = _of_stress(surface.max_von_mises, surface.error_estimate, outside)
    if row.safety_factor_interval and places.governs == "surface":
        at_surface = row.safety_factor or 0.0, *factor_ends(row)
    yield LettingGo("surface of the pin", "", LOCAL, *at_surface, required, clause=CLAUSE), True
    if (section := places.section) is not None and section.max_von_mises:
        there = section.strength or strength
        ends = _of_stress(section.max_von_mises, section.error_estimate, there)
        yield LettingGo("section of the pin", "", YIELDS, *ends, required, clause=CLAUSE), True
        if section.plastic_utilisation:
            factor = 1.0 / section.plastic_utilisation
            yield LettingGo("section of the pin", "", PLASTIC, factor), True
    for part in (x for x in places.hardened if x.part == "core"):
        ends = _of_stress(part.max_von_mises, part.error_estimate, part.strength)
        yield LettingGo("core of the pin", "", LOCAL, *ends, required, clause=CLAUSE), True
    if (contact := places.contact) is None:
        return
    if contact.beneath:
        there = contact.strength or strength
        ends = _of_stress(contact.beneath, contact.beneath_error, there)
        yield LettingGo("pin beneath the contact", "", LOCAL, *ends, required, clause=CLAUSE), True
    at_edges: dict[str, float] = {}
    for edge in contact.edges:
        at_edges[edge.band] = max(at_edges.get(edge.band, 0.0), edge.max_von_mises or 0.0)
    for band, stress in at_edges.items():
        if stress > 0.0:
            yield LettingGo(UNDER_EDGE, band, LOCAL, outside / stress), True


def _of_lugs(row: PinResult) -> Iterator[tuple[LettingGo, bool]]:
    """Yield the steps of lugs and bushings that yield at their bores."""
    for stress in row.joint.lugs if row.joint else ():
        if stress.yield_strength and stress.max_von_mises:
            ends = _of_stress(stress.max_von_mises, stress.error_estimate, stress.yield_strength)
            required = _required(row) if stress.place != "beneath" else None
            what, at = _wall(stress), stress.connection
            yield LettingGo(what, at, LOCAL, *ends, required, clause=CLAUSE), True


def _wall(stress: LugStress) -> str:
    part = WALLS[stress.wall]
    return f"{part}, {'free side' if stress.place == 'free' else 'where it is pressed'}"


def _of_margins(row: PinResult) -> Iterator[tuple[LettingGo, bool]]:
    """Yield the checks that count, at each of their places, without yield by the stress of the
    models, which has steps already.
    """
    for m in row.margins:
        factor = m.safety_factor
        by_model = m.method == YIELD_METHOD or (
            m.method.startswith(LUG_METHOD) and m.level == "limit"
        )
        without_load = m.kind == "fatigue" or m.method.startswith(PRESS_FIT_METHOD)
        if factor is None or by_model or not m.governs or without_load:
            continue
        if m.omits_cuts:  # the pin lets go earlier at its cuts
            yield _unknown(m, CUTS_NEEDED), False
            continue
        high = None
        if m.kind == "collapse" and row.limit_load and m.dimension == "1":
            high = row.limit_load.upper
        elif m.kind == "collapse":
            high = next((factor * x.upper / x.lower for x in row.lug_collapses
                         if x.connection == m.at and x.upper and x.lower), None)  # fmt: skip
        ends = factor, factor if high else None, high
        step = LettingGo(m.method, m.at, _effect(m), *ends, m.factor, clause=m.clause)
        yield step, m.kind == "model" or m.basis.startswith(JOINT_MODEL_BASIS)


def _unknown(m: Margin, needs: str) -> LettingGo:
    """Return a check without a load factor. needs: what is missing for one."""
    return LettingGo(m.method, m.at, _effect(m), required=m.factor, clause=m.clause, needs=needs)


def _effect(m: Margin) -> str:
    if m.kind == "collapse":
        return COLLAPSES
    if m.kind == "model":
        return ELASTIC_RUPTURE if m.level == "ultimate" else LOCAL
    return BY_FORMULA[m.level] if m.kind == "hand" else ALLOWED


def _not_computed(row: PinResult, joint: _Joint) -> Iterator[LettingGo]:
    """Yield the steps without a load factor, with what is missing for each."""
    for m in row.worst:
        if m.needs and m.governs:
            yield _unknown(m, m.needs)
    if row.limit_load is None and row.yield_strength:
        yield LettingGo("limit load of the pin", "", COLLAPSES, needs=LIMIT_LOAD_NEED)
    if joint.solved and not row.lug_collapses:
        yield LettingGo("limit load of the lugs", "", COLLAPSES, needs=LIMIT_LOAD_NEED)
    edges = row.places.contact.edges if row.places and row.places.contact else ()
    sharp = dict.fromkeys(edge.band for edge in edges if edge.max_von_mises is None)
    if sharp:
        at = ", ".join(sharp)
        yield LettingGo(UNDER_EDGE, at, LOCAL, needs=SHARP_EDGE_NEED)


def _required(row: PinResult) -> float | None:
    """Return the safety factor that is required against yield."""
    return next((m.factor for m in row.margins if m.method == YIELD_METHOD), row.required)


def _of_stress(stress: float, error: float | None, strength: float) -> tuple[float, float, float]:
    """Return the load factor at which a stress reaches a strength, and its ends by the error."""
    error = error or 0.0
    least = stress - error
    return strength / stress, strength / (stress + error), strength / least if least > 0.0 else inf


def _merged(steps: Iterable[LettingGo]) -> list[LettingGo]:
    """Return the steps with those of the same kind and load at several places merged into one.

    A merged step has the outer ends of all.
    """
    merged: list[LettingGo] = []
    for step in steps:
        for k, other in enumerate(merged):
            if _alike(step, other):
                at = ", ".join(dict.fromkeys([*other.at.split(", "), step.at]))
                merged[k] = replace(_outer(other, step), at=at)
                break
        else:
            merged.append(step)
    return merged


def _outer(a: LettingGo, b: LettingGo) -> LettingGo:
    """Return the earlier of two steps, with the outer ends of both."""
    first = min(a, b, key=lambda step: step.rank)
    lows, highs = (
        [x for x in ends if x is not None] for ends in ((a.low, b.low), (a.high, b.high))
    )
    return replace(first, low=min(lows, default=None), high=max(highs, default=None))


def _alike(a: LettingGo, b: LettingGo) -> bool:
    kinds = ((x.what, x.effect, x.needs, x.required, x.in_proportion) for x in (a, b))
    if next(kinds) != next(kinds) or not (a.at and b.at):
        return False
    x, y = a.load_factor, b.load_factor
    return x is y is None or (None not in (x, y) and isclose(x, y, rel_tol=SAME_FACTOR))  # type: ignore[arg-type]
