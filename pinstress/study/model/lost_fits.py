"""Pins pressed into their lugs that come loose at the temperature of a case."""

from __future__ import annotations

from collections.abc import Iterable

from fea.support.records import LostFit
from pinbase.keys import key_part
from pinbase.rounding import rounded_up
from pinstress.study.model.tasks import Task
from pinstress.study.model.temperature import rise_of, temperature_words
from pinstress.study.reading.file import Study


def lost_fits(study: Study, task: Task, case: str) -> tuple[LostFit, ...]:
    """Return the lugs from which a pressed-in pin comes loose at the temperature of a case.

    The temperature in the text ("LEFT above 143 degC") is that at which the least interference is
    lost.
    """
    rise, out = rise_of(study, case), []
    for lug in task.given:
        every = (x - lug.growth for x in (lug.clearance, *(lug.range.clearance or ())))
        lost = [x for x in every if x < 0.0 <= x + lug.growth]
        if rise and lost:
            opens = temperature_words(study, -rise * max(lost) / lug.growth)
            where = f"{lug.connection} {'above' if rise > 0.0 else 'below'} {opens}"
            out.append(LostFit(where, -max(lost), lug.growth))
    return tuple(out)


def _longest(study: Study, lost: Iterable[LostFit]) -> str:
    """Return the largest of the interferences that are needed, in the study's units:
    "0.0228 mm".
    """
    needed = max(x.needed for x in lost) / study.system.factor("length")
    return f"{rounded_up(needed):.3g} {study.system.length}"


def lost_fit_warnings(study: Study, todo: Iterable[Task]) -> list[str]:
    """Return a warning for each case whose temperature loosens pins pressed into their lugs."""
    return [
        str(
            study.error(
                f"case.{key_part(case.case)}.temperature: pin {task.pin.name} is no longer pressed "
                f"in at {temperature_words(study, rise_of(study, case.case))}: its press fit is "
                f"lost in {', '.join(x.where for x in lost)}; use an interference of more than "
                f"{_longest(study, lost)}, or say what else retains the pin"
            )
        )
        for task in todo
        for case in task.loads
        if (lost := lost_fits(study, task, case.case))
    ]
