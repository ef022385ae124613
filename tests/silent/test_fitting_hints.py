"""Hints and remedies that did not fit: "did you mean 'material'?" for `diameter`, "remove the sharp
corner" at the edge of a prescribed load; a traceback instead of plots for a name of 40 emoji; a pin
that fails and status 0 without a word.

Independent values: edit distances counted by hand, the kind of singularity in results.json, the
process's own exit status.
"""

from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from pinstress.cli.commands import run_command_line
from pinstress.study.schema.shown import nearest
from reports.plots.draw import svg
from tests.support.each import each
from tests.support.programs.command_line import QUICK

PINS = ["material", "clamp", "profile", "fillet", "lug", "distance"]


@each("unlike", ["diameter", "radius", "force", "stress"])
def test_a_name_with_some_letters_in_common_is_no_hint(unlike: str) -> None:
    """`diameter` and `material` share i, a, e, t and r; six of eight letters are wrong."""
    assert nearest(unlike, PINS, 0.5) is None


@each(
    ("written", "meant"),
    [
        ("matreial", "material"),  # two letters swapped
        ("materil", "material"),  # one left out
        ("profille", "profile"),  # one added
        ("clanp", "clamp"),  # one wrong
        ("MATERIAL", "material"),
        ("fillet_radius", "fillet"),  # more than the name
    ],
)
def test_a_misspelt_name_is(written: str, meant: str) -> None:
    assert nearest(written, PINS, 0.5) == meant


def run(folder: Path, text: str, *options: str) -> int:
    (folder / "study.toml").write_text(text, encoding="utf-8")
    out = str(folder / "out")
    arguments = ["run", str(folder / "study.toml"), "--out", out, "--vtk", "none", "--no-cache"]
    return run_command_line([*arguments, "--jobs", "1", *options])


def failing(pin: str) -> str:
    """At the edge of a load, or of a clamp, stress has no maximum, and the factor is too small."""
    return f"""
title = "fails"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "500 MPa"
[analysis]
joints = "prescribed"
required_safety_factor = 5
[case.one]
kind = "given"
distribution = "uniform"
{pin}
"""


FREE = failing("""
forces = { A = [0, -2000], B = [0, 2000], C = [0, 2000], D = [0, -2000] }
[pin.P]
material = "steel"
profile = [
  { length = 40, diameter = 22, connection = "A" }, { length = 100, diameter = 22 },
  { length = 40, diameter = 22, connection = "B" }, { length = 100, diameter = 22 },
  { length = 40, diameter = 22, connection = "C" }, { length = 100, diameter = 22 },
  { length = 40, diameter = 22, connection = "D" },
]
""")
CLAMPED = failing("""
forces = { B = [0, 2000] }
[pin.P]
material = "steel"
clamp = ["start"]
profile = [ { length = 100, diameter = 22 }, { length = 20, diameter = 22, connection = "B" } ]
""")


@pytest.mark.parametrize(
    ("text", "kind", "remedy"),
    [
        (FREE, "the edge of a load", 'first spread the load by distribution = "cosine"'),
        (CLAMPED, "the edge of a clamp", "first replace the clamp by its hub"),
    ],
    ids=["edge of a load", "edge of a clamp"],
)
def test_the_remedy_is_that_of_the_singularity(
    text: str, kind: str, remedy: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """And nobody is told to remove a sharp corner where there is none; the status is explained."""
    assert run(tmp_path, text) in (0, 1)
    said = capsys.readouterr()
    words = " ".join(said.out.split())
    (row,) = json.loads((tmp_path / "out" / "results.json").read_text())["pins"]
    assert {zone["kind"] for zone in row["singular_at"] if zone["governs"]} == {kind}
    assert remedy in words
    assert "sharp corner" not in words


FAILS = QUICK.replace("required_safety_factor = 10", "required_safety_factor = 1000")


@each(
    ("text", "options", "status", "told"),
    [
        (FAILS, (), 0, True),
        (FAILS, ("--fail-on-miss",), 4, False),
        (FAILS, ("--quiet",), 0, False),
        (QUICK, (), 0, False),
    ],
)
def test_why_the_status_is_zero_where_a_pin_fails(
    text: str,
    options: tuple[str, ...],
    status: int,
    told: bool,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert run(tmp_path, text, *options) == status
    words = " ".join(capsys.readouterr().err.split())
    assert ("Exit status 0: the run is complete; --fail-on-miss makes it 4" in words) == told


def test_emoji_are_drawn() -> None:
    """A label of 40, which Vega cuts amid one of them: the file is well-formed XML."""
    labels = [40 * "\N{GRINNING FACE}", 40 * "\N{CAT}"]
    spec = {
        "data": {"values": [{"x": k, "name": name} for k, name in enumerate(labels)]},
        "mark": "point",
        "encoding": {
            "x": {"field": "x", "type": "quantitative"},
            "color": {"field": "name", "type": "nominal"},
        },
        "config": {"legend": {"labelLimit": 101}},
    }
    drawn = svg(spec)
    ET.fromstring(drawn)
    assert "U+1F600" in drawn
