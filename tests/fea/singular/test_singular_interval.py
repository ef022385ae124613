"""What a row is worth whose stress has no bound: an interval, and how strong the growth is."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.peak import ErrorParts, Maximum, meets_limit
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Model, Requirement
from fea.singular.fit_exponent import singular_intensity
from fea.singular.singularities import find_singularities
from fea.singular.williams import notch_factor, plane_exponent
from fea.solve.solve import solve_pin
from geometry import Pin, Segment
from tests.support.each import each

ROOT = Pin("R", (Segment(0.04, 0.02, connection="R1"), Segment(0.01, 0.02, name="head")))
HELD = Pin("H", (Segment(0.02, 0.02, name="held"), *ROOT.segments))
PULLED = PinLoads("pulled", ("R1",), np.array([[[0.0, 0.0, 5000.0]]]))
BENT = PinLoads("bent", ("R1",), np.array([[[0.0, 5000.0, 0.0]]]))
HALF_TO_TWICE = (0.5, 1.0, 2.0)


def collar(step: float, fillet: float = 0.0) -> Pin:
    """A shaft of 20 mm with a collar that is higher by `step` of it on the radius."""
    d = 0.02
    return Pin(
        "C",
        (
            Segment(0.02, d, connection="a"),
            Segment(0.01, d * (1.0 + 2.0 * step), name="collar"),
            Segment(0.02, d, connection="b"),
            Segment(0.01, d, name="shaft"),
            Segment(0.02, d, connection="c"),
        ),
        fillet,
    )


SIZES = np.array([1.0, -2.0, 1.0]) * 2e4
THREE = PinLoads(
    "three",
    ("a", "b", "c"),
    SIZES[None, :, None] * np.array([0.0, 1.0, 0.0]),
    distribution="cosine",
)


@pytest.mark.parametrize(
    "model", ["harmonic", pytest.param("solid", marks=[pytest.mark.slow, pytest.mark.long])]
)
def test_the_interval_is_that_of_half_and_twice_the_distance(model: Model, steel: Material) -> None:
    """A clamped shaft: what the surface has in runs with these distances lies in the interval, and
    the interval is no wider than they and their errors on the meshes are. It begins at what the
    sections have, N / A = 15.9 MPa, if that is more.
    """
    found = {
        times: solve_pin(
            HELD,
            steel,
            ("held",),
            (PULLED,),
            Requirement(model=model, distance=0.1 * times, meshes=3),
        )[0].peak
        for times in HALF_TO_TWICE
    }
    peak = found[1.0]
    assert peak.verdict == "singular"
    assert peak.interval is not None
    assert peak.parts is not None
    low, high = peak.interval
    places = [found[times].places for times in (2.0, 1.0, 0.5)]
    twice, own, half = (x.surface.max_von_mises for x in places if x is not None)
    section = 5000.0 / (math.pi * 0.01**2)
    assert peak.max_von_mises == own
    assert max(twice, section) < own < half <= high
    slack = 3.0 * peak.parts.total
    assert low <= max(twice, section) * (1.0 + 1e-12)
    assert low == pytest.approx(max(twice, section), abs=slack)
    assert high == pytest.approx(half, abs=slack)
    assert peak.error_estimate == max(own - low, high - own)
    assert found[2.0].max_von_mises == pytest.approx(max(twice, section))


def test_a_governing_section_keeps_a_row_singular(steel: Material) -> None:
    """A bent root: outside of the zone the surface has less than M c / I at the clamp, which the
    row has then; how much its surface has remains unknown.
    """
    (found,) = solve_pin(ROOT, steel, ("start",), (BENT,))
    peak, bending = found.peak, 32.0 * 5000.0 * 0.02 / (math.pi * 0.02**3)
    assert peak.places is not None
    assert peak.places.governs == "section"
    assert peak.max_von_mises == pytest.approx(bending)
    assert peak.places.surface.max_von_mises < 0.9 * bending
    assert peak.verdict == peak.places.surface.verdict == "singular"
    assert peak.interval is not None
    assert peak.interval[0] == pytest.approx(bending)
    assert meets_limit(peak, 1.01 * peak.interval[1]) is None


def test_meshes_decide_by_the_interval(steel: Material) -> None:
    """A required factor within the interval is never decided, one outside of it soon is."""
    (known,) = solve_pin(HELD, steel, ("held",), (PULLED,))
    assert known.peak.interval is not None
    assert steel.yield_strength is not None
    low, high = known.peak.interval
    for limit, open_ in ((0.5 * low, False), (0.5 * (low + high), True)):
        requirement = Requirement(
            1e-4, goal="decide", required=steel.yield_strength / limit, meshes=4
        )
        (found,) = solve_pin(HELD, steel, ("held",), (PULLED,), requirement)
        assert ("mesh-decides" in found.peak.reasons) is not open_
        assert meets_limit(found.peak, limit) is (None if open_ else False)


def test_a_converged_row_has_no_interval(steel: Material) -> None:
    (found,) = solve_pin(collar(0.1, fillet=1.5e-3), steel, (), (THREE,))
    assert found.peak.verdict == "converged"
    assert found.peak.interval is None
    assert found.peak.parts is not None
    assert found.peak.error_estimate == found.peak.parts.total


@each(
    ("verdict", "interval", "limit", "expected"),
    [
        ("singular", (90.0, 120.0), 80.0, False),
        ("singular", (90.0, 120.0), 95.0, None),  # a part of the interval is enough for nothing
        (
            "singular",
            (90.0, 120.0),
            150.0,
            None,
        ),  # nor is all of it: the places themselves are open
        ("converged", None, 89.0, False),
        ("converged", None, 95.0, None),  # its error reaches the limit
        ("converged", None, 105.0, None),
        ("converged", None, 110.0, True),
        ("unconverged", None, 80.0, False),
        ("unconverged", None, 95.0, None),
        ("unconverged", None, 130.0, True),
        ("rigid", None, 80.0, None),
    ],
)
def test_what_decides(
    verdict: str, interval: tuple[float, float] | None, limit: float, expected: bool | None
) -> None:
    value = None if verdict == "rigid" else 100.0
    peak = Maximum(
        "P", "c", "harmonic", verdict, "", value, value and 10.0,  # type: ignore[arg-type]
        interval=interval, parts=ErrorParts(10.0),
    )  # fmt: skip
    assert meets_limit(peak, limit) is expected


@each("step", [1e-2, 1e-3, 1e-5, 1e-8])
def test_a_sharp_corner_is_singular_however_small_its_step(step: float, steel: Material) -> None:
    """Its stress grows without bound within the step's height, wherever the nominal stress is the
    largest; the stress elsewhere is that of the plain shaft, to their errors.
    """
    (found,) = solve_pin(collar(step), steel, (), (THREE,))
    (plain,) = solve_pin(collar(0.0), steel, (), (THREE,))
    assert (found.peak.verdict, plain.peak.verdict) == ("singular", "converged")
    error = (found.peak.parts or ErrorParts(0.0)).total + (plain.peak.error_estimate or 0.0)
    assert found.peak.max_von_mises == pytest.approx(plain.peak.max_von_mises, abs=error)
    governing = [zone for zone in found.peak.singular_at if zone.governs]
    assert {zone.kind for zone in governing} == {"a sharp corner"}


@pytest.mark.slow
def test_the_solid_model_sees_a_small_step_too(steel: Material) -> None:
    """Which its elements do not resolve; a step where stress is low does not govern."""
    (found,) = solve_pin(collar(1e-3), steel, (), (THREE,), Requirement(model="solid", meshes=1))
    assert found.peak.verdict == "singular"
    left, right = found.peak.singular_at
    assert (left.governs, right.governs) == (False, True)  # 0.46 and 0.81 of the largest stress


def test_a_fillet_makes_a_small_step_finite(steel: Material) -> None:
    """10 um on a step of 20 um: the stress has a maximum there, far above the shaft's."""
    (found,) = solve_pin(collar(1e-3, fillet=1e-5), steel, (), (THREE,))
    (plain,) = solve_pin(collar(0.0), steel, (), (THREE,))
    assert found.peak.verdict == "converged"
    assert (found.peak.max_von_mises or 0.0) > 1.5 * (plain.peak.max_von_mises or 0.0)


def test_strength_goes_with_the_step(steel: Material) -> None:
    """Small steps are alike: strength ~ (height of the step)^s, to 5 %, in stress times length^s;
    measured exponents are that of theory to 0.07.
    """
    s = plane_exponent(1.5 * math.pi, steel.poisson_ratio, "free", "free")
    found = []
    for step in (1e-3, 1e-5):
        (solved,) = solve_pin(collar(step), steel, (), (THREE,))
        zone = max(solved.peak.singular_at, key=lambda zone: zone.max_von_mises)
        assert zone.strength is not None
        assert zone.exponent == pytest.approx(s, abs=0.07)
        assert zone.strength.exponent == pytest.approx(s)
        found.append(zone.strength)
    assert found[0].along / found[1].along == pytest.approx(100.0**s, rel=0.05)
    assert found[0].notch is not None
    factor = notch_factor(1.5 * math.pi, steel.poisson_ratio)
    assert found[0].notch == pytest.approx(found[0].along * factor)


def test_features_are_as_long_as_the_outline_goes_on() -> None:
    """A corner's is the height of its step; bands along one shaft do not shorten it; a clamp ends
    where its segment does.
    """
    (first, second) = find_singularities(collar(1e-3), (), (), 0.3)
    assert first.feature == pytest.approx(1e-3 * 0.02)
    assert second.feature == pytest.approx(1e-3 * 0.02)
    (corner, *_) = find_singularities(collar(0.3), (), (), 0.3)
    assert corner.feature == corner.radius
    narrow = Pin("N", (Segment(0.02, 0.02), Segment(2e-4, 0.02, name="ring"), Segment(0.02, 0.02)))
    rims = find_singularities(narrow, ("ring",), (), 0.3)
    assert [singularity.feature for singularity in rims] == pytest.approx([2e-4, 2e-4])


def test_strength_of_a_power_that_is_known() -> None:
    """A d^-s + B d^q, exact, in any unit of length."""
    d = np.geomspace(1e-6, 1e-4, 40)
    assert singular_intensity(d, 3.0 * d**-0.45 + 50.0 * d**0.2, 0.45, 0.2) == pytest.approx(
        3.0, rel=1e-9
    )
    millimetres = singular_intensity(1e3 * d, 3.0 * d**-0.45 + 50.0 * d**0.2, 0.45, 0.2)
    assert millimetres == pytest.approx(3.0 * 1e3**0.45, rel=1e-9)


@each("angle", [200.0, 225.0, 270.0, 300.0])
def test_notch_factor_is_that_of_the_stress_function(angle: float) -> None:
    """Beside Williams' stress function r^(L+1) (a cos (L+1) t + b cos (L-1) t), whose constants are
    those of a side without traction; its second derivatives are the stresses. To 1e-8.
    """
    omega, nu = math.radians(angle), 0.3
    eigenvalue = 1.0 - plane_exponent(omega, nu, "free", "free")
    half, p, m = omega / 2.0, eigenvalue + 1.0, eigenvalue - 1.0
    ratio = -math.cos(p * half) / math.cos(m * half)  # b / a: no normal stress on the side

    def hoop(t: float) -> float:
        return p * eigenvalue * (math.cos(p * t) + ratio * math.cos(m * t))

    def radial(t: float) -> float:
        second = -p * p * math.cos(p * t) - ratio * m * m * math.cos(m * t)
        return second + p * (math.cos(p * t) + ratio * math.cos(m * t))

    shear = -eigenvalue * (-p * math.sin(p * half) - ratio * m * math.sin(m * half))
    assert abs(shear) < 1e-8 * abs(hoop(0.0))
    von_mises = abs(radial(half)) * math.sqrt(1.0 - nu + nu * nu)
    expected = math.sqrt(2.0 * math.pi) * abs(hoop(0.0)) / von_mises
    assert notch_factor(omega, nu) == pytest.approx(expected, rel=1e-8)


def test_notch_factor_of_torsion() -> None:
    """Shear on the bisector is as large as along the side, von Mises sqrt 3 of it."""
    assert notch_factor(1.5 * math.pi, 0.3, torsion=True) == pytest.approx(
        math.sqrt(2.0 * math.pi / 3.0)
    )
