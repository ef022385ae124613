"""`pinstress reliability`: a bar with an exact answer through the whole chain, and bad input."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from pinstress.cli.commands import run_command_line
from pinstress.explore.reliability.designs import for_values, random_numbers
from pinstress.explore.reliability.drivers import base_samples, indices
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import parse_study
from tests.conftest import ROOT
from tests.support.each import each

EXACT = 0.0291981946  # of tests/pinstress/explore/reliability/test_reliability_mathematics.py

PAGE = (ROOT / "docs" / "reliability.md").read_text(encoding="utf-8")
SMALL = """
[reliability]
samples = 200
importance_samples = 300
sobol_samples = 16

"""
# The page's own example, with fewer samples.
BAR = PAGE.split("```toml\n")[1].split("```")[0].replace("[vary.", f"{SMALL}[vary.", 1)


def _run(tmp_path: Path, text: str, *more: str) -> int:
    path = tmp_path / "bar.toml"
    path.write_text(text)
    return run_command_line(
        ["reliability", str(path), "--out", str(tmp_path / "out"), "--jobs", "1", "--quiet", *more]
    )


def _table(path: Path) -> list[dict[str, str]]:
    with path.open() as file:
        return list(csv.DictReader(file))


@pytest.mark.slow
def test_the_bar_through_the_whole_chain(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _run(tmp_path, BAR) == 0
    printed = capsys.readouterr().out
    found = json.loads((tmp_path / "out" / "reliability.json").read_text())
    (risk,) = found["risks"]
    for way in ("sampled", "weighted"):
        assert risk[way]["low"] < EXACT < risk[way]["high"]
    assert risk["by_weights"]
    assert risk["weighted"]["high"] - risk["weighted"]["low"] < 0.5 * EXACT
    # FORM errs by the curvature alone: it is that of the exact limit state to the mesh's error.
    assert risk["form"]["probability"] == pytest.approx(EXACT, rel=0.06)
    mesh = risk["mesh"]
    assert 0.002 < mesh["most"] < 0.01
    assert mesh["lower"]["value"] < risk["weighted"]["value"] < mesh["higher"]["value"]
    assert risk["result"] == "fails"  # 0.001 is allowed
    first, second = (driver["importance"] for driver in risk["drivers"])
    assert first == pytest.approx(0.72, abs=0.02)
    assert first + second == pytest.approx(1.0)
    assert "95 %" in printed
    assert "Not included" in printed
    (row,) = _table(tmp_path / "out" / "reliability.csv")
    assert float(row["probability"]) == risk["weighted"]["value"]
    assert float(row["probability_low"]) == risk["weighted"]["low"]
    drivers = _table(tmp_path / "out" / "drivers.csv")
    assert [d["parameter"] for d in drivers] == [
        "material.steel.yield_strength", "case.pull.forces.A[3]",
    ]  # fmt: skip
    page = (tmp_path / "out" / "reliability.html").read_text()
    assert "<svg" in page
    assert "normal, mean 75000 N" in page


STRENGTH = '"material.steel.yield_strength" = { lognormal = [300, 30] }'


def _with_range(low: float) -> str:
    """The bar with few samples and a range of its yield strength."""
    given = "yield_strength = 300\n"
    text = BAR.replace(given, f"{given}range = {{ yield_strength = [{low}, 300] }}\n")
    text = text.replace("samples = 200", "probability = 0.2\nsamples = 40")
    text = text.replace("importance_samples = 300", "importance_samples = 0")
    return text.replace("sobol_samples = 16", "sobol_samples = 0")


@pytest.mark.parametrize(("low", "result"), [(290, "safe"), (150, "depends")])
def test_a_range_without_a_law_is_at_its_worst(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], low: float, result: str
) -> None:
    """A pin that depends on its yield strength in a run was safe. Half the strength is twice the
    stress, so that every design fails.
    """
    status = _run(tmp_path, _with_range(low).replace(STRENGTH, ""))
    (risk,) = json.loads((tmp_path / "out" / "reliability.json").read_text())["risks"]
    assert risk["result"] == result
    assert risk["over_open"]["value"] == (result == "depends")
    said = "Depends on what the study leaves open: Pin A, pull." in capsys.readouterr().err
    assert (status, said) == ((1, True) if result == "depends" else (0, False))


def test_a_range_with_a_law_is_left_out(tmp_path: Path) -> None:
    assert _run(tmp_path, _with_range(150)) in (0, 1)
    found = json.loads((tmp_path / "out" / "reliability.json").read_text())
    assert found["risks"][0]["over_open"] is None
    assert found["risks"][0]["unknown"] == 0  # half the strengths lie above the range
    assert found["reasons"] == {}  # of the designs of FORM either
    (told,) = (note for note in found["notes"] if "range" in note)
    assert told.startswith("The range of a yield strength is left out, since a law takes its place")


@pytest.mark.slow
def test_the_same_study_gives_the_same_numbers_with_more_processes(tmp_path: Path) -> None:
    small = BAR.replace("samples = 200", "samples = 250").replace("= 300", "= 20")
    small = small.replace("sobol_samples = 16", "sobol_samples = 0")
    assert _run(tmp_path, small) in (0, 1)
    first = (tmp_path / "out" / "reliability.json").read_bytes()
    path = str(tmp_path / "bar.toml")
    again = ["reliability", path, "--out", str(tmp_path / "again"), "--jobs", "2", "--quiet"]
    assert run_command_line(again) in (0, 1)
    assert (tmp_path / "again" / "reliability.json").read_bytes() == first


@each(
    ("old", "new", "said"),
    [
        ("[vary.parameters]", "[nothing]", "unknown key"),
        ('{ normal = ["75 kN", "5 kN"] }', "{ from = 70000, to = 80000 }", "needs a law"),
        ("samples = 200", "probability = 1.0", "must be less than 1"),
        ("samples = 200", "probability = 0", "must be greater than 0"),
        ("samples = 200", "factor = -1", "must be greater than 0"),
        ("yield_strength = 300\n", "ultimate_strength = 300\n", "yield_strength"),
        ("[vary.parameters]", CORRELATED := """[[vary.correlations]]
between = ["material.steel.yield_strength", "case.pull.forces.A[3]"]
coefficient = 0.5
[vary.parameters]""", "normal law"),
    ],
)  # fmt: skip
def test_bad_input(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, said: str
) -> None:
    assert old in BAR
    assert _run(tmp_path, BAR.replace(old, new)) == 2
    assert said in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_study_without_random_numbers(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert _run(tmp_path, BAR[: BAR.index("[vary.parameters]")]) == 2
    assert "[vary]" in capsys.readouterr().err


def test_designs_that_fail_count_both_ways(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A fillet that does not fit for half of the designs."""
    text = BAR.replace("fillet = 4000", "fillet = 7000").replace("samples = 200", "samples = 40")
    text = text.replace("importance_samples = 300", "importance_samples = 0")
    text = text.replace("sobol_samples = 16", "sobol_samples = 0")
    text += '"pin.A.profile[1].length" = { uniform = [30, 60] }\n'
    assert _run(tmp_path, text) in (0, 1)
    found = json.loads((tmp_path / "out" / "reliability.json").read_text())
    (risk,) = found["risks"]
    assert 0 < risk["unknown"] < 40
    assert sum(found["reasons"].values()) >= risk["unknown"]
    assert risk["sampled"]["high"] > risk["unknown"] / 40
    assert "count both ways" in capsys.readouterr().out


def test_nothing_fails_gives_an_upper_bound_only(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = BAR.replace("samples = 200", "samples = 20\nfactor = 0.2")
    text = text.replace("importance_samples = 300", "importance_samples = 0")
    text = text.replace("sobol_samples = 16", "sobol_samples = 0")
    assert _run(tmp_path, text) == 1
    printed = capsys.readouterr()
    assert "is below 0.168 (95 % confidence; no sample fails" in printed.out
    assert "Not decided: Pin A, pull" in printed.err
    (risk,) = json.loads((tmp_path / "out" / "reliability.json").read_text())["risks"]
    assert risk["sampled"] == {"value": 0.0, "low": 0.0, "high": pytest.approx(0.16843, rel=1e-4)}
    assert "9 standard deviations" in risk["form"]["why"]
    assert risk["form"]["probability"] is None


def test_the_study_s_correlation_reaches_the_space() -> None:
    text = BAR.replace("lognormal = [300, 30]", "normal = [300, 30]")
    text += """[[vary.correlations]]
between = ["material.steel.yield_strength", "case.pull.forces.A[3]"]
coefficient = 0.6
"""
    parameters, space = random_numbers(parse_study(Path("bar.toml"), text))
    assert len(parameters) == 2
    u = np.random.default_rng(1).standard_normal((20_000, 2))
    x = space.physical(u)
    assert float(np.corrcoef(x[:, 0], x[:, 1]).ravel()[1]) == pytest.approx(0.6, abs=0.02)
    assert x.mean(axis=0) == pytest.approx([300e6, 75e3], rel=0.01)
    assert space.importance(np.array([1.0, 0.0])).sum() == pytest.approx(1.0)


def test_sobol_indices_of_a_sum_and_a_product() -> None:
    """Of 3 a + 4 b: 9/25 and 16/25; of a b: none alone, all together."""

    def both(u: np.ndarray[tuple[int, int], np.dtype[np.float64]]) -> object:
        return np.stack([3.0 * u[:, 0] + 4.0 * u[:, 1], u[:, 0] * u[:, 1]], axis=1)

    found = indices(both, 2, 256, 1, 0.95)  # type: ignore[arg-type]
    assert found is not None
    for (first, total), exact in zip(found[0], (9.0 / 25.0, 16.0 / 25.0), strict=True):
        assert first.value == pytest.approx(exact, abs=0.02)
        assert first.low <= exact + 0.01
        assert total.value == pytest.approx(exact, abs=0.02)
    for first, total in found[1]:
        assert first.low < 0.0 < first.high + 0.02
        assert abs(first.value) < 0.1
        assert total.value == pytest.approx(1.0, abs=0.1)
    assert [base_samples(n) for n in (0, 15, 16, 256, 300)] == [0, 0, 2, 32, 32]


def test_ranges_are_refused_by_the_function_too() -> None:
    text = BAR.replace('{ normal = ["75 kN", "5 kN"] }', "{ from = 70000, to = 80000 }")
    with pytest.raises(InputError, match="from and to") as caught:
        random_numbers(parse_study(Path("bar.toml"), text))
    assert caught.value.code == "no-law"


@pytest.mark.long
@pytest.mark.slow
def test_the_page_shows_what_is_printed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """With all samples, whose interval has the exact probability in it too."""
    _run(tmp_path, BAR.replace(SMALL, ""))
    printed = [line.rstrip() for line in capsys.readouterr().out.splitlines()]
    shown = PAGE.split("```text\n")[1].split("```")[0].splitlines()
    assert shown == printed
    (risk,) = json.loads((tmp_path / "out" / "reliability.json").read_text())["risks"]
    assert risk["weighted"]["low"] < EXACT < risk["weighted"]["high"]
    assert risk["sampled"]["low"] < EXACT < risk["sampled"]["high"]


def test_laws_alone_are_checked_without_a_sweep(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The page's example has no sample; a range is no law where [reliability] is asked for."""
    path = tmp_path / "bar.toml"
    path.write_text(BAR)
    assert run_command_line(["check", str(path)]) == 0
    said = "reliability: 2 numbers scatter, a factor below 1 is failure; 200 plain and 300"
    assert said in capsys.readouterr().out
    path.write_text(BAR.replace('{ normal = ["75 kN", "5 kN"] }', "{ from = 7e4, to = 8e4 }"))
    assert run_command_line(["check", str(path)]) == 2
    path.write_text(BAR.split("[vary.")[0])
    assert run_command_line(["check", str(path)]) == 2
    assert "has no [vary]" in capsys.readouterr().err


def test_probabilities_do_not_take_the_goal_to_decide() -> None:
    """With which a design far from the required factor has a beam's error."""
    decide = BAR.replace("[reliability]", '[analysis]\ngoal = "decide"\n\n[reliability]')
    found = for_values(parse_study(Path("bar.toml"), decide))
    assert found.table.analysis.goal == "value"
    assert found.table.material == parse_study(Path("bar.toml"), BAR).table.material


# Fillets of 0.2 mm are the place of the largest stress; beside larger ones it is the clamp's edge.
STUB = """
title = "Stub"
units = "mm-N-s"

[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = 800

[pin.A]
material = "steel"
clamp = ["start"]
profile = [
  { length = 20, diameter = 20, fillet = 0.2 },
  { length = 30, diameter = 18.5, connection = "A" },
]

[case.pull]
kind = "given"
forces = { A = [0, 1500] }

[reliability]
samples = 12
importance_samples = 0
sobol_samples = 0
probability = 0.5

[vary.parameters]
"pin.A.profile[1].fillet" = { uniform = [0.15, 0.4] }
"""


@pytest.mark.slow
def test_a_pin_that_is_singular_in_many_designs_is_not_safe(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Though it is not in the study as it is, and all factors outside of the zones are above 5."""
    assert _run(tmp_path, STUB) == 1
    printed = capsys.readouterr()
    (risk,) = json.loads((tmp_path / "out" / "reliability.json").read_text())["risks"]
    assert risk["verdict"] == "converged"
    assert risk["failures"] == 0
    assert risk["sampled"]["high"] < 0.5 < risk["unbounded"]["high"]
    assert risk["result"] == "not decided"
    assert "unbounded at a corner or an edge in some designs" in " ".join(printed.out.split())
    assert "Not decided: Pin A, pull" in printed.err
