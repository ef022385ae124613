"""The results of a study with other numbers: a row for each of its pins in each of its cases.

A design is solved as a run solves a study, so `pinstress run` of the changed study finds the same
rows. Parts that do not change from one design to the next are not solved again: loads that depend
on no changed number, pins whose shape, material and loads are those of an earlier design, and the
unit loads of a pin that only loads or strength change.
"""

from __future__ import annotations

import hashlib
import re
from collections import OrderedDict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Generic, TypeVar

from assess.judgement import NOT_DECIDED
from fea.core.material import Material
from fea.core.peak import Maximum, Verdict
from fea.core.requirement import Requirement
from fea.support.lugs.lug import Lug
from geometry import ArgumentError
from loads import Linkage
from pinbase.memo import Memo
from pinbase.records import pack
from pinstress.analysis.plan import prepare, requirement_of
from pinstress.analysis.solve import solutions
from pinstress.analysis.stored import shape_of
from pinstress.explore.sweep.laws import Floats
from pinstress.explore.sweep.number import Number
from pinstress.explore.sweep.outcomes import bare_row, judged_row, outcome_words, stress_at
from pinstress.explore.sweep.parameters import Parameter
from pinstress.study.model.cases import CaseLoads, case_loads
from pinstress.study.model.impulses import ImpulseLoads
from pinstress.study.model.mechanism.linkage import determined, linkage
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.model.requirements import required_factor, required_factors
from pinstress.study.model.tasks import Task, tasks
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study, raw_study, with_raw, with_value
from reports.data.results import PinResult

MAX_MESHES_SIZE = 2 * 10**8  # bytes of meshes and fields in each of perhaps many processes
MAX_REMEMBERED_LOADS, MAX_REMEMBERED_ROWS = 64, 4096  # that are remembered, loads of each case
# Of which loads do not depend
TABLES_WITHOUT_LOADS = ("pin", "lug_defaults", "material", "analysis")
IGNORED_TABLES = ("vary", "published", "beam_check", "motion_check", "report")

K = TypeVar("K")
V = TypeVar("V")


@dataclass(frozen=True)
class DesignRow:
    """One pin in one case of a design, in SI.

    max_von_mises, error_estimate: Pa, None where there is no maximum (verdict `failed` or `rigid`).
    governing_time: s, None without a motion.
    mass: kg, None without a density.
    reason, code: why the verdict is not `converged`, for people and for programs.
    outcome, depends_on: as in a run (pinstress.explore.sweep.outcomes).
    governs: "surface" or "section", empty where the model has no places.
    surface, section, beneath, beneath_error: largest stresses and the last one's error, Pa; None
    where there is none.
    """

    pin: str
    case: str
    max_von_mises: float | None
    error_estimate: float | None
    safety_factor: float | None
    verdict: Verdict
    governing_time: float | None = None
    mass: float | None = None
    reason: str = ""
    code: str = ""
    outcome: str = NOT_DECIDED
    depends_on: str = ""
    governs: str = ""
    surface: float | None = None
    section: float | None = None
    beneath: float | None = None
    beneath_error: float | None = None


def rows_without_maximum(
    table: Iterable[tuple[str, str]], reason: str, code: str
) -> list[DesignRow]:
    """Return the rows of a design that nothing is known of.

    table: their pins and cases.
    """
    return [
        DesignRow(pin, case, None, None, None, "failed", reason=reason, code=code)
        for pin, case in table
    ]


class Recent(Generic[K, V]):
    """A memory of the values of the latest keys, at most `most` of them."""

    def __init__(self, most: int) -> None:
        self._most, self._known = most, OrderedDict[K, V]()

    def get(self, key: K) -> V | None:
        """Return the value of a key, if it is remembered."""
        if key in self._known:
            self._known.move_to_end(key)
        return self._known.get(key)

    def put(self, key: K, value: V) -> V:
        """Remember a value."""
        self._known[key] = value
        if len(self._known) > self._most:
            self._known.popitem(last=False)
        return value


class Evaluator:
    """A study whose numbers change.

    pins, cases: names; all by default.
    parameters: in the order of the values of `rows`.
    table: the (pin, case) of a design's rows, in their order.
    memo: of meshes, unit fields and flexibilities of its pins.
    files: those that the study names, as far as the creator noted them
    (pinstress.explore.sweep.batches).

    Raises: InputError where the study as it is cannot be run.
    """

    def __init__(
        self,
        study: Study,
        parameters: Iterable[Parameter | Number],
        pins: Iterable[str] | None = None,
        cases: Iterable[str] | None = None,
    ) -> None:
        self.numbers = tuple(p.number if isinstance(p, Parameter) else p for p in parameters)
        self._raw = {k: v for k, v in raw_study(study).items() if k not in IGNORED_TABLES}
        self.study = with_raw(study, self._raw)
        plan = prepare(self.study, pins=pins, cases=cases)
        self.files: tuple[Path, ...] = ()
        self._memory = (
            plan.requirement.memory
        )  # free when it began: to ask again takes a millisecond
        self._cases = tuple(plan.loads)
        rows = {(t.pin.name, case.case): None for t in plan.tasks for case in t.loads}
        self._pins = tuple(dict.fromkeys(pin for pin, _ in rows))
        self.table = tuple(
            (pin, case) for pin in self._pins for case in self._cases if (pin, case) in rows
        )
        self._loads = Recent[tuple[object, ...], CaseLoads | InputError](
            MAX_REMEMBERED_LOADS * len(self._cases)
        )
        self.memo = Memo(MAX_MESHES_SIZE)
        self._rows = Recent[str, tuple[PinResult, ...]](MAX_REMEMBERED_ROWS)
        self._of_loads = {
            case: [k for k, number in enumerate(self.numbers) if self._moves(number, case)]
            for case in self._cases
        }

    def rows(self, values: Sequence[float] | Floats) -> list[DesignRow]:
        """Return the rows of a design, one for each of `table`.

        values: of the parameters (p,), SI.
        """
        numbers = [float(value) for value in values]
        try:
            study = self.changed(numbers)
            loads = self.loads_of(study, numbers)
        except (InputError, MemoryError) as error:
            return [_failed(self.study, pin, case, error) for pin, case in self.table]
        rows: dict[tuple[str, str], DesignRow] = {}
        for pin in self._pins:
            cases = [case for name, case in self.table if name == pin]
            rows |= {(pin, case): row for case, row in self._of_pin(study, pin, cases, loads)}
        return [rows[key] for key in self.table]

    def changed(self, values: Sequence[float]) -> Study:
        """Return the study with other values (SI) of its numbers.

        Raises: InputError.
        """
        raw = self._raw
        for number, value in zip(self.numbers, values, strict=True):
            for path in number.paths:
                raw = with_value(raw, path, number.in_study(value / number.factor))
        return with_raw(self.study, raw)

    def _moves(self, number: Number, case: str) -> bool:
        """Return whether the loads of a case depend on a number.

        They depend on numbers of the mechanism, of the case and of cases that it names, and on
        those that give mass to floating pins.
        """
        table, *inner = number.path
        if table == "case":
            table_of_case = self._raw["case"].get(case)  # None of a case of a table with many
            return table_of_case is None or inner[0] == case or _names(table_of_case, str(inner[0]))
        if table not in TABLES_WITHOUT_LOADS:
            return True
        study, mechanism = self.study.table, self.study.table.mechanism
        if mechanism is None or table in ("lug_defaults", "analysis"):
            return False
        free = [
            name
            for name, joint in mechanism.joint.items()
            if name in study.pin and joint.fixed_in is None and joint.weight is None
        ]
        if table == "pin":
            return inner[0] in free
        return inner[-1] == "density" and any(study.pin[x].material == inner[0] for x in free)

    def loads_of(self, study: Study, values: Sequence[float]) -> dict[str, CaseLoads | InputError]:
        """Return the loads of a design by case, or why a case has none.

        study: with the values (p,) of the parameters, SI.
        """
        loads: dict[str, CaseLoads | InputError] = {}
        mechanism: Linkage | None = None
        for name in self._cases:
            key = name, *(values[k] for k in self._of_loads[name])
            known = self._loads.get(key)
            if known is None:
                if mechanism is None and study.table.mechanism:
                    mechanism = linkage(study)
                    determined(study, mechanism)
                try:
                    known = case_loads(study, name, mechanism)
                except InputError as error:
                    known = error
                self._loads.put(key, known)
            loads[name] = known
        return loads

    def _of_pin(
        self,
        study: Study,
        name: str,
        cases: list[str],
        loads: dict[str, CaseLoads | InputError],
    ) -> Iterable[tuple[str, DesignRow]]:
        wrong = {c: x for c in cases if isinstance(x := loads[c], InputError)}
        right = {c: x for c in cases if not isinstance(x := loads[c], InputError)}
        yield from ((c, _failed(study, name, c, error)) for c, error in wrong.items())
        if not right:
            return
        try:
            todo = tasks(study, [pin_of(study, name)], right)
        except (InputError, ArithmeticError, MemoryError) as error:
            yield from ((c, _failed(study, name, c, error)) for c in right)
            return
        requirement = requirement_of(study, memory=self._memory)
        for task in todo:
            yield from self._solved(study, task, requirement, right)

    def _solved(
        self, study: Study, task: Task, requirement: Requirement, loads: Mapping[str, CaseLoads]
    ) -> Iterable[tuple[str, DesignRow]]:
        density = task.material.density
        mass = density * task.pin.volume if density else None
        try:
            rows = self._rows_of(study, task, requirement, loads)
        except (InputError, ArgumentError, ArithmeticError, MemoryError) as error:
            names = [loads.case for loads in task.loads]
            yield from ((c, _failed(study, task.pin.name, c, error)) for c in names)
            return
        pin = task.pin.name
        for row in (judged_row(x, task, required_factor(study, pin, x.case)) for x in rows):
            peak, good = row.maximum, row.verdict == "converged"
            yield (
                row.case,
                DesignRow(
                    row.pin,
                    row.case,
                    row.max_von_mises,
                    row.error_estimate,
                    row.safety_factor,
                    peak.verdict,
                    peak.time,
                    mass,
                    "" if good else row.note,
                    "" if good else _code(peak),
                    *outcome_words(row, task, study.system),
                    peak.places.governs if peak.places else "",
                    *stress_at(peak),
                ),
            )

    def _rows_of(
        self, study: Study, task: Task, requirement: Requirement, loads: Mapping[str, CaseLoads]
    ) -> tuple[PinResult, ...]:
        key = _question(study, task, requirement, [loads[x.case].range for x in task.loads])
        known = self._rows.get(key)
        if known is None:
            solved = solutions(study, task, requirement, lambda _: None, self.memo)
            known = self._rows.put(key, tuple(bare_row(task, s, loads) for s in solved))
        return known


def _names(content: object, case: str) -> bool:
    """Return whether a table contains the name of a case as a text."""
    if isinstance(content, Mapping):
        return any(_names(entry, case) for entry in content.values())
    if isinstance(content, list | tuple):
        return any(_names(entry, case) for entry in content)
    return content == case


def elastic(material: Material) -> Material:
    """Return a material without its strengths, on which no stress depends."""
    return Material(
        material.name, material.youngs_modulus, material.poisson_ratio, material.density
    )


def _elastic_lug(lug: Lug) -> Lug:
    """Return a lug without strengths, by which only its own share is judged (bare_row drops
    that).
    """
    bushing = lug.bushing and replace(lug.bushing, material=elastic(lug.bushing.material))
    return replace(lug, material=elastic(lug.material), bushing=bushing)


def _question(
    study: Study, task: Task, requirement: Requirement, ranges: Sequence[ImpulseLoads | None]
) -> str:
    """Return a hash of all on which a pin's answers depend in a study whose mechanism does not
    change.

    ranges: of impulses by case, as other ones may have the same forces.
    """
    decides = requirement.goal == "decide"
    asks = (
        shape_of(task.pin),
        task.clamps,
        task.lugs if decides else tuple(map(_elastic_lug, task.lugs)),
        study.table.analysis.joints,
        study.table.fatigue is not None,
        task.loads,
        task.ranges,
        ranges,
        task.material if decides else elastic(task.material),
        replace(requirement, memory=None),
        required_factors(study, task.pin.name, (loads.case for loads in task.loads)),
    )
    return hashlib.sha256(pack(asks)).hexdigest()


def _code(peak: Maximum) -> str:
    return peak.reasons[0] if peak.verdict == "rigid" and peak.reasons else peak.verdict


def _failed(study: Study, pin: str, case: str, error: BaseException) -> DesignRow:
    """Return a row without a maximum; its reason names no file, whose place changes nothing."""
    lines = error.lines if isinstance(error, InputError) else (str(error) or "out of memory",)
    place = re.compile(rf"{re.escape(str(study.path))}(:\d+)?: ")
    reason = "; ".join(place.sub("", line) for line in lines)
    code = getattr(error, "code", "") or "failed"
    return DesignRow(pin, case, None, None, None, "failed", reason=reason, code=code)
