"""The sequences of a study, with their cases and the time at which each begins."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from pinbase.arrays import Floats
from pinbase.keys import key_part
from pinstress.study.reading.choices import select
from pinstress.study.reading.file import Study
from pinstress.study.schema.sequence import SequenceTable

MAX_SEQUENCE_INSTANTS = 1_000_000  # limit for each sequence


@dataclass(frozen=True)
class Occurrence:
    """A case that begins at a time of the sequence and lasts for a duration, s."""

    case: str
    begin: float
    duration: float


def steps(table: SequenceTable, times: Mapping[str, Floats | None]) -> Iterator[Occurrence]:
    """Yield every occurrence of every case.

    times: (T,) s of each case, None at rest.
    """
    begin = 0.0
    for step in table.steps:
        course = times[step.case]
        duration = step.duration or 0.0 if course is None else float(np.ptp(course))
        for _ in range(step.repeat):
            yield Occurrence(step.case, begin, duration)
            begin += duration


def complete(study: Study, cases: Container[str]) -> tuple[str, ...]:
    """Return the sequences whose cases are all among these."""
    table = study.table.sequence
    return tuple(name for name, s in table.items() if all(x.case in cases for x in s.steps))


def chosen_cases(study: Study, wanted: Iterable[str] | None) -> list[str]:
    """Return the wanted cases, with those of the wanted sequences; by default all.

    Raises: ChoiceError.
    """
    names = select([*study.table.case, *study.table.sequence], wanted, "case")
    chosen = dict.fromkeys(names)
    for name in chosen.keys() & study.table.sequence.keys():
        chosen |= dict.fromkeys(step.case for step in study.table.sequence[name].steps)
    return [name for name in study.table.case if name in chosen]


def require_times(study: Study, times: Mapping[str, Floats | None]) -> None:
    """Raise InputError for a step whose case has neither a time nor a duration, or has both, and
    for a sequence with too many instants.
    """
    for name in complete(study, times):
        count = 0
        for i, step in enumerate(study.table.sequence[name].steps, 1):
            course, where = times[step.case], f"sequence.{key_part(name)}.steps[{i}]"
            count += step.repeat * (2 if course is None else len(course))
            if (course is None) == (step.duration is None):
                what = "is at rest; give its" if course is None else "has its own time; remove the"
                raise study.error(f"{where}: {step.case} {what} duration", code="give-one")
        if count > MAX_SEQUENCE_INSTANTS:
            raise study.error(
                f"sequence.{key_part(name)}: {count:,} instants; the limit is "
                f"{MAX_SEQUENCE_INSTANTS:,}",
                code="too-large",
            )
