"""Studies made and changed in Python, and results asked for by pin and case."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pinstress
from pinstress import InputError, changed_study, load_study, shipped_studies, study_from
from pinstress.explore.sweep.number import number_at
from pinstress.study.reading.file import raw_study, with_raw
from pinstress.study.reading.in_python import changed_raw
from tests.support.each import each

ONE_PIN = shipped_studies()["one_pin"]
BAR: dict[str, Any] = {
    "title": "A bar",
    "units": "mm-N-s",
    "material": {"steel": {"youngs_modulus": 210e3, "poisson_ratio": np.float64(0.3)}},
    "pin": {
        "P": {
            "material": "steel",
            "clamp": ("start",),
            "fillet": None,
            "profile": [{"length": 40, "diameter": np.int64(20), "connection": "rod"}],
        }
    },
    "case": {"pull": {"kind": "given", "forces": {"rod": np.array([0.0, 0.0, 1000.0])}}},
}


def test_a_dict_is_as_good_as_a_file(tmp_path: Path) -> None:
    """The tables of a shipped study, and its text, give its table and the same stress."""
    text = ONE_PIN.read_text(encoding="utf-8")
    loaded, made = load_study(ONE_PIN), study_from(tomllib.loads(text))
    assert made.table == loaded.table
    assert study_from(text).table == loaded.table
    asked = pinstress.run(made, tolerance=0.05)["B", "landing"]
    assert asked.max_von_mises == pinstress.run(loaded, tolerance=0.05).pins[0].max_von_mises


def test_numbers_of_numpy_tuples_and_none_are_understood() -> None:
    study = study_from(BAR)
    pin = study.table.pin["P"]
    assert pin.profile is not None
    assert pin.profile[0].diameter == pytest.approx(0.02)
    assert list(pin.clamp) == ["start"]
    assert study.name == "study"


def test_mistakes_in_a_dict_name_the_key_and_no_line() -> None:
    wrong = {**BAR, "units": "furlongs"}
    with pytest.raises(InputError) as error:
        study_from(wrong)
    assert str(error.value).startswith("study: units: ")
    with pytest.raises(InputError) as error:
        study_from({**BAR, "case": {"pull": {"kind": "given", "forces": {"rod": object()}}}})
    assert str(error.value).startswith("study.case.pull.forces.rod: ")
    with pytest.raises(InputError):
        study_from(12)  # type: ignore[arg-type]


def test_files_are_looked_for_in_the_folder() -> None:
    with pytest.raises(InputError) as error:
        pinstress.run(study_from({**BAR, "pin": {"P": {
            "material": "steel", "clamp": ["start"], "geometry": "no.step",
            "band": {"rod": {"z": [0, 1]}},
        }}}, folder="some/where"))  # fmt: skip
    assert str(Path("some/where/no.step")) in str(error.value)


def test_a_changed_study_has_the_new_value_and_all_else_as_it_was() -> None:
    study = load_study(ONE_PIN)
    pin = next(iter(study.table.pin))
    new = changed_study(study, {f"pin.{pin}.profile[1].diameter": "3 in", "title": "Thick"})
    assert (new.table.title, new.path) == ("Thick", study.path)
    before, after = study.table.pin[pin].profile, new.table.pin[pin].profile
    assert before is not None
    assert after is not None
    assert after[0].diameter == pytest.approx(3 * 0.0254)
    assert after[1:] == before[1:]
    assert study.table.title != "Thick"


def test_a_key_with_dots_is_quoted_and_a_new_key_is_added() -> None:
    odd = study_from({**BAR, "pin": {"a.b": BAR["pin"]["P"]}})
    new = changed_study(odd, {'pin."a.b".clamp[1]': "end", "analysis": {"tolerance": 0.1}})
    assert list(new.table.pin["a.b"].clamp) == ["end"]
    assert new.table.analysis.tolerance == 0.1


def test_a_value_with_provenance_is_replaced() -> None:
    sourced = {"value": 210e3, "provenance": "assumed", "note": "a guess"}
    steel = {"youngs_modulus": sourced, "poisson_ratio": 0.3}
    study = study_from({**BAR, "material": {"steel": steel}})
    assert len(study.provenance) == 1
    new = changed_study(study, {"material.steel.youngs_modulus": "70 GPa"})
    assert new.table.material["steel"].youngs_modulus == pytest.approx(70e9)
    assert new.provenance == ()


@each(
    "key",
    [
        *("", "pin.", "pin..P", "pin.Q.clamp", "pin.P[1].x"),
        *("pin.P.profile[2].bore", "pin.P.profile[0].bore", "pin.P.profile[1].colour"),
    ],
)
def test_keys_that_lead_nowhere(key: str) -> None:
    with pytest.raises(InputError):
        changed_study(study_from(BAR), {key: 1})


def test_results_by_pin_and_case() -> None:
    results = pinstress.run(study_from(BAR), tolerance=0.1)
    assert results["P", "pull"] == results.pins[0]
    with pytest.raises(KeyError, match=r"P.*pull"):
        results["P", "push"]
    plan = pinstress.prepare(study_from(BAR), tolerance=0.1)
    assert pinstress.solve(plan)["P", "pull"].max_von_mises == results.pins[0].max_von_mises


@each(
    ("name", "changes"),
    [
        ("landing_gear", {"pin.E.profile[2].diameter": "2.1 in", "pin.E.lug.E1.clearance": 0.001}),
        ("landing_gear", {"case.landing.apply[1].impulse.range.impulse_time[2]": 0.12}),
        ("landing_gear", {"case.landing.apply[1].impulse.pulse": "half-sine"}),
        ("clevis", {"case.pull.forces": {"LEFT": [-1, 0], "EYE": (2, 0), "RIGHT": [-1, 0]}}),
        ("one_pin", {"pin.B.fillet": np.float64(0.1), "analysis.tolerance": 0.05}),
    ],
)
def test_changed_content_is_that_of_the_changed_study(name: str, changes: dict[str, Any]) -> None:
    study = load_study(shipped_studies()[name])
    raw, new = raw_study(study), changed_study(study, changes)
    assert changed_raw(study, raw, changes) == raw_study(new)
    assert with_raw(study, changed_raw(study, raw, changes)).table == new.table != study.table
    assert raw == raw_study(study)  # which others still have


@each(
    ("name", "key", "full"),
    [
        ("lifting_arm", "case.hold.apply.force[2]", "case.hold.apply[1].force[2]"),
        ("one_pin", "pin[1].B.fillet", "pin.B.fillet"),
        ("bucket_pin", "lug_defaults.edge_radius.value", "lug_defaults.edge_radius"),
        ("crane", "mechanism.joint.S.at.value[2]", "mechanism.joint.S.at[2]"),
    ],
)
def test_a_key_of_vary_is_one_of_a_changed_study(name: str, key: str, full: str) -> None:
    """[vary] took the only element of a list without its index, a changed study did not; the value
    of a table with provenance was known to a changed study only, and an Engine had a TypeError.
    """
    study = load_study(shipped_studies()[name])
    raw, wanted = raw_study(study), changed_study(study, {full: 2.0})
    assert changed_study(study, {key: 2.0}).table == wanted.table != study.table
    assert changed_raw(study, raw, {key: 2.0}) == raw_study(wanted)
    assert number_at(study, key).path == number_at(study, full).path


@each("key", ["lug.thick", "lug.rod", "lug.rod.bushing"])
def test_a_table_beneath_dotted_keys_is_written_there(key: str, tmp_path: Path) -> None:
    """It began a table [lug] at the root."""
    path = tmp_path / "dotted.toml"
    path.write_text(
        """title = "dotted"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
[pin.P]
material = "steel"
profile = [
  { length = 10, diameter = 20, connection = "rod" },
  { length = 10, diameter = 20, name = "thick" },
]
lug.rod.outer_diameter = 50
[case.pull]
kind = "given"
forces = { rod = [0, 5] }
""",
        encoding="utf-8",
    )
    value = {"thickness": 1, "material": "steel"}
    new = changed_study(
        load_study(path),
        {f"pin.P.{key}": value if "bushing" in key else {"bushing": value}},
    )
    bushing = new.table.pin["P"].lug["thick" if "thick" in key else "rod"].bushing
    assert bushing is not None
    assert bushing.thickness == 1e-3


@each(
    "key",
    ["pin.Z.fillet", "pin.B.profile[9].length", "pin.B.clamp[0]", "", "a[", "pin.B.fillet.note"],
)
def test_both_ways_refuse_a_key_with_the_same_words(key: str) -> None:
    study = load_study(shipped_studies()["one_pin"])
    with pytest.raises(InputError) as one:
        changed_study(study, {key: 1.0})
    with pytest.raises(InputError) as other:
        changed_raw(study, raw_study(study), {key: 1.0})
    assert str(one.value) == str(other.value)
