"""The `size` command: size every pin, run the new study, write it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

import click

from assess.judgement import DEPENDS, FAILS, NOT_DECIDED
from pinbase.processes.pool import Job, ProcessDied, Progress, in_parallel, preload, processes
from pinstress.analysis.plan import Plan, prepare
from pinstress.analysis.remedies.secant import FACTOR_TOLERANCE
from pinstress.analysis.results import run
from pinstress.cli.new_file import require_new, write_new
from pinstress.cli.run import RUN_LIBRARIES, RUN_MODELS, console, progress_bar
from pinstress.cli.streams import unneeded
from pinstress.explore.size.counted import beneath_factor
from pinstress.explore.size.scaled_study import moved, resized_study
from pinstress.explore.size.size_pin import SizingGoal, SizingResult, size_pin
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.model.pins import slenderness, weight
from pinstress.study.reading.choices import require_positive
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study
from reports.data.decision import factor_ends
from reports.data.dependence import BENEATH_CONTACT
from reports.data.headline import worst_checks
from reports.data.results import PinResult, Results
from reports.format.numbers import DASH, engineering, short
from reports.format.ranges import factor_range
from reports.format.words import over_words
from reports.text.sizes import SizeRow, print_sizes

MAX_SIZING_PASSES = 4
OTHER_FILE_REMEDY = "choose another file with --out"


def size_and_write(
    study: Study,
    wish: SizingGoal,
    out: Path | None,
    pins: list[str] | None,
    quiet: bool = False,
    jobs: int | None = None,
) -> int:
    """Size pins and write the new study, unless nothing in it is new.

    Returns the exit status: 1 if any pin is not shown to reach the factor.

    jobs: number of pins sized in parallel, by default the number of cores.

    Raises: InputError.
    """
    target = target_of(study, out)
    with progress_bar(alone=processes(jobs) == 1, quiet=quiet) as progress:
        new, sized, results = _sized(study, wish, pins, processes(jobs), progress)
    rows = [_row(study, new, s, results) for s in sized]
    if changed := any(s.scale is not None for s in sized) and new.text != study.text:
        text = moved(new.text, study.path.parent, target.parent)
        write_new(target, text.encode(), OTHER_FILE_REMEDY)
    with unneeded(target):
        print_sizes(rows, wish.required, results.units, console())
    if not quiet:
        close(study, new, target if changed else None)
    missed = [row for row in rows if row.why]
    for row in missed:
        click.echo(f"Not decided: pin {row.pin}: {row.why}.", err=True)
    return int(bool(missed))


def require_wish(study: Study, fos: float | None, step: float | None) -> SizingGoal:
    """Return the factor to reach.

    fos: the factor, or None for that of the study.
    step: step of diameters, m.

    Raises: InputError.
    """
    required = require_positive("fos", fos) or study.table.analysis.required_safety_factor
    if required is None:
        raise study.error(
            "size needs a factor of safety to reach: --fos 10, or "
            "required_safety_factor in [analysis]",
            code="no-required-factor",
        )
    return SizingGoal(required, step)


def _sized(
    study: Study, wish: SizingGoal, pins: list[str] | None, jobs: int, progress: Progress
) -> tuple[Study, list[SizingResult], Results]:
    """Size all pins and return the new study, the sizes and the new study's run.

    The weights of pins change the loads of others, so all are sized again until the run confirms
    them.
    """
    plan = prepare(study, pins=pins)
    scales: dict[str, float] = {}
    before: dict[str, float | None] = {}
    for _ in range(MAX_SIZING_PASSES):
        sized = _all(plan, wish, scales, jobs, progress)
        scales = {s.pin: s.scale for s in sized if s.scale is not None}
        before = {s.pin: s.before for s in sized} | before
        progress("run of the new study", 0.9)
        new = resized_study(study, scales, wish.step, wish.required)
        results = run(new, pins=[s.pin for s in sized], jobs=jobs)
        if _agree(sized, results, wish.required):
            break
    return new, [replace(s, before=before[s.pin]) for s in sized], results


def _agree(sized: list[SizingResult], results: Results, required: float) -> bool:
    """Return whether the run confirms that every size reaches the factor, with little excess."""
    for pin in sized:
        factor = min(_factors(results, pin.pin), default=None)
        if pin.factor is None or factor is None:
            continue
        if factor < required or factor > pin.factor * (1.0 + FACTOR_TOLERANCE):
            return False
    return True


def _factors(results: Results, pin: str) -> list[float]:
    """Return a pin's factors as size_pin counts them: with the error, but for singular rows."""
    return [
        min(p.safety_factor if p.verdict == "singular" else factor_ends(p)[0], beneath_factor(p))
        for p in results.pins
        if p.pin == pin and p.safety_factor is not None
    ]


def _all(
    plan: Plan, wish: SizingGoal, scales: Mapping[str, float], jobs: int, progress: Progress
) -> list[SizingResult]:
    names = list(dict.fromkeys(task.pin.name for task in plan.tasks))
    if jobs > 1:
        preload(*RUN_LIBRARIES, *RUN_MODELS)
    work = [Job(f"pin {name}", partial(size_pin, plan, name, wish, scales)) for name in names]
    sizings = in_parallel(work, jobs, lambda message, part: progress(message, 0.9 * part))
    return [
        SizingResult(name, None, None, None, None, sizing.reason)
        if isinstance(sizing, ProcessDied)
        else sizing
        for name, sizing in zip(names, sizings, strict=True)
    ]


def target_of(study: Study, out: Path | None) -> Path:
    """Return the path of the file to be written.

    Raises: InputError where it cannot be written.
    """
    target = out or study.path.with_name(f"{study.name}_sized.toml")
    require_new(target, OTHER_FILE_REMEDY)
    if not target.parent.is_dir():
        raise InputError(f"--out: there is no folder {target.parent}", code="no-folder")
    return target


def close(study: Study, new: Study, target: Path | None) -> None:
    """Report other changes, and the file that was written."""
    for name, table in new.table.pin.items():
        for at, lug in table.lug.items():
            old = study.table.pin[name].lug[at].outer_diameter
            if lug.outer_diameter != old and old and lug.outer_diameter:
                unit = study.system.factor("length")
                click.echo(
                    f"Pin {name}: the eye {at} would be too narrow; its outer diameter is now "
                    f"{short(lug.outer_diameter / unit)} {study.system.length}, was "
                    f"{short(old / unit)}.",
                    err=True,
                )
    click.echo(f"Written: {target}" if target else "Nothing is new; no study is written.", err=True)


def _row(study: Study, new: Study, sized: SizingResult, results: Results) -> SizeRow:
    """Return a pin's row, with the results of the run of the new study only."""
    rows = [p for p in results.pins if p.pin == sized.pin and p.safety_factor is not None]
    worst = min(rows, key=lambda p: p.safety_factor or 0.0) if rows else None
    unit = study.system.factor("length")
    before, after = (
        tuple(d / unit for d in x.table.pin[sized.pin].diameters) for x in (study, new)
    )
    return SizeRow(
        pin=sized.pin,
        before=tuple(dict.fromkeys(before)),
        after=tuple(dict.fromkeys(after)) if sized.scale is not None else None,
        factor_before=sized.before,
        factor=DASH if worst is None else factor_range(worst, "–"),
        governs=DASH if worst is None else worst.case,
        stricter="" if worst is None else _stricter(worst),
        weights=(_weight(study, sized.pin), _weight(new, sized.pin)),
        slenderness=slenderness(pin_of(new, sized.pin)),
        why=sized.why if sized.scale is None else why_missed(results, sized.pin),
    )


def _weight(study: Study, name: str) -> float | None:
    """Return a pin's weight in the study's units; None without a density."""
    density = study.table.material[study.table.pin[name].material].density
    heavy = weight(pin_of(study, name), density) if density else None
    return None if heavy is None else heavy / study.system.factor("force")


def _stricter(worst: PinResult) -> str:
    """Describe a hand check with a smaller factor than that of the largest stress, if any."""
    checks = [c for c in worst.hand_checks if c.safety_factor is not None and c.governs]
    least = min(checks, key=lambda c: c.safety_factor or 0.0, default=None)
    if least is None or (least.safety_factor or 0.0) >= (worst.safety_factor or 0.0):
        return ""
    return f"{least.method} at {least.at}: {engineering(least.safety_factor)}"


def why_missed(results: Results, pin: str) -> str:
    """Explain why the factor is not shown to be reached, from the run of the new study; empty if it
    is.
    """
    rows = [p for p in results.pins if p.pin == pin and p.safety_factor is not None]
    singular = [p.case for p in rows if p.verdict == "singular"]
    if not rows:
        return "the run of the new study gives no safety factor"
    missing = [p.case for p in rows if p.outcome == FAILS]
    depends = [p.case for p in rows if p.outcome == DEPENDS]
    loose = [p.case for p in rows if p.verdict != "singular" and p.outcome == NOT_DECIDED]
    if missing:
        return f"it fails in the run of the new study, case {', '.join(missing)}"
    if singular:
        zones = [
            z.kind for p in rows if p.verdict == "singular" for z in p.singular_at if z.governs
        ]
        where = " and ".join(dict.fromkeys(zones))
        return (
            f"the factor is reached only outside the excluded zones; in {', '.join(singular)} the "
            f"stress is singular at {where}, whatever the size; singular_zones.csv of a run lists "
            "remedies"
        )
    if loose:
        return f"in {', '.join(loose)} the error of the stress leaves it open"
    check = worst_checks(results)[pin]
    if check.row is None and check.outcome == FAILS:
        return f"{check.check} has a margin of safety of {1.0 / check.used - 1.0:.3g} in that run"
    if depends:
        every = [d for p in rows if p.outcome == DEPENDS for d in p.depends_on]
        ranges = over_words([d for d in every if d.over != BENEATH_CONTACT])
        places = ["beneath contact"] * any(d.over == BENEATH_CONTACT for d in every)
        places += [f"within the range of the {ranges}"] * bool(ranges)
        cases = ", ".join(depends)
        return f"the factor is reached as described, but not {' and not '.join(places)} ({cases})"
    return ""
