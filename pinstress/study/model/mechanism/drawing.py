"""The mechanism as drawn, with the positions of its joints and the bodies on them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from loads import LinkageError
from pinstress.study.model.mechanism.joint_layout import Point
from pinstress.study.reading.file import Study
from pinstress.study.schema.mechanism import MechanismTable
from pinstress.study.schema.tables import AnyMechanism


@dataclass(frozen=True)
class Drawing:
    """The mechanism as drawn.

    at: positions of the joints, m.
    shown: formats a length (m) as text.
    """

    mechanism: MechanismTable
    at: dict[str, Point]
    shown: Callable[[float], str]

    def on(self, joint: str) -> list[str]:
        """Return the bodies at a joint, including the one that carries the pin."""
        j = self.mechanism.joint[joint]
        return ([j.fixed_in] if j.fixed_in else []) + list(j.connections.values())

    def require_on(self, joint: str, body: str, at: tuple[str, str], right: str) -> None:
        """Raise LinkageError if the body is not at the joint.

        at: the key in question.
        right: the remedy that the message names.
        """
        if body not in (on := self.on(joint)):
            raise LinkageError(
                f"{' '.join(at)}: joint {joint} is not on {body} but on {', '.join(on)}; {right}",
                "joint-not-on-body",
                at,
            )


def joints_on(mechanism: AnyMechanism, body: str) -> list[str]:
    """Return the joints on which a body turns or whose pin it carries."""
    joints = mechanism.joint.items()
    return [name for name, j in joints if body in (j.fixed_in, *j.connections.values())]


def shown_length(study: Study, length: float) -> str:
    """Return a length (m) as text in the study's unit."""
    return f"{length / study.system.factor('length'):.4g} {study.system.length}"
