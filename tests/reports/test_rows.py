"""A row states each number once: its properties are those of its maximum and its judgement."""

from __future__ import annotations

from dataclasses import fields

import pytest

from assess.judgement import Judgement
from fea.core.peak import Maximum
from pinstress.study.schema.units import UNIT_SYSTEMS
from reports.data.results import Results
from reports.data.row import LandingRange, PinResult
from tests.support.results.made_up_run import ranged
from tests.support.results.rows import with_landing

INCHES = UNIT_SYSTEMS["in-lbf-s"]


def test_no_field_of_a_row_repeats_one_of_its_maximum_or_judgement() -> None:
    of_row, of_maximum, of_judgement = (
        {f.name for f in fields(kind)} for kind in (PinResult, Maximum, Judgement)
    )
    assert not of_row & (of_maximum | of_judgement)
    said = {name for name in of_maximum | of_judgement if hasattr(PinResult, name)}
    assert {"pin", "case", "verdict", "max_von_mises", "safety_factor", "decided"} <= said


def test_factors_and_decisions_do_not_depend_on_units(results: Results) -> None:
    """To the last bit, which a quotient of converted numbers would not keep."""
    shown = results.in_units(results.units, INCHES.factor)
    for row, other in zip(results.pins, shown.pins, strict=True):
        assert other.judgement == row.judgement
        if row.max_von_mises is None:
            continue
        psi, inch = 6894.757293168361, 0.0254
        assert other.max_von_mises == pytest.approx(row.max_von_mises / psi, rel=1e-12)
        parts = {k: v / psi for k, v in row.error_parts.items()}
        assert other.error_parts == pytest.approx(parts, rel=1e-12)
        assert row.location is not None
        assert other.location == pytest.approx([x / inch for x in row.location], rel=1e-12)
        assert other.time == row.time


def test_what_belongs_to_rows_is_listed_from_them(results: Results) -> None:
    ranges: tuple[LandingRange, ...] = (ranged("A"), ranged("B"))
    some = with_landing(results, *ranges)
    assert some.landing == ranges
    assert [p.pin for p in some.pins if p.landing] == ["A", "B"]
