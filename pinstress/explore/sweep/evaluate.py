"""The results of a study with changed numbers: a row for each of its pins in each of its cases.

A design is solved as in a run, so `pinstress run` of the changed study finds the same rows, but for
minor cases of pins in lugs, unless these are only to be decided here, too. Parts that do not change
from one design to the next are not solved again: loads that do not depend on a changed number, pins
whose shape, material and loads are those of an earlier design, and the unit loads of a pin of which
only loads or strength change.
"""

from __future__ import annotations

import re
from collections import OrderedDict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Generic, TypeVar

from assess.judgement import NOT_DECIDED
from fea.core.peak import Maximum, Verdict
from geometry import ArgumentError, PinLike
from pinbase.memo import Memo
from pinstress.analysis.plan import prepare, requirement_of
from pinstress.analysis.reused_loads import depends_on_bands
from pinstress.analysis.solve import solutions
from pinstress.explore.sweep.laws import Floats
from pinstress.explore.sweep.number import Number
from pinstress.explore.sweep.outcomes import bare_row, judged_row, outcome_words, stress_at
from pinstress.explore.sweep.parameters import Parameter
from pinstress.explore.sweep.superposed import PosedTask, Rows, posed_task, superposed
from pinstress.study.model.cases import CaseLoads, case_loads
from pinstress.study.model.mechanism.linkage import AnyLinkage, any_linkage, determined
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.model.tasks import Task, tasks
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study, raw_study, with_raw, with_value
from reports.data.row import PinResult

MAX_MESHES_SIZE = 2 * 10**8  # bytes of meshes and fields kept by each of possibly many processes
MAX_SUPERPOSED = 256  # designs superposed at once: with 5,000 points, 10 MB per array of bounds
STRENGTH_KEYS = ("yield_strength", "ultimate_strength", "shear_strength", "bearing_strength")
MAX_REMEMBERED_LOADS, MAX_REMEMBERED_ROWS = 64, 4096  # loads are counted for each case
# Tables on which loads usually do not depend
TABLES_WITHOUT_LOADS = ("pin", "lug_defaults", "material", "analysis")
IGNORED_TABLES = ("vary", "published", "beam_check", "motion_check", "report")

K = TypeVar("K")
V = TypeVar("V")


@dataclass(frozen=True)
class DesignRow:
    """One pin in one load case of a design, in SI.

    max_von_mises, error_estimate: Pa; None if there is no maximum (verdict `failed` or `rigid`).
    governing_time: s, None without a motion.
    mass: kg, None without a density.
    reason, code: why the verdict is not `converged`, as human-readable text and as a code.
    outcome, depends_on: as in a run (pinstress.explore.sweep.outcomes).
    governs: "surface" or "section"; empty if the model has no places.
    surface, section, beneath, beneath_error: the largest stress of surface, of sections and beneath
    contact, and the error of the last, Pa; None where there is none.
    loose: whether the pin comes loose from a lug at the temperature of the case.
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
    loose: bool = False


def rows_without_maximum(
    table: Iterable[tuple[str, str]], reason: str, code: str
) -> list[DesignRow]:
    """Return the rows of a design without any results. table: pin and case of each row."""
    return [
        DesignRow(pin, case, None, None, None, "failed", reason=reason, code=code)
        for pin, case in table
    ]


@dataclass(frozen=True)
class PosedDesign:
    """A design before it is solved: its tasks, and failed rows, by pin and case, for those that
    cannot be built.
    """

    study: Study
    tasks: tuple[PosedTask, ...]
    failed: dict[tuple[str, str], DesignRow]


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
    """The evaluator of a study whose numbers change.

    pins, cases: names; all by default.
    every: whether the maximum of every case is wanted; otherwise minor cases are only decided, as
    in a run, by the strengths of the design, so that designs of other strengths share nothing.
    parameters: the numbers that change, in the order of the values passed to `rows`.
    table: pin and case of each row of a design, in the order of the rows.
    memo: meshes, unit fields and flexibilities of the pins.
    files: the files that the study names, if the creator of the evaluator has noted them
    (pinstress.explore.sweep.batches).

    Raises: InputError if the study as given cannot be run.
    """

    def __init__(
        self,
        study: Study,
        parameters: Iterable[Parameter | Number],
        pins: Iterable[str] | None = None,
        cases: Iterable[str] | None = None,
        *,
        every: bool = True,
    ) -> None:
        self.numbers = tuple(p.number if isinstance(p, Parameter) else p for p in parameters)
        self._raw = {k: v for k, v in raw_study(study).items() if k not in IGNORED_TABLES}
        self.study = with_raw(study, self._raw)
        plan = prepare(self.study, pins=pins, cases=cases)
        self.files: tuple[Path, ...] = ()
        # The memory that was free at the start; each query would take a millisecond.
        self._memory = plan.requirement.memory
        self._every = every or plan.requirement.every
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
        self._rows = Recent[str, Rows](MAX_REMEMBERED_ROWS)
        self._shapes = Recent[tuple[object, ...], PinLike](MAX_REMEMBERED_LOADS)
        self._alike = Recent[tuple[object, ...], str](MAX_REMEMBERED_LOADS)
        self._of_shapes = [k for k, x in enumerate(self.numbers) if not only_loads(x)]
        self._of_loads = {
            (case, along): [k for k, x in enumerate(self.numbers) if self._moves(x, case, along)]
            for case in self._cases
            for along in (False, True)
        }

    def rows(self, values: Sequence[float] | Floats) -> list[DesignRow]:
        """Return the rows of a design, one for each entry of `table`.

        values: (p,) of the parameters, SI.
        """
        return self.rows_of([values])[0]

    def rows_of(self, designs: Iterable[Sequence[float] | Floats]) -> list[list[DesignRow]]:
        """Return the rows of each design, as `rows` does.

        Pins that differ only by their loads are superposed together.
        designs: values (p,) of the parameters of each design, SI.
        """
        values = [[float(value) for value in design] for design in designs]
        out: list[list[DesignRow]] = []
        for k in range(0, len(values), MAX_SUPERPOSED):
            posed = [self._posed(design) for design in values[k : k + MAX_SUPERPOSED]]
            new = (x for one in posed for x in one.tasks if self._rows.get(x.key) is None)
            known = superposed(new, self.memo)
            out += [self._answered(one, known) for one in posed]
        return out

    def changed(self, values: Sequence[float] | Floats) -> Study:
        """Return the study with other values (SI) of its numbers.

        Raises: InputError.
        """
        raw = self._raw
        for number, value in zip(self.numbers, values, strict=True):
            # float(), because numpy's numbers behave differently, as when compared with [].
            for path in number.paths:
                raw = with_value(raw, path, number.in_study(number.shown(float(value))))
        return with_raw(self.study, raw)

    def _moves(self, number: Number, case: str, along: bool) -> bool:
        """Whether the loads of a case depend on a number.

        Loads depend on numbers of the mechanism, of the case and of cases that it names, on numbers
        that give mass to floating pins, and on lengths, which place bands along pins.

        along: whether the places of bands count (`depends_on_bands`), which may differ between
        designs.
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
            lengths = any(path[-1] == "length" for path in number.paths)
            places = lengths or not study.pin[str(inner[0])].profile
            return inner[0] in free or (along and places)
        return inner[-1] == "density" and any(study.pin[x].material == inner[0] for x in free)

    def loads_of(self, study: Study, values: Sequence[float]) -> dict[str, CaseLoads | InputError]:
        """Return the loads of a design by case, or the error of a case without loads.

        study: the study of the design. values: (p,) of its parameters, SI.
        """
        loads: dict[str, CaseLoads | InputError] = {}
        mechanism: AnyLinkage | None = None
        along = study.table.mechanism is not None and depends_on_bands(study)
        for name in self._cases:
            key = name, along, *(values[k] for k in self._of_loads[name, along])
            known = self._loads.get(key)
            if known is None:
                if mechanism is None and study.table.mechanism:
                    mechanism = any_linkage(study)
                    determined(study, mechanism)
                try:
                    known = case_loads(study, name, mechanism)
                except InputError as error:
                    known = error
                self._loads.put(key, known)
            loads[name] = known
        return loads

    def _posed(self, values: Sequence[float]) -> PosedDesign:
        """Return a design with its loads, before anything is solved.

        values: (p,) of the parameters, SI.
        """
        try:
            study = self.changed(values)
            loads = self.loads_of(study, values)
        except (InputError, MemoryError) as error:
            failed = {(p, c): _failed(self.study, p, c, error) for p, c in self.table}
            return PosedDesign(self.study, (), failed)
        posed, failed = list[PosedTask](), dict[tuple[str, str], DesignRow]()
        for pin in self._pins:
            cases = [case for name, case in self.table if name == pin]
            wrong = {c: x for c in cases if isinstance(x := loads[c], InputError)}
            right = {c: x for c in cases if not isinstance(x := loads[c], InputError)}
            failed |= {(pin, c): _failed(study, pin, c, error) for c, error in wrong.items()}
            try:
                posed += self._of_pin(study, pin, right, values) if right else ()
            except (InputError, ArithmeticError, MemoryError) as error:
                failed |= {(pin, c): _failed(study, pin, c, error) for c in right}
        return PosedDesign(study, tuple(posed), failed)

    def _of_pin(
        self, study: Study, name: str, loads: dict[str, CaseLoads], values: Sequence[float]
    ) -> list[PosedTask]:
        """Return the tasks of a pin of a design.

        loads: by case. values: of the parameters (p,), SI.

        Raises: InputError, MeshError.
        """
        key = name, *(values[k] for k in self._of_shapes)
        pin = self._shapes.get(key) or self._shapes.put(key, pin_of(study, name))
        requirement = requirement_of(study, memory=self._memory)
        requirement = replace(requirement, every=self._every)
        posed = []
        for task in tasks(study, [pin], loads):
            # With the goal to decide, strengths affect where stress is read; on a pin with a
            # hardened surface, they affect where stress governs.
            strong = requirement.goal == "decide" or bool(task.material.hardened)
            alike = None if task.lugs or strong else self._alike.get(key)
            one = posed_task(study, task, requirement, loads, alike)
            posed.append(one)
            if not task.lugs:
                self._alike.put(key, one.alike)
        return posed

    def _answered(self, design: PosedDesign, known: Mapping[str, Rows]) -> list[DesignRow]:
        """Return the rows of a design. known: rows of some tasks, by their keys."""
        rows = dict(design.failed)
        for posed in design.tasks:
            rows |= self._solved(posed, known.get(posed.key))
        return [rows[key] for key in self.table]

    def _solved(self, posed: PosedTask, known: Rows | None) -> dict[tuple[str, str], DesignRow]:
        """Return the rows of a task, by pin and case. known: its rows before they are judged."""
        study, task, pin = posed.study, posed.task, posed.task.pin.name
        try:
            rows = known or self._rows_of(posed)
        except (InputError, ArgumentError, ArithmeticError, MemoryError) as error:
            names = [loads.case for loads in task.loads]
            return {(pin, c): _failed(study, pin, c, error) for c in names}
        return {(pin, x.case): _design_row(judged_row(x, task, study), task, study) for x in rows}

    def _rows_of(self, posed: PosedTask) -> Rows:
        known = self._rows.get(posed.key)
        if known is None:
            task, silent = posed.task, (lambda _: None)
            solved = solutions(posed.study, task, posed.requirement, silent, self.memo)
            known = self._rows.put(posed.key, tuple(bare_row(task, s, posed.loads) for s in solved))
        return known


def _design_row(row: PinResult, task: Task, study: Study) -> DesignRow:
    """Return the row of a judged pin."""
    density, peak, good = task.material.density, row.maximum, row.verdict == "converged"
    return DesignRow(
        row.pin,
        row.case,
        row.max_von_mises,
        row.error_estimate,
        row.safety_factor,
        peak.verdict,
        peak.time,
        density * task.pin.volume if density else None,
        "" if good else row.note,
        "" if good else _code(peak),
        *outcome_words(row, task, study.system),
        peak.places.governs if peak.places else "",
        *stress_at(peak),
        loose=bool(row.lost_fits),
    )


def only_loads(number: Number) -> bool:
    """Whether a number changes only the given loads of pins and the strengths that judge them."""
    return all(
        path[0] == "case" or (path[0] == "material" and path[-1] in STRENGTH_KEYS)
        for path in number.paths
    )


def _names(content: object, case: str) -> bool:
    """Whether a table contains the name of a case as a text."""
    if isinstance(content, Mapping):
        return any(_names(entry, case) for entry in content.values())
    if isinstance(content, list | tuple):
        return any(_names(entry, case) for entry in content)
    return content == case


def _code(peak: Maximum) -> str:
    return peak.reasons[0] if peak.verdict == "rigid" and peak.reasons else peak.verdict


def _failed(study: Study, pin: str, case: str, error: BaseException) -> DesignRow:
    """Return a failed row; its reason omits the study's file, so that equal studies give equal
    rows wherever they are.
    """
    lines = error.lines if isinstance(error, InputError) else (str(error) or "out of memory",)
    place = re.compile(rf"{re.escape(str(study.path))}(:\d+)?: ")
    reason = "; ".join(place.sub("", line) for line in lines)
    code = getattr(error, "code", "") or "failed"
    return DesignRow(pin, case, None, None, None, "failed", reason=reason, code=code)
