"""The path of the largest force in a sentence, from the load through the pins to the frame."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fea.core.places import Places, SectionPlace, SurfacePlace
from reports.data.motion import AppliedForce
from reports.data.results import Results
from reports.data.row import GoverningLoad, PinResult
from reports.data.skeleton import Skeleton
from reports.format.place_words import action
from reports.text.load_path import load_path
from tests.support.results.rows import row_with, with_values

# Connections: name, body, joint. The load on the wheel goes J–E–A; the side link EF takes little.
CONNECTIONS = (
    ("J1", "leg", "J"), ("J2", "wheel", "J"), ("E1", "EF", "E"), ("E2", "leg", "E"),
    ("E3", "AE", "E"), ("A", "AE", "A"), ("F1", "EF", "F"),
)  # fmt: skip
FORCES = {"J1": -194.0, "J2": 194.0, "E1": 2.0, "E2": 194.0, "E3": -196.0, "A": 196.0, "F1": 19.0}


def force(body: str, size: float = 194.0) -> AppliedForce:
    return AppliedForce(body, np.zeros((1, 3)), np.array([[0.0, size, 0.0]]))


def skeleton(*applied: AppliedForce) -> Skeleton:
    joints = ("J", "E", "A", "F")
    return Skeleton(
        "landing", None, ("leg", "wheel", "EF", "AE"), (), np.zeros((1, 4, 3)), joints, ("A", "F"),
        np.zeros((1, 4, 3)), np.zeros((1, 4, 3)), CONNECTIONS, applied=applied,
    )  # fmt: skip


def rows(forces: dict[str, float] = FORCES) -> list[PinResult]:
    def loads(pin: str) -> tuple[GoverningLoad, ...]:
        return tuple(
            GoverningLoad(name, body, np.array([0.0, forces[name], 0.0]), np.zeros(3))
            for name, body, joint in CONNECTIONS
            if joint == pin
        )

    return [replace(row_with(pin, "landing"), loads=loads(pin)) for pin in "EJAF"]


@pytest.fixture
def landing(results: Results) -> Results:
    return replace(results, space=(skeleton(force("wheel")),), motion=())


def test_the_one_load_is_followed_to_the_frame(landing: Results) -> None:
    unit = landing.units.force
    path = load_path(landing, rows())
    assert path == f"194 {unit} goes J–E–A to the frame; others at most 19.0."


def test_there_is_no_path_where_several_loads_act_or_forces_differ(landing: Results) -> None:
    """A load on a link between, two loads, and a lever, whose pins carry more than the load."""
    unit = landing.units.force
    plain = f"E, J and A carry up to 196 {unit}, others 19.0."
    several = skeleton(force("wheel"), force("EF", 1.0))
    others = [skeleton(force("wheel", size)) for size in (50.0, 0.0)]  # that of weights alone
    for other in (several, skeleton(force("leg")), *others, skeleton()):
        assert load_path(replace(landing, space=(other,)), rows()) == plain
    assert load_path(replace(landing, space=()), rows()) == plain


def test_a_path_that_does_not_reach_the_frame_is_none(landing: Results) -> None:
    off_ground = replace(skeleton(force("wheel")), ground=("F",))
    text = load_path(replace(landing, space=(off_ground,)), rows())
    assert text.startswith("E, J and A carry up to")


def test_a_single_pin_has_its_largest_force(landing: Results) -> None:
    text = load_path(landing, rows()[:1])
    assert text == f"The largest force on pin E is 196 {landing.units.force}, at E3 (landing)."


def test_a_pin_on_which_nothing_acts_has_no_largest_force(landing: Results) -> None:
    """An idle press fit had one of 0 N, and bending that dominates it."""
    row = rows()[0]
    idle = replace(row, loads=tuple(replace(x, force=np.zeros(3)) for x in row.loads))
    assert load_path(landing, [idle]) == ""
    section = SectionPlace(0.0, 0.0, "converged", 0.0, None, 0.0, 0.0, 0.0, 0.0)
    surface = SurfacePlace(1e6, 1e4, "converged", (0.0, 0.0, 0.0), None)
    assert action(with_values(idle, places=Places("surface", surface, section))) == ""
