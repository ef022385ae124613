"""Charts of models: points measured in processes of their own, ladders, what they say, files."""

from __future__ import annotations

import csv
import math
import time
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from fea.core.mesh_result import MeshMaximum
from fea.harmonic.evaluate import SECTION_MESHES
from fea.solve.single_mesh import ModelMesh
from pinstress import load_study
from pinstress.cli.chart import _report_missed
from pinstress.explore.chart.chart import ChartPlan, chart, plan_chart
from pinstress.explore.chart.measured_process import Measured, MeasureJob, MeasureLimits, measure
from reports.data.chart import Chart, ChartPoint
from reports.plots.chart import chart_plot
from reports.plots.draw import draw
from reports.tables.chart import chart_table
from reports.text.chart_summary import cost, failures, reference_line, staying, summary
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.programs.command_line import ONE_PIN

STUDY = ROOT / "studies" / "one_pin.toml"
CONTRACT = [
    "model", "element", "dofs", "seconds", "peak_memory_mb", "max_von_mises", "relative_error",
]  # fmt: skip
EXACT = 1.0e7  # Pa
CURVED, STRAIGHT, LINEAR = (
    "curved quadratic tetrahedra", "straight quadratic tetrahedra", "linear tetrahedra",
)  # fmt: skip


@dataclass
class MadeUp:
    """Models whose errors and costs are powers of how fine they are: harmonic 0.02 / 2^level at
    0.01 s 2^level, curved 0.08 / 2^level at 1 s 4^level; what `fails` answers is that reason.
    """

    fails: dict[tuple[str, str], str]

    def __call__(self, job: MeasureJob) -> Measured:
        rung = job.rung
        if reason := self.fails.get((rung.model, rung.element if rung.model == "solid" else "")):
            return Measured(None, failed=reason, over="limit" in reason)
        part = {"linear": 4.0, "straight": 2.0, "curved": 1.0}[rung.element]
        error, unknowns, spent, memory = {
            "beam": (0.3, 0, 1e-3, 1.0),
            "harmonic": (0.02 * 0.5**rung.level, 2.0**rung.level, 0.01 * 2.0**rung.level, 10.0),
            "solid": (0.08 * part * 0.5**rung.level, 4.0**rung.level, 4.0**rung.level, 400.0),
        }[rung.model]
        result = MeshMaximum(round(1000 * unknowns), EXACT * (1.0 - error), 0, (0.0, 0.0, 0.0))
        return Measured(result, spent, memory, 100.0)


@pytest.fixture(scope="module")
def plan() -> ChartPlan:
    return plan_chart(load_study(STUDY), "B", "landing")


@pytest.fixture
def made_up(plan: ChartPlan) -> Chart:
    return chart(plan, MadeUp({}))


def test_every_model_and_mesh_is_charted_coarse_to_fine(made_up: Chart) -> None:
    curves = made_up.curves
    assert [name for name, _ in curves] == ["beam", "harmonic", "solid", "solid", "solid"]
    assert [element for _, element in curves][2:] == [LINEAR, STRAIGHT, CURVED]
    assert len(curves["harmonic", "quadratic triangles"]) >= 4
    for (model, _), curve in curves.items():
        dofs = [p.dofs or 0 for p in curve]
        assert dofs == sorted(dofs)
        assert model == "beam" or len(curve) >= 4


def test_the_reference_is_an_order_finer_and_its_error_is_stated(made_up: Chart) -> None:
    """Of made-up errors of second order Roache's index makes 1.25 times themselves, and the least
    error of a section (fea.core.verdict) is a little more.
    """
    charted = max(p.dofs or 0 for p in made_up.points if p.model == "harmonic")
    assert made_up.reference.dofs >= 10 * charted
    true = 0.02 * 1000 / made_up.reference.dofs
    assert made_up.reference.error == pytest.approx(SECTION_MESHES.scatter / 0.02 * true, rel=1e-2)
    beam = made_up.points[0]
    assert beam.error == pytest.approx(0.3, abs=2 * true)
    assert "Reference: harmonic model" in reference_line(made_up)


def test_a_reference_only_somewhat_finer_is_told_as_that(made_up: Chart) -> None:
    """One of a pin with cuts, 1.5 times as fine, was "1 times the finest charted"."""
    finest = max(p.dofs or 0 for p in made_up.points if p.model == "harmonic")
    near = replace(made_up.reference, model="harmonic", dofs=round(1.475 * finest))
    assert ", 1.5 times the finest charted: " in reference_line(replace(made_up, reference=near))


def test_errors_below_that_of_the_reference_are_told_to_be_unknown(made_up: Chart) -> None:
    """Local solids had errors of 0.03 % by a reference with one of 0.13 %."""
    least = min(point.error for point in made_up.points if point.error is not None)
    for factor, told in ((0.5, False), (2.0, True)):
        coarse = replace(made_up.reference, error=factor * least)
        line = reference_line(replace(made_up, reference=coarse))
        assert ("smaller errors above may have as well" in line) == told


def test_the_mesh_on_which_auto_ends_is_marked(plan: ChartPlan) -> None:
    """Errors of second order on meshes finer by the root of 2 are known to 1.25 times themselves
    from the third on, where that is 0.63 %, so auto ends there for 5 %; for 0.2 % on the fifth, to
    which the ladder is made longer.
    """
    assert plan.peak.model == "harmonic"
    for tolerance, third in ((0.05, True), (0.002, False)):
        requirement = replace(plan.requirement, tolerance=tolerance)
        found = chart(replace(plan, requirement=requirement), MadeUp({}))
        (marked,) = [p for p in found.points if p.chosen]
        assert (marked.model, marked.dofs) == ("harmonic", 4000 if third else 16000)


def test_what_equal_errors_cost_is_read_between_the_points(made_up: Chart) -> None:
    """By the made-up laws, whatever meshes are charted."""
    curves = {k[1]: v for k, v in made_up.curves.items()}
    ours, theirs = cost(curves["quadratic triangles"], 0.0113), cost(curves[CURVED], 0.0613)
    assert ours is not None
    assert theirs is not None
    scale = made_up.reference.error / 1.25  # the reference's own
    assert ours.seconds == pytest.approx(0.01 * 0.02 / (0.0113 + scale), rel=5e-3)
    assert theirs.seconds == pytest.approx((0.08 / 0.0613) ** 2, rel=1e-2)
    assert not ours.at_most
    coarsest = cost(curves["quadratic triangles"], 0.9)
    assert coarsest is not None
    assert coarsest.at_most
    assert cost(curves[LINEAR], 1e-5) is None


def test_an_error_that_is_small_by_chance_does_not_count(made_up: Chart) -> None:
    curve = list(made_up.curves["solid", CURVED])
    curve[1] = replace(curve[1], error=1e-9)
    wanted = curve[3].error or 0.0
    assert staying(curve, 1.0001 * wanted) == curve[3:]
    found = cost(curve, 1.0001 * wanted)
    assert found is not None
    assert found.seconds == pytest.approx(curve[3].seconds, rel=1e-2)


def test_the_sentence_names_the_cheapest_and_the_ratio(plan: ChartPlan) -> None:
    """At 5 % the solid model takes (0.08 / 0.05)^2 = 2.56 s and the harmonic one 0.004 s, 640 times
    less; 4 % is the best of the solid model's meshes, 4 s beside 0.005 s.
    """
    told = summary(chart(plan, MadeUp({})))
    assert "Cheapest within 5 %: harmonic (quadratic triangles, 1,000 unknowns), 10 ms" in told
    assert "At an equal error of 5 % the solid model (curved quadratic tetrahedra) takes" in told
    times = int(told.split(" takes ")[1].split(" times")[0])
    assert times == pytest.approx(640, rel=2e-2)
    assert "40 times the memory" in told
    assert "does not stay" not in told
    strict = replace(plan, requirement=replace(plan.requirement, tolerance=0.01))
    told = summary(chart(strict, MadeUp({})))
    assert "does not stay within 1 % on these meshes; its smallest error is 4 %." in told
    times = int(told.split(" takes ")[1].split(" times")[0])
    assert times == pytest.approx(800, rel=2e-2)


def test_a_beam_that_is_right_by_chance_is_told_from_one_that_knows(made_up: Chart) -> None:
    points = (replace(made_up.points[0], error=0.01), *made_up.points[1:])
    told = summary(replace(made_up, points=points, beam_error=0.34))
    assert "Cheapest within 5 %: beam, 1.0 ms" in told
    assert "auto does not use it: the estimated error of the beam is 34 %" in told


def test_what_failed_is_shown_with_its_reason(
    plan: ChartPlan, made_up: Chart, tmp_path: Path
) -> None:
    """One that passes a limit ends its ladder; any other failure is a point among others."""
    fails = {("solid", "linear"): "exceeded the limit of 9 s", ("solid", "straight"): "no mesh"}
    found = chart(plan, MadeUp(fails))
    assert [p.failed for p in found.points if p.element == LINEAR] == ["exceeded the limit of 9 s"]
    assert [p.failed for p in found.points if p.element == STRAIGHT] == ["no mesh"] * 5
    assert failures(found) == [
        f"Failed: solid ({LINEAR}): exceeded the limit of 9 s",
        f"Failed: solid ({STRAIGHT}), all meshes: no mesh",
    ]
    one = (*made_up.points, ChartPoint("solid", CURVED, failed="no mesh"))
    assert failures(replace(made_up, points=one)) == [f"Failed: solid ({CURVED}), mesh 6: no mesh"]
    chart_table(found).write(tmp_path)
    rows = list(csv.DictReader((tmp_path / "chart.csv").read_text().splitlines()))
    (row,) = [r for r in rows if r["element"] == LINEAR]
    assert row["failed"] == "exceeded the limit of 9 s"
    assert [row[c] for c in CONTRACT[2:]] == [""] * 5
    svg = draw([chart_plot(found)], tmp_path)[0].read_text()
    assert "<svg" in svg


def test_without_any_point_inside_the_status_is_1(
    made_up: Chart, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _report_missed(made_up) == 0
    assert _report_missed(replace(made_up, tolerance=1e-3)) == 1
    assert "no mesh is within the tolerance" in capsys.readouterr().err
    vague = replace(made_up.reference, error=0.06)
    assert _report_missed(replace(made_up, reference=vague)) == 1
    assert "the reference itself has an error of 6 %" in capsys.readouterr().err


def test_the_chart_is_the_same_bytes_every_time(made_up: Chart, tmp_path: Path) -> None:
    one, two = tmp_path / "one", tmp_path / "two"
    for folder in (one, two):
        draw([chart_plot(made_up)], folder)
    for name in ("chart.svg", "chart.png"):
        assert (one / name).read_bytes() == (two / name).read_bytes()


@pytest.mark.slow
def test_a_point_in_its_own_process(plan: ChartPlan) -> None:
    """What it says is the same every time; its time and memory are its own."""
    rung = ModelMesh("harmonic", level=0)
    one, two = (measure(MeasureJob(plan.problem, rung, runs=n), MeasureLimits()) for n in (1, 2))
    assert one.result is not None
    assert one.result == two.result
    assert 0.0 < one.seconds < 60.0
    assert 1.0 < one.memory < 200.0
    assert 30.0 < one.bare < 500.0


@each(
    ("rung", "limits", "reason"),
    [
        (ModelMesh("solid", level=2), MeasureLimits(seconds=0.5), "exceeded the limit of 0.5 s"),
        (ModelMesh("solid", level=2), MeasureLimits(memory=20.0), "exceeded the limit of 20 MB"),
        (ModelMesh("solid", level=40), MeasureLimits(), "allowed, because the thinnest part"),
    ],
)
def test_a_point_that_passes_a_limit_or_cannot_be_fails(
    plan: ChartPlan, rung: ModelMesh, limits: MeasureLimits, reason: str
) -> None:
    start = time.monotonic()
    found = measure(MeasureJob(plan.problem, rung), limits)
    assert found.result is None
    assert reason in found.failed
    assert time.monotonic() - start < 60.0


def test_a_pin_that_is_no_body_of_revolution(tmp_path: Path) -> None:
    """Its reference is the solid model itself, on finer meshes than are charted."""
    text = ONE_PIN.replace(
        "fillet = 0.4", "flat = [{ z = [3.2, 3.5], distance = 0.45 }]\nfillet = 0.4"
    )
    (tmp_path / "study.toml").write_text(text)
    found = chart(plan_chart(load_study(tmp_path / "study.toml"), "B", "landing"), MadeUp({}))
    assert all(p.failed and "pin B" in p.failed for p in found.points[:2])
    assert found.reference.model == "solid"
    assert found.reference.dofs >= 8 * max(p.dofs or 0 for p in found.curves["solid", CURVED])
    assert math.isfinite(found.reference.error)
    assert "Reference: solid model" in reference_line(found)


def test_where_no_maximum_exists_the_chart_says_so(tmp_path: Path) -> None:
    text = ONE_PIN.replace("fillet = 0.4", "fillet = 0")
    (tmp_path / "study.toml").write_text(text)
    found = chart(plan_chart(load_study(tmp_path / "study.toml"), "B", "landing"), MadeUp({}))
    assert found.note.startswith("No maximum exists: at a sharp corner")
    assert "the same" not in found.note
    assert "which all models share" in found.note
