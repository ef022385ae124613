"""Each motion on the page: figures of linkages and legs, and the animation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import count
from pathlib import Path

from reports.data.results import LinkageMotion, Results
from reports.format.file_names import animation_name

Uri = Callable[..., str | None]
LEG = {
    "leg-motion": "rotation of the wheel, velocities and accelerations over time",
    "leg-momenta": "rates of momentum and of angular momentum over time",
    "leg-hinge": "force and moment on the hinge, actuator moment and spin moment over time",
}


@dataclass(frozen=True)
class MotionPart:
    """A motion: its animation as an HTML page (or empty), figures with captions."""

    case: str
    animation: str
    figures: tuple[tuple[str, str], ...]


def motion_parts(results: Results, uri: Uri, directory: Path) -> list[MotionPart]:
    """The cases with figures or an animation, which is read from the folder of the page.

    uri: address of a plot by its kind and names, None if there is none.
    """
    parts = [_linkage(m, uri, _animation(m.case, directory)) for m in results.motion]
    parts += [_part(leg.case, LEG, uri, _animation(leg.case, directory)) for leg in results.legs]
    return [part for part in parts if part.figures or part.animation]


def _linkage(motion: LinkageMotion, uri: Uri, animation: str) -> MotionPart:
    moving = motion.time is not None
    texts = {
        "linkage": "the linkage from start to end, with the paths of its joints"
        if moving
        else "the position of the linkage"
    }
    if moving:
        turning = "angles, angular velocities and angular accelerations of bodies over time"
        texts["bodies"] = turning
        for number in count(2):
            if uri(f"bodies-{number}", motion.case) is None:
                break
            texts[f"bodies-{number}"] = f"{turning}, continued ({number})"
        texts |= {
            "transmission": "transmission angles, and condition number of the loop equations",
            "shaking": "force of the linkage on its ground, and moment about "
            + motion.shaking_about,
            "ledger": "powers of drives, gravity, applied loads and friction, "
            "and the rate of kinetic energy",
        }
    return _part(motion.case, texts, uri, animation)


def _part(case: str, texts: dict[str, str], uri: Uri, animation: str) -> MotionPart:
    found = ((uri(kind, case), f"{case}: {text}") for kind, text in texts.items())
    return MotionPart(case, animation, tuple((at, text) for at, text in found if at is not None))


def _animation(case: str, directory: Path) -> str:
    path = directory / animation_name(case)
    return path.read_text(encoding="utf-8") if path.is_file() else ""
