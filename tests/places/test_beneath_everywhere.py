"""A stub in its lugs that surface and section carry, but not what lies beneath its contact: every
command that judges it says so.

Pin 20 mm, lugs 8 + 16 + 8 mm, 50 kN, yield 700 MPa: row about 256 MPa (factor 2.73), beneath about
279 MPa (2.51; with its error 2.46). A factor of 2.6 is between them.
"""

from __future__ import annotations

import csv
import json
from pathlib import Path
from statistics import NormalDist
from typing import Any

import pytest
from pyarrow import parquet

from pinstress.cli.commands import run_command_line
from pinstress.explore.size.size_pin import CONTACT_FACTOR_TOLERANCE
from tests.conftest import ROOT
from tests.places.test_headline_again import violations
from tests.support.study_text import edited

pytestmark = pytest.mark.slow

REQUIRED, MEAN, DEVIATION = 2.6, 700.0, 15.0
RANDOM = f"""
[vary.parameters]
"material.steel.yield_strength" = {{ normal = [{MEAN}, {DEVIATION}] }}

[vary]
sample = "random"
count = 6

[reliability]
factor = {REQUIRED}
probability = 0.2
samples = 300
importance_samples = 200
sobol_samples = 0
"""


def stub(required: float = REQUIRED, more: str = "") -> str:
    text = (ROOT / "studies" / "clevis.toml").read_text(encoding="utf-8")
    changes = (
        ("length = 10, diameter", "length = 8, diameter"),
        ("length = 20, diameter", "length = 16, diameter"),
        ("length = 1, diameter", "length = 0.5, diameter"),
        ("required_safety_factor = 1.5", f'required_safety_factor = {required}\ngoal = "value"'),
    )
    return edited(text, changes) + more


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With the study, also with a random strength, and the output of a run."""
    made = tmp_path_factory.mktemp("stub")
    (made / "stub.toml").write_text(stub(), encoding="utf-8")
    (made / "random.toml").write_text(stub(more=RANDOM), encoding="utf-8")
    command(made, "run", "stub.toml", "--out", str(made / "run"), "--fail-on-miss", expected=4)
    return made


def command(folder: Path, name: str, study: str, *more: str, expected: int = 0) -> None:
    assert run_command_line([name, str(folder / study), *more]) == expected


def row(folder: Path, run: str = "run") -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder / run / "results.json").read_text())["pins"][0]
    return found


def test_a_run(folder: Path) -> None:
    """By the numbers of results.json themselves."""
    found = row(folder)
    below, permitted = found["contact"], MEAN / REQUIRED
    assert found["max_von_mises"] + found["error_estimate"] < permitted
    assert below["beneath"] > permitted
    assert found["outcome"] == "depends"
    assert [x["over"] for x in found["depends_on"]] == ["beneath", "joint"]
    assert found["depends_on"][1]["what"] == "together"
    written = json.loads((folder / "run" / "results.json").read_text())
    assert "not beneath contact" in written["headline"]["sentence"]
    assert written["headline"]["depends"] == ["P"]
    assert violations(written) == []
    reach = found["depends_on"][0]["reach"]
    assert 2.0 <= reach <= 10.0  # farther than 0.1 d, within the pin
    assert reach > (below["reach"] or 0.0)  # which is that of yield


def test_its_tables(folder: Path) -> None:
    for name in ("safety_factors", "envelope"):
        path = folder / "run" / f"{name}.csv"
        if path.exists():
            with path.open(encoding="utf-8") as file:
                assert {x["outcome"] for x in csv.DictReader(file)} == {"depends"}, name


def test_it_counts_over_the_joint(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A factor of 2.3 permits 304 MPa: what lies beneath meets it as described, but not at twice
    the clearance, which a study with that clearance finds, too; surface and section always do.
    """
    (folder / "less.toml").write_text(stub(2.3), encoding="utf-8")
    command(folder, "run", "less.toml", "--out", str(folder / "less"))
    said = " ".join(capsys.readouterr().out.split())
    assert "beneath contact at clearance above" in said
    found = row(folder, "less")
    permitted, below = MEAN / 2.3, found["contact"]
    assert below["beneath"] + below["beneath_error"] < permitted
    assert found["joint"]["range"]["max_von_mises"][1] < permitted
    assert found["outcome"] == "depends"
    loose = next(x for x in found["joint"]["range"]["over"] if x["value"] == "twice the given")
    entry = next(x for x in found["depends_on"] if x["value"] == "clearance")
    assert (entry["what"], entry["over"], entry["at"]) == ("beneath", "joint", 0.1)
    assert 0.05 < entry["flips_at"] <= 0.1
    other = stub(2.3).replace("clearance = 0.05", "clearance = 0.1")
    (folder / "loose.toml").write_text(other, encoding="utf-8")
    command(folder, "run", "loose.toml", "--out", str(folder / "loose"))
    twice = row(folder, "loose")["contact"]
    assert loose["beneath"] == pytest.approx(twice["beneath"], rel=0.03)
    assert twice["beneath"] + twice["beneath_error"] > permitted


@pytest.mark.long
def test_a_comparison_sees_that_it_is_no_longer_safe(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """With a factor of 1.5 it is safe, everywhere and over its joint; the row is the same."""
    (folder / "safe.toml").write_text(stub(1.5), encoding="utf-8")
    command(folder, "run", "safe.toml", "--out", str(folder / "safe"))
    assert row(folder, "safe")["outcome"] == "safe"
    capsys.readouterr()
    run_command_line(["compare", str(folder / "safe"), str(folder / "run")])
    assert "depends" in capsys.readouterr().out


@pytest.mark.long
def test_a_sweep(folder: Path) -> None:
    """Of random strengths: safe only where what lies beneath, with its error, is too."""
    command(folder, "sweep", "random.toml", "--out", str(folder / "sweep"), "--jobs", "1")
    for x in parquet.read_table(folder / "sweep" / "designs.parquet").to_pylist():
        permitted = x["material.steel.yield_strength"] / REQUIRED
        if x["max_von_mises"] + x["error_estimate"] > permitted:
            assert x["outcome"] in ("fails", "not decided")
        elif x["beneath"] + x["beneath_error"] > permitted:
            assert x["outcome"] == "depends"
            assert "beneath contact" in x["depends_on"]


@pytest.mark.long
def test_its_reliability(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Stress does not depend on strength, so that both probabilities are those of a normal law."""
    out = str(folder / "reliability")
    command(folder, "reliability", "random.toml", "--out", out, "--jobs", "1", expected=1)
    said = capsys.readouterr()
    written = json.loads((folder / "reliability" / "reliability.json").read_text())
    (risk,) = written["risks"]
    found, law = row(folder), NormalDist(MEAN, DEVIATION)
    below = found["contact"]
    failing = law.cdf(REQUIRED * found["max_von_mises"])
    depending = law.cdf(REQUIRED * (below["beneath"] + below["beneath_error"]))
    assert failing < 0.2 < depending
    ends = risk["weighted"] if risk["by_weights"] else risk["sampled"]
    assert ends["low"] <= failing <= ends["high"]
    assert risk["beneath"]["low"] <= depending <= risk["beneath"]["high"]
    assert risk["result"] == "depends"
    assert "with what lies beneath contact" in " ".join(said.out.split())
    assert "Depends on what lies beneath contact: Pin P, pull." in said.err
    with (folder / "reliability" / "reliability.csv").open(encoding="utf-8") as file:
        (line,) = csv.DictReader(file)
    assert line["result"] == "depends"
    assert float(line["beneath"]) == risk["beneath"]["value"]
    page = (folder / "reliability" / "reliability.html").read_text(encoding="utf-8")
    assert "or beneath contact" in page


def test_its_size(folder: Path) -> None:
    """It is made larger, though its row meets the factor, until what lies beneath does."""
    sized = str(folder / "sized.toml")
    run_command_line(["size", str(folder / "stub.toml"), "--fos", str(REQUIRED), "--out", sized])
    command(folder, "run", "sized.toml", "--out", str(folder / "sized"))
    found = row(folder, "sized")
    below = found["contact"]
    allowed = MEAN / REQUIRED
    least = allowed / (1.0 + CONTACT_FACTOR_TOLERANCE)
    assert least < below["beneath"] + below["beneath_error"] <= allowed
    assert not [x for x in found["depends_on"] if x["over"] == "beneath"]
