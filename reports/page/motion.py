"""Motions on the page: plots of linkages, and the animation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import count
from pathlib import Path

from reports.data.results import Results
from reports.format.file_names import animation_name
from reports.format.packed import deflated
from reports.plots.spec import Plot

Find = Callable[..., Plot | None]


@dataclass(frozen=True)
class MotionPart:
    """A motion: its animation as a compressed HTML page (or empty), and its plots."""

    case: str
    animation: str
    plots: tuple[Plot, ...]


def motion_parts(results: Results, find: Find, directory: Path) -> list[MotionPart]:
    """Return the cases with plots or an animation, which is read from the folder of the page.

    find: returns a plot by its kind and names, None if there is none.
    """
    kinds = {s.case: list(_linkage(s.case, find)) for s in results.skeletons}
    parts = [
        MotionPart(
            case,
            _animation(case, directory),
            tuple(plot for kind in names if (plot := find(kind, case)) is not None),
        )
        for case, names in kinds.items()
    ]
    return [part for part in parts if part.plots or part.animation]


def _linkage(case: str, find: Find) -> Iterator[str]:
    yield from ("linkage", "bodies")
    for number in count(2):
        if find(f"bodies-{number}", case) is None:
            break
        yield f"bodies-{number}"
    yield from ("transmission", "shaking", "ledger")


def _animation(case: str, directory: Path) -> str:
    path = directory / animation_name(case)
    return deflated(path.read_bytes()) if path.is_file() else ""
