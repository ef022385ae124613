"""Centres of mass that a study does not state: where they follow from joints, and where not."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

import pytest

from pinstress import InputError, study_from
from pinstress.analysis.plan import all_loads
from tests.support.each import each
from tests.support.errors import raises

G = 9.80665
PLANE: dict[str, Any] = {
    "title": "x",
    "units": "m-N-s",
    "case": {"rest": {"kind": "static"}},
    "mechanism": {
        "joint": {"O": {"at": [0, 0], "fixed_in": "ground", "connections": {"O": "arm"}}},
        "body": {"arm": {"mass": 50.0}},
        "drive": {"body": "arm"},
    },
}
RAM = {
    "joint": {
        "O": {"at": [0, 0], "fixed_in": "ground", "connections": {"O": "arm"}},
        "P": {"at": [0.2, -0.6], "fixed_in": "ground", "connections": {"P": "barrel"}},
        "Q": {"at": [0.8, 0.0], "fixed_in": "arm", "connections": {"Q": "rod"}},
    },
    "body": {"arm": {"mass": 0.0}, "barrel": {"mass": 40.0}, "rod": {"mass": 20.0}},
    "slider": {"ram": {"bodies": ["barrel", "rod"], "joints": ["P", "Q"]}},
    "drive": {"slider": "ram"},
}
SPACE = {
    "dimension": 3,
    "joint": {"O": {"at": [0, 0, 0], "axis": [0, 0, 1], "fixed_in": "ground",
                    "connections": {"O": "arm"}}},
    "body": {"arm": {"mass": 50.0}},
    "drive": {"joint": "O"},
}  # fmt: skip


def with_mechanism(**parts: Any) -> dict[str, Any]:
    raw = deepcopy(PLANE)
    raw["mechanism"] = {**deepcopy(parts)}
    return raw


def changed(mechanism: dict[str, Any], name: str, **keys: Any) -> dict[str, Any]:
    raw = with_mechanism(**mechanism)
    raw["mechanism"]["body"][name] |= keys
    return raw


def torque(raw: dict[str, Any]) -> float:
    """Torque of the drive, N m."""
    rest = all_loads(study_from(raw), ["rest"])["rest"]
    if rest.space is not None:
        return float(rest.space.dynamics.drive[0, 0])
    assert rest.dynamics is not None
    return float(rest.dynamics.drive[0, 0])


@each(
    ("raw", "bodies"),
    [
        (PLANE, ["arm"]),
        (changed(PLANE["mechanism"], "arm", inertia=3.0), ["arm"]),
        (with_mechanism(**RAM), ["barrel", "rod"]),
        (changed(RAM, "rod", centre=[0.7, -0.1]), ["barrel"]),
        (with_mechanism(**SPACE), ["arm"]),
    ],
)
def test_a_body_that_turns_about_its_only_joint_states_its_centre(
    raw: dict[str, Any], bodies: list[str]
) -> None:
    """Its weight has a moment about the joint, which would be left out without a word."""
    named = [f"body {body}: a body with 1 joint needs a centre" for body in bodies]
    with raises(InputError, "missing-centre", *named):
        all_loads(study_from(raw), ["rest"])


def test_the_weight_of_an_arm_and_of_a_ram_has_its_moment() -> None:
    """Arm, barrel and rod by moments about their pins."""
    for raw in (
        changed(PLANE["mechanism"], "arm", centre=[0.7, 0.1]),
        changed(SPACE | {"gravity": [0, -G, 0]}, "arm", centre=[0.7, 0.1, 0.0]),
    ):
        assert torque(raw) == pytest.approx(50.0 * G * 0.7)
    raw = changed(RAM, "barrel", centre=[0.3, -0.5])
    raw["mechanism"]["body"]["rod"]["centre"] = [0.7, -0.1]
    force = all_loads(study_from(raw), ["rest"])["rest"].reactions.force("Q")[0]
    # About P of barrel and rod, and about O of the arm without weight, which is level.
    about_p = 40.0 * G * (0.3 - 0.2) + 20.0 * G * (0.7 - 0.2)
    assert 0.6 * (force[1] - force[0]) == pytest.approx(-about_p)
    assert force[1] == pytest.approx(0.0, abs=1e-9)


def test_a_force_at_a_centre_that_nothing_states_is_refused() -> None:
    """Of an arm without mass the centre may be left out; then a force does not act there."""
    push: dict[str, Any] = {"body": "arm", "force": [0.0, -100.0]}
    law = {"position_of": "arm", "points": [["-9 deg", 100], ["9 deg", 100]]}
    varies: dict[str, Any] = {"body": "arm", "direction": [0, -1], "force_law": law}
    about = {"body": "arm", "couple": 70.0}
    for mechanism, two in ((PLANE["mechanism"], True), (SPACE, False)):
        raw = changed(mechanism | {"gravity": [0.0] * (2 if two else 3)}, "arm", mass=0.0)
        for load in (push, varies) if two else ({"body": "arm", "force": [0.0, -100.0, 0.0]},):
            raw["case"]["rest"]["apply"] = [load]
            with raises(InputError, "missing-key", "apply[1]: give at", "of arm"):
                all_loads(study_from(raw), ["rest"])
            raw["case"]["rest"]["apply"] = [load | {"at": [0.7, 0.2] if two else [0.7, 0.2, 0.0]}]
            assert torque(raw) == pytest.approx(70.0)
    raw = changed(PLANE["mechanism"] | {"gravity": [0.0, 0.0]}, "arm", mass=0.0)
    raw["case"]["rest"]["apply"] = [about]
    assert torque(raw) == pytest.approx(-70.0)


def test_gears_blocks_and_weights_have_their_centre_at_their_joint() -> None:
    """A weight that hangs on an arm, a block in a guide and a gear: nothing needs stating."""
    raw = changed(PLANE["mechanism"], "arm", centre=[0.7, 0.1])
    mechanism = raw["mechanism"]
    mechanism["joint"] |= {
        "W": {"at": [1, 0], "fixed_in": "arm", "connections": {"W": "weight"}},
        "S": {"at": [0.5, 0], "fixed_in": "arm", "connections": {"S": "gear"}},
    }
    mechanism["body"] |= {"weight": {"mass": 10.0}, "gear": {"mass": 4.0, "inertia": 0.1}}
    mechanism["gear"] = {"g": {"bodies": ["ground", "gear"], "joints": ["O", "S"], "teeth": [4, 1]}}
    assert torque(raw) == pytest.approx(G * (50.0 * 0.7 + 10.0 * 1.0 + 4.0 * 0.5))
