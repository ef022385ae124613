"""Ground loads of a study: one section for all of a part of 14 CFR, by closed forms at a leg."""

from __future__ import annotations

import csv
import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pinstress import InputError, load_study, study_from
from pinstress.analysis.plan import all_loads
from pinstress.cli.commands import run_command_line
from pinstress.study.reading.file import raw_study
from pinstress.study.schema.mechanism import MechanismTable
from tests.conftest import ROOT
from tests.support.described import describe
from tests.support.each import each
from tests.support.errors import raises

V = 1e5  # the reference, N
RADIUS = 0.4
WHEEL = {"inertia": 0.9, "radius": 0.35, "speed": 40.0, "time": 0.15}
TURNING = {"name": "turning", "clause": "Report LR-12: turn", "vertical": 0.5, "side": 0.3}
BRAKED = {
    "name": "braked", "clause": "Report LR-12: brake", "vertical": 0.6, "drag": 0.4,
    "reference": 1.5e5, "braked": True,
}  # fmt: skip


def leg(**case: Any) -> dict[str, Any]:
    """A vertical leg AW of 2 m without mass, hinged at A, that a stay DE at 45 degrees holds."""
    section = {
        "kind": "ground", "part": "25", "reference": V, "body": "leg", "at": "W",
        "radius": RADIUS, "factors": [BRAKED, TURNING], **case,
    }  # fmt: skip
    return {
        "title": "leg",
        "units": "m-N-s",
        "case": {"main *": {key: value for key, value in section.items() if value is not None}},
        "mechanism": {
            "joint": {
                "A": {"at": [0, 0], "fixed_in": "ground", "connections": {"A": "leg"}},
                "W": {"at": [0, -2], "fixed_in": "leg", "connections": {"W": "wheel"}},
                "D": {"at": [1, 0], "fixed_in": "ground", "connections": {"D": "stay"}},
                "E": {"at": [0, -1], "fixed_in": "leg", "connections": {"E": "stay"}},
            },
            "body": {
                "leg": {"mass": 0.0, "centre": [0, -1], "inertia": 1.0},
                "stay": {"mass": 0.0, "centre": [0.5, -0.5], "inertia": 1.0},
                "wheel": {"mass": 0.0},
            },
        },
    }


SPIN = math.sqrt(2 * 0.9 * 40.0 * 0.8 * V / 0.15) / 0.35 / V  # appendix D, over V
CASES = {  # vertical and drag over their reference, the reference, whether drag is at the ground
    "25.473-spin-up": (1.0, SPIN, V, False),
    "25.473-spring-back": (1.0, -SPIN, V, False),
    "25.479-drag": (1.0, 0.25, V, False),
    "25.479-drift-inboard": (0.75, 0.3, V, False),
    "25.479-drift-outboard": (0.75, 0.3, V, False),
    "braked": (0.6, 0.4, 1.5e5, True),
    "turning-inboard": (0.5, 0.0, V, False),
    "turning-outboard": (0.5, 0.0, V, False),
}


def test_one_section_gives_all_cases_and_moments_about_the_hinge_their_forces() -> None:
    study = study_from(leg(spin_up=WHEEL))
    assert list(study.table.case) == [f"main {name}" for name in CASES]
    for name, (vertical, drag, reference, at_ground) in CASES.items():
        loads = all_loads(study, [f"main {name}"])[f"main {name}"]
        push = np.array([drag, vertical]) * reference
        arm = 2.0 + RADIUS * at_ground
        # Moments about A: drag at its arm, the stay's pull S along (1, 1)/sqrt 2 at E, 1 m below.
        stay = -math.sqrt(2.0) * arm * push[0]
        pull = stay * np.array([1.0, 1.0]) / math.sqrt(2.0)
        forces = dict(zip(loads.reactions.connections, loads.reactions.forces[0], strict=True))
        scale = 1e-9 * reference
        assert forces["A"][:2] == pytest.approx(push + pull, abs=scale), name
        assert np.linalg.norm(forces["D"][:2]) == pytest.approx(abs(stay), abs=scale), name


def test_a_note_on_the_drag_has_the_units_of_the_study() -> None:
    """An inch study was told kg m^2 and m/s beside a radius in inches."""
    wheel = {"inertia": "4000 lb*in^2", "radius": "14 in", "speed": "130 ft/s", "time": 0.15}
    study = study_from({**leg(spin_up=wheel, reference="33700 lbf"), "units": "in-lbf-s"})
    note = all_loads(study, ["main 25.473-spin-up"])["main 25.473-spin-up"].note
    assert "I = 4000 lb in^2, v = 1560 in/s, n = 0.8, t = 0.15 s, r = 14 in" in note


def test_without_a_wheel_the_drag_is_the_most_that_is_required() -> None:
    study = study_from(leg())
    loads = all_loads(study, ["main 25.473-spin-up"])["main 25.473-spin-up"]
    assert loads.ground is not None
    drag = loads.ground.forces[1]
    assert (drag.component, drag.factor, drag.towards) == ("drag", 0.8, "aft")
    assert "as no wheel is given" in loads.note


def test_reports_show_every_sum_with_its_clause(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = tmp_path / "leg.toml"
    study.write_text(TEXT + MORE, encoding="utf-8")
    assert run_command_line(["loads", str(study), "--out", str(tmp_path / "out")]) == 0
    told = capsys.readouterr()
    words = " ".join(told.out.split())
    assert "14 CFR 25.479(d)(2)" in words
    assert "side 0.1875 × 100,000 = 18,750 N outboard, at the ground contact" in words
    assert "Warning" not in told.err
    with (tmp_path / "out/wheel_loads.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    side = next(r for r in rows if r["case"] == "main 25.479-drift-inboard" and
                r["component"] == "side")  # fmt: skip
    assert float(side["factor"]) * float(side["reference"]) == float(side["force"]) == 18750.0
    assert float(side["direction_z"]) == -1.0
    assert (float(side["at_x"]), float(side["at_y"])) == pytest.approx((0.0, -2.4))
    results = json.loads((tmp_path / "out/results.json").read_text(encoding="utf-8"))
    assert len(results["wheel_loads"]) == len(rows) == 2 + 2 + 2 + 3 + 3 + 6
    clauses = {case["case"]: case["clause"] for case in results["loads"]}
    assert clauses["main 25.479-drag"].startswith("14 CFR 25.479(d)(1)")
    # Of more than eight cases the page shows those that govern, but every sum.
    page = (tmp_path / "out/report.html").read_text(encoding="utf-8")
    assert "Loads of the ground on wheels" in page
    assert "14 CFR 25.479(d)(2)" in page
    assert "Report LR-12, row 5" in page[page.index('id="wheel"') :]


MORE = "".join(
    f"""[[case."main *".factors]]
name = "row {k}"
clause = "Report LR-12, row {k}"
vertical = 0.5
"""
    for k in range(6)
)
TEXT = """title = "leg"
units = "m-N-s"
[case."main *"]
kind = "ground"
part = "25"
reference = 1e5
body = "leg"
at = "W"
radius = 0.4
[mechanism.joint]
A = { at = [0, 0], fixed_in = "ground", connections = { A = "leg" } }
W = { at = [0, -2], fixed_in = "leg", connections = { W = "wheel" } }
D = { at = [1, 0], fixed_in = "ground", connections = { D = "stay" } }
E = { at = [0, -1], fixed_in = "leg", connections = { E = "stay" } }
[mechanism.body]
leg = { mass = 0.0, centre = [0, -1], inertia = 1.0 }
stay = { mass = 0.0, centre = [0.5, -0.5], inertia = 1.0 }
wheel = { mass = 0.0 }
"""


def test_a_side_load_bends_the_hinge_of_a_leg_that_is_held() -> None:
    """Without the stay, of a leg that its drive holds: statics about A, all six components."""
    raw = leg(spin_up=WHEEL)
    mechanism = raw["mechanism"]
    del mechanism["joint"]["D"], mechanism["joint"]["E"], mechanism["body"]["stay"]
    mechanism["drive"] = {"body": "leg"}
    study = study_from(raw)
    inboard = -1.0  # of a left leg that flies to -x: towards the pilot's right, -z
    for name, (vertical, drag, reference, at_ground) in CASES.items():
        side = {"25.479-drift": 0.1875, "turning": 0.3}.get(re.sub("-(in|out)board", "", name), 0.0)
        side *= inboard if name.endswith("inboard") else -inboard
        loads = all_loads(study, [f"main {name}"])[f"main {name}"]
        k = loads.reactions.connections.index("A")
        push = np.array([drag, vertical, side]) * reference
        scale = 1e-9 * reference
        assert loads.reactions.forces[0, k] == pytest.approx(push, abs=scale), name
        # (0, -2 - r, 0) x (0, 0, F): about x; the moment about z is the drive's.
        about_x = -(2.0 + RADIUS) * push[2]
        assert loads.reactions.moments[0, k] == pytest.approx((about_x, 0.0, 0.0), abs=scale), name
        torque = (2.0 + RADIUS * at_ground) * push[0]
        assert loads.dynamics is not None
        assert abs(loads.dynamics.drive[0, 0]) == pytest.approx(abs(torque), abs=scale), name


def test_a_leg_whose_loads_name_its_lock_needs_no_drive() -> None:
    """A stay of two parts that the case locks holds the leg as the stay of one part does."""
    whole = all_loads(study_from(leg()), ["main 25.479-drag"])["main 25.479-drag"].reactions
    raw = leg(hold=["lock"])
    mechanism = raw["mechanism"]
    mechanism["joint"]["E"]["connections"] = {"E": "rod"}
    mechanism["body"]["rod"] = {"mass": 0.0, "centre": [0.5, -0.5], "inertia": 1.0}
    mechanism["slider"] = {"lock": {"bodies": ["stay", "rod"], "joints": ["D", "E"]}}
    locked = all_loads(study_from(raw), ["main 25.479-drag"])["main 25.479-drag"].reactions
    for name in whole.connections:
        k, there = locked.connections.index(name), whole.connections.index(name)
        expected = pytest.approx(whole.forces[0, there], abs=1e-6 * V)
        assert locked.forces[0, k] == expected, name


def test_a_wheel_beside_the_plane_rolls_its_leg() -> None:
    """The axle 0.25 m out of the plane: vertical and drag bend the hinge about x and y."""
    raw = leg(part=None, factors=[BRAKED])
    mechanism = raw["mechanism"]
    del mechanism["joint"]["D"], mechanism["joint"]["E"], mechanism["body"]["stay"]
    mechanism["drive"] = {"body": "leg"}
    mechanism["joint"]["W"]["z"] = 0.25
    loads = all_loads(study_from(raw), ["main braked"])["main braked"]
    k = loads.reactions.connections.index("A")
    drag, vertical = 0.4 * 1.5e5, 0.6 * 1.5e5
    expected = (-0.25 * vertical, 0.25 * drag, 0.0)  # (0, -2.4, z) x (drag, vertical, 0)
    assert loads.reactions.moments[0, k] == pytest.approx(expected, abs=1e-4)


def test_a_wheel_beside_the_plane_twists_its_leg_in_a_drop_too() -> None:
    """A leg without mass: what the ground does amid the wheel's band balances the fixed pins."""
    raw = raw_study(load_study(ROOT / "studies" / "drop.toml"))
    del raw["lug_defaults"]
    mechanism = raw["mechanism"]
    for body in mechanism["body"].values():
        body |= {"mass": 0.0} | ({"inertia": 0.0} if "inertia" in body else {})
    for name, z in (("A", -39.0), ("B", -25.0), ("C", -25.0), ("W", 130.0)):
        mechanism["joint"][name]["z"] = z
    bands = [{"length": 50, "diameter": 20, "name": "root"},
             {"length": 40, "diameter": 20, "connection": "W"}]  # fmt: skip
    raw["pin"] = {"W": {"material": "AISI 4340", "profile": bands, "clamp": ["root"]}}
    loads = all_loads(study_from(raw), ["landing", "drag"])
    landing = loads["landing"].landing
    assert landing is not None
    f = landing.at(np.array(loads["landing"].reactions.times)).forces
    on_ground = loads["drag"].ground
    assert on_ground is not None
    steady = np.sum([force.force for force in on_ground.forces], axis=0)[None]
    falling = np.stack([f.on_leg, f.vertical, 0.0 * f.vertical], axis=1)
    for name, push in (("landing", falling), ("drag", steady)):
        r, motion = loads[name].reactions, loads[name].dynamics
        assert motion is not None
        axle = np.append(motion.motion.joint("W")[0], np.full((len(push), 1), 0.2), axis=1)
        moment = np.cross(axle, push)
        for pin, at in (("A", (0.0, 0.0)), ("C", (0.18, 0.33))):
            k, z = r.connections.index(pin), (-0.039 if pin == "A" else -0.025)
            moment -= np.cross([*at, z], r.forces[:, k]) + r.moments[:, k]
        size = np.abs(np.cross(axle, push)).max()
        np.testing.assert_allclose(moment, 0.0, atol=1e-7 * size, err_msg=name)


def test_a_wheel_without_inertia_carries_no_brake() -> None:
    study = study_from(leg(part=None, factors=[BRAKED], body="wheel"))
    with raises(InputError, "particle", "body wheel"):
        all_loads(study, ["main braked"])


def test_a_nose_wheel_has_left_and_right() -> None:
    study = study_from(leg(part="23", leg="nose", factors=None))
    sides = ["main 23.499-side-left", "main 23.499-side-right"]
    assert list(study.table.case) == ["main 23.499-aft", "main 23.499-forward", *sides]
    one, other = (all_loads(study, [name])[name].ground for name in sides)
    assert one is not None
    assert other is not None
    assert one.forces[1].force == pytest.approx((0.0, 0.0, 0.7 * 2.25 * V))
    assert other.forces[1].force == pytest.approx((0.0, 0.0, -0.7 * 2.25 * V))


def test_a_side_that_is_stated_is_the_only_one() -> None:
    rows = [{**TURNING, "toward": "outboard"}]
    assert list(study_from(leg(part=None, factors=rows)).table.case) == ["main turning"]
    assert len(study_from(leg(toward="inboard")).table.case) == 6


@each(
    ("case", "code"),
    [
        ({"part": None, "factors": None}, "unusable-name"),
        ({"rule": "25.479-drag"}, "give-one"),
        ({"reference": None}, "give-one"),
        ({"leg": "nose"}, "no-rule"),
        ({"part": "23", "leg": "nose", "toward": "inboard", "factors": None}, "no-inboard"),
        ({"radius": None}, "no-radius"),
        ({"factors": [{**TURNING, "name": ""}]}, "empty"),
        ({"factors": [BRAKED, BRAKED]}, "duplicate-case"),
        ({"factors": [{**TURNING, "clause": " "}]}, "empty"),
        ({"factors": [{**BRAKED, "name": "a/b"}]}, "unusable-name"),
        ({"factors": [{**TURNING, "lateral": 1.0}]}, "unknown-key"),
        ({"at": "nowhere"}, "unknown-joint"),
        ({"part": "27"}, "not-a-choice"),
        ({"hold": ["nothing"]}, "unknown-stop"),
        ({"part": "23", "leg": "nose", "reference": None, "drop": "fall"}, "key-not-applicable"),
    ],
)
def test_mistakes_have_codes_and_are_told_once(case: dict[str, Any], code: str) -> None:
    with pytest.raises(InputError) as caught:
        describe(study_from(leg(**case)))
    assert code in caught.value.codes
    assert len(caught.value.codes) == 1


def test_several_cases_need_a_name_with_a_star() -> None:
    raw = leg()
    raw["case"]["main"] = raw["case"].pop("main *")
    with pytest.raises(InputError) as caught:
        study_from(raw)
    assert caught.value.codes == ("unusable-name",)
    assert 'case."main *"' in str(caught.value)


def test_the_main_gear_passes_all_landings_on_to_the_aircraft() -> None:
    """Equilibrium of the whole gear: what its four pins on the aircraft get is the wheel's load.

    The same gear at rest is subtracted, so that weights drop out.
    """
    raw = raw_study(load_study(ROOT / "studies" / "main_gear.toml"))
    del raw["pin"]  # whose bands would lie beside the plane
    hold = {"hold": ["downlock"], "distribution": "uniform"}
    raw["case"] = {
        "rest": {"kind": "static", **hold},
        "main-*": {
            "kind": "ground", "part": "25", "reference": 1.8e5, "body": "leg", "at": "W",
            "radius": 0.45, "spin_up": {"inertia": 12.0, "radius": 0.4, "speed": 70.0, "time": 0.1},
            "factors": [BRAKED, TURNING], **hold,
        },
    }  # fmt: skip
    study = study_from(raw)
    names = [name for name in study.table.case if name != "rest"]
    assert len(names) == 8
    loads = all_loads(study, ["rest", *names])
    rest = loads["rest"].reactions
    mechanism = study.table.mechanism
    assert isinstance(mechanism, MechanismTable)
    fixed = [(rest.connections.index(name), mechanism.joint[name].at) for name in "ABGD"]
    for name in names:
        ground, now = loads[name].ground, loads[name].reactions
        assert ground is not None
        push, moment = np.zeros(3), np.zeros(3)
        for load in ground.forces:
            force, arm = np.array(load.force), np.array(load.arm)
            push += force
            moment += np.cross(np.array([0.0, -2.2, 0.0]) + arm, force)
        for k, (x, y) in fixed:
            force = now.forces[0, k] - rest.forces[0, k]
            push -= force
            moment -= np.cross([x, y, 0.0], force) + now.moments[0, k] - rest.moments[0, k]
        np.testing.assert_allclose(push, 0.0, atol=1e-4, err_msg=name)
        np.testing.assert_allclose(moment, 0.0, atol=1e-4, err_msg=name)


def test_a_drop_gives_reference_wheel_and_time_of_spin_up() -> None:
    """The wheel of studies/drop.toml by appendix D, and the strut as at the largest reaction."""
    raw = raw_study(load_study(ROOT / "studies" / "drop.toml"))
    del raw["pin"], raw["lug_defaults"]
    section = {"kind": "ground", "part": "23", "drop": "landing", "body": "arm", "at": "W"}
    raw["case"]["all-*"] = section
    study = study_from(raw)
    names = ["all-23.D-spin-up", "all-23.D-spring-back", "all-23.479-drag"]
    assert list(study.table.case) == ["landing", "drag", *names]
    loads = all_loads(study, ["landing", "drag", *names])
    landing = loads["landing"].landing
    assert landing is not None
    peak = landing.peaks["vertical"]
    drag = math.sqrt(2 * 0.12 * 32.0 * 0.8 * peak.value / peak.time) / 0.2
    assert drag < 0.8 * peak.value
    for name, sign in zip(names, (1.0, -1.0), strict=False):
        ground = loads[name].ground
        assert ground is not None
        total = np.sum([force.force for force in ground.forces], axis=0)
        assert total == pytest.approx((sign * drag, peak.value, 0.0))
    one, other = loads["drag"].reactions, loads[names[2]].reactions
    np.testing.assert_array_equal(one.forces, other.forces)  # the rule alone, or of the part
