"""Every study that ships runs from file to safety factors; `loads` writes its mechanics."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest

from pinstress.cli.commands import run_command_line
from pinstress.study.reading.file import load_study, raw_study
from tests.conftest import ROOT
from tests.support.programs.once import Shipped

STUDIES = ROOT / "studies"
MECHANISMS = [
    *("grenier2008", "bowman2019", "matrix_four_bar", "slider_crank", "excavator"),
    *("crane", "engine", "hood", "main_gear", "pump_jack", "scissor_lift", "bucket"),
    *("planetary", "landing_gear_part25"),
]
# No link with two joints alone moves what is at its end.
NO_COUPLER = "crane", "hood", "scissor_lift", "planetary", "grenier2008", "landing_gear_part25"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("study", "pin", "verdict"),
    [
        ("bowman2019", "A", "converged"),
        pytest.param("matrix_four_bar", "C", "converged", marks=pytest.mark.long),
        pytest.param("slider_crank", "A", "converged", marks=pytest.mark.long),
        ("clevis", "P", "converged"),
        ("pin_in_lugs", "P", "converged"),
        pytest.param("bucket_pin", "Z", "converged", marks=pytest.mark.long),
        ("fatigue", "P", "converged"),
        ("lifting_arm", "O", "converged"),
        ("kuleuven2014", "trunnion", "singular"),
    ],
)
def test_the_whole_pipeline(shipped: Shipped, study: str, pin: str, verdict: str) -> None:
    """The trunnion's moment is a traction that jumps at its band's edges, where stress grows like a
    logarithm; away from them it is known as well as the others.
    """
    out = shipped(study)
    found = json.loads((out / "results.json").read_text(encoding="utf-8"))
    decided = all(result["meets_required"] is not None for result in found["pins"])
    assert (out.parent / "status").read_text() == ("0" if decided else "1")
    results = [result for result in found["pins"] if result["pin"] == pin]
    assert results
    for result in results:
        assert result["verdict"] == verdict
        assert result["meets_required"] is (True if verdict == "converged" else None)
        surface = result["surface"]  # sections between two clamps have the error of a beam
        assert surface["error_estimate"] <= 0.1 * surface["max_von_mises"]
        assert result["safety_factor"] > found["required_safety_factor"]
        assert ("at the edge of a load" in result["note"]) == (verdict == "singular")
    assert (out / "report.html").is_file()


@pytest.mark.parametrize("study", MECHANISMS)
def test_loads_alone(tmp_path: Path, study: str, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    command = ["loads", str(STUDIES / f"{study}.toml"), "--out", str(out)]
    assert run_command_line(command) == 0
    printed = capsys.readouterr().out
    assert "power balance" in printed
    rows = list(csv.DictReader((out / "reactions.csv").read_text().splitlines()))
    turned = list(csv.DictReader((out / "reactions_pin_axes.csv").read_text().splitlines()))
    assert len(rows) == len(turned) > 0
    for world, own in zip(rows, turned, strict=True):  # turning does not change the size
        sizes = [math.hypot(float(r["fx"]), float(r["fy"])) for r in (world, own)]
        assert sizes[0] == pytest.approx(sizes[1], rel=1e-12, abs=1e-9)
    found = json.loads((out / "results.json").read_text(encoding="utf-8"))
    assert found["pins"] == []
    for case in found["loads"]:
        assert case["power_violation"] < 1e-9
    for name in ("motion.csv", "joints.csv", "linkage.csv"):
        assert len((out / name).read_text().splitlines()) > 1
    angles = (out / "transmission.csv").read_text().splitlines()[1:]
    assert bool(angles) == (study not in NO_COUPLER)
    if study == "main_gear":  # others are held by stops, through which the drive moves nothing
        assert {line.split(",")[0] for line in angles} == {"retract"}
    drives = list(csv.DictReader((out / "drive.csv").read_text().splitlines()))
    for case in found["loads"]:
        mine = [r for r in drives if r["case"] == case["case"]]
        assert {r["drive"] for r in mine} == {d["drive"] for d in case["drives"]} != set()
        for d in case["drives"]:
            assert d["largest"] * (1 + 1e-9) >= max(
                abs(float(r["force"])) for r in mine if r["drive"] == d["drive"]
            )


def test_the_leg_in_space(tmp_path: Path) -> None:
    """Force and moment on the hinge, and what the drives do, from the momenta of leg and wheel."""
    out = tmp_path / "out"
    command = ["loads", str(STUDIES / "kuleuven2014.toml"), "--out", str(out)]
    assert run_command_line(command) == 0

    def read(name: str, key: str, of: str, columns: str) -> np.ndarray:
        rows = csv.DictReader((out / f"{name}.csv").read_text().splitlines())
        return np.array([[float(r[c]) for c in columns.split()] for r in rows if r[key] == of])

    slope, g, hinge = np.radians(3.0), 9.80665, np.array([0.90, 0.0, -0.30])
    times = read("bodies", "body", "leg", "time")[:, 0]
    heading = 0.3 * times + 0.025 * times**2
    up = [np.sin(slope) * np.sin(heading), np.sin(slope) * np.cos(heading)]
    weight = -g * np.stack([*up, np.full(len(times), np.cos(slope))], axis=1)
    force, moment = np.zeros((2, len(times), 3))
    for body, mass in (("leg", 45.0), ("wheel", 30.0)):
        push = mass * weight - read("bodies", "body", body, "p_rate_x p_rate_y p_rate_z")
        force += push
        moment += np.cross(read("bodies", "body", body, "x y z") - hinge, push)
        moment -= read("bodies", "body", body, "L_rate_x L_rate_y L_rate_z")
    pin = read("reactions", "connection", "B", "fx fy fz mx my mz")
    actuator = read("drive", "drive", "fold", "force")[:, 0]
    np.testing.assert_allclose(pin[:, :3], force, atol=1e-9 * np.abs(force).max())
    assert np.abs(pin[:, 4]).max() < 1e-9 * np.abs(moment).max()
    pin[:, 4] -= actuator
    np.testing.assert_allclose(pin[:, 3:], moment, atol=1e-9 * np.abs(moment).max())
    # The closed forms of errors.csv, put right, of the wheel's centre while the leg folds.
    beta = np.pi / 4.0 * (1.0 - np.cos(np.pi * times / 3.0))
    rate = np.pi**2 / 12.0 * np.sin(np.pi * times / 3.0)
    second = np.pi**3 / 36.0 * np.cos(np.pi * times / 3.0)
    yaw, s, c = 0.3 + 0.05 * times, np.sin(beta), np.cos(beta)
    x, z = -1.2 * s - 0.2 * c, -1.2 * c + 0.2 * s
    a = [
        second * z - yaw**2 * (0.9 + x) - rate**2 * x,
        1.5 + 0.05 * (0.9 + x) + 2.0 * yaw * rate * z,
        -second * x - rate**2 * z,
    ]
    ours = read("bodies", "body", "wheel", "ax ay az")
    np.testing.assert_allclose(ours, np.stack(a, axis=1), atol=1e-9)
    spin = read("drive", "drive", "spin", "force")[:, 0]  # about its own axis also the yaw turns
    axial = 1.5 * (-25.0 / 3.0 - 0.05 * -s - yaw * rate * -c)
    np.testing.assert_allclose(spin, axial, atol=1e-9)


def test_the_gear_under_regulations_is_the_landing_gear() -> None:
    """Its linkage, its pins and their lugs, number for number; only cases and factors differ."""
    here, there = (
        raw_study(load_study(STUDIES / f"{name}.toml"))
        for name in ("landing_gear_part25", "landing_gear")
    )
    for key in ("units", "material", "mechanism", "lug_defaults", "pin"):
        assert here[key] == there[key], key


def test_guides_are_written_with_their_friction(tmp_path: Path) -> None:
    out = tmp_path / "out"
    command = ["loads", str(STUDIES / "slider_crank.toml"), "--out", str(out)]
    assert run_command_line(command) == 0
    rows = list(csv.DictReader((out / "sliders.csv").read_text().splitlines()))
    assert len(rows) == 241
    for r in rows:
        bound = 0.15 * abs(float(r["normal"]))
        assert abs(float(r["friction"])) == pytest.approx(bound, abs=1e-9)
    assert {float(r["friction"]) > 0 for r in rows} == {True, False}
    assert {float(r["normal"]) > 0 for r in rows} == {True, False}


def test_a_jammed_guide_ends_with_a_message(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    command = ["loads", str(STUDIES / "slider_crank_jammed.toml"), "--out", str(out)]
    assert run_command_line(command) == 2
    assert "friction jams slider guide" in capsys.readouterr().err
    assert not out.exists()


def test_the_linkage_of_the_docs_runs(tmp_path: Path) -> None:
    text = (ROOT / "docs" / "mechanisms.md").read_text(encoding="utf-8")
    study = tmp_path / "four_bar.toml"
    study.write_text(text.split("```toml\n")[1].split("```")[0], encoding="utf-8")
    out = tmp_path / "out"
    assert run_command_line(["loads", str(study), "--out", str(out)]) == 0


def test_the_study_that_scatters(tmp_path: Path) -> None:
    """Its check, and a few of its designs: those of fits of ISO 286 are in the limits."""
    from pyarrow import parquet

    text = (STUDIES / "lifting_arm.toml").read_text(encoding="utf-8")
    study, out = tmp_path / "few.toml", tmp_path / "out"
    study.write_text(text.replace("count = 32", "count = 4"), encoding="utf-8")
    assert run_command_line(["check", str(study)]) == 0
    command = ["sweep", str(study), "--out", str(out), "--jobs", "1", "--quiet", "--pins", "O"]
    assert run_command_line(command) == 0
    designs = parquet.read_table(out / "designs.parquet").to_pydict()
    assert len(designs["design"]) == 4
    limits = {
        "pin.O.profile[3].diameter": (19.979, 20.0),  # h7
        "pin.O.profile[2].fillet": (1.2, 1.8),
        "pin.A.lug.EYE.clearance": (0.02, 0.074),  # H8/f7
    }
    for key, (low, high) in limits.items():
        assert all(low <= value <= high for value in designs[key])
    assert all(factor > 1.0 for factor in designs["safety_factor"])
