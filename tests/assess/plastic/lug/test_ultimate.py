"""Pulled lugs against the strict bracket, a published collapse, and metal that broke."""

import math

import numpy as np
import pytest

from assess.plastic.flow import FlowRule
from assess.plastic.lug.limit_load import lug_limit_load
from assess.plastic.lug.mesh import half_lug_mesh
from assess.plastic.lug.pulled_body import PulledBody
from assess.plastic.lug.true_curve import hardening_exponent, true_curve
from assess.plastic.lug.ultimate import PullCurve, lug_ultimate, pull
from fea.core.material import Material
from geometry import ArgumentError
from pinbase.arrays import Floats
from tests.support.each import each
from tests.support.lug_outlines import round_lug, square_lug

INCH, KSI, LBF = 0.0254, 6.894757e6, 4.4482216
PERFECT = Material("perfect", 10.3e3 * KSI, 0.33, None, 60.0 * KSI)
HEAD = round_lug(0.5 * INCH, 1.5 * INCH)


def test_small_strain_tends_to_the_limit_load_without_locking() -> None:
    """Two independent methods: the pulled body's load is within the strict bracket."""
    limit = lug_limit_load(HEAD, 60.0 * KSI, 0.1)
    curve = pull(HEAD, PERFECT, 0.15, finite=False, max_travel=0.3)
    assert limit.lower < curve.load[-1] < limit.upper
    assert curve.load[-1] == pytest.approx(curve.load[-4], rel=2e-3)


def test_finite_strain_is_the_published_collapse() -> None:
    """C3 of an open lug solver: 9842 lbf for this head, 0.25 in thick, 60 ksi, plane strain."""
    load = pull(HEAD, PERFECT, 0.15, max_travel=0.12).largest()[0] * 0.25 * INCH / LBF
    assert load == pytest.approx(9842.0, rel=0.005)


@pytest.mark.slow
def test_a_bar_that_broke() -> None:
    """NACA TN 1503, 14S-T of 2 x 2 in, e/D 2: bearing ultimate 124.2 ksi; no constant of lugs."""
    metal = Material("14S-T", 10.4e3 * KSI, 0.33, None, 61.1 * KSI, 68.7 * KSI)
    bar = square_lug(0.5 * INCH, 2.0 * INCH, 1.0 * INCH)
    largest = pull(bar, true_curve(metal), 0.15).largest()[0]
    assert largest / (0.5 * INCH) == pytest.approx(124.2 * KSI, rel=0.03)


@each("strengths", [(79.8, 87.9), (48.4, 67.8), (63.2, 69.3)])
def test_the_curve_gives_back_its_tensile_test(strengths: tuple[float, float]) -> None:
    low, high = strengths
    strain, stress = FlowRule(true_curve(Material("m", 1e4, 0.33, None, low, high))).curve
    assert np.interp(0.002, strain, stress) == pytest.approx(low, rel=1e-3)
    even = np.linspace(1e-3, 0.4, 4000)
    engineering = np.interp(even, strain, stress) * np.exp(-even)
    assert engineering.max() == pytest.approx(high, rel=2e-3)
    assert even[engineering.argmax()] == pytest.approx(hardening_exponent(low, high), abs=0.015)


@each("strengths", [(60.0, 60.0), (60.0, 50.0), (60.0, None), (1.0, 1e3)])
def test_strengths_that_no_metal_has_are_refused(strengths: tuple[float, float | None]) -> None:
    with pytest.raises(ArgumentError):
        true_curve(Material("m", 1e4, 0.33, None, *strengths))


@pytest.mark.parametrize("finite", [False, True])
def test_the_tangent_is_the_derivative_of_the_forces(finite: bool) -> None:
    body = PulledBody(half_lug_mesh(HEAD, 0.6), FlowRule(_unit_metal()), finite)
    rng = np.random.default_rng(3)
    before = body.at_rest()
    start = _only_free(body, 2e-3 * rng.normal(size=body.start.shape))
    before = body.residual(before, start, 0.01)[2]
    moved = _only_free(body, 1e-4 * rng.normal(size=body.start.shape))
    tangent = body.residual(before, moved, 0.02)[1]
    along = _only_free(body, rng.normal(size=body.start.shape))
    h = 1e-8
    ends = [body.residual(before, moved + s * h * along, 0.02)[0] for s in (1.0, -1.0)]
    slope = (ends[0] - ends[1]) / (2.0 * h)
    expected = tangent @ along.ravel()[body.free]
    # In finite strain the rotation of the step itself is not in the tangent.
    assert np.linalg.norm(slope - expected) < (2e-2 if finite else 1e-4) * np.linalg.norm(slope)


def test_a_turn_of_the_whole_body_turns_its_stress_alone() -> None:
    body = PulledBody(half_lug_mesh(HEAD, 0.6), FlowRule(_unit_metal()), True)
    x, y = body.start.T
    state = body.residual(body.at_rest(), np.stack([4e-3 * x, -4e-3 * y], axis=1), -9.0)[2]
    elastic = state.elastic
    for _ in range(9):  # by 90 degrees
        a = math.radians(10.0)
        turn = np.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]])
        state = body.residual(state, state.nodes @ (turn.T - np.eye(2)), -9.0)[2]
    assert np.allclose(state.elastic[..., 0], elastic[..., 1], atol=2e-6)
    assert np.allclose(state.elastic[..., 1], elastic[..., 0], atol=2e-6)


def test_large_plane_stretch_has_the_logarithmic_strain() -> None:
    """Doubled length across plane strain: an equivalent strain of 2/sqrt(3) ln 2."""
    body = PulledBody(half_lug_mesh(HEAD, 0.6), FlowRule(_unit_metal()), True)
    state = body.at_rest()
    for _ in range(40):
        rate = 2.0 ** (1.0 / 40.0)
        grown = state.nodes * [rate, 1.0 / rate]
        state = body.residual(state, grown - state.nodes, -9.0)[2]
    expected = 2.0 / math.sqrt(3.0) * math.log(2.0)
    assert np.allclose(state.equivalent, expected, rtol=5e-3)


def test_a_failure_strain_ends_the_curve() -> None:
    curve = PullCurve(
        np.arange(4.0), np.array([0.0, 2.0, 3.0, 2.5]), np.array([0.0, 0.1, 0.3, 0.9])
    )
    assert curve.largest() == (3.0, 2.0, 0.3)
    assert curve.largest(0.2) == pytest.approx((2.5, 1.5, 0.2))
    assert curve.largest(0.6) == (3.0, 2.0, 0.3)


@pytest.mark.slow
def test_the_ultimate_load_says_what_ended_it() -> None:
    metal = true_curve(Material("75S-T", 10.4e3 * KSI, 0.33, None, 79.8 * KSI, 87.9 * KSI))
    bar = square_lug(0.5 * INCH, 2.0 * INCH, 0.75 * INCH)
    broken, whole = lug_ultimate(bar, metal, math.log(1.112)), lug_ultimate(bar, metal)
    assert broken.ended_by == "strain"
    assert whole.ended_by == "shape"
    assert broken.load < whole.load
    assert broken.strain == pytest.approx(math.log(1.112))
    assert max(broken.mesh_error, whole.mesh_error) < 0.01


def _unit_metal() -> Material:
    return Material("m", 1e3, 0.3, None, 1.0, hardening=((0.5, 2.0),))


def _only_free(body: PulledBody, moved: Floats) -> Floats:
    out = np.zeros_like(moved)
    out.reshape(-1)[body.free] = moved.reshape(-1)[body.free]
    return out
