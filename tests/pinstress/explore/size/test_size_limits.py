"""[size] of a study: what limits a pin, and what is proposed where that is too small."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

from pinstress.analysis.plan import prepare
from pinstress.explore.size.pin_answers import SizedStudy
from pinstress.explore.size.scaled_study import resized_study
from pinstress.explore.size.size_limits import largest_scale, too_small
from pinstress.explore.size.size_pin import _next_standard
from pinstress.explore.size.standard_diameters import standard_diameters
from pinstress.study.reading.file import Study, parse_study
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.programs.command_line import QUICK, run_here

CLEVIS = (ROOT / "studies" / "clevis.toml").read_text()  # a pin of 20 mm in eyes of 50 mm


def clevis(lines: str) -> Study:
    return parse_study(ROOT / "studies" / "clevis.toml", f"{CLEVIS}\n[size]\n{lines}\n")


def sized(study: Study, required: float = 10.0) -> SizedStudy:
    return SizedStudy(prepare(study), "P", required, {}, standard_diameters(study.table.size))


@each(
    ("lines", "largest"),
    [
        ("largest_diameter = 30", 30.0),
        ("largest_diameter = 30\nseries = 'R10'", 25.0),
        ("series = [16, 22, 27]", 27.0),
        ("room = 60", 40.0),  # of 1.5 times the bore
        ("room = 60\neye_ratio = 2", 30.0),
        ("room = 60\neye_ratio = 4", 24.0),  # the eye has only 2.5, and keeps it
        ("scale_lugs = false", 33.33),  # rounded down to four digits
        ("scale_lugs = false\nroom = 45\nlargest_diameter = 32", 30.0),
    ],
)
def test_the_largest_diameter_by_hand(lines: str, largest: float) -> None:
    """Of the clevis pin, 20 mm in eyes of 50 mm without bushings."""
    limit = largest_scale(sized(clevis(lines)))
    assert 20.0 * limit.scale == pytest.approx(largest, rel=1e-9)
    assert limit.reason.split(" =")[0].split(",")[0] in lines


@each(
    ("lines", "largest"),
    [
        # 1.25 in, the largest number of the series in mm below it, is above
        ("largest_diameter = 31.6\nseries = 'R10'", 25.4),
        ("largest_diameter = 31.6", 31.597),  # 1.244 in
    ],
)
def test_a_limit_is_in_the_unit_in_which_the_diameter_is_written(
    lines: str, largest: float
) -> None:
    text = clevis(lines).text.replace("diameter = 20", 'diameter = "0.8 in"')
    pin = sized(parse_study(ROOT / "studies" / "clevis.toml", text))
    assert 20.32 * largest_scale(pin).scale == pytest.approx(largest, abs=1e-3)


MERIDIAN = """
meridian = [[0, 11], [2, "0.4 in"], [44, "0.4 in"], [46, 11]]
band = { LEFT = { z = [2, 12] }, EYE = { z = [13, 33] }, RIGHT = { z = [34, 44] } }

lug.EYE"""


@each("shape", ["profile", "meridian"])
def test_the_next_standard_diameter_is_in_that_unit_too(shape: str) -> None:
    """It was 31.5 mm, which is 1.25 in when it is written: a full solution was wasted."""
    text = clevis("series = 'R10'").text.replace("diameter = 20", 'diameter = "0.8 in"')
    if shape == "meridian":
        start, end = text.index("profile"), text.index("lug.EYE")
        text = text[:start] + MERIDIAN.lstrip() + text[end + len("lug.EYE") :]
    pin = sized(parse_study(ROOT / "studies" / "clevis.toml", text))
    assert 0.8 * _next_standard(pin, 1.3) == pytest.approx(1.25, rel=1e-5)


def test_eyes_stay_where_they_may_not_grow() -> None:
    for lines, outer in (("", 0.06), ("eye_ratio = 2", 0.08), ("scale_lugs = false", 0.05)):
        eye = resized_study(clevis(lines), {"P": 2.0}).table.pin["P"].lug["EYE"]
        assert eye.outer_diameter == pytest.approx(outer)


def test_a_pin_within_limits_is_not_a_number_nobody_can_build(tmp_path: Path) -> None:
    """Status 1, no study, and what would do instead: a strength by hand, from the factor."""
    (tmp_path / "study.toml").write_text(f"{QUICK}\n[size]\nlargest_diameter = 2\n")
    told = run_here("size", "study.toml", "--fos", "200", "--jobs", "1", cwd=tmp_path)
    assert told.returncode == 1
    assert not (tmp_path / "study_sized.toml").exists()
    assert not (tmp_path / "study_sized.toml.unfinished").exists()
    assert "not reached" in told.stdout
    said = " ".join(told.stderr.split())
    match = re.search(
        r"largest_diameter = 2 in limits it to 2 in across, where its factor is (about )?([\d.]+) "
        r"instead of 200; instead, one of: a yield strength of ([\d,.e+]+) psi, not ([\d,]+);",
        said,
    )
    assert match is not None, said
    factor, strength, given = (float(match[k].replace(",", "")) for k in (2, 3, 4))
    assert strength / given == pytest.approx(200.0 / factor, rel=0.02)


def test_a_pin_that_is_too_large_is_judged_at_the_limit(tmp_path: Path) -> None:
    """The pin has 4 and 2 in, the limit halves both: by bending its factor is about 1/8 of the
    present 120. A diameter of 4 in times the cube root of 200 / 120 would do.
    """
    (tmp_path / "study.toml").write_text(f"{QUICK}\n[size]\nlargest_diameter = 2\n")
    told = run_here("size", "study.toml", "--fos", "200", "--jobs", "1", cwd=tmp_path)
    said = " ".join(told.stderr.split())
    match = re.search(r"is (?:about )?([\d.]+) instead of 200;.* allow about ([\d.]+) in", said)
    assert match is not None, said
    factor, across = map(float, match.groups())
    assert factor == pytest.approx(120.0 / 8.0, rel=0.1)
    assert across == pytest.approx(4.0 * (200.0 / 120.0) ** (1.0 / 3.0), rel=0.05)


def test_diameters_of_a_series(tmp_path: Path) -> None:
    """Every diameter is one of the list, the factor is reached, and the next smaller is not."""
    text = f"{QUICK}\n[size]\nseries = [0.5, 0.75, 1, 1.25, 1.5, 1.75, 2, 2.5, 3]\n"
    (tmp_path / "study.toml").write_text(text)
    told = run_here("size", "study.toml", "--fos", "10", "--jobs", "1", cwd=tmp_path)
    assert told.returncode == 0, told.stderr
    profile = tomllib.loads((tmp_path / "study_sized.toml").read_text())["pin"]["B"]["profile"]
    diameters = [segment["diameter"] for segment in profile]
    assert set(diameters) <= {0.75, 1.0, 1.25, 1.5, 1.75, 2.0}
    # without a series it is 0.8581 in, by `size` itself (tests/pinstress/explore/size/test_size.py)
    assert min(diameters) == 1.0


def test_what_would_do_by_hand() -> None:
    """A pin whose sections have half the factor: twice the shear planes; beneath contact a third:
    three times the width.
    """
    from fea.core.peak import Maximum
    from pinstress.explore.size.section_law import PinTrial

    pin = sized(clevis("largest_diameter = 30"))
    limit = largest_scale(pin)
    worst = Maximum("P", "pull", "harmonic", "converged", "")
    text = too_small(pin, limit, PinTrial(limit.scale, 5.0, 10.0 / 3.0, 2.0, "quick"), worst)
    assert "its factor is about 3.333 instead of 10" in text
    assert "about 4 shear planes, not 2, of the same width in all" in text
    assert "lugs about 3.0 times as wide in all" in text
    assert "0.3333 times the loads of pull" in text


def test_what_would_do_is_rounded_to_where_it_does() -> None:
    """700 MPa times 1.5 / 1.3 is 807.69, and 1.3 / 1.5 of the loads 0.86667."""
    from fea.core.peak import Maximum
    from pinstress.explore.size.section_law import PinTrial

    pin = sized(clevis("largest_diameter = 30"), 1.5)
    worst = Maximum("P", "pull", "harmonic", "converged", "")
    for factor, strength, loads in ((1.3, "807.7", "0.8666"), (1.499999, "700.1", "0.9999")):
        trial = PinTrial(1.0, factor, factor, 3.0, "quick")
        text = too_small(pin, largest_scale(pin), trial, worst)
        assert f"a yield strength of {strength} MPa" in text
        assert f"{loads} times the loads of pull" in text
    assert "its factor is about 1.499999 instead of 1.5" in text
