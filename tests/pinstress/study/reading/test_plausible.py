"""Numbers that are hardly meant are questioned, with the unit that is; those that are, are not."""

from __future__ import annotations

from pathlib import Path

import pytest

from pinstress import InputError, load_study, run
from pinstress.cli.commands import run_command_line
from pinstress.study.reading.file import parse_study
from tests.conftest import ROOT
from tests.support.each import each

STUDIES = sorted((ROOT / "studies").glob("**/*.toml"))
METRIC = """\
title = "A pin"
units = "mm-N-s"
[material.steel]
youngs_modulus = 210000
poisson_ratio = 0.3
density = 7.85e-9
yield_strength = 355
[pin.A]
material = "steel"
clamp = ["start"]
profile = [{ length = 40, diameter = 25, connection = "A" }]
[case.load]
kind = "given"
forces = { A = [0.0, 100.0] }
"""
IN_METRES = METRIC.replace("mm-N-s", "m-N-s").replace("210000", "210e9").replace("355", "355e6")
IN_METRES = IN_METRES.replace("7.85e-9", "7850").replace("40", "0.04").replace("25", "0.025")
IN_INCHES = METRIC.replace("mm-N-s", "in-lbf-s").replace("210000", "30e6").replace("355", "50e3")
IN_INCHES = IN_INCHES.replace("7.85e-9", "7.35e-4").replace("40", "2").replace("25", "1")
LINKAGE = (ROOT / "studies" / "slider_crank.toml").read_text()
HEAVY = LINKAGE.replace("gravity = [0, 0]", 'gravity = [0, "-9.81 m/s^2"]')
IN_MSI = IN_INCHES.replace("= 30e6", '= "30 Msi"')
E, RHO, YIELD, BORE = "youngs_modulus", "density", "yield_strength", "diameter"


@each("study", STUDIES)
def test_no_shipped_study_is_questioned(study: Path) -> None:
    assert load_study(study).warnings == ()


@each("text", [METRIC, IN_METRES, IN_INCHES, HEAVY, IN_MSI])
def test_what_is_right_is_not_questioned(text: str) -> None:
    assert parse_study(Path("s.toml"), text).warnings == ()


def test_a_strength_near_the_modulus_questions_both() -> None:
    """Young's modulus in MPa in a study in psi: its strength is not what is wrong."""
    warned = parse_study(Path("s.toml"), IN_INCHES.replace("30e6", "210000")).warnings
    assert len(warned) == 1
    assert warned[0].endswith("more than 5% of youngs_modulus (1,448 MPa); check the units of both")


@each(
    ("text", "old", "new", "key", "likely"),
    [
        (METRIC, "= 210000", '= "210 MPa"', E, "210 GPa"),
        (METRIC, "= 210000", "= 210", E, "210 GPa"),
        (METRIC, "= 210000", "= 210e9", E, "2.1e+11 Pa"),
        (METRIC, "= 210000", "= 30e6", E, "30000000 psi"),
        (METRIC, "= 210000", '= "70 MPa"', E, "70 GPa"),
        (IN_METRES, "= 210e9", "= 210000", E, "210000 MPa"),
        (IN_INCHES, "= 30e6", "= 28400", E, "28400 ksi"),
        (METRIC, "= 355", '= "355 GPa"', YIELD, "355 MPa"),
        (METRIC, "= 355", "= 355e6", YIELD, "355000000 Pa"),
        (METRIC, "= 355", "= 35500", YIELD, "35500 psi"),
        (IN_METRES, "= 355e6", "= 355", YIELD, "355 MPa"),
        (IN_INCHES, "= 50e3", "= 50", YIELD, "50 ksi"),
        (METRIC, "= 7.85e-9", "= 7850", RHO, "7850 kg/m^3"),
        (METRIC, "= 7.85e-9", "= 7.85", RHO, "7.85 g/cm^3"),
        (METRIC, "= 7.85e-9", "= 7.85e-6", RHO, None),
        (IN_METRES, "= 7850", "= 7.85e-9", RHO, "7.85e-09 t/mm^3"),
        (IN_METRES, "= 7850", "= 7.85", RHO, "7.85 g/cm^3"),
        (IN_INCHES, "= 7.35e-4", "= 0.2836", RHO, "0.2836 lb/in^3"),
        (IN_METRES, "= 0.025", "= 25", BORE, "25 mm"),
        (METRIC, "= 25", "= 0.05", BORE, "0.05 m"),
        (METRIC, "= 25", '= "25 m"', BORE, "25 mm"),
        (IN_METRES, "= 0.04", "= 20", "length", "20 mm"),
        (METRIC, "= 40", '= "5 um"', "length", "5 cm"),
        (HEAVY, '"-9.81 m/s^2"', "-9.81", "gravity", "-9.81 m/s^2"),
        (HEAVY, '"-9.81 m/s^2"', '"-9810 m/s^2"', "gravity", "-9810 mm/s^2"),
        (HEAVY, '"-9.81 m/s^2"', '"-386.09 m/s^2"', "gravity", "-386.09 in/s^2"),
        (LINKAGE, "[0, 0]  ", "[9.81, 0]  ", "gravity", "9.81 m/s^2"),
        (LINKAGE, 'section = [40, 20], density = "7.85 g/cm^3"', "section = [40, 20], density = "
         "7850", "bar.density", "7850 kg/m^3"),
    ],
)  # fmt: skip
def test_a_wrong_unit_is_questioned_with_the_likely_one(
    text: str, old: str, new: str, key: str, likely: str | None
) -> None:
    assert text.count(old) == 1
    (told,) = parse_study(Path("s.toml"), text.replace(old, new)).warnings
    place, told = told.split(": ", 1)
    line = int(place.removeprefix("s.toml:"))
    assert new.split()[-1].strip('"]') in text.replace(old, new).splitlines()[line - 1]
    assert told.split(":")[0].endswith(key)
    assert told.endswith(f'did you mean "{likely}"?') if likely else "did you mean" not in told


def test_a_shape_that_cannot_be_calculated_is_an_error_with_the_likely_unit() -> None:
    with pytest.raises(InputError) as caught:
        parse_study(Path("s.toml"), METRIC.replace("= 25", "= 0.025"))
    told = str(caught.value).splitlines()
    assert told[:2] == [
        "s.toml: 2 errors",
        "s.toml:11: pin.A.profile: the pin is 1,600 times as long as it is wide; the limit is "
        "1,000; check the units",
    ]
    assert told[2].endswith('did you mean "0.025 m"?')


def test_a_modulus_in_question_leaves_its_strength_alone() -> None:
    text = METRIC.replace("= 210000", '= "210 MPa"').replace("= 355", '= "355 MPa"')
    (told,) = parse_study(Path("s.toml"), text).warnings
    assert told == (
        "s.toml:4: material.steel.youngs_modulus: '210 MPa' is 0.21 GPa, but the usual range "
        'for a structural material is 1 to 1,200 GPa; did you mean "210 GPa"?'
    )


@each("command", ["check", "run", "loads", "size"])
def test_every_command_that_reads_a_study_says_it(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    command: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("s.toml").write_text(METRIC.replace("= 7.85e-9", "= 7850"))
    more = {"run": ["--quiet"], "loads": [], "size": ["--fos", "2"]}
    assert run_command_line([command, "s.toml", *more.get(command, [])]) in (0, 1)
    out, said = capsys.readouterr()
    assert said.startswith("Warning: s.toml:6: material.steel.density: 7850 is 7.85e+15 kg/m^3, ")
    assert said.count("Warning") == 1
    assert "Warning" not in out


def test_results_and_report_have_it_without_the_folder() -> None:
    study = parse_study(Path("/somewhere/s.toml"), METRIC.replace("= 7.85e-9", "= 7850"))
    found = run(study, tolerance=0.3)
    last = found.assumptions[-1]
    assert last.startswith("Possible mistake: material.steel.density: 7850 is 7.85e+")


def test_of_many_questions_the_first_are_said() -> None:
    many = '{ length = 40, diameter = "25 m" }, ' * 900
    study = parse_study(Path("s.toml"), METRIC.replace("profile = [", f"profile = [{many}"))
    assert len(study.questions) == 900
    assert len(study.warnings) == 21
    assert study.warnings[-1] == "s.toml: and 880 more"


@each(
    ("old", "new", "says"),
    [
        ('kind = "given"', 'kind = "given"\ntemperature = "1e6 K"', "'1e6 K' is 1e+06 K"),
        ('kind = "given"', 'kind = "given"\ntemperature = "300 degC"', ""),
        ("clamp = [\"start\"]", "lug.A.range.stiffness = [1, 2e5]", "1 to 200000 times"),
        ("clamp = [\"start\"]", "lug.A.range.stiffness = [0.2, 20]", ""),
    ],
)  # fmt: skip
def test_temperatures_and_ratios_of_no_machine_are_questioned(
    old: str, new: str, says: str
) -> None:
    text = METRIC.replace(old, new).replace("0.3\n", "0.3\nthermal_expansion = '12e-6 1/K'\n")
    told = [x for x in parse_study(Path("s.toml"), text).warnings if "no effect" not in x]
    assert len(told) == bool(says)
    assert says in "".join(told)
