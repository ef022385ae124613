"""What editors are told of the study file: the JSON Schema accepts what the reader accepts."""

from __future__ import annotations

import copy
import tomllib
from pathlib import Path
from typing import Any

import pytest

from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import parse_study
from pinstress.study.schema.json_schema import editor_schema
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.errors import raises
from tests.support.json_schema import mistakes

ONE_PIN = (ROOT / "studies" / "one_pin.toml").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def schema() -> dict[str, Any]:
    return editor_schema()


def test_shipped_studies_are_valid_in_an_editor(schema: dict[str, Any]) -> None:
    """24 of 27 were not: for values with their provenance, and for a single drive."""
    paths = sorted((ROOT / "studies").glob("*.toml"))
    assert len(paths) > 20
    for path in paths:
        study = tomllib.loads(path.read_text(encoding="utf-8"))
        if "title" in study:
            assert not mistakes(study, schema, schema), path.name


@each(
    ("place", "value", "right"),
    [
        (("title",), {"value": "One", "provenance": "given"}, True),
        (("title",), {"value": "One", "note": "no provenance"}, False),
        (("title",), {"value": 1, "provenance": "given"}, False),
        (("title",), 1, False),
        (("pin", "B", "clamp"), {"value": ["start"], "provenance": "assumed", "note": "x"}, True),
        (("pin", "B", "clamp"), ["start", {"value": "end", "provenance": "assumed"}], True),
        (("pin", "B", "clamp"), "start", False),
        (
            ("pin", "B", "clamp"),
            {"value": [{"value": "start", "provenance": "given"}], "provenance": "assumed"},
            True,
        ),
        (("pin", "B", "profile"), {"length": 1}, False),
        (("pin", "B", "note"), "x", False),
        (("pin", "B", "lug"), {"B": {"tilt": "guided"}}, True),
        (("pin", "B", "lug"), {"B": {"tilt": ["guided"]}}, False),
        (("case", "landing", "forces", "provenance"), "given", True),
    ],
)
def test_the_schema_agrees_with_the_reader(
    schema: dict[str, Any], place: tuple[str, ...], value: object, right: bool
) -> None:
    study = node = copy.deepcopy(tomllib.loads(ONE_PIN))
    for part in place[:-1]:
        node = node[part]
    node[place[-1]] = value
    assert bool(mistakes(study, schema, schema)) is not right
    assert reads(study) is right


def reads(study: dict[str, Any]) -> bool:
    import tomlkit

    try:
        parse_study(Path("s.toml"), tomlkit.dumps(study))
    except InputError:
        return False
    return True


@each(
    ("line", "code", "message"),
    [
        ('note = "x"', "unknown-key", "unknown key 'note'; write provenance = "),
        ("provenance = 1", "unknown-key", "unknown key 'provenance'; write provenance = "),
        (
            'provenance = "given"\nnote = ["x"]',
            "not-a-text",
            "pin.B.note: must be a text in quotes",
        ),
    ],
)
def test_a_note_is_a_text_beside_its_provenance(line: str, code: str, message: str) -> None:
    """A list was taken for the note as Python writes it."""
    text = ONE_PIN.replace('clamp = ["start"]', f'clamp = ["start"]\n{line}')
    with raises(InputError, code, message):
        parse_study(Path("s.toml"), text)


def test_limits_hold_within_a_value_with_its_provenance() -> None:
    """A name or list in it could be of any length."""
    forces = "forces = { B = [0.0, -988.86] }"
    name = "B" * 201
    value = f'forces = {{ value = {{ {name} = [0.0, 1.0] }}, provenance = "given" }}'
    assert forces in ONE_PIN
    with raises(InputError, "too-long", "case.landing.forces: the name", "201 characters"):
        parse_study(Path("s.toml"), ONE_PIN.replace(forces, value))
