"""Sensitivities of a run: of every pin, in the study's units, in table, page and results.json."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import pinstress
from fea.support.support import Solution
from pinstress.analysis.gather.gather import results_of
from pinstress.analysis.plan import prepare
from pinstress.analysis.remedies.joint_parameters import joint_parameters
from pinstress.analysis.remedies.sensitivities import differentiated_in_lugs
from pinstress.analysis.solve import solutions, solve_tasks
from pinstress.cli.commands import run_command_line
from reports.data.sensitivities import PinSensitivities
from tests.support.pins.clevis import CLEVIS
from tests.support.pins.studies import BY_SEGMENTS_AND_CORNERS
from tests.support.programs.command_line import QUICK


def _own(key: str) -> str:
    """A key as in the table of pin P or M."""
    return key.removeprefix("pin.P.").removeprefix("pin.M.")


def test_they_are_in_table_page_and_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of a pin that is safe too; with a step more the factor changes as the derivative says, and
    another run with it agrees.
    """
    monkeypatch.chdir(tmp_path)
    Path("a.toml").write_text(QUICK)
    assert run_command_line(["run", "a.toml", "--vtk", "none"]) == 0
    capsys.readouterr()
    (found,) = json.loads(Path("out/a/results.json").read_text("utf-8"))["sensitivities"]
    rows = list(csv.DictReader(Path("out/a/sensitivities.csv").read_text("utf-8").splitlines()))
    assert [row["key"] for row in rows] == [each["key"] for each in found["parameters"]]
    thin = next(row for row in rows if row["key"] == "pin.B.profile[2].diameter")
    assert (float(thin["value"]), thin["unit"], float(thin["step"])) == (2.0, "in", 0.1)
    factor, after = float(thin["safety_factor"]), float(thin["factor_with_step"])
    assert after - factor == pytest.approx(0.1 * float(thin["factor_per_unit"]), rel=1e-9)
    by_stress = -factor * float(thin["stress_per_unit"]) / float(thin["max_von_mises"])
    assert float(thin["factor_per_unit"]) == pytest.approx(by_stress, rel=1e-9)
    strength = next(row for row in rows if row["key"].endswith("yield_strength"))
    value = float(strength["value"])
    assert float(strength["factor_per_unit"]) == pytest.approx(factor / value, rel=1e-9)
    assert float(strength["stress_per_unit"]) == 0.0
    study = pinstress.study_from(QUICK)
    more, less = (
        pinstress.run(pinstress.changed_study(study, {"pin.B.profile[2].diameter": 2.0 + x}))
        for x in (0.05, -0.05)
    )
    slope = (more.pins[0].safety_factor - less.pins[0].safety_factor) / 0.1  # type: ignore[operator]
    assert float(thin["factor_per_unit"]) == pytest.approx(slope, rel=0.03)
    page = Path("out/a/report.html").read_text(encoding="utf-8")
    assert '<section id="sensitivities">' in page
    assert "profile[2].diameter" in page


def test_all_cases_where_asked() -> None:
    """Otherwise the worst one of each pin."""
    given = 'kind = "given"\ndistribution = "uniform"'  # as the other case
    more = f"\n[case.light]\n{given}\nforces = {{ B = [0.0, -100.0] }}\n"
    study = pinstress.study_from(QUICK + more)
    plan = prepare(study)
    (only,) = results_of(plan, solve_tasks(plan)).sensitivities
    assert only.case == "landing"
    every = replace(plan, sensitive=True)
    both = results_of(every, solve_tasks(every)).sensitivities
    assert [found.case for found in both] == ["landing", "light"]
    assert both[0] == only
    one, other = ({row.key: row.stress for row in found.rows} for found in both)
    key = "pin.B.profile[2].diameter"
    assert one[key] / both[0].maximum == pytest.approx(other[key] / both[1].maximum, rel=1e-6)


def test_corners_and_segments_agree() -> None:
    """The same pin twice: each number under its own key."""
    study = pinstress.study_from(BY_SEGMENTS_AND_CORNERS)
    both = {found.pin: found for found in pinstress.run(study).sensitivities}
    P, M = ({_own(row.key): row.stress for row in both[name].rows} for name in "PM")
    for ours, theirs in (
        ("profile[1].diameter & profile[2].diameter[1]", "meridian[1-2][2]"),
        ("profile[3].diameter & profile[2].diameter[2]", "meridian[3-4][2]"),
        ("profile[1-3].bore", "bore_meridian[1-2][2]"),
        ("fillet", "meridian[2][3]"),
        ("profile[3].edge_radius[2]", "meridian[4][3]"),
    ):
        times = 2.0 if theirs.endswith("[2]") else 1.0  # a radius is half a diameter
        assert M[theirs] == pytest.approx(times * P[ours], rel=1e-5, abs=1e-4), theirs
    # z of a corner: the segment before it is longer, the one after it shorter
    for corners, before, after in (
        ("meridian[2][1]", 1, 2),
        ("meridian[3][1] & band.C.z[1]", 2, 3),
        ("meridian[4][1] & bore_meridian[2][1] & band.C.z[2]", 3, None),
    ):
        shorter = 0.0 if after is None else P[f"profile[{after}].length"]
        given = P[f"profile[{before}].length"] - shorter
        assert M[corners] == pytest.approx(given, rel=1e-5, abs=1e-4)


def test_of_a_beam_they_are_relative_to_its_maximum() -> None:
    study = pinstress.study_from(QUICK)

    def by(model: str) -> PinSensitivities:
        (found,) = pinstress.run(study, model=model).sensitivities  # type: ignore[arg-type]
        return found

    beam, harmonic = by("beam"), by("harmonic")
    one, other = (
        np.array([r.stress for r in sorted(x.rows, key=lambda r: r.key) if r.kind == "length"])
        / x.maximum
        for x in (beam, harmonic)
    )
    assert one == pytest.approx(other, rel=0.1, abs=0.02 * float(np.abs(other).max()))


@pytest.mark.long
@pytest.mark.slow
def test_in_contact_by_all_of_the_joint() -> None:
    """Where asked; else how to get them. Eyes without an outer diameter grow with the pin, and the
    stiffness against tilt with that of their material: so all lengths together and all moduli obey
    the rules of sums, and differences of other studies agree. Some can be asked for alone.
    """
    study = pinstress.study_from(CLEVIS)
    plan = replace(prepare(study), sensitive=True)
    (found,) = results_of(plan, solve_tasks(plan)).sensitivities
    rows = {_own(row.key): row for row in found.rows}
    assert {f"lug.{c}.clearance" for c in "LMR"} <= set(rows)
    assert {f"lug.{c}.edge_radius" for c in "LMR"} <= set(rows)
    assert "lug.M.outer_diameter" not in rows
    assert rows["force M x"].kind == "force"

    def total(*kinds: str) -> float:
        some = (x for x in found.rows if x.kind in kinds and "yield" not in x.key)
        return sum(x.value * x.stress for x in some) / found.maximum

    forces = total("force")
    assert total("length") + 2.0 * forces == pytest.approx(0.0, abs=1e-6)
    assert total("stress") + forces == pytest.approx(1.0, abs=1e-6)
    (task,) = plan.tasks
    (joined,) = solutions(study, task, plan.requirement, lambda _: None)
    assert isinstance(joined, Solution)
    lengths = {_own(row.key): row.stress for row in found.rows if row.kind == "length"}
    some = [key for key in lengths if key.endswith("diameter")]
    some_parameters = [x.of_joint for x in joint_parameters(study, task) if x.of_joint.key in some]
    alone = differentiated_in_lugs(joined, task, some_parameters, alone=True)
    assert alone is not None
    ours = alone.by_parameter
    assert set(ours) == set(some)
    stress, length = study.system.factor("stress"), study.system.factor("length")
    for key in some:
        assert ours[key] == pytest.approx(lengths[key] * stress / length, rel=1e-6), key
    other = [
        pinstress.run(pinstress.changed_study(study, {"pin.P.profile[4].length": 20.0 + x}))
        for x in (0.4, -0.4)
    ]
    maxima = [x.pins[0].max_von_mises or 0.0 for x in other]
    slope = (maxima[0] - maxima[1]) / 0.8
    assert lengths["profile[4].length"] == pytest.approx(slope, rel=0.1)
    (brief,) = pinstress.run(study).sensitivities
    assert brief.rows == ()
    assert "--sensitivities" in brief.note
