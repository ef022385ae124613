"""The forces that a case applies, as animations draw them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from pinstress.analysis.gather.gather import loads_only
from pinstress.analysis.plan import prepare
from pinstress.study.reading.file import load_study
from pinstress.study.reading.in_python import study_from
from tests.support.each import each

STUDIES = Path(__file__).parents[3] / "studies"


def test_they_do_the_work_that_the_balance_of_powers_has() -> None:
    """Force times the point's velocity, the slope of its position, is the power put in."""
    (motion,) = loads_only(load_study(STUDIES / "excavator.toml"), ["dig"]).motion
    (load,) = motion.applied
    assert load.body == "bucket"
    assert motion.time is not None
    velocity = np.gradient(load.position, motion.time, axis=0, edge_order=2)
    power = (load.force * velocity).sum(axis=1)
    largest = np.abs(motion.ledger.applied).max()
    assert np.abs(power - motion.ledger.applied).max() < 2e-3 * largest


def test_an_impulse_acts_at_its_joint() -> None:
    results = loads_only(load_study(STUDIES / "landing_gear.toml"), ["landing"])
    (motion,) = results.motion
    (load,) = motion.applied
    at = motion.joint_position[:, motion.joints.index("J")]
    assert load.position == pytest.approx(at)
    # as the note of the case has it, which is from the study alone
    assert f"{load.sizes[0]:,.1f} lbf" in results.reactions[0].note
    assert load.force[0, 0] == 0.0
    assert motion.aside == ()


@each(
    ("ranges", "ratios"),
    [
        ("impulse_time = [0.1, 0.2]", [1.5, 0.75]),  # of the impulse over 0.15 s
        ('velocity_change = ["10 ft/s", "25 ft/s"]', [0.4, 1.0]),  # of 25 ft/s
        ('pulse = ["half-sine"]', [1.0, np.pi / 2.0]),  # and its own, the mean force
    ],
)
def test_an_impulse_may_have_a_range_of_one_of_its_numbers(
    tmp_path: Path, ranges: str, ratios: list[float]
) -> None:
    """The others are its own: the documentation shows a range of the impulse time alone."""
    before, rest = (STUDIES / "landing_gear.toml").read_text(encoding="utf-8").split("[published]")
    head, _ = before.split("[case.landing.apply.impulse.range]")
    (study := tmp_path / "ranged.toml").write_text(
        f"{head}[case.landing.apply.impulse.range]\n{ranges}\n[mechanism]{rest.split('[mechanism]')[1]}"
    )
    (task,) = prepare(load_study(study), pins=["J"], cases=["landing"]).tasks
    (load,) = task.loads
    upwards = task.also["landing"].forces[:, load.surfaces.index("J2"), 1]
    # Weights are nearly nothing beside the 194,000 lbf of the impulse.
    given = load.forces[0, load.surfaces.index("J2"), 1]
    assert upwards / given == pytest.approx(ratios, rel=1e-3)


def test_side_forces_are_apart_from_those_in_the_plane(tmp_path: Path) -> None:
    """A load with all three components and a couple, which is not drawn."""
    text = (STUDIES / "main_gear.toml").read_text(encoding="utf-8")
    text = text.replace('["40 kN", "90 kN"]', "[4e4, 9e4, -2e4]")
    text = text[: text.index("[pin.C]")].replace("apply]]\n", "apply]]\ncouple = [1, 2, 3]\n")
    (study := tmp_path / "side.toml").write_text(text, encoding="utf-8")
    (motion,) = loads_only(load_study(study), ["locked"]).motion
    (plane,), (side,) = motion.applied, motion.aside
    assert plane.force == pytest.approx(np.array([[4e4, 9e4]]))
    assert side.force == pytest.approx(np.array([[0.0, 0.0, -2e4]]))
    assert side.body == "leg"
    assert side.position == pytest.approx(plane.position)


def test_a_spring_between_two_points_has_its_ends_where_they_move() -> None:
    rope = {"bodies": ["ground", "arm"], "joints": [[0.0, 300.0], "B"], "stiffness": 100.0}
    study = study_from(
        {
            "title": "Arm on a rope",
            "units": "mm-N-s",
            "mechanism": {
                "joint": {
                    "O": {"at": [0.0, 0.0], "fixed_in": "ground", "connections": {"O1": "arm"}},
                    "B": {"at": [200.0, 0.0], "fixed_in": "arm", "connections": {"B1": "load"}},
                },
                "body": {
                    "arm": {"mass": 1.0, "centre": [100.0, 0.0], "inertia": 10.0},
                    "load": {"mass": 1.0},
                },
                "drive": [{"body": "arm", "start": "0 deg", "end": "90 deg", "duration": 1.0}],
                "spring": {"rope": rope},
            },
            "case": {"lift": {"kind": "motion", "samples": 5}},
        }
    )
    (motion,) = loads_only(study).motion
    ends = motion.springs["rope"]
    assert ends[:, 0] == pytest.approx(np.tile([0.0, 300.0], (len(ends), 1)))
    assert ends[-1, 1] == pytest.approx([0.0, 200.0], abs=1e-9)
