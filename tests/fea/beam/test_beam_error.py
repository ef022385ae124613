"""The largest stress of a beam, and an error that holds the truth or is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fea.beam.error_model import CLAMP_EDGE_REMARK, beam_estimate
from fea.beam.line_load import acting
from fea.beam.stress import BeamStress, beam_stress
from fea.beam.stress_concentration import BENDING_FIT, TENSION_FIT, TORSION_FIT, shoulder_factor
from fea.core.material import Material
from fea.core.pin_loads import PinLoads, UnitLoad
from fea.core.requirement import Requirement
from fea.solve.solve import solve_pin
from geometry import ArgumentError, Pin, Segment
from tests.support.each import sampled
from tests.support.errors import raises

d, L = 0.02, 0.2
I, A = math.pi / 64 * d**4, math.pi / 4 * d**2  # noqa: E741
PLAIN = Pin("P", (Segment(L - 0.02, d), Segment(0.02, d, connection="B")))


def case(force: tuple[float, ...], moment: tuple[float, ...] = (0.0, 0.0, 0.0)) -> PinLoads:
    return PinLoads("case", ("B",), np.array([[force]]), np.array([[moment]]))


def held(pin: Pin, steel: Material, loads: PinLoads) -> BeamStress:
    return beam_stress(pin, steel, acting(loads), ("start",))


SHAFT = Pin(
    "P", (Segment(0.03, 0.03), Segment(0.1, d), Segment(0.02, d, connection="B")), fillet=0.002
)


def test_notch_factors_multiply_the_nominal_stress(steel: Material) -> None:
    """Tension, torsion and bending, all 0.3 r into the fillet, 0.0314 m from the start."""
    kt = [shoulder_factor(f, 0.03, d, 0.002) for f in (TENSION_FIT, TORSION_FIT, BENDING_FIT)]
    nominal = [1 / A, math.sqrt(3) * d / 2 / (2 * I), (0.14 - 0.0314) * d / 2 / I]
    cases = [case((0, 0, 1.0)), case((0, 0, 0), (0, 0, 1.0)), case((1.0, 0, 0))]
    for k, s, loads in zip(kt, nominal, cases, strict=True):
        assert k is not None
        beam = held(SHAFT, steel, loads)
        assert beam.points[-1] == pytest.approx([d / 2, 0.0314])
        top = beam_estimate(beam, loads, ("start",))
        assert top.maximum == pytest.approx(k * s, rel=1e-9)
        assert top.error is not None
        assert 0.1 * top.maximum < top.error < 0.5 * top.maximum


def test_a_sharp_corner_has_no_maximum(steel: Material) -> None:
    """Named, without an error; one that no load passes is none of our business."""
    sharp = Pin("P", (Segment(0.03, 0.03), Segment(0.1, d, connection="B"), Segment(0.02, 0.03)))
    loads = case((1.0, 0.0, 0.0))
    found = beam_estimate(held(sharp, steel, loads), loads, ("start",))
    assert found.error is None
    assert found.without_factor == ("a sharp inner corner between segments 1 and 2",)
    assert found.leaves_out.endswith(CLAMP_EDGE_REMARK)
    torsion = Pin("P", (Segment(0.03, 0.03), Segment(0.1, d, connection="B")), fillet=0.0005)
    twist = case((0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    outside = beam_estimate(held(torsion, steel, twist), twist)
    assert outside.error is None  # h/r = 10: torsion's fit ends at 4, but bending's holds
    assert beam_estimate(held(torsion, steel, loads), loads).error is not None


def test_missing_unit_loads_are_told(steel: Material) -> None:
    beam = beam_stress(PLAIN, steel, (UnitLoad("B", "force", 1),), ("start",))
    with raises(ArgumentError, "missing-fields", "case case"):
        beam_estimate(beam, case((0.0, 0.0, 1.0)))


def test_a_cosine_pressure_bends_the_wall_of_a_tube(steel: Material) -> None:
    """What no beam feels makes the error larger, the more the thinner the wall."""
    errors = []
    for bore in (0.0, 0.014, 0.018):
        pin = Pin("P", (Segment(0.05, d, bore), Segment(0.02, d, bore, connection="B")))
        found = []
        for how in ("uniform", "cosine"):
            loads = PinLoads("case", ("B",), np.array([[[1.0, 0, 0]]]), distribution=how)
            beam = held(pin, steel, loads)
            found.append(beam_estimate(beam, loads, ("start",)))
        assert found[0].maximum == pytest.approx(found[1].maximum)
        assert found[0].error is not None
        assert found[1].error is not None
        errors.append(found[1].error - found[0].error)
    assert errors == sorted(errors)
    # 0.9 of the radius: the ring's 6 p_2 R^2 / (3 t^2) alone, with p_2 = 0.212 p_0
    p0 = 4 / (math.pi * d * 0.02)
    assert errors[-1] > 2 * 0.212 * p0 * (0.0095 / 0.001) ** 2


@pytest.mark.slow
@pytest.mark.parametrize(("gap", "across"), sampled([(0.004, 0.016), (0.03, 0.03)], every=2))
def test_the_error_holds_the_solids_maximum(steel: Material, gap: float, across: float) -> None:
    """Double shear with a thick middle, stubby and slender; the solid's own error is added."""
    band = Segment(0.02, d, connection="A")
    pin = Pin(
        "P",
        (band, Segment(gap, d), Segment(across, 0.028, connection="B"), Segment(gap, d),
         Segment(0.02, d, connection="C")),
        fillet=0.003,
    )  # fmt: skip
    force = 1000.0 * np.array([[[-0.5, 0, 0], [1.0, 0, 0], [-0.5, 0, 0]]])
    loads = PinLoads("case", ("A", "B", "C"), force)
    found = beam_estimate(beam_stress(pin, steel, acting(loads)), loads)
    (solid,) = solve_pin(pin, steel, (), (loads,), Requirement(0.05, model="solid", meshes=2))
    assert solid.peak.max_von_mises is not None
    assert solid.peak.error_estimate is not None
    assert found.error is not None
    assert found.error < 0.5 * found.maximum
    off = abs(solid.peak.max_von_mises - found.maximum)
    assert off < found.error + solid.peak.error_estimate


def test_between_two_clamps_the_error_is_of_how_stiff_they_are(steel: Material) -> None:
    """docs/method.md: 5 % anywhere, 15 % within a diameter of a clamp, and between two of them half
    the diameter over the length; and 0.8 of the nominal pressure. So at the roots, where a band
    over all of the span has its largest moment.
    """
    for length in (0.2, 0.4):
        pin = Pin("P", (Segment(length, d, connection="B"),))
        loads = case((0.0, 1000.0, 0.0))
        found = beam_estimate(
            beam_stress(pin, steel, acting(loads), ("start", "end")), loads, ("start", "end")
        )
        assert found.maximum == pytest.approx(1000.0 * length / 12.0 * d / 2.0 / I, rel=0.01)
        relative = 0.05 + 0.15 + 0.5 * d / length
        error = relative * found.maximum + 0.8 * 1000.0 / (d * length)
        assert found.error == pytest.approx(error, rel=1e-9)
        assert found.leaves_out.endswith(CLAMP_EDGE_REMARK)
