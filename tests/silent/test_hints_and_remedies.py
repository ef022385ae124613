"""Remedies and hints that did not fit their cause: "remove the sharp corner" at the edge of a
prescribed load, "did you mean 'material'?" for `diameter`; 40 emoji as a name ended `--plots` in a
traceback; the status 0 of a pin that fails was not explained.

Independent: what is in the studies (one has no corner and no clamp), and a count of letters.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from pinstress.schema.shown import nearest
from tests.support.programs.command_line import ONE_PIN, QUICK, pinstress, run_here

# A plain bar without corners or clamps: its only singularities are the edges of the loads.
EDGES_OF_LOADS = """
title = "edges"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = 300
[pin.P]
material = "steel"
profile = [
  { length = 4, diameter = 20, connection = "L" },
  { length = 2, diameter = 20 },
  { length = 8, diameter = 20, connection = "M" },
  { length = 2, diameter = 20 },
  { length = 4, diameter = 20, connection = "R" },
]
[case.pull]
kind = "given"
distribution = "uniform"
forces = { L = [-20000, 0], M = [40000, 0], R = [-20000, 0] }
[analysis]
required_safety_factor = 4
joints = "prescribed"
"""


def test_a_remedy_at_the_edge_of_a_load_is_of_loads(tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text(EDGES_OF_LOADS, encoding="utf-8")
    found = run_here("run", "s.toml", "--no-pictures", cwd=tmp_path)
    assert "singular" in found.stdout
    page = (tmp_path / "out" / "s" / "report.html").read_text(encoding="utf-8")
    for text in (found.stdout, found.stderr, page):
        assert "sharp corner" not in text.replace("at a sharp inner corner", "")
        assert "remove the" not in text
    assert 'spread the load by distribution = "cosine"' in " ".join(found.stdout.split())


@pytest.mark.parametrize(
    ("name", "known", "meant"),
    [
        ("diameter", ("material", "profile", "clamp"), None),
        ("materail", ("material", "profile"), "material"),
        ("Profile", ("material", "profile"), "profile"),
        ("youngs", ("youngs_modulus", "yield_strength"), "youngs_modulus"),
        ("lenght", ("length", "height"), "length"),
        ("xyz", ("abc", "length"), None),
    ],
)
def test_a_hint_is_a_misspelling(name: str, known: tuple[str, ...], meant: str | None) -> None:
    """`diameter` and `material` share five letters in their order, and mean nothing alike."""
    assert nearest(name, known) == meant


def test_the_message_for_a_key_of_another_table_suggests_none(tmp_path: Path) -> None:
    text = ONE_PIN.replace('material = "AISI 4340"', "diameter = 2")
    (tmp_path / "s.toml").write_text(text, encoding="utf-8")
    found = run_here("check", "s.toml", cwd=tmp_path)
    assert found.returncode == 2
    assert "unknown key 'diameter'" in found.stderr
    assert "did you mean" not in found.stderr


@pytest.mark.slow
def test_a_name_of_emoji_is_drawn(tmp_path: Path) -> None:
    """In a process of its own: every plot, as SVG and PNG, and no traceback."""
    name = "\N{GRINNING FACE}" * 40
    text = QUICK.replace('connection = "B"', f'connection = "{name}"')
    text = text.replace("forces = { B", f'forces = {{ "{name}"')
    (tmp_path / "s.toml").write_text(text, encoding="utf-8")
    found = pinstress("run", "s.toml", "--plots", "--out", "out", cwd=tmp_path)
    assert found.returncode == 0, found.stderr
    assert "Traceback" not in found.stderr
    drawn = {path.suffix for path in (tmp_path / "out" / "plots").iterdir()}
    assert drawn == {".svg", ".png"}
    texts = [p.read_text(encoding="utf-8") for p in (tmp_path / "out" / "plots").glob("*.svg")]
    assert any(name[0] in text or "U+1F600" in text for text in texts)


@pytest.mark.parametrize(("required", "explained"), [(10, False), (1000, True)])
def test_the_status_of_a_pin_that_fails_is_explained(
    tmp_path: Path, required: int, explained: bool
) -> None:
    text = QUICK.replace("required_safety_factor = 10", f"required_safety_factor = {required}")
    (tmp_path / "s.toml").write_text(text, encoding="utf-8")
    found = run_here("run", "s.toml", "--no-pictures", cwd=tmp_path)
    assert found.returncode == 0
    assert ("Exit status 0" in found.stderr) is explained
    assert ("--fail-on-miss" in found.stderr) is explained
    assert "--fail-on-miss" in run_here("run", "--help", cwd=tmp_path).stdout
    strict = run_here("run", "s.toml", "--no-pictures", "--fail-on-miss", cwd=tmp_path)
    assert strict.returncode == (4 if explained else 0)
