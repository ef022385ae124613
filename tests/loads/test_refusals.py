"""Linkages that contradict themselves, each with what is wrong and where."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from loads import GROUND, Body, Connection, Joint, Linkage, LinkageError, Sharing, Slider, Turn
from loads.motion import at_rest
from tests.loads.mechanisms import four_bar, slider_crank

BAR, CRANK = four_bar(), slider_crank()
O2, A, B, O4 = BAR.joints
(GUIDE,) = CRANK.sliders
TURN = BAR.turns[0]


def joints(*changed: Joint) -> dict[str, object]:
    """The four-bar's joints with some instead of those of the same name."""
    by_name = {j.name: j for j in changed}
    return {"joints": tuple(by_name.get(j.name, j) for j in BAR.joints)}


@pytest.mark.parametrize(
    ("linkage", "change", "message"),
    [
        (BAR, {"bodies": (*BAR.bodies, BAR.bodies[0])}, "body 'crank' is named twice"),
        (BAR, {"joints": (*BAR.joints, O2)}, "joint 'O2' is named twice"),
        (BAR, joints(replace(A, connections=(*A.connections, A.connections[0]))),
         "connection 'A2' is named twice"),
        (BAR, {"driven": ("crank", "crank")}, "drive 'crank' is named twice"),
        (BAR, {"turns": (TURN, TURN)}, "slider or turn 'crank' is named twice"),
        (BAR, {"bodies": (*BAR.bodies, Body(GROUND, 1.0, (0, 0), 1.0))}, "no body may be called"),
        (BAR, {"sharing": (Sharing(("A2", "X"), (1.0, 1.0)),)}, "connection 'X', which does not"),
        (BAR, joints(replace(O2, connections=(Connection("F12", "wheel"),))),
         "connection F12: there is no body 'wheel'"),
        (BAR, joints(replace(O2, fixed_in="crank")), "pin O2 is fixed in crank, so that body"),
        (BAR, joints(replace(O2, fixed_in="wheel")), "joint O2: there is no body 'wheel'"),
        (BAR, joints(replace(A, connections=A.connections[:1])), "at least two connections"),
        (BAR, {"turns": (replace(TURN, body="wheel"),)}, "drive crank: there is no body 'wheel'"),
        (BAR, {"turns": (replace(TURN, base="crank"),)}, "crank cannot turn against itself"),
        (BAR, {"bodies": (replace(BAR.bodies[0], inertia=None), *BAR.bodies[1:])},
         "body crank: without inertia it is a particle"),
        (CRANK, {"sliders": (replace(GUIDE, base="wall"),)}, "guide: there is no body 'wall'"),
        (CRANK, {"sliders": (replace(GUIDE, base="block"),)}, "block cannot slide on itself"),
        (CRANK, {"sliders": (replace(GUIDE, end=GUIDE.start, direction=None),)},
         "its two points coincide"),
    ],
    ids=lambda x: x if isinstance(x, str) else "",
)  # fmt: skip
def test_what_contradicts_itself_is_refused(
    linkage: Linkage, change: dict[str, object], message: str
) -> None:
    with pytest.raises(LinkageError, match=message):
        replace(linkage, **change)  # type: ignore[arg-type]


def test_a_particle_may_slide_on_the_ground_or_hang_on_its_only_joint() -> None:
    assert next(b for b in CRANK.bodies if b.name == "block").inertia is None
    hung = replace(
        BAR,
        bodies=(*BAR.bodies, Body("load", 5.0, B.at, None)),
        **joints(replace(B, connections=(*B.connections, Connection("B5", "load")))),  # type: ignore[arg-type]
    )
    assert hung.index["load"] == 3


def test_drives_must_be_as_many_as_are_told() -> None:
    with pytest.raises(ValueError, match="drive"):
        at_rest(BAR, [0.9, 1.0])


@pytest.mark.parametrize(
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
    from loads.four_bar import four_bar as recognised

    ground, crank, coupler, rocker = lengths
    found = recognised(four_bar(ground, crank, coupler, rocker, angle=1.2))
    assert found is not None
    assert found.kind == kind
    assert found.lengths == pytest.approx(lengths)


def test_what_is_no_four_bar_is_not_called_one() -> None:
    from loads.four_bar import four_bar as recognised

    assert recognised(CRANK) is None
    assert recognised(replace(BAR, turns=(Turn("coupler", "coupler", 0.0),), driven=())) is None
    slide = Slider("s", GROUND, "rocker", (0.0, 0.0), B.at)
    assert recognised(replace(BAR, sliders=(slide,))) is None
    assert np.isfinite(BAR.length_scale)
