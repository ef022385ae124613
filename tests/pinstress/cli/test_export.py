"""`pinstress export`: a reviewer's deck says what to expect, and CalculiX finds it."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

import pinstress
from assess.opinion.calculix import stresses
from assess.opinion.calculix_in_lugs import PinInLugs, largest_moment, transverse
from assess.opinion.calculix_joint import joint_opinion
from assess.opinion.calculix_joint_answer import contact_forces
from assess.opinion.calculix_joint_mesh import Fineness
from assess.opinion.opinions import (
    MAX_MAXIMUM_DIFFERENCE,
    MAX_MOMENT_DIFFERENCE,
    MAX_STRESS_DIFFERENCE,
)
from fea.core.voigt import von_mises
from geometry import body_of_revolution
from pinstress.analysis.plan import prepare
from pinstress.analysis.solve import solve_tasks
from pinstress.cli.commands import run_command_line
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.programs.command_line import QUICK

BOTH_MANUALS = {
    *("NODE", "ELEMENT", "MATERIAL", "ELASTIC", "SOLID SECTION", "SURFACE", "EQUATION", "SPRING"),
    *("SURFACE INTERACTION", "SURFACE BEHAVIOR", "CONTACT PAIR", "BOUNDARY", "STEP", "STATIC"),
    *("CLOAD", "NODE PRINT", "NODE FILE", "EL FILE", "END STEP"),
}
LUGS = """
title = "Lugs: ±"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "500 MPa"
[pin.P]
material = "steel"
profile = [
  { length = 20, diameter = 20, connection = "left" },
  { length = 30, diameter = 20, connection = "middle" },
  { length = 20, diameter = 20, connection = "right" },
]
[pin.P.lug.left]
tilt = "free"
[pin.P.lug.middle]
[pin.P.lug.right]
[case.pull]
kind = "given"
forces = { left = [5000, 0], middle = [-10000, 0], right = [5000, 0] }
[case.turn]
kind = "given"
forces = { left = [5000, 0, 800], middle = [-10000, 0, -800], right = [5000, 0, 0] }
[analysis]
tolerance = 0.2
joints = "contact"
"""
FILLETED = (
    LUGS.replace('material = "steel"\nprofile', 'material = "steel"\nfillet = 2\nprofile')
    .replace("length = 30, diameter = 20", "length = 30, diameter = 30")
    .replace('tilt = "free"', "")
    .replace("[case.pull]", "[lug_defaults]\nouter_diameter = 60\nedge_radius = 0.5\n[case.pull]")
    .replace("tolerance = 0.2", "tolerance = 0.05")
)
SINGLE_SHEAR = """
title = "Single shear"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "500 MPa"
[pin.P]
material = "steel"
profile = [
  { length = 5, diameter = 20 },
  { length = 20, diameter = 20, connection = "one" },
  { length = 0.6, diameter = 20 },
  { length = 20, diameter = 20, connection = "other" },
  { length = 5, diameter = 20 },
]
[lug_defaults]
outer_diameter = 50
edge_radius = 0.3
[case.pull]
kind = "given"
forces = { one = [10000, 0], other = [-10000, 0] }
[analysis]
tolerance = 0.05
joints = "contact"
"""
ON_STRUCTURE = (
    SINGLE_SHEAR.partition("  {")[0]
    + """
  { length = 20, diameter = 20, name = "left" },
  { length = 2, diameter = 20 },
  { length = 20, diameter = 20, connection = "eye" },
  { length = 8, diameter = 20 },
  { length = 10, diameter = 20, name = "right" },
]
[lug_defaults]
outer_diameter = 50
edge_radius = 0.5
[pin.P.lug.left]
[pin.P.lug.eye]
clearance = 0.01
[pin.P.lug.right]
clearance = 0.005
[case.pull]
kind = "given"
forces = { eye = [0, 10000] }
[analysis]
tolerance = 0.05
joints = "contact"
"""
)
NOTHING_HOLDS = QUICK.replace('clamp = ["start"]', "").replace("clamp", "# clamp")


def exported(folder: Path, study: str, *options: str, pin: str = "B", case: str = "landing") -> int:
    (folder / "study.toml").write_text(study, encoding="utf-8")
    where = ["--out", str(folder / "deck.inp"), "--quiet"]
    return run_command_line(["export", str(folder / "study.toml"), pin, case, *options, *where])


def expected(deck: Path) -> dict[str, str]:
    """The numbers at the head of a deck."""
    return dict(re.findall(r"^\*\*   (\w+) = (.*)$", deck.read_text("ascii"), re.MULTILINE))


def keywords(deck: Path) -> set[str]:
    return set(re.findall(r"^\*([A-Z][A-Z ]+[A-Z])", deck.read_text("ascii"), re.MULTILINE))


def test_the_head_has_the_numbers_of_the_run(tmp_path: Path) -> None:
    """In the study's units, as have the nodes; the loads are the links' forces."""
    assert exported(tmp_path, QUICK, "--deck", "calculix") == 0
    text, numbers = (tmp_path / "deck.inp").read_text("ascii"), expected(tmp_path / "deck.inp")
    row = pinstress.run(pinstress.load_study(tmp_path / "study.toml"))["B", "landing"]
    assert row.places is not None
    assert row.places.section is not None
    for key, value in {
        "max_von_mises": row.max_von_mises,
        "error_estimate": row.error_estimate,
        "safety_factor": row.safety_factor,
        "section_z": row.places.section.z,
        "section_moment": row.places.section.bending_moment,
    }.items():
        assert float(numbers[key]) == pytest.approx(value, rel=1e-5), key
    assert "Units, consistent: in, lbf, psi" in text
    assert "study.toml (One pin)" in text
    assert max(map(len, text.splitlines())) <= 132
    nodes = np.array(re.findall(r"^\d+, (\S+), (\S+), (\S+)$", text.split("*ELEMENT")[0],
                                re.MULTILINE), dtype=float)  # fmt: skip
    assert nodes[:, 2].max() == pytest.approx(3.5)  # inches
    at = [float(x) for x in numbers["node_at"].split(",")]
    assert nodes[int(numbers["node"]) - 1] == pytest.approx(at, rel=1e-5)
    loads = text.split("*CLOAD\n")[1].split("*")[0].split("\n")[:-1]
    force = sum(float(line.split(",")[2]) for line in loads if line.split(", ")[1] == "2")
    assert force == pytest.approx(-988.86, rel=1e-6)


@pytest.mark.slow
def test_abaqus_gets_keywords_that_both_manuals_define(tmp_path: Path) -> None:
    """The rest of the deck is CalculiX's."""
    texts = {}
    for dialect in ("abaqus", "calculix"):
        for study, pin, case in ((QUICK, "B", "landing"), (LUGS, "P", "pull")):
            (tmp_path / "deck.inp").unlink(missing_ok=True)
            assert exported(tmp_path, study, "--deck", dialect, pin=pin, case=case) == 0
            texts[dialect, pin] = (tmp_path / "deck.inp").read_text("ascii")
            more = {"CONTACT PRINT"} if (dialect, pin) == ("calculix", "P") else set[str]()
            assert keywords(tmp_path / "deck.inp") - BOTH_MANUALS == more
    assert "Lugs: +/-" in texts["abaqus", "P"]
    for pin in "BP":
        model = [texts[dialect, pin].split("*STEP")[0].split("\n*NODE", 1)[1]
                 for dialect in ("abaqus", "calculix")]  # fmt: skip
        assert model[0] == model[1]


@each(
    ("change", "pin", "case", "message"),
    [
        ("", "Q", "landing", "'Q'"),
        ("", "B", "take-off", "'take-off'"),
        (
            "nothing holds it",
            "B",
            "landing",
            "pin B in case landing has no stress to export (rigid",
        ),
    ],
)
def test_rows_that_are_not_there_are_refused(
    change: str,
    pin: str,
    case: str,
    message: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    study = NOTHING_HOLDS if change else QUICK
    assert exported(tmp_path, study, "--deck", "calculix", pin=pin, case=case) == 2
    said = [x for x in capsys.readouterr().err.splitlines() if not x.startswith("Warning")]
    assert len(said) == 1
    assert message in said[0]
    assert not (tmp_path / "deck.inp").exists()


@pytest.mark.slow
def test_what_a_deck_cannot_have_is_refused_by_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert exported(tmp_path, LUGS, "--deck", "abaqus", pin="P", case="turn") == 2
    assert "cannot be written: CalculiX's model has no forces along" in capsys.readouterr().err


def test_files_are_not_overwritten_unless_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    deck = tmp_path / "deck.inp"
    deck.write_text("mine")
    assert exported(tmp_path, QUICK, "--deck", "calculix") == 2
    assert "exists already; choose another --out, or --force" in capsys.readouterr().err
    assert deck.read_text() == "mine"
    assert exported(tmp_path, QUICK, "--deck", "calculix", "--force") == 0
    assert deck.read_text().startswith("** Pin B, case landing")
    study = str(tmp_path / "study.toml")
    arguments = ["export", study, "B", "landing", "--deck", "calculix", "--out"]
    for path in (tmp_path / "none" / "deck.inp", tmp_path / "study.toml" / "deck.inp"):
        assert run_command_line([*arguments, str(path)]) == 2
        assert "cannot be written" in capsys.readouterr().err
    assert run_command_line([*arguments, str(tmp_path), "--force"]) == 2
    assert "is a folder" in capsys.readouterr().err
    assert sorted(p.name for p in tmp_path.iterdir()) == ["deck.inp", "study.toml"]


def test_without_out_it_goes_into_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("s.toml").write_text(QUICK)
    assert run_command_line(["export", "s.toml", "B", "landing", "--deck", "abaqus"]) == 0
    assert capsys.readouterr().out == "Written: out/s-B-landing.inp\n"
    assert Path("out/s-B-landing.inp").is_file()


@pytest.mark.peers
def test_calculix_finds_the_expected_stress_of_a_prescribed_pin(tmp_path: Path) -> None:
    """Run as a reviewer does, with nothing of ours but the file."""
    study = (ROOT / "studies" / "one_pin.toml").read_text()
    assert exported(tmp_path, study, "--deck", "calculix") == 0
    subprocess.run(["ccx", "-i", "deck"], cwd=tmp_path, check=True, capture_output=True)
    numbers = expected(tmp_path / "deck.inp")
    theirs = von_mises(stresses(tmp_path / "deck.frd"))
    at_node = float(theirs[int(numbers["node"]) - 1])
    assert at_node == pytest.approx(float(numbers["node_von_mises"]), rel=MAX_STRESS_DIFFERENCE)
    assert at_node == pytest.approx(float(numbers["max_von_mises"]), rel=MAX_MAXIMUM_DIFFERENCE)


@pytest.mark.long
@pytest.mark.peers
def test_calculix_finds_the_expected_stress_and_moment_of_a_pin_in_lugs(tmp_path: Path) -> None:
    """The moment at the section is that of the contact forces on the rings before it."""
    study = (ROOT / "studies" / "clevis.toml").read_text()
    assert exported(tmp_path, study, "--deck", "calculix", pin="P", case="pull") == 0
    subprocess.run(["ccx", "-i", "deck"], cwd=tmp_path, check=True, capture_output=True)
    numbers = expected(tmp_path / "deck.inp")
    error = float(numbers["error_estimate"]) / float(numbers["max_von_mises"])
    theirs = von_mises(stresses(tmp_path / "deck.frd"))
    at_node = float(theirs[int(numbers["node"]) - 1])
    ours = float(numbers["node_von_mises"])
    assert at_node == pytest.approx(ours, rel=MAX_MAXIMUM_DIFFERENCE + error)
    assert ours == pytest.approx(float(numbers["max_von_mises"]))
    forces = contact_forces(tmp_path / "deck.dat")
    left = [f for name, f in forces.items() if name.startswith("PINLUG1R")]
    eye = [f for name, f in forces.items() if name.startswith("PINLUG3R")]
    z, before = float(numbers["section_z"]), [*left, *eye[: len(eye) // 2]]
    assert z == pytest.approx(23.0)  # the middle of the eye, between two of its rings
    moment = 2.0 * abs(sum(z * f[0] - f[4] for f in before))  # the deck is a half
    limit = MAX_MOMENT_DIFFERENCE + error
    assert moment == pytest.approx(float(numbers["section_moment"]), rel=limit)


def test_a_node_under_a_lug_says_how_its_stress_is_compared(tmp_path: Path) -> None:
    """Of pin F of the landing gear, CalculiX has 4,280 psi there and the run 11,956:
    without the pressure's it is 11,540.
    """
    assert exported(tmp_path, SINGLE_SHEAR, "--deck", "calculix", pin="P", case="pull") == 0
    head = " ".join((tmp_path / "deck.inp").read_text("ascii").replace("**", "").split())
    z = float(expected(tmp_path / "deck.inp")["node_at"].split(", ")[2])
    name = "one" if 5.0 < z < 25.0 else "other"
    assert not 25.0 <= z <= 25.6
    assert f"The node lies under lug {name}:" in head
    assert exported(tmp_path, FILLETED, "--deck", "calculix", "--force", pin="P", case="pull") == 0
    assert "lies under lug" not in (tmp_path / "deck.inp").read_text("ascii")


@pytest.mark.long
@pytest.mark.peers
def test_calculix_finds_the_stress_under_a_lug(tmp_path: Path) -> None:
    """By the rule that the head of the deck states, from nothing of ours but the deck."""
    assert exported(tmp_path, SINGLE_SHEAR, "--deck", "calculix", pin="P", case="pull") == 0
    subprocess.run(["ccx", "-i", "deck"], cwd=tmp_path, check=True, capture_output=True)
    numbers = expected(tmp_path / "deck.inp")
    x, y, _ = (float(value) for value in numbers["node_at"].split(", "))
    c, s = x / np.hypot(x, y), y / np.hypot(x, y)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    xx, yy, zz, yz, zx, xy = stresses(tmp_path / "deck.frd")[int(numbers["node"]) - 1]
    polar = turn @ np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]]) @ turn.T
    p = -polar[0, 0]
    relieved = polar + np.diag([p, 0.6 * p, p])
    deviator = relieved - np.eye(3) * np.trace(relieved) / 3.0
    at_node = np.sqrt(1.5 * (deviator**2).sum())
    error = float(numbers["error_estimate"]) / float(numbers["max_von_mises"])
    limit = MAX_MAXIMUM_DIFFERENCE + error
    assert at_node == pytest.approx(float(numbers["node_von_mises"]), rel=limit)


@pytest.mark.long
@pytest.mark.peers
def test_calculix_finds_the_stress_of_a_fillet_beside_a_lug(tmp_path: Path) -> None:
    """On a coarse mesh, with three elements on half of an arc; forces as statics has them."""
    path = tmp_path / "study.toml"
    path.write_text(FILLETED, encoding="utf-8")
    plan = prepare(pinstress.load_study(path), pins=["P"], cases=["pull"])
    row = next(r for o in solve_tasks(plan) for r in o.rows)
    task, peak = plan.tasks[0], row.maximum
    pin = body_of_revolution(task.pin)
    assert pin is not None
    seated = PinInLugs(pin, task.material, task.lugs)
    mesh = Fineness(rings=3, sectors=16, layers=1, eye=1, arc=3, along=2.0)
    loads = transverse(seated, peak.governing)
    theirs = joint_opinion(seated.pin, seated.material, seated.lugs, loads, mesh)
    for lug, force in (("left", 5000.0), ("middle", -10000.0), ("right", 5000.0)):
        band = seated.pin.band(lug)
        on = (theirs.ends[:, 0] > band.z0 - 1e-9) & (theirs.ends[:, 1] < band.z1 + 1e-9)
        assert theirs.force[on].sum(axis=0) == pytest.approx([force, 0.0], rel=1e-3, abs=1.0)
    assert row.joint is not None
    moment = largest_moment(theirs, seated.pin)
    assert moment == pytest.approx(row.joint.bending_moment, rel=MAX_MOMENT_DIFFERENCE)
    assert peak.location is not None
    assert peak.max_von_mises is not None
    assert peak.own_error is not None
    assert 0.018 < peak.location[2] < 0.020  # on the fillet
    stress = theirs.surface_at(np.array(peak.location), task.material.poisson_ratio)
    assert stress == pytest.approx(peak.max_von_mises, rel=0.08, abs=peak.own_error)


@pytest.mark.slow
def test_a_deck_names_lugs_of_a_structure(tmp_path: Path) -> None:
    assert exported(tmp_path, ON_STRUCTURE, "--deck", "calculix", pin="P", case="pull") == 0
    lines = (tmp_path / "deck.inp").read_text("ascii")
    assert "lugs of a structure" in " ".join(lines.replace("**", "").split())


@pytest.mark.long
@pytest.mark.peers
def test_calculix_shares_a_force_between_lugs_of_a_structure(tmp_path: Path) -> None:
    """Of different thickness and clearance, at different distances from the eye: statics alone
    does not decide their shares.
    """
    (tmp_path / "study.toml").write_text(ON_STRUCTURE, encoding="utf-8")
    plan = prepare(pinstress.load_study(tmp_path / "study.toml"))
    row = next(r for o in solve_tasks(plan) for r in o.rows)
    assert row.joint is not None
    ours = {band.name: band.force for band in row.joint.bands}
    pin = body_of_revolution(plan.tasks[0].pin)
    assert pin is not None
    seated = PinInLugs(pin, plan.tasks[0].material, plan.tasks[0].lugs)
    loads = transverse(seated, row.maximum.governing)
    mesh = Fineness(rings=4, sectors=16, layers=1, eye=1)
    theirs = joint_opinion(seated.whole, seated.material, seated.lugs, loads, mesh)
    assert set(ours) == {"left", "eye", "right"}
    for lug, force in ours.items():
        band = seated.whole.band(lug)
        on = (theirs.ends[:, 0] > band.z0 - 1e-9) & (theirs.ends[:, 1] < band.z1 + 1e-9)
        total = np.linalg.norm(theirs.force[on].sum(axis=0))
        assert total == pytest.approx(force, rel=0.03), lug
    moment = largest_moment(theirs, seated.whole)
    assert moment == pytest.approx(row.joint.bending_moment, rel=MAX_MOMENT_DIFFERENCE)


@pytest.mark.slow
def test_couples_of_links_are_in_the_units_of_the_deck(tmp_path: Path) -> None:
    """They were in N m whatever the units: 20 N m are 20,000 N mm and 177 lbf in."""
    couple = 'other = ["-10000 N", "0 N"] }\nmoments = { one = ["20 N m", "0 N m"] }'
    forces = (
        ("other = [-10000, 0] }", couple),
        ("one = [10000, 0]", 'one = ["10000 N", "0 N"]'),
        ("tolerance = 0.05", "tolerance = 0.2"),
    )
    lengths = [(f"= {x}", f'= "{x} mm"') for x in ("5,", "20", "0.6", "50")]
    study = SINGLE_SHEAR.replace("edge_radius = 0.3", 'edge_radius = "0.3 mm"')
    for old, new in (*forces, *((a, b.replace(', mm"', ' mm",')) for a, b in lengths)):
        study = study.replace(old, new)
    for units, size in (("mm-N-s", 20000.0), ("in-lbf-s", 177.015)):
        (tmp_path / "deck.inp").unlink(missing_ok=True)
        text = study.replace("mm-N-s", units)
        assert exported(tmp_path, text, "--deck", "calculix", pin="P", case="pull") == 0
        loads = (tmp_path / "deck.inp").read_text("ascii").split("*CLOAD\n")[1].split("*")[0]
        turning = [float(line.split(",")[2]) for line in loads.splitlines() if ", 2, " in line]
        assert np.abs(turning).max() == pytest.approx(size, rel=1e-5)
