"""A row that yields starts a limit load by itself, which had no end.

Pin E of the landing gear with edges of 1/8 in at its lugs ran for as long as anyone waited: its
contact cuts it into 27 rings, and the second mesh of the solid has 31,000 unknowns. What is not
asked for has 20 s of processor time now, is not computed beyond, and says how to have it.

Independent: a clock of our own, which the program reads; the number of its iterations.
"""

import json
import math
import time
from pathlib import Path

import numpy as np
import pytest

from assess.plastic import solve
from assess.plastic.body import FlowingBody
from assess.plastic.budget import Budget, OutOfTimeError
from assess.plastic.limit_load import limit_on_mesh
from assess.plastic.solve import limit_load
from fea.core.pin_loads import PinLoads
from geometry import Pin, Segment
from geometry.mesh.hexahedra import HexSize
from pinstress import load_study, prepare
from pinstress.analysis.assessed import limits
from pinstress.analysis.assessed.limits import UNASKED_LIMIT_LOAD_SECONDS, limit_seconds, rung_of
from pinstress.cli.commands import run_command_line
from tests.support.each import each
from tests.support.exact.plastic import STEEL, D

STUDY = """
title = "Past yield"
units = "mm-N-s"
[material.steel]
youngs_modulus = "200 GPa"
poisson_ratio = 0.3
yield_strength = "250 MPa"
[pin.P]
material = "steel"
clamp = ["start"]
profile = [{ length = 30, diameter = 20 }, { length = 10, diameter = 20, connection = "A" }]
[case.push]
kind = "given"
forces = { A = [8500.0, 0.0, 0.0] }
[analysis]
model = "harmonic"
tolerance = 0.5
"""
LACKS = "not computed: --limit-load computes it"


class Clock:
    """Stands still, but for so many seconds in every iteration of a body's equilibrium."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, seconds: float) -> None:
        self.now, self.iterations = 1000.0, 0
        stiffness = FlowingBody.stiffness

        def slow(body: FlowingBody, tangent: object) -> object:
            self.now += seconds
            self.iterations += 1
            return stiffness(body, tangent)  # type: ignore[arg-type]

        monkeypatch.setattr(FlowingBody, "stiffness", slow)
        monkeypatch.setattr(time, "thread_time", lambda: self.now)


def _pushed(length: float = 2.0) -> tuple[Pin, PinLoads]:
    """Between the beam's bounds."""
    pin = Pin("p", (Segment((length - 0.5) * D, D), Segment(0.5 * D, D, connection="a")))
    return pin, PinLoads("c", ("a",), np.array([[[8.5e3, 0.0, 0.0]]]))


def test_it_ends_in_the_middle_of_a_mesh_and_has_no_half_of_a_bracket(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock = Clock(monkeypatch, 3.0)
    pin, loads = _pushed()
    found = limit_load(pin, STEEL, ("start",), loads, seconds=20.0)
    assert clock.iterations == 7  # 21 s
    assert (found.method, found.stopped, found.meshes) == ("none", True, ())
    assert (found.lower, found.upper, found.carries, found.curve, found.flow) == (None,) * 5
    assert "20 s of processor time: --limit-load computes it" in found.note


def test_a_second_mesh_that_would_take_longer_is_not_begun(monkeypatch: pytest.MonkeyPatch) -> None:
    """A first mesh of 15 s; the second, of four times the unknowns, would have eight times that."""
    done = []

    def counted(*given: object) -> object:
        done.append(given)
        return limit_on_mesh(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(solve, "limit_on_mesh", counted)
    clock = Clock(monkeypatch, 0.25)
    pin, loads = _pushed()
    found = limit_load(pin, STEEL, ("start",), loads, seconds=20.0)
    assert found.stopped
    assert len(done) == 1
    assert clock.now < 1020.0


def test_of_many_unknowns_nothing_is_begun(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same on every computer, as no clock decides it."""
    monkeypatch.setattr(solve, "limit_on_mesh", None)
    monkeypatch.setattr(time, "thread_time", lambda: 0.0)
    band = Segment(0.5 * D, D, connection="a")
    pin = Pin("p", (Segment(1.5 * D, D), *(30 * (Segment(0.05 * D, D),)), band))
    loads = PinLoads("c", ("a",), np.array([[[8e3, 1e3, 100.0]]]), np.array([[[0.0, 0.0, 50.0]]]))
    found = limit_load(pin, STEEL, ("start",), loads, "solid", seconds=20.0)
    assert (found.method, found.stopped) == ("none", True)


@pytest.mark.long
@pytest.mark.slow
def test_without_a_budget_it_ends_by_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    Clock(monkeypatch, 1e6)
    pin, loads = _pushed()
    found = limit_load(pin, STEEL, ("start",), loads)
    assert found.lower is not None
    assert (found.method, found.stopped) == ("solid", False)


def test_a_budget_counts_from_its_beginning(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(time, "thread_time", lambda: 5.0)
    began = Budget(2.0)
    monkeypatch.setattr(time, "thread_time", lambda: 6.5)
    began.require(0.5)
    with pytest.raises(OutOfTimeError):
        began.require(0.6)
    Budget().require(1e9)


@each(
    ("asked", "flag", "rung", "seconds"),
    [
        ('"auto"', False, "auto", UNASKED_LIMIT_LOAD_SECONDS),
        ('"auto"', True, "auto", math.inf),
        ('"always"', False, "solid", math.inf),
        ('["P"]', False, "solid", math.inf),
        ('"never"', False, None, math.inf),
        ('"never"', True, "auto", math.inf),
    ],
)
def test_what_is_asked_for_has_no_budget(
    tmp_path: Path, asked: str, flag: bool, rung: str | None, seconds: float
) -> None:
    path = tmp_path / "study.toml"
    path.write_text(f"{STUDY}limit_load = {asked}\n")
    plan = prepare(load_study(path), limit_load=flag)
    assert (rung_of(plan, "P"), limit_seconds(plan)) == (rung, seconds)
    assert UNASKED_LIMIT_LOAD_SECONDS == 20.0


@pytest.mark.slow
def test_the_command_says_what_computes_it_and_the_cache_does_not_make_it_stick(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PINSTRESS_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("COLUMNS", "200")
    monkeypatch.setattr(limits, "UNASKED_LIMIT_LOAD_SECONDS", 1e-9)
    monkeypatch.setattr("assess.plastic.solve.MESH_SIZES", (HexSize(2, 0.5), HexSize(4, 0.5)))
    Path("study.toml").write_text(STUDY)

    def run(*options: str) -> tuple[str, bool, float | None]:
        """What is printed, whether the pin was reused, and the lower bound."""
        assert run_command_line(["run", "study.toml", "--jobs", "1", *options]) in (0, 1)
        said = capsys.readouterr()
        limit = json.loads(Path("out/study/results.json").read_text())["pins"][0]["limit_load"]
        return said.out, "reused from the cache" in said.err, limit["lower"]

    out, reused, lower = run()
    assert LACKS in out
    assert "a limit load (--limit-load)" in out  # of the checks that are not made
    assert (reused, lower) == (False, None)
    assert LACKS in Path("out/study/report.html").read_text()
    out, reused, lower = run()
    assert LACKS in out
    assert (reused, lower) == (True, None)
    out, reused, lower = run("--limit-load")
    assert LACKS not in out
    assert not reused
    assert lower is not None
    out, reused, again = run()  # as it is known now
    assert (reused, again) == (True, lower)
