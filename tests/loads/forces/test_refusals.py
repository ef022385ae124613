"""Linkages that contradict themselves, each with what is wrong and where."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from loads import (
    GROUND,
    Applied,
    Body,
    Connection,
    Joint,
    Linkage,
    LinkageError,
    Sharing,
    Slider,
    Turn,
    motion_reactions,
)
from loads.motion.motion import at_rest
from tests.support.each import each
from tests.support.errors import raises
from tests.support.mechanism.mechanisms import four_bar, slider_crank

BAR, CRANK = four_bar(), slider_crank()
O2, A, B, O4 = BAR.joints
(GUIDE,) = CRANK.sliders
TURN = BAR.turns[0]


def joints(*changed: Joint) -> dict[str, object]:
    """The four-bar's joints with some instead of those of the same name."""
    by_name = {j.name: j for j in changed}
    return {"joints": tuple(by_name.get(j.name, j) for j in BAR.joints)}


@pytest.mark.parametrize(
    ("linkage", "change", "code", "named"),
    [
        (BAR, {"bodies": (*BAR.bodies, BAR.bodies[0])}, "duplicate-name", "body 'crank'"),
        (BAR, {"bodies": (*BAR.bodies, Body("pin A", 1.0, (0, 0), 1.0))}, "duplicate-name",
         "body 'pin A'"),
        (BAR, {"joints": (*BAR.joints, O2)}, "duplicate-name", "joint 'O2'"),
        (BAR, joints(replace(A, connections=(*A.connections, A.connections[0]))),
         "duplicate-name", "connection 'A2'"),
        (BAR, {"driven": ("crank", "crank")}, "duplicate-name", "drive 'crank'"),
        (BAR, {"turns": (TURN, TURN)}, "duplicate-name", "slider or turn 'crank'"),
        (BAR, {"bodies": (*BAR.bodies, Body(GROUND, 1.0, (0, 0), 1.0))}, "reserved-name",
         "body 'ground'"),
        (BAR, {"sharing": (Sharing(("A2", "X"), (1.0, 1.0)),)}, "unknown-connection",
         "'X'"),
        (BAR, joints(replace(O2, connections=(Connection("F12", "wheel"),))),
         "unknown-body", "connection F12"),
        (BAR, joints(replace(O2, fixed_in="crank")), "fixed-and-turning", "connection F12"),
        (BAR, joints(replace(O2, fixed_in="wheel")), "unknown-body", "joint O2"),
        (BAR, joints(replace(A, connections=A.connections[:1])), "too-few-connections", "joint A"),
        (BAR, {"turns": (replace(TURN, body="wheel"),)}, "unknown-body",
         "drive crank"),
        (BAR, {"turns": (replace(TURN, base="crank"),)}, "same-body", "drive crank: crank"),
        (BAR, {"bodies": (replace(BAR.bodies[0], inertia=None), *BAR.bodies[1:])},
         "particle", "body crank"),
        (BAR, {"bodies": (*BAR.bodies, Body("bob", 5.0, B.at, None)),
               "turns": (TURN, Turn("stop", "bob", 0.0)),
               **joints(replace(B, connections=(*B.connections, Connection("B5", "bob"))))},
         "missing-inertia", "stop acts on its angle"),
        (CRANK, {"sliders": (replace(GUIDE, base="wall"),)}, "unknown-body", "slider guide"),
        (CRANK, {"sliders": (replace(GUIDE, base="block"),)}, "same-body", "slider guide: block"),
        (CRANK, {"sliders": (replace(GUIDE, end=GUIDE.start, direction=None),)},
         "no-direction", "slider guide"),
    ],
    ids=lambda x: x if isinstance(x, str) else "",
)  # fmt: skip
def test_what_contradicts_itself_is_refused(
    linkage: Linkage, change: dict[str, object], code: str, named: str
) -> None:
    with raises(LinkageError, code, named):
        replace(linkage, **change)  # type: ignore[arg-type]


def test_a_particle_may_slide_on_the_ground_or_hang_on_its_only_joint() -> None:
    assert next(b for b in CRANK.bodies if b.name == "block").inertia is None
    hung = replace(
        BAR,
        bodies=(*BAR.bodies, Body("load", 5.0, B.at, None)),
        **joints(replace(B, connections=(*B.connections, Connection("B5", "load")))),  # type: ignore[arg-type]
    )
    assert hung.index["load"] == 3


@pytest.mark.parametrize(
    "load",
    [Applied("load", (B.at[0] + 0.1, B.at[1]), (0.0, -1.0)), Applied("load", B.at, couple=1.0)],
)
def test_a_particle_carries_no_moment(load: Applied) -> None:
    hung = replace(
        BAR,
        bodies=(*BAR.bodies, Body("load", 5.0, B.at, None)),
        **joints(replace(B, connections=(*B.connections, Connection("B5", "load")))),  # type: ignore[arg-type]
    )
    motion = at_rest(hung, [TURN.drawn])
    motion_reactions("x", motion, [Applied("load", (B.at[0], B.at[1] - 0.5), (0.0, -1.0))])
    with raises(LinkageError, "particle", "body load: a load has a moment"):
        motion_reactions("x", motion, [load])


def test_drives_must_be_as_many_as_are_told() -> None:
    with raises(LinkageError, "laws-mismatch"):
        at_rest(BAR, [0.9, 1.0])


@each(
    ("lengths", "kind"),
    [
        ((1.0, 0.4, 0.9, 0.8), "crank-rocker (Grashof)"),
        ((0.3, 0.9, 0.8, 1.0), "double-crank (Grashof)"),
        ((0.9, 0.8, 0.3, 1.0), "double-rocker (Grashof)"),
        ((1.0, 0.9, 0.8, 0.3), "rocker-crank (Grashof)"),
        ((1.0, 0.7, 0.6, 0.8), "triple-rocker (not Grashof)"),
        ((1.0, 0.5, 1.0, 0.5), "change point"),
    ],
)
def test_grashofs_classes(lengths: tuple[float, float, float, float], kind: str) -> None:
    from loads.motion.four_bar import four_bar as recognised

    ground, crank, coupler, rocker = lengths
    found = recognised(four_bar(ground, crank, coupler, rocker, angle=1.2))
    assert found is not None
    assert found.kind == kind
    assert found.lengths == pytest.approx(lengths)


def test_what_is_no_four_bar_is_not_called_one() -> None:
    from loads.motion.four_bar import four_bar as recognised

    assert recognised(CRANK) is None
    assert recognised(replace(BAR, turns=(Turn("coupler", "coupler", 0.0),), driven=())) is None
    slide = Slider("s", GROUND, "rocker", (0.0, 0.0), B.at)
    assert recognised(replace(BAR, sliders=(slide,))) is None
    assert np.isfinite(BAR.length_scale)
