"""Hardened surfaces in a study file: what is read, refused, and written."""

import json
from pathlib import Path

import pytest

import pinstress
from pinstress.study.reading.errors import InputError
from tests.support.each import each
from tests.support.programs.command_line import run_here

BAR = """
title = "Hardened bar"
units = "mm-N-s"
[material.steel]
youngs_modulus = "205 GPa"
poisson_ratio = 0.29
{strength}
[pin.P]
material = "steel"
{of_pin}
profile = [
  {{ length = 20, diameter = 40, connection = "A", bore = 10 }},
  {{ length = 60, diameter = 40, bore = 10 {of_segment} }},
  {{ length = 20, diameter = 40, connection = "B", bore = 10 }},
  {{ length = 60, diameter = 40, bore = 10 }},
  {{ length = 20, diameter = 40, connection = "C", bore = 10 }},
]
[case.press]
kind = "given"
forces = {{ A = [0.0, 10000.0], B = [0.0, -20000.0], C = [0.0, 10000.0] }}
distribution = "uniform"
[analysis]
required_safety_factor = 1.5
"""
CASE = 'hardened = { surface = "900 MPa", core = "500 MPa", depth = 2 }'
RANGED = "yield_strength = 800\nrange = { yield_strength = [10, 9000] }"


def study(tmp_path: Path, strength: str = "", of_pin: str = "", of_segment: str = "") -> Path:
    path = tmp_path / "bar.toml"
    path.write_text(BAR.format(strength=strength, of_pin=of_pin, of_segment=of_segment))
    return path


@each(
    ("strength", "of_pin", "of_segment", "told"),
    [
        (CASE.replace("= 2 }", "= 15 }"), "", "", r"hardened\.depth.*15 mm deep.*wall is 15 mm"),
        (CASE.replace("= 2 }", "= 0 }"), "", "", r"hardened\.depth: must be positive"),
        (CASE.replace("500", "950"), "", "", r"hardened.*core is 1\.056 times"),
        (CASE.replace(", depth = 2", ""), "", "", r"hardened\.depth.*"),
        (CASE + '\nyield_strength = "500 MPa"', "", "", "either yield_strength or hardened"),
        ("", CASE.replace("= 2 }", "= 16 }"), "", r"pin\.P\.hardened\.depth"),
        ("", "", ", " + CASE, r"profile\[2\]\.hardened: the rest of pin P has no yield strength"),
        (RANGED, "", ", " + CASE, r"range\.yield_strength: pin P is hardened in part.*lower end"),
    ],
)
def test_bad_case_is_told(
    tmp_path: Path, strength: str, of_pin: str, of_segment: str, told: str
) -> None:
    with pytest.raises(InputError, match=r"(?s)" + told):
        pinstress.run(pinstress.load_study(study(tmp_path, strength, of_pin, of_segment)))


def test_hole_is_refused(tmp_path: Path) -> None:
    path = study(tmp_path, CASE)
    path.write_text(path.read_text() + "[[pin.P.hole]]\nz = 100\ndiameter = 3\n")
    with pytest.raises(InputError, match="holes, flats, slots or passages"):
        pinstress.run(pinstress.load_study(path))


def test_row_says_what_governs(tmp_path: Path) -> None:
    out = tmp_path / "out"
    path = str(study(tmp_path, CASE))
    assert run_here("run", path, "--out", str(out), cwd=tmp_path).returncode == 0
    (row,) = json.loads((out / "results.json").read_text())["pins"]
    first, second = row["hardened"]
    assert (row["governs"], first["part"], second["part"]) == ("core", "core", "case")
    assert row["max_von_mises"] == first["max_von_mises"]
    assert row["safety_factor"] == pytest.approx(500.0 / row["max_von_mises"])
    assert row["safety_factor"] < second["safety_factor"]
    assert ",core," in (out / "safety_factors.csv").read_text()
    assert "the core beneath the hardened case governs" in (out / "report.html").read_text()


def test_a_range_of_the_material_is_none_of_a_pin_hardened_all_over(tmp_path: Path) -> None:
    """Neither its outcome nor its checks take a yield strength that counts nowhere on it."""
    (plain,) = pinstress.run(
        pinstress.load_study(study(tmp_path, of_pin=CASE, strength="yield_strength = 800"))
    ).pins
    (ranged,) = pinstress.run(pinstress.load_study(study(tmp_path, RANGED, CASE))).pins
    assert plain.outcome != "depends"
    assert (ranged.outcome, ranged.depends_on, ranged.strength_range) == (plain.outcome, (), None)
    assert ranged.margins == plain.margins


def test_only_the_hardened_segment_has_the_case(tmp_path: Path) -> None:
    # The middle of the bar, where bending is largest, is not hardened.
    path = study(tmp_path, 'yield_strength = "400 MPa"', "", ", " + CASE)
    (row,) = pinstress.run(pinstress.load_study(path)).pins
    assert row.places is not None
    assert row.places.hardened[0].part == "unhardened"
    assert row.yield_strength == pytest.approx(400.0)


@pytest.mark.slow
def test_depth_may_be_varied(tmp_path: Path) -> None:
    engine = pinstress.Engine(pinstress.load_study(study(tmp_path, "", CASE)))
    factors = [
        engine.answer({"pin.P.hardened.depth": depth}).pins[0].safety_factor for depth in (1, 4, 12)
    ]
    assert factors[0] is not None
    assert factors == sorted(factors, key=lambda x: x or 0.0)
    assert factors[-1] == pytest.approx(factors[0] * 900 / 500 * 19 / 20, rel=0.02)


@pytest.mark.slow
@each(
    ("command", "told"),
    [
        (["size"], "hardened gives it two yield strengths"),
        (["chart", "--pin", "P", "--case", "press"], "a chart takes one yield strength"),
    ],
)
def test_what_takes_one_strength_refuses(tmp_path: Path, command: list[str], told: str) -> None:
    path = str(study(tmp_path, CASE))
    done = run_here(command[0], path, *command[1:], cwd=tmp_path)
    assert done.returncode != 0
    assert told in " ".join((done.stdout + done.stderr).split())


VARIED = """
[vary.parameters]
"pin.P.profile[2].bore" = { normal = [10, 0.1] }
"""


@each(("surface", "part"), [("900", "core"), ("510", "case")])
def test_the_terminal_says_whether_case_or_core_governs(
    tmp_path: Path, surface: str, part: str
) -> None:
    """Stress falls linearly, to 18/20 at the boundary: the case governs up to a ratio of 20/18."""
    path = study(tmp_path, CASE.replace("900", surface))
    done = run_here("run", str(path), cwd=tmp_path)
    assert f"({part} under B)" in " ".join(done.stdout.split())


@each("command", ["check", "reliability"])
def test_reliability_is_refused_before_anything_is_solved(tmp_path: Path, command: str) -> None:
    path = study(tmp_path, CASE)
    path.write_text(path.read_text() + VARIED)
    done = run_here(command, str(path), cwd=tmp_path)
    assert done.returncode == 2
    assert "hardened: reliability takes one yield strength" in " ".join(done.stderr.split())
    assert "the study as it is" not in done.stderr
