"""A second opinion: when it complains, that failures are told, and what CalculiX itself says."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fea.ladder import Asked, solve_pin
from fea.material import Material
from fea.peak import Peak
from fea.pin_loads import PinLoads
from fea.second_opinion import Opinion, second_opinions
from geometry import Pin, Segment

AGREED = Opinion("P", "up", 100.0, 5.0, 900, 1e-7, 1e-5, 95.0, 95.0)
FORCES = np.array([[[0.0, 1e3, 0.0]], [[0.0, -2e3, 500.0]]])
UP = PinLoads("up", ("P1",), FORCES)


def test_what_is_beyond_its_limit_is_complained_of() -> None:
    assert AGREED.complaint == ""
    assert AGREED.beside == pytest.approx(-0.05)
    told = {
        "displacements on the same mesh differ by 1.0e-03, allowed 1e-05": {"displacement": 1e-3},
        "von Mises stresses on the same mesh differ by 2.0e-02, allowed 1e-04": {"stress": 0.02},
        "its maximum is +36.0% from the answer, allowed 35.0%": {"theirs": 136.0},
        "ccx failed": {"failure": "ccx failed"},
    }
    for complaint, change in told.items():
        assert replace(AGREED, **change).complaint == complaint  # type: ignore[arg-type]
    assert replace(AGREED, theirs=134.0).complaint == ""
    assert "nan" in replace(AGREED, stress=float("nan")).complaint


def test_a_failure_of_calculix_is_in_the_opinion(
    cantilever_pin: Pin, steel: Material, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "ccx").write_text("#!/bin/sh\necho '*ERROR in nonsense'\n")
    (tmp_path / "ccx").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    peak = Peak("P", "up", "beam", "converged", "", 1e8, 1e6)
    (opinion,) = second_opinions(cantilever_pin, steel, ("start",), (UP,), (peak,), 0.1)
    assert opinion.complaint == "ccx failed: *ERROR in nonsense"
    assert opinion.theirs is None


def test_a_pin_that_is_not_held_has_no_opinion(cantilever_pin: Pin, steel: Material) -> None:
    peak = Peak("P", "up", "auto", "rigid", "nothing holds it")
    assert second_opinions(cantilever_pin, steel, (), (UP,), (peak,), 0.1) == ()


@pytest.mark.peers
def test_calculix_agrees_on_a_clamped_pin(cantilever_pin: Pin, steel: Material) -> None:
    """At the governing instant, the second."""
    (solved,) = solve_pin(cantilever_pin, steel, ("start",), (UP,), Asked(0.05, "harmonic"))
    assert solved.peak.instant == 1
    (opinion,) = second_opinions(cantilever_pin, steel, ("start",), (UP,), (solved.peak,), 0.1)
    assert opinion.complaint == ""
    assert opinion.ours == pytest.approx(opinion.theirs, rel=1e-4)
    other = replace(solved.peak, instant=0)
    (opinion,) = second_opinions(cantilever_pin, steel, ("start",), (UP,), (other,), 0.1)
    assert "its maximum is -5" in opinion.complaint  # half the force


@pytest.mark.peers
def test_calculix_agrees_on_a_pin_that_nothing_holds(steel: Material) -> None:
    pin = Pin(
        "P",
        (
            Segment(0.02, 0.02, connection="A"),
            Segment(0.02, 0.02, connection="B"),
            Segment(0.02, 0.02, connection="C"),
        ),
    )
    forces = np.array([[[0.0, 1e3, 0.0], [0.0, -2e3, 0.0], [0.0, 1e3, 0.0]]])
    loads = PinLoads("up", ("A", "B", "C"), forces, distribution="cosine")
    (solved,) = solve_pin(pin, steel, (), (loads,), Asked(0.05))
    (opinion,) = second_opinions(pin, steel, (), (loads,), (solved.peak,), 0.1)
    assert opinion.complaint == ""
    assert opinion.displacement is not None
    assert opinion.displacement < 2e-6
