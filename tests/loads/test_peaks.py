"""Peaks between samples: few samples must give what many do."""

from __future__ import annotations

import numpy as np
import pytest

from loads import Linkage, Reactions, motion_reactions, move
from loads.linkage import Floats
from loads.peaks import peak_forces
from loads.reactions import given_reactions
from pinstress.mechanism import laws, span
from pinstress.study import Study


def test_twenty_one_samples_give_every_peak_of_the_landing_gear_to_1e_10(
    gear: Study, gear_linkage: Linkage
) -> None:
    course = laws(gear)

    def at(times: Floats) -> Reactions:
        return motion_reactions("x", move(gear_linkage, course, times)).reactions

    exact = peak_forces(at(np.linspace(0.0, span(gear), 4001)), at)
    found = peak_forces(at(np.linspace(0.0, span(gear), 21)), at)
    for ours, best in zip(found, exact, strict=True):
        assert ours.force == pytest.approx(best.force, rel=1e-10)
        assert ours.time == pytest.approx(best.time, abs=1e-3)
    sampled = at(np.linspace(0.0, span(gear), 21)).magnitudes.max(axis=0)
    assert max(f.force / s for f, s in zip(found, sampled, strict=True)) > 1.00005


def test_a_known_maximum_between_samples() -> None:
    from dataclasses import replace

    def at(times: Floats) -> Reactions:
        forces = np.zeros((len(times), 2, 3))
        forces[:, 0, 0] = 3.0 - (times - 0.4321) ** 4
        forces[:, 1, 1] = np.exp(times)  # at its largest at the end
        one = given_reactions("x", {"P": (0.0, 0.0), "Q": (0.0, 0.0)})
        turn = np.zeros((len(times), 2))
        return replace(one, times=times, forces=forces, moments=0.0 * forces, turn=turn)

    inside, end = peak_forces(at(np.linspace(0.0, 1.0, 6)), at)
    assert inside.force == pytest.approx(3.0, abs=1e-13)
    assert inside.time == pytest.approx(0.4321, abs=1e-2)  # flat to fourth order
    assert (end.force, end.time) == pytest.approx((np.e, 1.0))
