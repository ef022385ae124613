"""The stress of lugs in runs: their rows, directions, margins, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import pinstress
from fea.core.linear_solver import SolveError
from fea.support.records import LugStress
from pinstress.analysis.plan import all_loads
from pinstress.analysis.results import solve
from pinstress.study.model.shanks import shank_angles
from reports.files import write_reports
from tests.support.each import each
from tests.support.mechanism.machines import STUDIES
from tests.support.pins.remembered import MEMO, remembered
from tests.support.study_text import edited

CLEVIS = (STUDIES / "clevis.toml").read_text(encoding="utf-8")
SHANK = "edge_radius = 0.5\nshank = {}"


def study(tmp_path: Path, *changes: tuple[str, str], shank: str = SHANK) -> pinstress.Study:
    text = CLEVIS.replace("edge_radius = 0.5", shank)
    path = tmp_path / "clevis.toml"
    path.write_text(edited(text, changes), encoding="utf-8")
    return pinstress.load_study(path)


def lugs(results: pinstress.RunResults) -> dict[tuple[str, str], LugStress]:
    (row,) = results.pins
    assert row.joint is not None
    return {(x.connection, x.place): x for x in row.joint.lugs}


@pytest.fixture(scope="module")
def clevis(tmp_path_factory: pytest.TempPathFactory) -> tuple[pinstress.RunResults, Path]:
    out = tmp_path_factory.mktemp("clevis")
    results = remembered(study(out))
    write_reports(results, out / "run")
    return results, out / "run"


@pytest.mark.seconds
def test_the_lugs_of_a_clevis(clevis: tuple[pinstress.RunResults, Path]) -> None:
    found = lugs(clevis[0])
    assert set(found) == {(c, p) for c in ("LEFT", "EYE", "RIGHT") for p in ("free", "beneath")}
    left, right, eye = (found[name, "free"] for name in ("LEFT", "RIGHT", "EYE"))
    assert left.max_von_mises == pytest.approx(right.max_von_mises, rel=1e-2)
    bearing = 50_000.0 / (20.0 * 20.0)  # MPa, alike in all three lugs
    assert eye.max_hoop_stress > 2.0 * bearing  # a pin that bends, and a bore that stretches
    assert 90.0 < abs(eye.angle) < 130.0  # where contact ends
    assert eye.safety_factor == pytest.approx(700.0 / eye.max_von_mises)
    assert eye.error_estimate == pytest.approx(eye.mesh + eye.rings + eye.sampling)
    assert eye.assumed


def test_the_pins_row_is_that_of_its_contact(
    clevis: tuple[pinstress.RunResults, Path], tmp_path: Path
) -> None:
    """The stress of lugs changes nothing of the pin."""
    contact = ("[analysis]", '[analysis]\njoints = "contact"')
    bare = study(tmp_path, contact, shank="edge_radius = 0.5")
    (row,), (with_lugs,) = remembered(bare).pins, clevis[0].pins
    assert row.max_von_mises == with_lugs.max_von_mises
    assert row.outcome == with_lugs.outcome


def test_files_have_the_rows(clevis: tuple[pinstress.RunResults, Path]) -> None:
    _, out = clevis
    assert (out / "lugs.csv").read_text(encoding="utf-8").count("\n") == 7
    rows = json.loads((out / "results.json").read_text(encoding="utf-8"))["lugs"]
    assert {row["connection"] for row in rows} == {"LEFT", "EYE", "RIGHT"}
    assert rows[0]["max_von_mises"] > 0.0
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "Stress of the lugs" in page
    assert "Stress of the lugs at LEFT, EYE, RIGHT: shank along the largest force" in page


@pytest.mark.seconds
def test_a_lug_is_judged_with_the_factor_of_its_pin(
    clevis: tuple[pinstress.RunResults, Path],
) -> None:
    (row,) = clevis[0].pins
    margins = [m for m in row.margins if m.method == "lug, von Mises stress at the bore"]
    limit = {m.at: m for m in margins if m.level == "limit"}
    assert {m.factor for m in limit.values()} == {1.5}
    eye = lugs(clevis[0])["EYE", "free"]
    assert limit["EYE"].demand == pytest.approx(eye.max_von_mises + eye.error_estimate)
    beneath = [m for m in row.margins if "beneath the pin" in m.method]
    assert beneath
    assert not any(m.governs for m in beneath)


def test_a_lug_without_a_shank_is_named_among_checks_not_made(tmp_path: Path) -> None:
    results = remembered(study(tmp_path, shank="edge_radius = 0.5"))
    (row,) = results.pins
    assert any("lug.EYE.shank" in m.needs for m in row.margins)


def test_prescribed_loads_leave_the_stress_of_lugs_open(tmp_path: Path) -> None:
    """It is named, not forgotten."""
    loads = ("[analysis]", '[analysis]\njoints = "prescribed"')
    (row,) = pinstress.run(study(tmp_path, loads)).pins
    lug = [m for m in row.margins if m.method.startswith("lug, von Mises")]
    assert [m.needs for m in lug] == ["the contact of the pin with its lugs, solved in full"]
    assert all(m.margin is None for m in lug)


def test_a_failure_at_a_lug_leaves_the_pin_its_stress(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*_: object) -> None:
        raise SolveError("contact does not settle", "contact-unsettled")

    monkeypatch.setattr("fea.lug.in_joint.lug_stresses", fails)
    (row,) = solve(pinstress.prepare(study(tmp_path)), memo=MEMO).pins
    assert row.outcome == "safe"
    assert row.joint is not None
    assert "no stress of the lugs: contact does not settle" in row.joint.remark
    assert any("solved in full" in m.needs for m in row.margins)


def test_lugs_of_a_joint_that_is_not_varied_are_not_varied_either(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*_: object) -> None:
        raise SolveError("the joint was varied", "contact-unsettled")

    monkeypatch.setattr("fea.lug.in_joint.varied_pressures", fails)
    known = "[lug_defaults.range]\nclearance = [0.05, 0.05]\nstiffness = [1, 1]\n[pin.P]"
    tilts = (
        'lug.EYE = { tilt = "guided" }',
        "".join(
            f'lug.{name} = {{ tilt = "guided", range = {{ tilt = ["guided", "guided"] }} }}\n'
            for name in ("LEFT", "EYE", "RIGHT")
        ),
    )
    (row,) = solve(pinstress.prepare(study(tmp_path, ("[pin.P]", known), tilts)), memo=MEMO).pins
    assert row.joint is not None
    assert row.joint.range is not None
    assert row.joint.range.variations == ()
    assert {x.over_joint for x in row.joint.lugs} == {1.0}


def test_turning_forces_and_shanks_together_changes_nothing(
    clevis: tuple[pinstress.RunResults, Path], tmp_path: Path
) -> None:
    turned = study(
        tmp_path,
        ("[-25000, 0]", "[0, -25000]"),
        ("[50000, 0]", "[0, 50000]"),
        shank=SHANK.replace("{}", '{ angle = "-90 deg" }'),
    )
    # The shanks of the fork point along -y, where its sides pull; that of the eye is pushed.
    text = turned.path.read_text(encoding="utf-8")
    text = text.replace('tilt = "guided" }', 'tilt = "guided", shank = { angle = "90 deg" } }')
    turned.path.write_text(text, encoding="utf-8")
    found = lugs(remembered(pinstress.load_study(turned.path)))
    for key, lug in lugs(clevis[0]).items():
        assert found[key].max_von_mises == pytest.approx(lug.max_von_mises, rel=2e-2), key
        assert not found[key].assumed


def test_a_shank_turns_with_its_link(tmp_path: Path) -> None:
    """The strut of the landing gear: at the start, by the coordinates of its joints as drawn."""
    text = (STUDIES / "landing_gear.toml").read_text(encoding="utf-8")
    path = tmp_path / "gear.toml"
    path.write_text(text.replace("[lug_defaults]\n", "[lug_defaults]\nshank = {}\n"), "utf-8")
    turned = pinstress.load_study(path)
    case = all_loads(turned, ["retract"])["retract"]
    angles = shank_angles(turned, "C", case)
    at = {j.name: j.at for j in case.dynamics.motion.linkage.joints}  # type: ignore[union-attr]
    here = np.array(at["C"])
    middle = (np.array(at["D"]) + np.array(at["G"])) / 2.0
    x, y = middle - here
    r = case.reactions
    first = angles["C2"].angle[0] + r.turn[0, r.connections.index("C2")]
    assert np.cos(first - np.arctan2(y, x)) == pytest.approx(1.0, abs=1e-6)
    assert np.ptp(np.unwrap(angles["C2"].angle)) > 0.1 or np.ptp(r.turn) > 0.1
    assert "D" in angles["C2"].assumed


@each(
    ("shank", "part"),
    [
        ("{ width = 19 }", "times as wide as the hole"),
        ("{ width = 60 }", "tapered"),
        ("{ length = 10 }", "held inside of its head"),
        ("{ end = 9 }", "0.9 times the radius of its hole; it must be larger"),
        ("{ end = 40 }", "no wall"),
        ('{ shape = "square", width = 15 }', "0.75 times as wide as the hole of its eye"),
        ('{ shape = "square", end = 9 }', "0.9 times the radius of its hole"),
        ('{ angle = "0 deg", toward = "X" }', "not both"),
        ('{ toward = "X" }', "toward: needs the joints of a linkage in the plane"),
        ('{ shape = "oval" }', "shape"),
        ("{ length = -1 }", "must be positive"),
    ],
)
def test_an_impossible_shank_is_refused_before_anything_is_solved(
    tmp_path: Path, shank: str, part: str
) -> None:
    with pytest.raises(pinstress.InputError, match=part):
        pinstress.run(study(tmp_path, shank=SHANK.replace("{}", shank)))


TRUSS = """
title = "Two bars under a load"
units = "mm-N-s"
[mechanism]
gravity = [0, 0]
[mechanism.joint.A]
at = [-300, 0]
fixed_in = "ground"
connections = { AC = "left" }
[mechanism.joint.B]
at = [400, 0]
fixed_in = "ground"
connections = { BC = "right" }
[mechanism.joint.C]
at = [0, 400]
connections = { CA = "left", CB = "right" }
[mechanism.body.left]
mass = 0
inertia = 0
[mechanism.body.right]
mass = 0
inertia = 0
[case.load]
kind = "static"
apply = [{ body = "left", at = "C", force = [0, -20000] }]
[pin.C]
material = "AISI 4340"
profile = [
  { length = 10, diameter = 20, connection = "CA" },
  { length = 20, diameter = 20, connection = "CB" },
  { length = 10, diameter = 20, name = "FAR", ear_of = "CA" },
]
lug.CA.shank = {}
[pin.B]
material = "AISI 4340"
profile = [
  { length = 10, diameter = 20, name = "NEAR" },
  { length = 20, diameter = 20, connection = "BC" },
  { length = 10, diameter = 20, name = "OTHER" },
]
lug.NEAR.shank.toward = "A"
lug.OTHER.shank = {}
"""


def directions(pin: str, text: str = TRUSS) -> dict[str, float]:
    """The directions of its shanks, degrees."""
    truss = pinstress.study_from(text)
    angles = shank_angles(truss, pin, all_loads(truss, ["load"])["load"])
    return {name: np.degrees(found.angle.item()) for name, found in angles.items()}


def test_both_ears_of_a_link_have_its_shank() -> None:
    """Also where the other ear states a lug of its own."""
    own = TRUSS.replace("lug.CA.shank = {}", "lug.CA.shank = {}\nlug.FAR.shank = { width = 50 }")
    along = np.degrees(np.arctan2(-400.0, -300.0))
    for text in (TRUSS, own):
        found = directions("C", text)
        assert (found["CA"], found["FAR"]) == pytest.approx((along, along))
    other = own.replace("{ width = 50 }", '{ toward = "B" }')
    assert directions("C", other)["FAR"] == pytest.approx(-45.0)


def test_the_lug_of_a_structure_points_where_it_says() -> None:
    """Without a word it lies along the largest force, as nothing gives its direction."""
    assert directions("B") == pytest.approx({"NEAR": 180.0})
