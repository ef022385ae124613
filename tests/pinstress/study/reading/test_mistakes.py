"""Mistakes in values of a study: each in our words, with its key and what would be right."""

from __future__ import annotations

import copy
import datetime
import math
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from pydantic import ValidationError

from pinstress.study.reading.errors import InputError, Wrong
from pinstress.study.reading.file import parse_study
from pinstress.study.reading.validation import OTHER_MISTAKE, explain
from pinstress.study.schema.tables import StudyTable
from pinstress.study.schema.units import UNIT_SYSTEMS
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.errors import raises

ABSENT = object()
MISTAKES: tuple[Any, ...] = (
    5, -5, 5.5, True, "x", "", [], {}, [1], [1, 2], list(range(9)), {"a": 1}, {"a": {}}, math.nan,
    math.inf, 10**400, datetime.date(2020, 1, 1), ["a"], [True, True], ["1 Mpa"], "3 ksi", ABSENT,
)  # fmt: skip
PYDANTICS = ("input", "valid ", "discriminator", "Field", "field", "tag", "validation", "error")
Path_ = tuple[str | int, ...]


def everywhere(node: Any, path: Path_ = ()) -> Iterator[Path_]:
    """Every key and list element of a study."""
    if path:
        yield path
    if isinstance(node, dict | list):
        for key, value in node.items() if isinstance(node, dict) else enumerate(node):
            yield from everywhere(value, (*path, key))


def changed(tree: Any, path: Path_, value: object) -> Any:
    tree = node = copy.deepcopy(tree)
    for part in path[:-1]:
        node = node[part]
    if value is ABSENT:
        del node[path[-1]]
    else:
        node[path[-1]] = value
    return tree


def mistakes(raw: Any) -> list[Wrong]:
    try:
        StudyTable.model_validate(raw, context={"system": UNIT_SYSTEMS["mm-N-s"]})
    except ValidationError as error:
        return explain(error)
    return []


@pytest.mark.parametrize(
    "study",
    [
        *("one_pin", "kuleuven2014"),
        pytest.param("slider_crank", marks=pytest.mark.slow),
        pytest.param("bowman2019", marks=[pytest.mark.slow, pytest.mark.long]),
    ],
)
def test_no_wording_of_pydantic_reaches_the_user(study: str) -> None:
    raw = tomllib.loads((ROOT / "studies" / f"{study}.toml").read_text(encoding="utf-8"))
    count = 0
    for path in everywhere(raw):
        for value in MISTAKES:
            for wrong in mistakes(changed(raw, path, value)):
                count += 1
                assert wrong.code, (path, value, wrong)
                assert wrong.code != OTHER_MISTAKE[0], (path, value, wrong)
                _, _, message = wrong.message.partition(": ")
                assert not any(word in message for word in PYDANTICS), (path, value, message)
                assert "<" not in wrong.message.split(":")[0], wrong.message
    assert count > 300


ONE_PIN = (ROOT / "studies" / "one_pin.toml").read_text(encoding="utf-8")
CRANK = (ROOT / "studies" / "slider_crank.toml").read_text(encoding="utf-8")
STUDIES = {"one_pin": ONE_PIN, "slider_crank": CRANK}
LANDING = "case.landing"


@each(
    ("study", "old", "new", "code", "key", "right"),
    [
        ("one_pin", 'title = "One pin"', "title = 1", "not-a-text", "title", "not 1"),
        ("one_pin", "poisson_ratio = 0.30", 'poisson_ratio = "0.3"', "not-a-number",
         'material."AISI 4340".poisson_ratio', "without a unit or quotes"),
        ("one_pin", "poisson_ratio = 0.30", "poisson_ratio = true", "not-a-number",
         'material."AISI 4340".poisson_ratio', "not true"),
        ("one_pin", "poisson_ratio = 0.30", "poisson_ratio = nan", "not-finite",
         'material."AISI 4340".poisson_ratio', "finite"),
        ("one_pin", 'kind = "given"', "", "missing-key", f"{LANDING}.kind", '"given"'),
        ("one_pin", 'kind = "given"', "kind = 3", "not-a-choice", f"{LANDING}.kind", "'motion'"),
        ("one_pin", "[0.0, -988.86]", "[0.0]", "list-too-short", f"{LANDING}.forces.B",
         "at least 2 elements, not 1"),
        ("one_pin", "[0.0, -988.86]", "-988.86", "not-a-list", f"{LANDING}.forces.B", "[a, b"),
        ("one_pin", "{ B = [0.0, -988.86] }", "[0.0, -988.86]", "not-a-table",
         f"{LANDING}.forces", "{ key = value"),
        ("one_pin", 'clamp = ["start"]', 'clamp = "start"', "not-a-list", "pin.B.clamp", "[a, b"),
        ("one_pin", '"225 ksi"', '"225 Ksi"', "unknown-unit",
         'material."AISI 4340".yield_strength', "did you mean 'ksi'?"),
        ("one_pin", '"225 ksi"', '"195 kN/mm2"', "unknown-unit",
         'material."AISI 4340".yield_strength', "did you mean 'kN/mm^2'?"),
        ("one_pin", '"225 ksi"', '"650 Mpa"', "unknown-unit",
         'material."AISI 4340".yield_strength', "did you mean 'MPa'?"),
        ("one_pin", '"0.2836 lb/in^3"', '"7850 kg/m3"', "unknown-unit",
         'material."AISI 4340".density', "did you mean 'kg/m^3'?"),
        ("one_pin", '"225 ksi"', '"225 in"', "wrong-dimension",
         'material."AISI 4340".yield_strength', "not a stress"),
        ("one_pin", '"225 ksi"', '"1,5 GPa"', "decimal-comma",
         'material."AISI 4340".yield_strength', "with a point"),
        ("one_pin", "diameter = 4.0", "diameter = true", "not-a-quantity",
         "pin.B.profile[1].diameter", "true is not a length"),
        ("one_pin", "diameter = 4.0", "diameter = 1979-05-27", "not-a-quantity",
         "pin.B.profile[1].diameter", "1979-05-27"),
        ("one_pin", "[analysis]", '[analysis]\ncode = ["fork"]', "not-a-choice", "analysis.code[1]",
         "not 'fork'"),
        ("one_pin", "[analysis]", '[analysis]\n[lug_defaults]\naxial = ["head"]\n[size]',
         "missing-key", "lug_defaults.axial[2]", "is missing"),
        ("slider_crank", "direction = [1, 0]", "direction = [1]", "missing-key",
         "mechanism.slider.guide.direction[2]", "is missing"),
        ("slider_crank", "direction = [1, 0]", "direction = 1", "not-a-list",
         "mechanism.slider.guide.direction", "[a, b]"),
        ("slider_crank", 'joints = ["O", "C"]', 'joints = ["O", 3]', "not-a-list",
         "mechanism.slider.guide.joints[2]", "not 3"),
        ("slider_crank", "friction = 0.15", "friction = true", "not-a-number",
         "mechanism.slider.guide.friction", "not true"),
    ],
)  # fmt: skip
def test_a_mistake_has_its_code_key_and_remedy(
    study: str, old: str, new: str, code: str, key: str, right: str
) -> None:
    text = STUDIES[study]
    assert old in text
    with raises(InputError, code, f": {key}: ", right):
        parse_study(Path("s.toml"), text.replace(old, new, 1))


SLEWING = (ROOT / "studies" / "slewing_crank.toml").read_text(encoding="utf-8")


@each(
    ("study", "old", "new", "message"),
    [
        ("slewing", 'at = { value = [300, 250, 200], provenance = "assumed" }',
         "at = [nan, 400, 200]", "mechanism.joint.C.at[1]: must be finite, not nan"),
        ("slewing", "dimension = 3", "dimension = 4", "mechanism.dimension: must be 3, not 4"),
        ("slewing", "dimension = 3", 'dimension = "3"', "mechanism.dimension: must be 3, not '3'"),
        ("slider_crank", "[mechanism]", "[mechanism]\ndimension = 4",
         "mechanism.dimension: must be 2, not 4"),
    ],
)  # fmt: skip
def test_what_follows_from_a_mistake_is_not_reported(
    study: str, old: str, new: str, message: str
) -> None:
    """A vector without its wrong element has two numbers; a linkage is read by its dimension."""
    text = (STUDIES | {"slewing": SLEWING})[study]
    assert old in text
    with pytest.raises(InputError) as error:
        parse_study(Path("s.toml"), text.replace(old, new, 1))
    assert re.fullmatch(rf"s\.toml:\d+: {re.escape(message)}", str(error.value))


@each(
    ("study", "old", "new", "message"),
    [
        ("one_pin", 'name = "root"', 'name = ""', "pin.B.profile[1].name: is empty"),
        ("one_pin", "[analysis]", '[fatigue]\nunit = " "\n[analysis]', "fatigue.unit: is empty"),
        ("one_pin", "[analysis]", '[material."  "]\n[analysis]', "material: a name is empty"),
        ("slider_crank", 'body = "crank"', 'body = ""', "mechanism.drive.body: is empty"),
    ],
)
def test_a_text_or_name_without_a_letter_is_refused(
    study: str, old: str, new: str, message: str
) -> None:
    """A segment had no name then, a body a blank one, and a drive ended in a traceback."""
    assert old in STUDIES[study]
    with raises(InputError, "empty", f": {message}; "):
        parse_study(Path("s.toml"), STUDIES[study].replace(old, new, 1))


def test_the_title_block_may_be_blank() -> None:
    parse_study(Path("s.toml"), f'{ONE_PIN}\n[report]\nprepared = ""\nrevision = " "\n')


@each(
    "date",
    ["0", "1774915200", "20260331", "true", "2026-03-31T10:00:00", "10:00:00", "'31.3.2026'"],
)
def test_a_date_is_no_number(date: str) -> None:
    """0 was 1970-01-01, and others could not have "this value"."""
    text = f"{ONE_PIN}\n[report]\ndate = {date}\n"
    with raises(InputError, "not-a-date", "report.date: must be a date such as 2026-03-31"):
        parse_study(Path("s.toml"), text)


@each("date", ["2026-03-31", "'2026-03-31'"])
def test_a_date_may_be_in_quotes(date: str) -> None:
    study = parse_study(Path("s.toml"), f"{ONE_PIN}\n[report]\ndate = {date}\n")
    assert study.table.report.date == datetime.date(2026, 3, 31)
