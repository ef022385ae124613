"""Names of pins and cases cannot lead out of the output folder, nor to one file for two."""

from __future__ import annotations

import os
from pathlib import Path

from pinstress import InputError, load_study
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.errors import raises

ONE_PIN = (ROOT / "studies" / "one_pin.toml").read_text()


@each(
    "name",
    ["../up", "/etc/passwd", "a/b", "a\\\\b", "..", ".", ".hidden", "", " ", "nul\\u0000", "a\\nb",
     "x" * 101, "ß" * 20, "C:", "a*b", "a?b", "a|b", "<b>"],
)  # fmt: skip
@each("place", ["[pin.B]", "[case.landing]"])
def test_a_name_that_is_no_part_of_a_file_name_is_refused(
    tmp_path: Path, name: str, place: str
) -> None:
    kind, _, _ = place.strip("[]").partition(".")
    (tmp_path / "study.toml").write_text(ONE_PIN.replace(place, f'[{kind}."{name}"]'))
    with raises(InputError, "unusable-name"):
        load_study(tmp_path / "study.toml")


@each("name", ["x" * 100, "Ü1", "pin 3", "a.b", "-"])
def test_other_names_are_taken(tmp_path: Path, name: str) -> None:
    (tmp_path / "study.toml").write_text(ONE_PIN.replace("[pin.B]", f'[pin."{name}"]'))
    assert name in load_study(tmp_path / "study.toml").table.pin


@each(("first", "second"), [("Pin", "pIN"), ("straße", "STRASSE"), ("K", "\u212a")])
def test_names_that_differ_in_capitals_only_are_refused(
    tmp_path: Path, first: str, second: str
) -> None:
    other = ONE_PIN.split("[pin.B]")[1].split("[case")[0].replace('"B"', '"C"')
    text = ONE_PIN.replace("[pin.B]", f'[pin."{first}"]')
    text = text.replace("[case.landing]", f'[pin."{second}"]{other}[case.landing]')
    (tmp_path / "study.toml").write_text(text)
    with raises(InputError, "same-file-names", f"pin.{first}"):
        load_study(tmp_path / "study.toml")


def test_a_pin_and_a_case_that_give_the_name_of_others_are_refused(tmp_path: Path) -> None:
    """Pin "a" in case "b_c" and pin "a_b" in case "c"."""
    head, rest = ONE_PIN.split("[pin.B]")
    pin, case = rest.split("[case.landing]")
    case, analysis = case.split("[analysis]")
    other = pin.replace('"B"', '"C"')
    text = f"{head}[pin.a]{pin}[pin.a_b]{other}[case.c]{case}[case.b_c]{case}[analysis]{analysis}"
    (tmp_path / "study.toml").write_text(text)
    with raises(InputError, "same-file-names", "pin.a in case.b_c"):
        load_study(tmp_path / "study.toml")


def test_a_study_whose_name_is_no_text_is_refused_before_it_is_solved(tmp_path: Path) -> None:
    """As "Bügel.toml" in Latin-1; tables and pages name the study, in UTF-8."""
    path = tmp_path / os.fsdecode(b"B\xfcgel.toml")
    path.write_text(ONE_PIN)
    with raises(InputError, "unusable-name"):
        load_study(path)
