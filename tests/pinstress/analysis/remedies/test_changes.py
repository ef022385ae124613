"""What to change: each remedy, put into the study, gives the required factor."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import pinstress
from pinstress.cli.commands import run_command_line
from reports.data.changes import Remedy
from reports.data.decision import factor_ends
from reports.data.results import Results
from tests.conftest import ROOT
from tests.support.programs.command_line import QUICK

GEAR = ROOT / "studies" / "grenier2008.toml"
STRONG = "material.AISI 4340.yield_strength"


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
    command = ["run", name, "--no-pictures", "--vtk", "none", "--sensitivities"]
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
