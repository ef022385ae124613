"""`pinstress size` to the factors that [[require]] states: of each pin, case and check.

A bar in bending under balanced forces, by a beam: its stress is proportional to the load and to the
diameter to the power of -3, so that a factor k times as large needs k^(1/3) times the diameter.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from assess.judgement import FAILS, NOT_DECIDED
from pinstress import load_study, run
from pinstress.cli.commands import run_command_line
from pinstress.cli.size import sizing_goal
from pinstress.explore.size.judged_pin import judged_pin
from pinstress.study.reading.errors import InputError
from reports.data.decision import factor_ends
from reports.data.headline import worst_checks
from tests.pinstress.analysis.test_margins import STUDY

LONG = [
    {"length": 20, "diameter": 16, "connection": "L"},
    {"length": 60, "diameter": 16},
    {"length": 20, "diameter": 16, "connection": "M"},
    {"length": 60, "diameter": 16},
    {"length": 20, "diameter": 16, "connection": "R"},
]
MATERIAL = {
    **STUDY["material"]["steel"],
    "yield_strength": "400 MPa",
    "ultimate_strength": "500 MPa",
}


def file(
    folder: Path, *requirements: dict[str, Any], often: float = 500.0, **analysis: Any
) -> Path:
    import tomlkit

    def pull(force: float) -> dict[str, Any]:
        forces = {"L": [-force / 2, 0], "M": [force, 0], "R": [-force / 2, 0]}
        return {"kind": "given", "forces": forces, "distribution": "uniform"}

    tables = {
        **STUDY,
        "material": {"steel": MATERIAL},
        "pin": {"P": {"material": "steel", "profile": LONG}},
        "case": {"often": pull(often), "seldom": pull(1000.0)},
        "analysis": {"joints": "prescribed", "tolerance": 0.1, **analysis},
        "require": list(requirements),
    }
    path = folder / "s.toml"
    path.write_text(tomlkit.dumps(tables), encoding="utf-8")
    return path


def sized(path: Path, *more: str) -> dict[str, tuple[float, float]]:
    """The lower end of the factor in each case of the new study, and what is required there."""
    run_command_line(["size", str(path), "--jobs", "1", "--quiet", *more])
    results = run(load_study(path.with_name("s_sized.toml")))
    return {row.case: (factor_ends(row)[0], row.required or 0.0) for row in results.pins}


@pytest.mark.slow
def test_each_case_reaches_its_own_factor_and_no_more(tmp_path: Path) -> None:
    """4 in "often", 1.5 in "seldom" under twice the load: the first needs a larger pin."""
    found = sized(
        file(
            tmp_path,
            {"cases": ["often"], "check": "yield", "factor": 4},
            required_safety_factor=1.5,
        )
    )
    assert {case: required for case, (_, required) in found.items()} == {
        "often": 4.0, "seldom": 1.5,
    }  # fmt: skip
    assert 4.0 <= found["often"][0] <= 4.0 * 1.05
    assert found["seldom"][0] == pytest.approx(found["often"][0] / 2.0, rel=0.02)


@pytest.mark.slow
def test_rupture_is_a_goal_too(tmp_path: Path) -> None:
    """3 against 500 MPa is 2.4 against 400 MPa, which is more than 1.5."""
    found = sized(file(tmp_path, {"check": "rupture", "factor": 3}, required_safety_factor=1.5))
    assert 2.4 <= found["seldom"][0] <= 2.4 * 1.05
    text = (tmp_path / "s_sized.toml").read_text(encoding="utf-8")
    assert "required_safety_factor = 1.5" in text


def test_goals_of_pins(tmp_path: Path) -> None:
    often = {"cases": ["often"], "check": "yield", "factor": 4}
    goal = sizing_goal(load_study(file(tmp_path, often, required_safety_factor=1.5)), None, None)
    assert (goal.required, goal.written) == (1.5, None)
    assert goal.of_pin("P") == {"often": pytest.approx(4.0 / 1.5), "seldom": 1.0}
    alone = sizing_goal(load_study(file(tmp_path, often)), None, None)
    assert (alone.required, alone.of_pin("P")) == (4.0, {"often": 1.0, "seldom": 0.0})
    asked = sizing_goal(load_study(file(tmp_path, often)), 2.0, None)
    assert (asked.required, asked.written, asked.multiples) == (2.0, 2.0, {})
    with pytest.raises(InputError, match="needs a factor"):
        sizing_goal(load_study(file(tmp_path, {"check": "shear", "factor": 4})), None, None)


def test_the_least_weight_reaches_the_factor_of_each_case(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """As the smallest size does: 4 in "often" needs more than 1.5 under twice the load."""
    often = {"cases": ["often"], "check": "yield", "factor": 4}
    path = file(tmp_path, often, required_safety_factor=1.5)
    found = sized(path, "--least-weight")
    assert "1 of 1 pin reaches their required factors in a run" in capsys.readouterr().out
    assert 4.0 <= found["often"][0] <= 4.0 * 1.02
    assert found["seldom"][0] == pytest.approx(found["often"][0] / 2.0, rel=0.02)
    text = (tmp_path / "s_sized.toml").read_text(encoding="utf-8")
    assert "required_safety_factor = 1.5" in text


def test_the_least_weight_where_only_one_case_has_a_factor(tmp_path: Path) -> None:
    """3 in "often" alone: "seldom", with more stress, does not count."""
    path = file(tmp_path, {"cases": ["often"], "check": "yield", "factor": 3})
    found = sized(path, "--least-weight")
    assert 3.0 <= found["often"][0] <= 3.0 * 1.02
    assert found["seldom"][0] < 1.6


def test_a_size_says_what_a_run_says_of_checks_besides_yield(tmp_path: Path) -> None:
    """What is missed was "not decided", and what is not decided "depends"."""
    stress = max(row.max_von_mises or 0.0 for row in run(load_study(file(tmp_path))).pins)
    requirements = {
        FAILS: {"check": "bearing", "factor": 1e3},
        NOT_DECIDED: {"check": "rupture", "factor": 500.0 / stress},  # within the error
    }
    for outcome, requirement in requirements.items():
        path = file(tmp_path, requirement, required_safety_factor=1.5)
        results = run(load_study(path))
        judged = judged_pin(results, "P")
        assert worst_checks(results)["P"].outcome == judged.outcome == outcome
        assert judged.why.startswith(str(requirement["check"]))
        if outcome == FAILS:  # it was a margin against the required factor, as no run states it
            assert judged.why.endswith(", 1,000 required (seldom)")


def test_a_pin_that_only_other_cases_load_needs_no_size(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its stress counted nothing, by which its strength was divided."""
    demand = {"pins": ["P"], "cases": ["often"], "check": "yield", "factor": 2}
    path = file(tmp_path, demand, often=0.0)
    assert run_command_line(["size", str(path), "--jobs", "1", "--quiet"]) == 1
    why = "no case in which a factor is required loads it"
    assert f"Not decided: pin P: {why}." in capsys.readouterr().err
