"""The reference has every key, and the schema tells editors what each one is."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from docs.study_reference import reference, sections, takes
from pinstress.study.schema.cases import ImpulseTable, MotionCase
from pinstress.study.schema.mechanism import SliderTable
from pinstress.study.schema.pins import PinTable, SegmentTable
from pinstress.study.schema.tables import StudyTable
from pinstress.study.schema.types import StrictTable, described
from tests.support.each import each

SCHEMA = StudyTable.model_json_schema()


def tables(table: type[StrictTable] = StrictTable) -> Iterator[type[StrictTable]]:
    for one in table.__subclasses__():
        yield one
        yield from tables(one)


@each("table", list(tables()))
def test_every_key_says_what_it_is(table: type[StrictTable]) -> None:
    told = described(table)
    assert set(told) == set(table.model_fields)
    assert all(words.endswith(".") for words in told.values())


def test_every_table_has_its_place() -> None:
    placed = {section.table["title"] for section in sections(SCHEMA)}
    assert placed == {"StudyTable", *SCHEMA["$defs"]}
    anchors = [section.anchor for section in sections(SCHEMA)]
    assert len(anchors) == len(set(anchors))


def test_the_reference_has_type_unit_domain_default_and_description() -> None:
    text = reference(SCHEMA)
    for row in (
        "| `length` | length from 1 µm to 1 km | **required** | Length along the axis. |",
        '| `gravity` | acceleration > 0 | `"9.80665 m/s^2"` | Converts the weight to a mass. |',
        "| `samples` | integer ≥ 2, ≤ 100001 | `201` | Number of equally spaced instants. |",
        "| `poisson_ratio` | number > -1, < 0.5 | **required** | Poisson's ratio. |",
    ):
        assert row in text
    assert '## `case.NAME`, kind = "motion"' in text
    assert "[table](#key-pin-NAME-profile)" in text


@each(
    ("table", "key", "words"),
    [
        (SegmentTable, "bore", "length ≥ 0 or [length ≥ 0, length ≥ 0]"),
        (PinTable, "meridian", "list of list of 2 to 3 length ≥ 0"),
        (SliderTable, "direction", "[number, number]"),
        (ImpulseTable, "direction", "list of 2 to 3 number"),
        (MotionCase, "clamp", "by name: list of string"),
        (MotionCase, "distribution", '`"uniform"`, `"cosine"`'),
        (MotionCase, "kind", '`"motion"`'),
    ],
)
def test_what_a_key_takes_in_words(table: type[StrictTable], key: str, words: str) -> None:
    properties: dict[str, Any] = table.model_json_schema()["properties"]
    assert takes(properties[key]) == words


def test_list_without_a_least_length_states_the_most() -> None:
    assert takes({"type": "array", "maxItems": 9, "items": {"dimension": "length"}}) == (
        "list of up to 9 length"
    )
