"""The `size` command: size every pin, run the new study, write it."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path

import click

from pinstress.analysis.plan import Plan, prepare
from pinstress.analysis.results import run
from pinstress.cli.new_file import require_new, write_new
from pinstress.cli.run import SOLVERS, console, progress_bar
from pinstress.cli.streams import unneeded
from pinstress.processes.pool import Died, Job, Progress, preload, processes, side_by_side
from pinstress.sizing.secant import CLOSE
from pinstress.sizing.size_pin import Sized, new_text, size_pin
from pinstress.study.choices import require_positive
from pinstress.study.errors import InputError
from pinstress.study.file import Study, parse_study
from reports.data.results import PinResult, Results
from reports.format.ranges import factor_range
from reports.text.sizes import SizeRow, print_sizes

PASSES = 4
ANOTHER = "choose another file with --out"


def size_and_write(
    study: Study,
    fos: float | None,
    out: Path | None,
    pins: list[str] | None,
    step: float | None,
    quiet: bool = False,
    jobs: int | None = None,
) -> int:
    """Size pins and write the new study; returns the exit status: 1 if any pin does not verifiably
    reach the factor. fos: default the study's own. step: of diameters, m. jobs: number of pins
    sized in parallel, default the number of cores.

    Raises: InputError.
    """
    required = require_positive("fos", fos) or study.table.analysis.required_safety_factor
    if required is None:
        raise study.error(
            "size needs a factor of safety to reach: --fos 10, or "
            "required_safety_factor in [analysis]",
            code="no-required-factor",
        )
    target = _target(study, out)
    plan = prepare(study, pins=pins)
    most = processes(jobs)
    with progress_bar(alone=most == 1, quiet=quiet) as progress:
        for _ in range(PASSES):
            sized = _all(plan, required, step, most, progress)
            text = new_text(study, sized, step, required)
            progress("run of the new study", 0.9)
            new = parse_study(target, text)
            results = run(new, pins=[s.pin for s in sized], jobs=most)
            if _agree(sized, results, required):
                break
            # The new weights change the loads of the linkage: size again under the new loads.
            plan = replace(plan, loads=prepare(new, pins=pins).loads)
    rows = [_row(study, new, s, results) for s in sized]
    write_new(target, text.encode(), ANOTHER)
    with unneeded(target):
        print_sizes(rows, required, study.system.length, console())
    if not quiet:
        click.echo(f"Written: {target}", err=True)
    missed = [row for row in rows if row.why]
    for row in missed:
        click.echo(f"Not decided: pin {row.pin}: {row.why}.", err=True)
    return int(bool(missed))


def _agree(sized: list[Sized], results: Results, required: float) -> bool:
    """Whether the run confirms that every size reaches the factor, with little excess."""
    for pin in sized:
        found = min(_factors(results, pin.pin), default=None)
        if pin.factor is None or found is None:
            continue
        if found < required or found > pin.factor * (1.0 + CLOSE):
            return False
    return True


def _factors(results: Results, pin: str) -> list[float]:
    return [p.safety_factor for p in results.pins if p.pin == pin and p.safety_factor is not None]


def _all(
    plan: Plan, required: float, step: float | None, jobs: int, progress: Progress
) -> list[Sized]:
    names = list(dict.fromkeys(task.pin.name for task in plan.tasks))
    if jobs > 1:
        preload(*SOLVERS)
    work = [Job(f"pin {name}", partial(size_pin, plan, name, required, step)) for name in names]
    found = side_by_side(work, jobs, lambda message, part: progress(message, 0.9 * part))
    return [
        Sized(name, None, None, None, None, made.reason) if isinstance(made, Died) else made
        for name, made in zip(names, found, strict=True)
    ]


def _target(study: Study, out: Path | None) -> Path:
    target = out or study.path.with_name(f"{study.name}_sized.toml")
    require_new(target, ANOTHER)
    if not target.parent.is_dir():
        raise InputError(f"--out: there is no folder {target.parent}", code="no-folder")
    return target


def _row(study: Study, new: Study, sized: Sized, results: Results) -> SizeRow:
    """A pin's row, with the results of the run of the new study only."""
    mine = [p for p in results.pins if p.pin == sized.pin and p.safety_factor is not None]
    worst = min(mine, key=lambda p: p.safety_factor or 0.0) if mine else None
    unit = study.system.factor("length")
    diameters = [
        [s.diameter / unit for s in t.table.pin[sized.pin].profile or ()] for t in (study, new)
    ]
    return SizeRow(
        pin=sized.pin,
        before=tuple(dict.fromkeys(diameters[0])),
        after=tuple(dict.fromkeys(diameters[1])) if sized.scale is not None else None,
        factor_before=sized.before,
        factor=None if worst is None else worst.safety_factor,
        verdict=next((p.verdict for p in (worst, *results.pins) if p and p.pin == sized.pin), ""),
        yields=None if worst is None else worst.yields,
        why=_why(sized, mine),
        shown="" if worst is None else factor_range(worst, "–\n"),
    )


def _why(sized: Sized, found: list[PinResult]) -> str:
    """Why the factor is not verifiably reached; empty if it is."""
    if sized.scale is None:
        return sized.why
    singular = [p.case for p in found if p.verdict == "singular"]
    if not found:
        return "the run of the new study gives no safety factor"
    missing = [p.case for p in found if p.meets_required is False]
    loose = [p.case for p in found if p.verdict == "unconverged" and p.meets_required is None]
    if missing:
        return f"it fails in the run of the new study, case {', '.join(missing)}"
    if singular:
        return (
            f"the factor is reached only outside the excluded zones; in {', '.join(singular)} the "
            "stress is singular at a sharp corner or the edge of a clamp or lug, whatever the "
            "size; singular_zones.csv of a run lists remedies"
        )
    if loose:
        return f"in {', '.join(loose)} the stress has not converged to the tolerance"
    return ""
