"""Quantities between samples: maxima, means and jumps that no sample shows."""

from __future__ import annotations

import numpy as np
import pytest

from loads.motion.refine import resolved
from pinbase.arrays import Floats


def test_samples_at_the_same_angle_of_every_turn_hide_nothing() -> None:
    def at(times: Floats) -> Floats:
        return np.stack([1.62 * np.sin(2 * np.pi * times - 0.3), np.cos(2 * np.pi * times)], axis=1)

    for turns in (1, 10, 16, 32):
        found = resolved(np.linspace(0.0, turns, turns + 1), at)
        assert not len(found.unresolved)
        top, when = found.largest()
        assert top == pytest.approx([1.62, 1.0], rel=1e-9)
        assert np.abs(np.diag(at(when))) == pytest.approx([1.62, 1.0], rel=1e-9)
        assert found.mean() == pytest.approx([0.0, 0.0], abs=1e-9)
        assert np.sqrt(found.mean(np.square)) == pytest.approx(
            np.array([1.62, 1.0]) / np.sqrt(2.0), rel=1e-9
        )


def test_a_thousand_turns_between_two_samples_are_not_taken_for_rest() -> None:
    for turns in (512, 1000, 1024, 4096):
        found = resolved(
            np.array([0.0, turns]), lambda t: np.sin(2 * np.pi * t)[:, None], max_evaluations=2000
        )
        assert len(found.unresolved)
        assert found.largest()[0] > 0.9


def test_a_crest_narrower_than_the_samples_is_found() -> None:
    def at(times: Floats) -> Floats:
        return (1.0 / (1.0 + ((times - 0.5377) / 0.01) ** 2))[:, None]

    found = resolved(np.linspace(0.0, 1.0, 5), at)
    top, when = found.largest()
    assert top == pytest.approx([1.0], rel=1e-8)
    assert when == pytest.approx([0.5377], abs=1e-6)
    integral = 0.01 * (np.arctan((1 - 0.5377) / 0.01) + np.arctan(0.5377 / 0.01))
    assert found.mean() == pytest.approx([integral], rel=1e-8)


def test_a_crest_that_only_one_sample_shows_is_resolved_around_it() -> None:
    def at(times: Floats) -> Floats:
        return np.exp(-(((times - 0.3) / 2e-4) ** 2))[:, None]

    found = resolved(np.array([0.0, 0.29995, 1.0]), at)
    assert found.largest()[0] == pytest.approx([1.0], rel=1e-7)


def test_a_jump_at_a_corner_is_seen_from_both_sides() -> None:
    def at(times: Floats) -> Floats:
        return np.where(times < 0.4, 3.0 - times, np.where(times > 0.4, 5.0 - times, 0.0))[:, None]

    found = resolved(np.linspace(0.0, 1.0, 11), at, corners=(0.4,))
    assert not len(found.unresolved)
    top, when = found.largest()
    assert (top[0], when[0]) == pytest.approx((4.6, 0.4), abs=1e-12)
    low, when_low = found.largest(np.negative)
    assert (low[0], when_low[0]) == pytest.approx((-2.6, 0.4), abs=1e-12)
    assert found.mean() == pytest.approx([0.4 * 3.0 + 0.6 * 5.0 - 0.5], rel=1e-12)
    assert found.interpolate(np.array([0.4, 0.4000001])) == pytest.approx(
        np.array([[2.6], [4.5999999]]), rel=1e-9
    )


def test_a_kink_is_resolved_and_a_jump_without_corner_is_reported() -> None:
    kink = resolved(np.linspace(0.0, 1.0, 3), lambda t: np.abs(t - 1 / 3)[:, None])
    assert not len(kink.unresolved)
    assert kink.largest(np.negative)[0] == pytest.approx([0.0], abs=1e-6)
    jump = resolved(np.linspace(0.0, 1.0, 3), lambda t: np.sign(t - 1 / 3)[:, None])
    ((low, high),) = jump.unresolved
    assert low <= 1 / 3 <= high
    assert high - low < 1e-6


def test_the_samples_and_their_values_are_among_the_instants() -> None:
    samples = np.array([0.0, 0.1, 0.37, 1.0])
    found = resolved(samples, lambda t: np.stack([np.exp(t), 0.0 * t], axis=1))
    assert np.all(np.diff(found.times) > 0.0)
    assert set(samples) <= set(found.times)
    assert np.array_equal(found.values[:, 0], np.exp(found.times))
    t = np.linspace(0.0, 1.0, 777)
    assert found.interpolate(t)[:, 0] == pytest.approx(np.exp(t), rel=1e-10)


def test_rounding_in_a_quantity_that_is_zero_costs_nothing() -> None:
    noise = np.random.default_rng(0)

    def at(times: Floats) -> Floats:
        return np.stack([np.sin(times), 1e-14 * noise.standard_normal(len(times))], axis=1)

    found = resolved(np.linspace(0.0, 1.0, 3), at)
    assert not len(found.unresolved)
    assert len(found.times) < 400


def test_integrals_up_to_any_instant() -> None:
    found = resolved(np.linspace(0.0, 2.0, 3), lambda t: np.cos(5.0 * t)[:, None], corners=(0.7,))
    t = np.linspace(0.0, 2.0, 33)
    assert found.integral(t, lambda v: v)[:, 0] == pytest.approx(np.sin(5.0 * t) / 5.0, abs=1e-10)


def test_a_component_counts_as_its_group() -> None:
    """A thousandth of the group needs only a thousandth of the accuracy."""

    def at(times: Floats) -> Floats:
        return np.stack([np.cos(times), 1e-5 * np.sin(300.0 * times)], axis=1)

    alone = resolved(np.linspace(0.0, 3.0, 3), at)
    grouped = resolved(np.linspace(0.0, 3.0, 3), at, groups=(0, 0))
    assert len(grouped.times) < 0.7 * len(alone.times)
    t = np.linspace(0.0, 3.0, 999)
    assert grouped.interpolate(t) == pytest.approx(at(t), abs=1e-6)


def test_a_maximum_just_past_the_end_of_a_panel_is_found() -> None:
    samples = np.linspace(0.0, 2.0, 5)
    ends = resolved(samples, lambda t: np.cos(t)[:, None]).ends
    inner, width = ends[1:-1], np.diff(ends).min()
    crests = np.concatenate([inner - 0.01 * width, inner, inner + 0.01 * width])
    found = resolved(samples, lambda t: np.cos(t[:, None] - crests))
    best, when = found.largest()
    assert when == pytest.approx(crests, abs=1e-5)
    assert best == pytest.approx(np.ones(len(crests)), rel=1e-12)


def test_values_known_at_the_samples_are_not_requested_again() -> None:
    samples, requested = np.linspace(0.0, 1.0, 1001), []

    def at(times: Floats) -> Floats:
        requested.append(times)
        return np.sin(5.0 * times)[:, None]

    plain = resolved(samples, at)
    asked = requested.pop(0)
    assert np.array_equal(asked, samples)
    requested.clear()
    found = resolved(samples, at, known=np.sin(5.0 * samples)[:, None])
    assert not np.isin(samples[1:-1], np.concatenate(requested)).any()
    assert np.array_equal(found.values, plain.values)
