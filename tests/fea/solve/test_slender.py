"""Pins of any slenderness beside beam theory, and the beam where no section can be solved."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.solve.solve import solve_pin
from geometry import Pin, Segment
from geometry.mesh.gmsh_session import MeshError
from tests.support.each import sampled
from tests.support.errors import raises
from tests.support.pins.plain_pins import double_shear

D = 0.02
BAND = D  # long, at which loads act


def cantilever(length: float) -> tuple[Pin, PinLoads, float]:
    """A pin, 100 N at its end, and the bending stress at its clamp, Pa."""
    pin = Pin("P", (Segment(length - BAND, D, name="shaft"), Segment(BAND, D, connection="B")))
    loads = PinLoads("c", ("B",), np.array([[[0.0, 100.0, 0.0]]]), distribution="cosine")
    return pin, loads, 100.0 * (length - BAND / 2) * 32.0 / math.pi / D**3


def three_points(length: float) -> tuple[Pin, PinLoads, float]:
    """In balance: 100 N on its middle, 50 N on its ends; the bending stress there."""
    gap = (length - 3 * BAND) / 2
    pin = double_shear(BAND, gap, BAND, D)
    forces = np.array([[[0.0, -50.0, 0.0], [0.0, 100.0, 0.0], [0.0, -50.0, 0.0]]])
    moment = 50.0 * (length - BAND) / 2 - 100.0 * BAND / 8
    stress = moment * 32.0 / math.pi / D**3
    return pin, PinLoads("c", ("A", "B", "C"), forces, distribution="cosine"), stress


@pytest.mark.slow
@pytest.mark.parametrize("diameters", sampled([10, 50, 200, 1000], every=2))
def test_sections_agree_with_beam_theory(diameters: int, steel: Material) -> None:
    """The sections have it exactly and govern, as a clamp's edge is excluded to 0.1 D and Poisson's
    contraction felt there to about D: the surface has less.
    """
    for made, clamps in ((cantilever, ("start",)), (three_points, ())):
        pin, loads, expected = made(diameters * D)
        (found,) = solve_pin(pin, steel, clamps, (loads,), Requirement(model="harmonic"))
        peak = found.peak
        assert peak.places is not None
        assert peak.places.section is not None
        surface = peak.places.surface.max_von_mises
        assert peak.places.section.max_von_mises == pytest.approx(expected, rel=1e-9)
        assert peak.places.section.error_estimate == 0.0
        assert surface == pytest.approx(expected, rel=0.01 + 0.6 / diameters)
        assert peak.max_von_mises == pytest.approx(max(surface, expected), rel=1e-9)
        assert len(peak.history) >= 3
        assert peak.error_estimate is not None
        assert peak.error_estimate < 0.02 * expected
        assert peak.verdict == ("singular" if clamps else "converged")


@pytest.mark.parametrize(
    ("diameters", "limit"),
    [(50, 0.0), pytest.param(2500, 1e-3, marks=[pytest.mark.slow, pytest.mark.long])],
)
def test_where_round_off_is_too_much_the_beam_answers(
    diameters: int, limit: float, steel: Material, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At 2500 diameters it changes a section's solution by more than a thousandth: by about a
    sixteenth of the 0.18 at 5000, whose mesh takes six times as long.

    The harmonic model fails once, and for `auto` by the same error without its minutes.
    """
    monkeypatch.setattr("fea.core.linear_solver.MAX_REFINEMENT_CHANGE", limit)
    pin, loads, expected = cantilever(diameters * D)
    with raises(SolveError, "ill-conditioned") as caught:
        solve_pin(pin, steel, ("start",), (loads,), Requirement(model="harmonic"))

    def fails(*_: object) -> None:
        raise caught.value

    monkeypatch.setattr("fea.harmonic.section_solution.meridian_mesh", fails)
    (found,) = solve_pin(pin, steel, ("start",), (loads,), Requirement(model="auto"))
    assert found.peak.model == "beam"
    assert found.peak.max_von_mises == pytest.approx(expected, rel=1e-6)
    assert "harmonic-failed" in found.peak.reasons
    assert "is too slender" in found.peak.note  # what failed is quoted


def test_no_beam_stands_in_for_a_harmonic_model_that_was_asked_for(
    steel: Material, monkeypatch: pytest.MonkeyPatch
) -> None:
    def no_mesh(*_: object) -> None:
        raise MeshError("pin P: no mesh", "none")

    monkeypatch.setattr("fea.harmonic.section_solution.meridian_mesh", no_mesh)
    pin, loads, _ = cantilever(10 * D)
    with raises(MeshError, "none"):
        solve_pin(pin, steel, ("start",), (loads,), Requirement(model="harmonic"))
    (found,) = solve_pin(pin, steel, ("start",), (loads,), Requirement(model="auto"))
    assert found.peak.model == "beam"
    assert found.peak.note.endswith("pin P: no mesh")
