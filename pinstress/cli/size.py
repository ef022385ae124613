"""The `size` command, which sizes every pin and writes the new study, each pin as soon as it is
sized.
"""

from __future__ import annotations

from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from assess.judgement import NOT_DECIDED
from pinbase.grouped import grouped
from pinbase.processes import interrupts
from pinbase.processes.pool import preload, processes
from pinstress.analysis.gather.gather import units_of
from pinstress.analysis.plan import Plan, prepare
from pinstress.cli.new_file import require_new, write_over
from pinstress.cli.run import RUN_LIBRARIES, RUN_MODELS, console, progress_bar
from pinstress.cli.shared import connected, resumable, say
from pinstress.cli.streams import unneeded
from pinstress.explore.size.scaled_study import moved
from pinstress.explore.size.size_pin import SizingGoal, SizingResult
from pinstress.explore.size.size_pins import new_study, size_pins
from pinstress.explore.size.size_state import FinishedPins, SizeState, identity
from pinstress.explore.size.standard_diameters import standard_diameters
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.model.pins import slenderness, weight
from pinstress.study.model.requirements import sizing_factor
from pinstress.study.reading.choices import require_positive
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study
from pinstress.study.reading.inputs import inputs, require_unchanged
from reports.format.numbers import DASH, short
from reports.text.sizes import SizeRow, print_sizes

if TYPE_CHECKING:
    from pinstress.explore.sweep.connection import ClusterConnection

OTHER_FILE_REMEDY = "choose another file with --out"


@dataclass(frozen=True)
class SizeOptions:
    """Options of the command.

    out: the new study, by default next to the study.
    pins: their names, by default all.
    jobs: number of pins sized in parallel, by default the number of cores.
    connection: to a cluster that sizes the pins instead.
    resume: whether to resume an interrupted size.
    """

    out: Path | None = None
    pins: list[str] | None = None
    jobs: int | None = None
    resume: bool = False
    quiet: bool = False
    connection: ClusterConnection | None = None


def size_and_write(study: Study, goal: SizingGoal, options: SizeOptions) -> int:
    """Size pins and write the new study, unless it would not differ from the old one.

    Returns the exit status: 1 if any pin is not shown to reach the factor.

    Raises: InputError.
    """
    target = target_of(study, options.out, new=False)
    plan = prepare(study, pins=options.pins)
    task_pins = {task.pin.name for task in plan.tasks}
    asked = identity(study, goal, task_pins)
    with closing(SizeState[SizingResult](target, asked, FinishedPins)) as state:
        sizing = _Sizing(study, goal, target, state)
        sized, new = _size(plan, sizing, options)
    rows = [_row(study, new, result) for result in sized]
    with unneeded(target):
        units = units_of(study)
        print_sizes(rows, goal.written, units, console(), sizing.written, goal.over_ranges)
    if not options.quiet:
        close(study, new, target if sizing.written else None)
    missed = grouped(((row.result.capitalize(), row.why), row.pin) for row in rows if row.why)
    for (result, why), pins in missed.items():
        of = f"pin{'s' * (len(pins) > 1)} {', '.join(pins)}"
        say(f"{result}: {of}: {why}.")
    return int(bool(missed))


def _size(plan: Plan, sizing: _Sizing, options: SizeOptions) -> tuple[list[SizingResult], Study]:
    """Return the sizes of the pins, and the new study as it is written.

    Raises: InputError.
    """
    sizing.start(options.resume)
    jobs = 1 if options.connection else processes(options.jobs)
    with resumable(sizing.stop, "pin"):
        with (
            progress_bar(alone=jobs == 1, quiet=options.quiet) as progress,
            connected(options.connection) as cluster,
        ):
            if jobs > 1:
                preload(*RUN_LIBRARIES, *RUN_MODELS)
            sized = size_pins(
                plan, sizing.goal, sizing.pins, sizing.finish, jobs, progress, cluster
            )
        new = sizing.write(sized)
    sizing.end()
    return sized, new


class _Sizing:
    """A size in progress: the finished pins, in the new study and in the saved state."""

    def __init__(
        self, study: Study, goal: SizingGoal, target: Path, state: SizeState[SizingResult]
    ) -> None:
        self.goal = goal
        self._study, self._target, self._state = study, target, state
        self._inputs = inputs(study)
        self._pins: dict[str, SizingResult] = {}
        self.written = False

    @property
    def pins(self) -> list[SizingResult]:
        return list(self._pins.values())

    def start(self, resume: bool) -> None:
        """Begin, or read the pins that an earlier size has finished.

        Raises: InputError, also if the new study has changed since it was written.
        """
        if not resume:
            if not self._state.exists:
                require_new(self._target, OTHER_FILE_REMEDY)
            self._state.begin()
            return
        self._pins = {result.pin: result for result in self._state.read()}
        if not self._target.exists():
            return
        stages = [self._text(self.pins), self._text(self.pins[:-1])]
        if self._target.read_bytes() not in stages:
            raise InputError(
                f"--resume: {self._target} has changed since it was written; move it, and resume",
                code="changed-since",
            )
        self.written = True

    def finish(self, result: SizingResult) -> None:
        """Save a pin that is sized.

        Raises: InputError if a file of the study has changed, or if nothing can be written.
        """
        require_unchanged(self._study, self._inputs)
        self._pins.pop(result.pin, None)  # so that the pin becomes the last in the dictionary
        self._pins[result.pin] = result
        self._state.write(tuple(self.pins))
        self.write(self.pins)

    def write(self, sized: list[SizingResult]) -> Study:
        """Write the new study, unless it would not differ from the old one, and return it."""
        new = new_study(self._study, self.goal, sized)
        if self.written or (
            any(result.scale is not None for result in sized) and new.text != self._study.text
        ):
            if not self.written:
                require_new(self._target, OTHER_FILE_REMEDY)
            write_over(self._target, self._text(sized))
            self.written = True
        return new

    def end(self) -> None:
        """Remove the saved state, which the new study contains."""
        with interrupts.deferred():
            self._state.end()
            if self.written:
                interrupts.state_left(f"{self._target} is written")

    def stop(self) -> int:
        """Return the number of finished pins; without any, remove the saved state."""
        if not self._pins:
            self._state.end()
        return len(self._pins)

    def _text(self, sized: list[SizingResult]) -> bytes:
        text = new_study(self._study, self.goal, sized).text
        return moved(text, self._study.path.parent, self._target.parent).encode()


def sizing_goal(
    study: Study, fos: float | None, step: float | None, over_ranges: bool = False
) -> SizingGoal:
    """Return the goal of sizing: the factor to reach and the diameters to choose from.

    fos: the factor, or None for that of the study.
    step: step of diameters, m, instead of the study's series.
    over_ranges: as in SizingGoal.

    Raises: InputError.
    """
    required, more = require_positive("fos", fos), dict[tuple[str, str], float]()
    if required is None:
        required, more = _stated_goal(study)
    if required is None:
        raise study.error(
            "size needs a factor of safety to reach: --fos 10, or required_safety_factor in "
            "[analysis]",
            code="no-required-factor",
        )
    return SizingGoal(required, standard_diameters(study.table.size, step), more, over_ranges)


def _stated_goal(study: Study) -> tuple[float | None, dict[tuple[str, str], float]]:
    """Return the factor that a study requires, and the ratio of the factor of each pin and case to
    it; empty if all ratios are 1.
    """
    table = study.table
    required = table.analysis.required_safety_factor
    if not table.require:
        return required, {}
    factors = {
        (pin, case): sizing_factor(study, pin, case) or 0.0
        for pin in table.pin
        for case in table.case
    }
    required = required or max(factors.values(), default=0.0)
    if not required:
        return None, {}
    more = {place: factor / required for place, factor in factors.items()}
    return required, more if set(more.values()) != {1.0} else {}


def target_of(study: Study, out: Path | None, new: bool = True) -> Path:
    """Return the path of the new study.

    new: whether the file must not exist.

    Raises: InputError if the file cannot be written.
    """
    target = out or study.path.with_name(f"{study.name}_sized.toml")
    if new:
        require_new(target, OTHER_FILE_REMEDY)
    if not target.parent.is_dir():
        parent = target.parent
        is_file = f"{parent} is a file, not a folder"
        why = is_file if parent.exists() else f"there is no folder {parent}"
        raise InputError(f"--out: {why}", code="no-folder")
    return target


def close(study: Study, new: Study, target: Path | None) -> None:
    """Report changes of lugs, and the file that was written."""
    for name, table in new.table.pin.items():
        for at, lug in table.lug.items():
            old = study.table.pin[name].lug[at].outer_diameter
            if lug.outer_diameter != old and old and lug.outer_diameter:
                unit = study.system.factor("length")
                say(
                    f"Pin {name}: the eye {at} would be too narrow; its outer diameter is now "
                    f"{short(lug.outer_diameter / unit)} {study.system.length}, was "
                    f"{short(old / unit)}."
                )
    say(f"Written: {target}" if target else "Nothing is new; no study is written.")


def _row(study: Study, new: Study, sized: SizingResult) -> SizeRow:
    """Return a pin's row."""
    judged = sized.judged
    unit = study.system.factor("length")
    before, after = (
        tuple(d / unit for d in x.table.pin[sized.pin].diameters) for x in (study, new)
    )
    return SizeRow(
        pin=sized.pin,
        before=tuple(dict.fromkeys(before)),
        after=tuple(dict.fromkeys(after)) if sized.scale is not None else None,
        factor_before=sized.before,
        factor=DASH if judged is None else judged.factor,
        governs=DASH if judged is None else judged.governs,
        stricter="" if judged is None else judged.stricter,
        weights=(_weight(study, sized.pin), _weight(new, sized.pin)),
        slenderness=slenderness(pin_of(new, sized.pin)),
        why=sized.why or (judged.why if judged else ""),
        limited=sized.limited,
        outcome=NOT_DECIDED if sized.why or judged is None else judged.outcome,
        least="" if judged is None else judged.least,
    )


def _weight(study: Study, name: str) -> float | None:
    """Return a pin's weight in the study's units; None without a density."""
    density = study.material_of(name).density
    heavy = weight(pin_of(study, name), density) if density else None
    return None if heavy is None else heavy / study.system.factor("force")
