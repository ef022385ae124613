"""The command `chart` for a pin in its lugs: which models are climbed, and what is said of them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

import pytest

from assess.opinion import calculix
from fea.core.mesh_result import MeshMaximum
from fea.support.contact.resolution import Resolution
from geometry import ArgumentError
from pinstress import load_study
from pinstress.cli.commands import run_command_line
from pinstress.explore.chart.chart import ChartPlan, chart, plan_chart
from pinstress.explore.chart.in_lugs import CHART_RESOLUTIONS, CONTACT_LEVELS, contact_rung, sets_of
from pinstress.explore.chart.measured_process import Measured, MeasureJob
from pinstress.explore.chart.single_joint import JointProblem, JointRung, joint_result_on
from pinstress.study.reading.errors import InputError
from reports.data.chart import Chart
from reports.plots.chart import chart_plot
from reports.plots.draw import draw
from reports.text.chart_summary import curve_name, reference_line, summary
from tests.conftest import ROOT
from tests.support.errors import raises
from tests.support.programs.command_line import ONE_PIN

EXACT = 3e8
CLEVIS = (ROOT / "studies" / "clevis.toml").read_text().replace("edge_radius = 0.5", "")


@dataclass
class MadeUp:
    """Contact is off by 0.02 / 2^level on the mesh and as much as 0.1 / rings for its cells;
    CalculiX by 0.03; `fails` names a model.
    """

    fails: str = ""
    jobs: list[MeasureJob] = field(default_factory=list)

    def __call__(self, job: MeasureJob) -> Measured:
        self.jobs.append(job)
        rung = job.rung
        assert isinstance(rung, JointRung)
        if rung.model == self.fails:
            return Measured(None, failed="passed the limit of 9 s", over=True)
        mesh, cells = 0.02 * 0.5**rung.level, 0.1 / rung.cells.rings
        error, seconds = {
            "contact": (mesh + cells, 1.0 * rung.cells.rings * 2.0**rung.level),
            "calculix": (0.03, 100.0),
            "foundation": (0.02, 1e-2),
        }[rung.model]
        result = MeshMaximum(
            round(1e4 * 2.0**rung.level), EXACT * (1.0 + error), 0, (0.0, 0.0, 0.0)
        )
        return Measured(result, seconds, 10.0, 100.0)


@pytest.fixture(scope="module")
def plan(tmp_path_factory: pytest.TempPathFactory) -> ChartPlan:
    path = tmp_path_factory.mktemp("clevis") / "clevis.toml"
    path.write_text(CLEVIS)
    return plan_chart(load_study(path), "P", "pull")


@pytest.fixture(scope="module")
def made_up(plan: ChartPlan) -> Chart:
    return chart(plan, MadeUp(), calculix=True)


def test_all_models_of_a_joint_are_charted(plan: ChartPlan, made_up: Chart) -> None:
    assert isinstance(plan.problem, JointProblem)
    curves = made_up.curves
    sets = sets_of(plan.problem)
    assert [model for model, _ in curves] == [
        "foundation",
        *["contact"] * (len(sets) - 1),
        "calculix",
    ]
    for (model, _), curve in curves.items():
        least = {"foundation": 1, "calculix": 3}.get(model, len(CONTACT_LEVELS))
        assert len(curve) >= least
    without = chart(plan, MadeUp())
    assert "calculix" not in {p.model for p in without.points}


def test_the_mesh_on_which_a_run_ends_is_marked(plan: ChartPlan, made_up: Chart) -> None:
    assert plan.chosen == contact_rung(Resolution(), len(plan.peak.history) - 1)
    (marked,) = [p for p in made_up.points if p.chosen]
    assert (marked.model, marked.element) == ("contact", plan.chosen.element)


def test_errors_are_those_against_the_finest_contact(plan: ChartPlan, made_up: Chart) -> None:
    """The reference's own error has a part for its cells: of first order, (1/12 - 1/16) / (16/12 -
    1) of 0.1, which is what it is off.
    """
    cells = sets_of(plan.problem)[-1]  # type: ignore[arg-type]
    assert cells == CHART_RESOLUTIONS[-1]
    assert made_up.reference.model == "contact"
    assert made_up.reference.element == contact_rung(cells, 0).element
    assert made_up.reference.error > 0.1 / cells.rings * 0.9
    assert made_up.reference.error < 0.02
    best = 1.0 + 0.02 / 16.0 + 0.1 / cells.rings
    assert made_up.points[0].error == pytest.approx(abs(1.02 / best - 1.0))


def test_a_reference_on_narrow_arcs_has_their_error(plan: ChartPlan) -> None:
    """Two sets of cells agree to less than 2 %, but follow the pressure of loose lugs no better."""
    problem = plan.problem
    assert isinstance(problem, JointProblem)
    loose = replace(problem, lugs=tuple(replace(lug, clearance=5e-4) for lug in problem.lugs))
    light = replace(loose, loads=replace(loose.loads, forces=0.02 * loose.loads.forces))
    reference = chart(replace(plan, problem=light), MadeUp()).reference
    assert reference.error > 2.7 / (CHART_RESOLUTIONS[-1].highest * light.half_angle) ** 2
    assert reference.error > 0.3


def test_what_is_said(made_up: Chart) -> None:
    """Of the beam on foundations only its error; CalculiX is at 3 %."""
    told = summary(made_up)
    assert "Cheapest within 2 %: contact (8 × 36 cells a lug" in told
    assert "CalculiX (hexahedra (C3D20R)) takes" in told
    assert "Error of the beam on foundations: 1.2 %." in told
    assert reference_line(made_up).startswith("Reference: contact model, 16 × 64 cells a lug")


def test_every_curve_has_a_name(made_up: Chart, tmp_path: Path) -> None:
    assert [curve_name(*curve) for curve in made_up.curves] == [
        "foundation",
        *("contact, 4 × 18 cells a lug", "contact, 8 × 36 cells a lug"),
        *("contact, 12 × 48 cells a lug", "CalculiX"),
    ]
    assert all(path.stat().st_size for path in draw([chart_plot(made_up)], tmp_path))


def test_calculix_ends_at_a_limit_and_is_run_once(plan: ChartPlan) -> None:
    measure = MadeUp("calculix")
    found = chart(plan, measure, runs=3, calculix=True)
    (failed,) = [p for p in found.points if p.failed]
    assert failed.model == "calculix"
    assert {j.runs for j in measure.jobs if j.rung.model == "calculix"} == {1}
    assert all(j.reference for j in measure.jobs[-3:])


def test_results_are_of_the_same_places(plan: ChartPlan) -> None:
    """All models of a clevis find their largest stress at mid-span, on the surface that contact
    leaves free or in the section; contact on a coarse mesh as a run does. Nothing of a plain pin is
    left out.
    """
    problem = plan.problem
    assert isinstance(problem, JointProblem)
    assert not problem.singularities
    rungs = JointRung("foundation", ""), contact_rung(Resolution(4, 18, 6), -2)
    found = [joint_result_on(problem, rung) for rung in rungs]
    for result in found:
        z = result.location[2]
        assert z == pytest.approx(0.023, abs=2e-3)
    largest = plan.peak.max_von_mises
    assert largest is not None
    assert found[0].maximum == pytest.approx(largest, rel=0.06)
    assert found[1].maximum == pytest.approx(largest, rel=0.03)


def test_what_calculix_lacks_is_refused(plan: ChartPlan) -> None:
    assert isinstance(plan.problem, JointProblem)
    lugs = (replace(plan.problem.lugs[0], clearance=-1e-6), *plan.problem.lugs[1:])
    with raises(ArgumentError, "interference"):
        joint_result_on(replace(plan.problem, lugs=lugs), JointRung("calculix", ""))


def test_other_pins_are_referred_to_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(calculix, "installed", lambda: True)
    Path("study.toml").write_text(ONE_PIN)
    arguments = "chart study.toml --pin B --case landing --second-opinion ccx"
    assert run_command_line(arguments.split()) == 2
    assert "run --second-opinion ccx" in capsys.readouterr().err
    assert [p.name for p in tmp_path.iterdir()] == ["study.toml"]


def test_a_pin_without_load_has_nothing_to_chart(tmp_path: Path) -> None:
    path = tmp_path / "clevis.toml"
    path.write_text(CLEVIS.replace("25000", "0").replace("50000", "0"))
    with pytest.raises(InputError, match="nothing to chart"):
        plan_chart(load_study(path), "P", "pull")
