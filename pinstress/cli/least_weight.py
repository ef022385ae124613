"""The command `size --least-weight`, which finds the lightest pins that reach a factor and writes
the new study.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import closing, nullcontext
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import click

from assess.judgement import FAILS, NOT_DECIDED
from pinbase.keys import key_part
from pinbase.processes import interrupts
from pinbase.processes.pool import processes
from pinstress.cli.new_file import write_new
from pinstress.cli.run import console, progress_bar
from pinstress.cli.shared import resumable, say
from pinstress.cli.size import OTHER_FILE_REMEDY, close, target_of
from pinstress.cli.streams import unneeded
from pinstress.explore.size.at_probability import lighten_at
from pinstress.explore.size.judged_pin import judged_pin
from pinstress.explore.size.least_weight import LightStudy, lighten
from pinstress.explore.size.lightest_pin import Lightest
from pinstress.explore.size.pin_shape import DIMENSION_KINDS, Proportions
from pinstress.explore.size.scaled_study import moved
from pinstress.explore.size.search_log import FinishedSearch, SearchLog
from pinstress.explore.size.size_pin import SizingGoal
from pinstress.explore.size.size_state import FinishedSearches, SizeState, identity
from pinstress.explore.size.weight_search import WeightGoal
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.model.pins import weight
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study
from reports.data.decision import low_factor
from reports.format.numbers import DASH, short
from reports.format.ranges import factor_range
from reports.text.least_weight import ChangedDimension, LightRow, print_light

MAX_NAMED_BINDING = 4  # number of active constraints that are named


@dataclass(frozen=True)
class LeastWeightOptions:
    """Options of the command line for the least weight.

    vary: kinds of dimensions.
    wall: least wall thickness over the diameter.
    shoulder: least ratio of the larger to the smaller diameter of a step.
    probability: allowed probability of missing the factor, if any.
    """

    vary: Sequence[str] | None = None
    wall: float | None = None
    shoulder: float | None = None
    probability: float | None = None

    @property
    def given(self) -> list[str]:
        """Return the options that were given."""
        return [f"--{name}" for name, value in vars(self).items() if value is not None]


def weight_goal(goal: SizingGoal, options: LeastWeightOptions, step: float | None) -> WeightGoal:
    """Return the goal of the search that the options describe.

    goal: the factors to reach. step: step to which diameters are rounded up, m.

    Raises: InputError for options that are invalid or contradict each other.
    """
    vary = tuple(dict.fromkeys(options.vary or DIMENSION_KINDS))
    unknown = [kind for kind in vary if kind not in DIMENSION_KINDS]
    if unknown:
        raise InputError(
            f"--vary: {unknown[0]!r} is none of {', '.join(DIMENSION_KINDS)}", code="unknown-kind"
        )
    if step is not None and "diameters" not in vary:
        raise InputError(
            "--step rounds diameters, which --vary leaves as they are; leave out one of them",
            code="contradiction",
        )
    stated = {key: value for key in ("wall", "shoulder") if (value := getattr(options, key))}
    return WeightGoal(goal.required, vary, Proportions(**stated), step, goal.multiples)


def lighten_and_write(
    study: Study,
    aim: WeightGoal,
    out: Path | None,
    pins: list[str] | None,
    quiet: bool = False,
    jobs: int | None = None,
    probability: float | None = None,
    resume: bool = False,
) -> int:
    """Find the lightest pins and write the new study.

    Returns the exit status: 1 if any pin is not shown to reach the factor.

    jobs: number of pins in parallel, by default the number of cores.
    probability: largest probability of missing the factor; without it, the factor is that of the
    study as it is.
    resume: whether to begin with the searches that an interrupted command has finished.

    Raises: InputError.
    """
    target = target_of(study, out, new=not resume)
    asked = identity(study, (aim, probability), pins or study.table.pin)
    with closing(SizeState[FinishedSearch](target, asked, FinishedSearches)) as state:
        if resume:
            log = SearchLog(state.read(), state.write)
        else:
            state.begin()
            log = SearchLog((), state.write)
        with resumable(partial(_kept, state, log), "search", "searches"):
            with progress_bar(alone=processes(jobs) == 1, quiet=quiet) as progress:
                design = (
                    lighten(study, aim, pins, processes(jobs), progress, log)
                    if probability is None
                    else lighten_at(study, aim, probability, pins, processes(jobs), progress, log)
                )
            changed = _write(study, design, target, resume)
        with interrupts.deferred():
            state.end()
            if changed:
                interrupts.state_left(f"{target} is written")
    return _report(study, design, aim, target if changed else None, quiet, probability)


def _kept(state: SizeState[FinishedSearch], log: SearchLog) -> int:
    """Return the number of finished searches; without any, remove the saved state."""
    if not len(log):
        state.end()
    return len(log)


def _write(study: Study, design: LightStudy, target: Path, resume: bool) -> bool:
    """Write the new study, and return whether it differs from the old one.

    resume: whether the interrupted command may have written it already.

    Raises: InputError.
    """
    if design.study.text == study.text or not any(x.values or x.scale for x in design.pins):
        return False
    content = moved(design.study.text, study.path.parent, target.parent).encode()
    if not (resume and target.is_file() and target.read_bytes() == content):
        write_new(target, content, OTHER_FILE_REMEDY)
    return True


def _report(
    study: Study,
    design: LightStudy,
    aim: WeightGoal,
    target: Path | None,
    quiet: bool,
    probability: float | None,
) -> int:
    """Print the dimensions and return the exit status.

    target: the new study, if it was written.
    """
    heavy = all(study.material_of(lightest.pin).density for lightest in design.pins)
    rows = [_row(study, design, lightest, aim, heavy) for lightest in design.pins]
    system = study.system
    unit = system.force if heavy else f"{system.length}³"
    with unneeded(target) if target else nullcontext():
        print_light(rows, aim.written, (system.length, unit, heavy), console())
        if probability is not None:
            factor = "A required factor" if aim.multiples else f"The factor {short(aim.required)}"
            click.echo(
                f"{factor} is that which is missed with probability {probability:g}, by the first "
                "order; pinstress reliability samples it."
            )
    if not quiet:
        close(study, design.study, target)
    if not design.settled:
        say(
            "Not settled: the factors in the run of the new study are not yet those that were "
            "aimed at; size the new study again."
        )
    missed = [row for row in rows if row.why]
    for row in missed:
        say(f"{row.result.capitalize()}: pin {row.pin}: {row.why}.")
    return int(bool(missed) or not design.settled)


def _row(
    study: Study, design: LightStudy, lightest: Lightest, aim: WeightGoal, heavy: bool
) -> LightRow:
    rows = [p for p in design.results.pins if p.pin == lightest.pin and p.safety_factor is not None]
    demanded = aim.of_pin(lightest.pin)
    worst = min(
        (p for p in rows if demanded.get(p.case, 1.0)),
        key=lambda p: (low_factor(p) or 0.0) / demanded.get(p.case, 1.0),
        default=None,
    )
    before, after = (pin_of(x, lightest.pin).volume for x in (study, design.study))
    written = lightest.values is not None or lightest.scale is not None
    judged = judged_pin(design.results, lightest.pin) if written else None
    unlikely = _unlikely(design, lightest.pin, aim)
    return LightRow(
        pin=lightest.pin,
        factor=DASH if worst is None else factor_range(worst, "–"),
        factor_before=lightest.before,
        governs=DASH if worst is None else worst.case,
        weights=tuple(
            None if volume is None else _amount(study, lightest.pin, volume, heavy)
            for volume in (before, lightest.scaled, after if written else None)
        ),  # type: ignore[arg-type]
        at=min(
            (x for (pin, _), x in design.at.items() if pin == lightest.pin and math.isfinite(x)),
            default=None,
        ),
        residual=None if lightest.optimality is None else lightest.optimality.residual,
        dimensions=tuple(_dimensions(study, design.study, lightest)),
        binding=lightest.binding[:MAX_NAMED_BINDING],
        bands=tuple(_bands(study, design.study, lightest.pin)) if written else (),
        solved=lightest.solved,
        why=lightest.why if judged is None else judged.why or unlikely,
        way=lightest.way,
        outcome=judged.outcome
        if judged is not None and (judged.outcome == FAILS or not unlikely)
        else NOT_DECIDED,
    )


def _unlikely(design: LightStudy, pin: str, aim: WeightGoal) -> str:
    """Return why the factor is not reached at a probability; empty if it is, or if no probability
    is requested.
    """
    factors = {case: x for (name, case), x in design.at.items() if name == pin}
    unknown = [case for case, x in factors.items() if math.isnan(x)]
    low = [
        case
        for case, x in factors.items()
        if x < aim.required * aim.multiples.get((pin, case), 1.0) * (1.0 - 1e-9)
    ]
    if unknown:
        return f"in {', '.join(unknown)} its factor at the probability is not known"
    return f"in {', '.join(low)} its factor at the probability is too small" if low else ""


def _amount(study: Study, name: str, volume: float, heavy: bool) -> float:
    """Return the weight of a volume, m^3, in the study's units; the volume itself unless
    `heavy`.
    """
    if not heavy:
        return volume / study.system.factor("length") ** 3
    of_one = (
        weight(pin_of(study, name), study.material_of(name).density or 0.0)
        / pin_of(study, name).volume
    )
    return of_one * volume / study.system.factor("force")


def _dimensions(study: Study, new: Study, lightest: Lightest) -> list[ChangedDimension]:
    """Return the dimensions that changed."""
    from pinstress.analysis.remedies.dimensions import dimensions_of

    unit, table = study.system.factor("length"), f"pin.{key_part(lightest.pin)}"
    old = {d.key: d.value for d in dimensions_of(study, pin_of(study, lightest.pin))}
    after = {d.key: d.value for d in dimensions_of(new, pin_of(new, lightest.pin))}
    return [
        ChangedDimension(f"{table}.{key}", old[key] / unit, after[key] / unit)
        for key in after
        if key in old and abs(after[key] - old[key]) > 1e-9 * old[key]
    ]


def _bands(study: Study, new: Study, name: str) -> list[str]:
    """Return the links that bear on another diameter than before, with the new diameter."""
    unit, out = study.system.factor("length"), []
    old, now = pin_of(study, name), pin_of(new, name)
    for connection in now.connections:
        before, after = (2.0 * pin.band(connection).radius for pin in (old, now))
        if abs(after - before) > 1e-9 * before:
            out.append(f"{connection} {short(after / unit)}")
    return out
