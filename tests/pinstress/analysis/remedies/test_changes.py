"""What to change: each remedy, put into the study, gives the required factor."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import pinstress
from fea.core.peak import Maximum
from fea.core.requirement import Requirement
from fea.support.support import Solution
from geometry import Pin, Segment
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from pinstress.analysis.plan import prepare
from pinstress.analysis.remedies.changes import FROM_FILE, change
from pinstress.cli.commands import run_command_line
from reports.data.changes import Remedy, command
from reports.data.decision import factor_ends
from reports.data.results import Results
from tests.conftest import ROOT
from tests.support.pins.pin_files import write_mesh
from tests.support.programs.command_line import QUICK

GEAR = ROOT / "studies" / "grenier2008.toml"
STRONG = "material.AISI 4340.yield_strength"


FROM_MESH = """
title = "A mesh"
units = "mm-N-s"
[material.steel]
youngs_modulus = "205 GPa"
poisson_ratio = 0.3
yield_strength = "100 MPa"
[pin.B]
material = "steel"
geometry = "pin.vtk"
clamp = ["root"]
[pin.B.band]
B = { z = [60.0, 90.0] }
root = { z = [0.0, 40.0], connection = false }
[case.push]
kind = "given"
forces = { B = [0.0, 50000.0] }
[analysis]
tolerance = 0.5
required_safety_factor = 4
"""


def least(results: Results) -> float:
    """By the maximum with its error, which has to decide."""
    return min(factor_ends(pin)[0] for pin in results.pins)


@pytest.fixture(scope="module")
def weak() -> pinstress.Study:
    """The small study with four times the load that is permissible."""
    study = pinstress.study_from(QUICK)
    factor = least(pinstress.run(study))
    return pinstress.changed_study(study, {"analysis.required_safety_factor": 4.0 * factor})


def only(results: Results) -> Remedy:
    (found,) = results.changes
    return found


def test_the_worst_case_is_that_which_may_fail_with_its_error(weak: pinstress.Study) -> None:
    """Not that of the largest stress, which may be known better."""
    (task,) = prepare(weak).tasks
    strength = task.material.yield_strength or 0.0
    requirement = Requirement(required=1.0)
    sure, rough = (
        Solution(
            Maximum("B", case, "harmonic", "converged", "", share * strength, error * strength),
            None,
            task.loads[0],
        )
        for case, share, error in (("sure", 0.99, 0.0), ("rough", 0.97, 0.05))
    )
    found = change(requirement, task, (sure, rough))
    assert found is not None
    assert found.case == "rough"
    assert found.load_factor == pytest.approx(1.0 / 1.02)


def test_an_error_that_is_not_known_asks_for_no_stronger_pin(weak: pinstress.Study) -> None:
    """A finer mesh is what such a row needs."""
    (task,) = prepare(weak).tasks
    stress = 0.9 * (task.material.yield_strength or 0.0)
    codes = ("too-few-meshes", "no-error-known")
    peak = Maximum("B", "once", "solid", "unconverged", "", stress, stress, reasons=codes)
    once = Solution(peak, None, task.loads[0])
    assert change(Requirement(required=1.0), task, (once,)) is None
    found = change(Requirement(required=2.0), task, (once,))
    assert found is not None
    assert found.load_factor == pytest.approx(0.5 / 0.9)


def test_each_remedy_is_enough(weak: pinstress.Study) -> None:
    """Strength and loads exactly, diameters to a few per cent; and none where nothing fails."""
    required = weak.table.analysis.required_safety_factor or 0.0
    found = only(pinstress.run(weak))
    assert found.load_factor == pytest.approx(0.25)
    stronger = pinstress.changed_study(weak, {STRONG: f"{found.yield_strength} psi"})
    assert least(pinstress.run(stronger)) == pytest.approx(required)
    assert pinstress.run(stronger).changes == () or only(
        pinstress.run(stronger)
    ).load_factor == pytest.approx(1.0)
    force = f"{-988.86 * found.load_factor} lbf"
    less = pinstress.changed_study(weak, {"case.landing.forces.B": [0.0, force]})
    assert least(pinstress.run(less)) == pytest.approx(required)
    times = found.diameter_factor
    assert times is not None
    larger = pinstress.changed_study(
        weak,
        {
            "pin.B.profile[1].diameter": 4.0 * times,
            "pin.B.profile[2].diameter": 2.0 * times,
            "pin.B.fillet": 0.4 * times,
        },
    )
    assert least(pinstress.run(larger)) == pytest.approx(required, rel=0.05)


def test_a_pin_as_wide_as_long_is_no_remedy(weak: pinstress.Study) -> None:
    hard = pinstress.changed_study(weak, {"analysis.required_safety_factor": 1e4})
    found = only(pinstress.run(hard))
    assert found.diameter_factor is None
    assert "as wide as long" in found.diameter_note


def test_the_command_names_all_pins_but_those_that_it_says_it_leaves_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Every other of eight pins needs a pin wider than long: named with the reason, not just gone.

    The command is one line however narrow the terminal, and no diameter is estimated for them.
    """
    head, profile = QUICK.split("[pin.B]")[0], QUICK.split("[pin.B]")[1].split("[case")[0]
    band = 'connection = "B"'
    assert band in profile
    pins = {f"P{k}": 300.0 if k % 2 else 600.0 for k in range(1, 9)}
    tables = [f"[pin.{n}]{profile.replace(band, f'connection = {chr(34)}{n}{chr(34)}')}"
              for n in pins]  # fmt: skip
    forces = ", ".join(f"{n} = [0.0, {force}]" for n, force in pins.items())
    case = f'[case.landing]\nkind = "given"\nforces = {{ {forces} }}\n'
    study = tmp_path / "many.toml"
    required = "[analysis]\ntolerance = 0.1\nrequired_safety_factor = 1200\n"
    study.write_text("\n".join((head, *tables, case, required)))
    command = ["run", str(study), "--out", str(tmp_path / "out"), "--quiet"]
    run_command_line([*command, "--vtk", "none", "--jobs", "1"])
    lines = capsys.readouterr().out.splitlines()
    (sizing,) = (line.split() for line in lines if "pinstress size" in line)
    sized = set(sizing[sizing.index("--pins") + 1].split(","))
    assert sized == {"P1", "P3", "P5", "P7"}
    said = " ".join(lines)
    assert "no remedy for P2, P4, P6, P8, so the command leaves them out (P2: a pin as wide" in said
    estimated = {line.split()[0] for line in lines if " → " in line}
    assert estimated == {*sized, "#"}  # and the key


def test_a_shape_from_a_file_is_not_sized(tmp_path: Path) -> None:
    """The command would refuse it."""
    file = Pin("B", (Segment(0.04, 0.05), Segment(0.05, 0.04)))
    write_mesh(solid_mesh(file, MeshSize(1.0)), tmp_path / "pin.vtk", linear=True)
    study = tmp_path / "study.toml"
    study.write_text(FROM_MESH)
    results = pinstress.run(pinstress.load_study(study))
    found = only(results)
    assert (found.diameter_factor, found.diameter_note) == (None, FROM_FILE)
    assert command(results.changes, "study.toml", 4.0) == ""


@pytest.mark.slow
def test_a_longer_impulse_is_enough() -> None:
    """With the weights of the linkage, which act as well; J in its lugs, which carry its couple.

    The time is for what lies beneath contact, which is larger than surface and section, with the
    error of this run; a run of its own has another error, so what is compared is the factor with
    the error that the time allows for.
    """
    lugs = {name: {"edge_radius": 0.02} for name in ("J1", "J2", "J3")}
    held = {"pin.J.clamp": [], "pin.J.fillet": 0.15, "pin.J.lug": lugs}
    gear = pinstress.changed_study(pinstress.load_study(GEAR), held)
    before = pinstress.run(gear, pins=["J"], cases=["landing"])
    found = only(before)
    assert found.given_time == 0.15
    assert found.impulse_time is not None
    key = "case.landing.apply[1].impulse.impulse_time"
    longer = pinstress.changed_study(gear, {key: found.impulse_time})
    after = pinstress.run(longer, pins=["J"], cases=["landing"])
    first, second = (x.pins[0] for x in (before, after))
    assert first.places is not None
    assert second.places is not None
    contact, then = first.places.contact, second.places.contact
    assert contact is not None
    assert then is not None
    assert contact.upper_end > (first.max_von_mises or 0.0)
    allowed = contact.upper_end / contact.beneath
    permitted = (second.yield_strength or 0.0) / 10.0
    # contact is not in proportion to loads: with less of them other cells are pressed
    assert then.beneath * allowed == pytest.approx(permitted, rel=2e-2)


def test_the_command_and_the_files_say_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    name = "my study.toml"
    Path(name).write_text(
        QUICK.replace("required_safety_factor = 10", "required_safety_factor = 300")
    )
    command = ["run", name, "--vtk", "none", "--sensitivities"]
    assert run_command_line(command) == 0
    said = capsys.readouterr().out
    line = "pinstress size 'my study.toml' --pins B"
    assert line in said
    assert "diameter [in]" in said
    folder = Path("out/my study")
    (change,) = json.loads((folder / "results.json").read_text())["changes"]
    assert change["pin"] == "B"
    assert change["load_factor"] < 1.0
    assert "sensitivities" not in change
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "profile[2].diameter" in page
    assert '<section id="change">' in page
    assert "--pins B</code>" in page
