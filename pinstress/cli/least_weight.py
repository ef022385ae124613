"""`size --least-weight`: the lightest pins that reach a factor, run and written."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import click

from pinbase.processes.pool import processes
from pinstress.cli.new_file import write_new
from pinstress.cli.run import console, progress_bar
from pinstress.cli.size import OTHER_FILE_REMEDY, close, target_of, why_missed
from pinstress.cli.streams import unneeded
from pinstress.explore.size.at_probability import lighten_at
from pinstress.explore.size.counted import low_factor
from pinstress.explore.size.least_weight import LightStudy, lighten
from pinstress.explore.size.lightest_pin import Lightest, WeightGoal
from pinstress.explore.size.pin_shape import DIMENSION_KINDS, Proportions
from pinstress.explore.size.scaled_study import moved
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.model.pins import weight
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study
from reports.format.numbers import DASH, short
from reports.format.ranges import factor_range
from reports.text.least_weight import ChangedDimension, LightRow, print_light

MAX_NAMED_BINDING = 4  # of what binds, that is named


@dataclass(frozen=True)
class Wishes:
    """As the command line has them: kinds of dimensions, least wall over the diameter, least larger
    over smaller diameter of a step, and the probability for the factor, if any.
    """

    vary: Sequence[str] | None = None
    wall: float | None = None
    shoulder: float | None = None
    probability: float | None = None

    @property
    def given(self) -> list[str]:
        """Options that were given."""
        return [f"--{name}" for name, value in vars(self).items() if value is not None]


def require_aim(study: Study, wishes: Wishes, required: float, step: float | None) -> WeightGoal:
    """Raises: InputError for wishes that contradict each other or cannot be."""
    vary = tuple(dict.fromkeys(wishes.vary or DIMENSION_KINDS))
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
    usual = Proportions()
    limits = Proportions(
        usual.wall if wishes.wall is None else wishes.wall,
        usual.shoulder if wishes.shoulder is None else wishes.shoulder,
    )
    return WeightGoal(required, vary, limits, step)


def lighten_and_write(
    study: Study,
    aim: WeightGoal,
    out: Path | None,
    pins: list[str] | None,
    quiet: bool = False,
    jobs: int | None = None,
    probability: float | None = None,
) -> int:
    """Find the lightest pins and write the new study; returns the exit status: 1 if any pin does
    not verifiably reach the factor. jobs: pins in parallel, default the number of cores.
    probability: with which the factor is missed at most; without, that of the study as it is.

    Raises: InputError.
    """
    target = target_of(study, out)
    with progress_bar(alone=processes(jobs) == 1, quiet=quiet) as progress:
        found = (
            lighten(study, aim, pins, processes(jobs), progress)
            if probability is None
            else lighten_at(study, aim, probability, pins, processes(jobs), progress)
        )
    heavy = all(_density(study, each.pin) for each in found.pins)
    rows = [_row(study, found, each, aim, heavy) for each in found.pins]
    if changed := found.study.text != study.text and any(x.values or x.scale for x in found.pins):
        text = moved(found.study.text, study.path.parent, target.parent)
        write_new(target, text.encode(), OTHER_FILE_REMEDY)
    system = study.system
    unit = system.force if heavy else f"{system.length}³"
    with unneeded(target):
        print_light(rows, aim.required, (system.length, unit, heavy), console())
        if probability is not None:
            click.echo(
                f"The factor {short(aim.required)} is that which is missed with probability "
                f"{probability:g}, by the first order; pinstress reliability samples it."
            )
    if not quiet:
        close(study, found.study, target if changed else None)
    if not found.settled:
        click.echo(
            "Not settled: the factors in the run of the new study are not yet those that were "
            "aimed at; size the new study again.",
            err=True,
        )
    missed = [row for row in rows if row.why]
    for row in missed:
        click.echo(f"Not decided: pin {row.pin}: {row.why}.", err=True)
    return int(bool(missed) or not found.settled)


def _density(study: Study, name: str) -> float | None:
    return study.table.material[study.table.pin[name].material].density


def _row(study: Study, found: LightStudy, each: Lightest, aim: WeightGoal, heavy: bool) -> LightRow:
    mine = [p for p in found.results.pins if p.pin == each.pin and p.safety_factor is not None]
    worst = min(mine, key=lambda p: low_factor(p) or 0.0) if mine else None
    before, after = (pin_of(x, each.pin).volume for x in (study, found.study))
    written = each.values is not None or each.scale is not None
    return LightRow(
        pin=each.pin,
        factor=DASH if worst is None else factor_range(worst, "–"),
        factor_before=each.before,
        governs=DASH if worst is None else worst.case,
        weights=tuple(
            None if volume is None else _amount(study, each.pin, volume, heavy)
            for volume in (before, each.scaled, after if written else None)
        ),  # type: ignore[arg-type]
        at=min((x for (pin, _), x in found.at.items() if pin == each.pin), default=None),
        residual=None if each.optimality is None else each.optimality.residual,
        dimensions=tuple(_dimensions(study, found.study, each)),
        binding=each.binding[:MAX_NAMED_BINDING],
        bands=tuple(_bands(study, found.study, each.pin)) if written else (),
        solved=each.solved,
        why=(why_missed(found.results, each.pin) or _unlikely(found, each.pin, aim))
        if written
        else each.why,
        way=each.way,
    )


def _unlikely(found: LightStudy, pin: str, aim: WeightGoal) -> str:
    """Why the factor is not reached at a probability; empty if it is, or none is requested."""
    mine = {case: x for (name, case), x in found.at.items() if name == pin}
    unknown = [case for case, x in mine.items() if not math.isfinite(x)]
    low = [case for case, x in mine.items() if x < aim.required * (1.0 - 1e-9)]
    if unknown:
        return f"in {', '.join(unknown)} its factor at the probability was not found"
    return f"in {', '.join(low)} its factor at the probability is too small" if low else ""


def _amount(study: Study, name: str, volume: float, heavy: bool) -> float:
    """Weight in the study's units, or volume."""
    if not heavy:
        return volume / study.system.factor("length") ** 3
    of_one = weight(pin_of(study, name), _density(study, name) or 0.0) / pin_of(study, name).volume
    return of_one * volume / study.system.factor("force")


def _dimensions(study: Study, new: Study, each: Lightest) -> list[ChangedDimension]:
    """Those that changed."""
    from pinstress.analysis.remedies.dimensions import dimensions_of

    unit = study.system.factor("length")
    old = {d.key: d.value for d in dimensions_of(study, pin_of(study, each.pin))}
    after = {d.key: d.value for d in dimensions_of(new, pin_of(new, each.pin))}
    return [
        ChangedDimension(key, old[key] / unit, after[key] / unit)
        for key in after
        if key in old and abs(after[key] - old[key]) > 1e-9 * old[key]
    ]


def _bands(study: Study, new: Study, name: str) -> list[str]:
    """Where links bear on another diameter, with it."""
    unit, out = study.system.factor("length"), []
    old, now = pin_of(study, name), pin_of(new, name)
    for connection in now.connections:
        before, after = (2.0 * pin.band(connection).radius for pin in (old, now))
        if abs(after - before) > 1e-9 * before:
            out.append(f"{connection} {short(after / unit)}")
    return out
