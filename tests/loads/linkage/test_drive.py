"""Laws of motion: their rates are the derivatives of their values; outside their time they rest."""

from __future__ import annotations

import numpy as np
import pytest

from loads import ConstantDrive, CosineDrive, CycloidalDrive, Law, LinkageError, TableDrive
from tests.support.each import each
from tests.support.errors import raises

AT = np.linspace(0.31, 1.69, 29)
LAWS = [
    CosineDrive(1.0, -2.0, 1.5, begin=0.25),
    CycloidalDrive(0.3, 5.0, 1.5, begin=0.25),
    ConstantDrive(2.0, 1.0, 1.5, begin=0.25),
    TableDrive(*(tuple(x) for x in (np.linspace(0, 2, 21), np.sin(np.linspace(0, 2, 21))))),
]


@each("law", LAWS)
def test_rates_are_derivatives(law: Law) -> None:
    h = 1e-5
    before, now, after = law(AT - h), law(AT), law(AT + h)
    assert now[1] == pytest.approx((after[0] - before[0]) / (2 * h), abs=1e-8)
    assert now[2] == pytest.approx((after[1] - before[1]) / (2 * h), abs=1e-7)


@each("law", LAWS[:3])
def test_it_rests_outside_its_time(law: CosineDrive) -> None:
    value, rate, second = law(np.array([-1.0, 0.2, 1.8, 9.0]))
    assert value.tolist() == [law.start, law.start, law.end, law.end]
    assert not rate.any()
    assert not second.any()


def test_cycloids_start_and_end_without_a_jump() -> None:
    law = CycloidalDrive(0.3, 5.0, 1.5)
    for t in (0.0, 1.5):
        _, rate, second = law(np.array([t]))
        assert [rate[0], second[0]] == pytest.approx([0.0, 0.0], abs=1e-12)


def test_a_table_of_a_smooth_motion_is_that_motion() -> None:
    """Quintic splines are sixth order; with rates given, each piece meets them exactly."""
    t = np.linspace(0.0, 2.0, 21)
    law = TableDrive(tuple(t), tuple(np.sin(t)))
    value, rate, second = law(AT)
    assert value == pytest.approx(np.sin(AT), abs=1e-7)
    assert rate == pytest.approx(np.cos(AT), abs=1e-6)
    assert second == pytest.approx(-np.sin(AT), abs=1e-5)
    full = TableDrive(tuple(t), tuple(np.sin(t)), tuple(np.cos(t)), tuple(-np.sin(t)))
    for found, wanted in zip(full(t), (np.sin(t), np.cos(t), -np.sin(t)), strict=True):
        assert found == pytest.approx(wanted, abs=1e-12)


@each(
    ("times", "code"),
    [((0.0, 1.0), "too-few-rows"), ((0, 1, 2, 2, 3, 4), "times-not-increasing")],
)
def test_tables_that_cannot_be_used(times: tuple[float, ...], code: str) -> None:
    with raises(LinkageError, code):
        TableDrive(times, times)
