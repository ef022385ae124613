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
from tests.conftest import ROOT

pytestmark = pytest.mark.slow

REQUIRED, MEAN, DEVIATION = 2.6, 700.0, 15.0
RANDOM = f"""
[vary.parameters]
"material.steel.yield_strength" = {{ normal = [{MEAN}, {DEVIATION}] }}

[vary]
seed = 1
sample = "random"
count = 4

[reliability]
factor = {REQUIRED}
probability = 0.05
samples = 150
importance_samples = 80
sobol_samples = 0
"""


def stub(required: float = REQUIRED, more: str = "") -> str:
    text = (ROOT / "studies" / "clevis.toml").read_text(encoding="utf-8")
    for old, new in (
        ("length = 10, diameter", "length = 8, diameter"),
        ("length = 20, diameter", "length = 16, diameter"),
        ("length = 1, diameter", "length = 0.5, diameter"),
        ("required_safety_factor = 1.5", f'required_safety_factor = {required}\ngoal = "value"'),
    ):
        assert old in text
        text = text.replace(old, new)
    return text + more


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With the study, also with a random strength, and the output of a run."""
    made = tmp_path_factory.mktemp("stub")
    (made / "stub.toml").write_text(stub(), encoding="utf-8")
    (made / "random.toml").write_text(stub(more=RANDOM), encoding="utf-8")
    command(made, "run", "stub.toml", "--out", "run", "--fail-on-miss", expected=4)
    return made


def command(folder: Path, name: str, study: str, *more: str, expected: int = 0) -> None:
    given = [str(folder / x) if (folder / x).suffix or x == "run" else x for x in more]
    found = run_command_line([name, str(folder / study), *given])
    assert found == expected


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
    assert [x["over"] for x in found["depends_on"]] == ["beneath"]
    written = json.loads((folder / "run" / "results.json").read_text())
    assert "not beneath contact" in written["headline"]["sentence"]
    assert written["headline"]["depends"] == ["P"]


def test_its_tables(folder: Path) -> None:
    for name in ("safety_factors", "envelope"):
        path = folder / "run" / f"{name}.csv"
        if path.exists():
            with path.open(encoding="utf-8") as file:
                assert {x["outcome"] for x in csv.DictReader(file)} == {"depends"}, name


def test_a_comparison_with_a_factor_that_it_meets(folder: Path) -> None:
    (folder / "less.toml").write_text(stub(2.3), encoding="utf-8")
    command(folder, "run", "less.toml", "--out", str(folder / "less"), expected=0)
    found = row(folder, "less")
    assert found["outcome"] == "safe", found["depends_on"]


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
    assert failing < 0.05 < depending
    ends = risk["weighted"] if risk["by_weights"] else risk["sampled"]
    assert ends["low"] <= failing <= ends["high"]
    assert risk["beneath"]["low"] <= depending <= risk["beneath"]["high"]
    assert risk["result"] == "depends"
    assert "with what lies beneath contact" in said.out
    assert "Depends on what lies beneath contact: Pin P, pull." in said.err
    with (folder / "reliability" / "reliability.csv").open(encoding="utf-8") as file:
        (line,) = csv.DictReader(file)
    assert line["result"] == "depends"
    assert float(line["beneath"]) == risk["beneath"]["value"]
    page = (folder / "reliability" / "reliability.html").read_text(encoding="utf-8")
    assert "or beneath contact" in page


def test_its_size(folder: Path) -> None:
    """It is made larger, though its row meets the factor, until what lies beneath meets it, too.
    Over the range of the joint it still does not: status 1.
    """
    command(folder, "size", "stub.toml", "--out", str(folder / "size"), expected=1)
    found = row(folder, "size")
    below = found["contact"]
    assert below["beneath"] + below["beneath_error"] < MEAN / REQUIRED
    assert {x["over"] for x in found["depends_on"]} == {"joint"}
