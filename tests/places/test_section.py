"""The stress of sections by their forces, beside brute force and closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from assess.plastic.hinge import beam_bounds
from fea.core.material import Material
from fea.core.peak import ErrorParts
from fea.core.pin_loads import Floats, PinLoads
from fea.section.place import FLEXIBILITY_ERROR, found_section
from fea.section.section_stress import AtSection, SectionField
from geometry import Pin, Segment
from tests.support.each import each

STEEL = Material("steel", 205e9, 0.3, yield_strength=400e6)
NU, D = 0.3, 0.02


def loads(bands: str, forces: Floats, moments: Floats | None = None) -> PinLoads:
    zero = np.zeros(3)
    return PinLoads("c", tuple(bands), forces[None], zero if moments is None else moments[None])


def beyond(pin: Pin, case: PinLoads, z: float) -> tuple[Floats, Floats]:
    """Force and moment (3,) that the part of a pin beyond z exerts on the rest, about the axis at
    z, by statics: each band carries its force and torque evenly.
    """
    force, moment = np.zeros(3), np.zeros(3)
    for name, own, about in zip(case.surfaces, case.forces[0], case.moments[0], strict=True):
        band = pin.band(name)
        start = max(band.z0, z)
        part = max(band.z1 - start, 0.0) / band.length
        arm = np.array([0.0, 0.0, 0.5 * (start + band.z1) - z])
        force = force + part * own
        moment = moment + np.cross(arm, part * own) + part * about * [0.0, 0.0, 1.0]
    return force, moment


def stress_at(
    force: Floats, moment: Floats, outer: float, inner: float, x: Floats, y: Floats
) -> Floats:
    """sqrt(s^2 + 3 t^2) at points of a section, in Cartesian axes. Shear as Saint-Venant's flexure
    has it: s_xz = V / (8 (1 + nu) I) ((3 + 2 nu) (a^2 + b^2) - (3 + 2 nu) x^2 + .. ), which for a
    solid section is Timoshenko & Goodier's, art. 121.
    """
    a2, b2, r2 = outer**2, inner**2, x**2 + y**2
    inertia = math.pi / 4.0 * (outer**4 - inner**4)
    area = math.pi * (a2 - b2)
    axial = force[2] / area + (moment[0] * y - moment[1] * x) / inertia
    k, ring = 3.0 + 2.0 * NU, a2 * b2 / np.maximum(r2, 1e-30) ** 2
    each = 1.0 / (8.0 * (1.0 + NU) * inertia)

    def along(p: Floats, q: Floats) -> tuple[Floats, Floats]:
        """Of a unit shear along p: s_pz and s_qz."""
        own = each * (k * (a2 + b2 - p**2) - (1.0 - 2.0 * NU) * q**2 - k * ring * (p**2 - q**2))
        return own, -2.0 * each * p * q * ((1.0 + 2.0 * NU) + k * ring)

    (xx, xy), (yy, yx) = along(x, y), along(y, x)
    twist = moment[2] / (2.0 * inertia)
    sx = force[0] * xx + force[1] * yx - twist * y
    sy = force[0] * xy + force[1] * yy + twist * x
    return np.asarray(np.sqrt(axial**2 + 3.0 * (sx**2 + sy**2)))


def brute(pin: Pin, case: PinLoads, sections: Floats) -> float:
    """The largest over many points of many sections between the bands' and segments' ends."""
    turn = np.linspace(0.0, 2.0 * np.pi, 181)[:-1]
    best = 0.0
    for segment, start in zip(pin.segments, pin.stations, strict=False):
        outer, inner = segment.diameter / 2.0, segment.bore / 2.0
        r = np.linspace(inner, outer, 41)[:, None]
        x, y = r * np.cos(turn), r * np.sin(turn)
        for z in start + segment.length * sections:
            best = max(best, float(stress_at(*beyond(pin, case, z), outer, inner, x, y).max()))
    return best


@each("seed", range(8))
def test_it_is_the_largest_of_all_points_of_all_sections(seed: int) -> None:
    """Random stepped pins, solid and hollow, clamped at a face, with random forces along all axes
    and torques: to 0.3 %, of the sampling of both.
    """
    rng = np.random.default_rng(seed)
    segments = tuple(
        Segment(
            rng.uniform(0.2, 1.5) * D, (d := rng.uniform(0.7, 1.3) * D), name=f"s{k}",
            connection=name, bore=d * rng.uniform(0.2, 0.85) * (seed % 2),
        )
        for k, name in enumerate((None, "A", None, "B", "C"))
    )  # fmt: skip
    pin = Pin("R", segments)
    moments = np.zeros((3, 3))
    moments[:, 2] = rng.normal(size=3) * 100.0
    forces = rng.normal(size=(3, 3)) * [1e4, 1e4, 5e4]
    case = loads("ABC", forces, moments)
    answer = SectionField(pin, STEEL, ("start",), (case,))
    expected = brute(pin, case, np.linspace(1e-9, 1.0 - 1e-9, 65))
    at = answer.place(case)
    assert at.value == pytest.approx(expected, rel=3e-3)
    assert answer.largest(case)[0] == pytest.approx(expected, rel=1e-2)
    force, moment = beyond(pin, case, at.z)
    x, y = at.r * np.cos([at.angle]), at.r * np.sin([at.angle])
    there = stress_at(force, moment, at.section.outer, at.section.inner, x, y)
    assert at.value == pytest.approx(float(there[0]), rel=1e-9)
    assert at.axial_force == pytest.approx(force[2], abs=1e-6)
    assert at.shear_force == pytest.approx(float(np.hypot(*force[:2])))
    assert at.bending_moment == pytest.approx(float(np.hypot(*moment[:2])), abs=1e-6)
    assert abs(at.torque) == pytest.approx(abs(moment[2]), abs=1e-9)


@each("seed", range(6))
def test_a_moment_may_be_largest_within_a_band(seed: int) -> None:
    """Three bands side by side in balance, of unlike lengths, whose largest moment is somewhere in
    the middle one, to 0.02 %.
    """
    rng = np.random.default_rng(seed)
    lengths = rng.uniform(0.5, 2.0, 3) * D
    pin = Pin("B", tuple(Segment(x, D, connection=c) for x, c in zip(lengths, "ABC", strict=True)))
    a, c = 0.5 * (lengths[0] + lengths[1]), 0.5 * (lengths[1] + lengths[2])
    sizes = 1e4 * np.array([-c, a + c, -a]) / (a + c)
    case = loads("ABC", sizes[:, None] * [0.6, 0.8, 0.0])
    at = SectionField(pin, STEEL, (), (case,)).place(case)
    expected = brute(pin, case, np.linspace(1e-9, 1.0 - 1e-9, 401))
    assert at.value == pytest.approx(expected, rel=2e-4)


def cantilever(bore: float = 0.0) -> Pin:
    """A long shaft with a loaded end."""
    shaft = Segment(0.2, D, name="shaft", bore=bore)
    return Pin("C", (shaft, Segment(0.02, D, bore=bore, connection="E")))


@pytest.mark.parametrize("bore", [0.0, 0.012])
def test_a_cantilever_is_that_of_the_textbooks(bore: float) -> None:
    """Tension N / A, torsion sqrt 3 T a / J, bending M a / I of a long one; and the shear of one
    that is as short as it gets beside its load, on the axis of a solid section
    (3 + 2 nu) / (2 (1 + nu)) V / A, sqrt 3 times that.
    """
    pin, a, b = cantilever(bore), D / 2.0, bore / 2.0
    area, inertia = math.pi * (a * a - b * b), math.pi / 4.0 * (a**4 - b**4)

    def place(x: float, z: float, torque: float) -> AtSection:
        case = loads("E", np.array([[x, 0.0, z]]), np.array([[0.0, 0.0, torque]]))
        return SectionField(pin, STEEL, ("start",), (case,)).place(case)

    tension, twist, bent = place(0.0, 1e5, 0.0), place(0.0, 0.0, 300.0), place(1e3, 0.0, 0.0)
    assert tension.value == pytest.approx(1e5 / area)
    assert tension.plastic_use(400e6) == pytest.approx(1e5 / area / 400e6)
    assert twist.value == pytest.approx(math.sqrt(3.0) * 300.0 * a / (2.0 * inertia))
    assert bent.value == pytest.approx(1e3 * 0.21 * a / inertia, rel=1e-6)
    assert (bent.z, bent.r) == pytest.approx((0.0, a))
    assert abs(math.cos(bent.angle)) == pytest.approx(1.0)  # in the plane of the force
    together = place(0.0, 1e5, 300.0)
    assert together.value == pytest.approx(math.hypot(tension.value, twist.value))


def test_shear_governs_between_a_pair_of_lugs_side_by_side() -> None:
    """Two equal and opposite forces on bands that touch: V between them on the axis of a solid
    section, where bending has none.
    """
    thin = Segment(0.05 * D, D, connection="A"), Segment(0.05 * D, D, connection="B")
    forces = np.array([[1e5, 0.0, 0.0], [-1e5, 0.0, 0.0]])
    pin = Pin("S", (Segment(D, D, name="root"), *thin))
    case = loads("AB", forces)
    at = SectionField(pin, STEEL, ("start",), (case,)).place(case)
    area = math.pi * D * D / 4.0
    shear = (3.0 + 2.0 * NU) / (2.0 * (1.0 + NU)) * 1e5 / area
    assert at.value == pytest.approx(math.sqrt(3.0) * shear, rel=0.01)
    assert at.z == pytest.approx(1.05 * D)
    assert at.shear_force == pytest.approx(1e5)


def test_both_sides_of_a_step_count() -> None:
    """The thin shaft's own end, whichever side of the step it is on."""
    root = Segment(0.05, 1.5 * D, name="root")
    pin = Pin("S", (root, Segment(0.1, D), Segment(0.02, D, connection="E")))
    for clamp, segments in (("start", pin.segments), ("end", pin.segments[::-1])):
        turned = Pin("S", segments)
        case = loads("E", np.array([[0.0, 2e3, 0.0]]))
        at = SectionField(turned, STEEL, (clamp,), (case,)).place(case)
        assert at.value == pytest.approx(32.0 * 2e3 * 0.11 / (math.pi * D**3), rel=1e-4)
        assert at.section.outer == pytest.approx(D / 2.0)
        assert at.z == pytest.approx(0.05 if clamp == "start" else 0.12)


def test_a_cone_is_largest_where_it_is_half_as_thick_again() -> None:
    """A bar that widens from d by k per length under a force at its thin end: 32 P x / pi d(x)^3 is
    largest at d(x) = 1.5 d. Slices are a hundredth of the diameter, and count as thin as they get.
    """
    k, tip = 0.1, 1e-3 * D
    long = Segment(0.3, D + 0.3 * k, end_diameter=D, name="cone")
    pin = Pin("K", (long, Segment(tip, D, connection="E")))
    case = loads("E", np.array([[1e3, 0.0, 0.0]]))
    at = SectionField(pin, STEEL, ("start",), (case,)).place(case)
    expected = 32.0 * 1e3 * (0.5 * D / k) / (math.pi * (1.5 * D) ** 3)
    assert expected * 0.999 <= at.value <= expected * 1.03
    assert 2.0 * at.section.outer == pytest.approx(1.5 * D, rel=0.05)


def test_two_clamps_share() -> None:
    """A force in the middle between two clamps: P L / 8 at both and amid, N and T by halves."""
    half = Segment(0.2, D, name="a"), Segment(0.2, D, name="b")
    pin = Pin("T", (half[0], Segment(1e-4, D, connection="E"), half[1]))
    case = loads("E", np.array([[1e3, 0.0, 6e3]]), np.array([[0.0, 0.0, 50.0]]))
    at = SectionField(pin, STEEL, ("start", "end"), (case,)).place(case)
    assert at.bending_moment == pytest.approx(1e3 * 0.4 / 8.0, rel=1e-3)
    assert abs(at.axial_force) == pytest.approx(3e3, rel=1e-3)
    assert abs(at.torque) == pytest.approx(25.0, rel=1e-3)
    assert at.shear_force == pytest.approx(500.0, rel=1e-3)


@pytest.mark.parametrize("bore", [0.0, 0.012])
def test_its_plastic_use_is_that_of_the_static_theorem(bore: float) -> None:
    """Where the same section is the most stressed and the most used, as at a clamp: one over the
    lower bound of the load factor, for any bending, pulling, twisting and shear.
    """
    pin = cantilever(bore)
    rng = np.random.default_rng(3)
    for _ in range(6):
        force = rng.normal(size=(1, 3)) * [2e3, 2e3, 4e4]
        case = loads("E", force, rng.normal(size=(1, 3)) * [0.0, 0.0, 200.0])
        at = SectionField(pin, STEEL, ("start",), (case,)).place(case)
        lower = float(beam_bounds(pin, STEEL, ("start",), case).lower[0])
        assert at.plastic_use(400e6) == pytest.approx(1.0 / lower, rel=1e-3)


def swing(times: Floats) -> PinLoads:
    """A force that turns by a full turn in a second and is largest at 0.37 s."""
    size = 2e3 * np.exp(-(((times - 0.37) / 0.3) ** 2))
    angle = 2.0 * np.pi * times
    forces = np.stack([size * np.cos(angle), size * np.sin(angle), 0.0 * size], axis=1)[:, None]
    return PinLoads("swing", ("E",), forces, times=times)


def test_a_motion_is_largest_between_its_samples() -> None:
    pin = cantilever()
    case = swing(np.linspace(0.0, 1.0, 5))
    answer = SectionField(pin, STEEL, ("start",), (case,))
    expected = 2e3 * 0.21 / (math.pi * D**3 / 32.0)
    assert answer.place(case).value < 0.9 * expected
    found = found_section(answer, case, swing, 0.02)
    assert found.at.value == pytest.approx(expected, rel=1e-4)
    assert found.time == pytest.approx(0.37, abs=2e-3)
    off = math.remainder(found.at.angle - 2.0 * np.pi * 0.37, np.pi)
    assert off == pytest.approx(0.0, abs=0.05)
    assert len(found.loads) == 1
    assert expected <= found.upper_end
    assert found.parts.mesh == found.parts.cells == 0.0
    assert found.parts.total == found.parts.time <= 0.02 * expected
    steps = found_section(answer, case, None, 0.02)  # of a table only the rows count
    assert steps.at.value == answer.place(case).value
    assert steps.parts.total == 0.0


@pytest.mark.parametrize(("gap", "solid"), [(0.005, 105.9), (0.02, 233.6)])
def test_between_two_clamps_moments_have_the_error_of_a_beam(gap: float, solid: float) -> None:
    """solid: N m at the clamps, from a quarter of the pin in 27-node hexahedra (scikit-fem, 21,000
    unknowns, the bands held rigidly): its residual in the middle and statics. A beam has W (3 L^2 -
    b^2) / (24 L), 13 and 5 % more, since the pin's core gives way in the clamps.
    """
    widths = (("A", 0.015), ("", gap), ("B", 0.03), ("", gap), ("C", 0.015))
    pin = Pin("P", tuple(Segment(w, D, connection=name or None) for name, w in widths))
    case = loads("B", np.array([[0.0, -30e3, 0.0]]))
    answer = SectionField(pin, STEEL, ("A", "C"), (case,))
    found = found_section(answer, case, None, 0.02)
    long, section = 0.03 + 2.0 * gap, math.pi * D**3 / 32.0
    beam = 30e3 * (3.0 * long**2 - 0.03**2) / (24.0 * long)
    assert found.at.value == pytest.approx(beam / section, rel=1e-9)
    assert found.parts == ErrorParts(0.0, model=0.5 * D / long * found.at.value)
    assert found.lower_end < solid / section < found.upper_end
    assert not found.known(0.02)


def test_forces_of_contact_bring_its_errors() -> None:
    case = loads("E", np.array([[1e3, 0.0, 0.0]]))
    answer = SectionField(cantilever(), STEEL, ("start",), (case,))
    found = found_section(answer, case, None, 0.02, cells=0.01)
    value = found.at.value
    assert found.parts == ErrorParts(mesh=FLEXIBILITY_ERROR * value, cells=0.01 * value)
    assert (found.lower_end, found.upper_end) == pytest.approx(
        ((1.0 - FLEXIBILITY_ERROR - 0.01) * value, (1.0 + FLEXIBILITY_ERROR + 0.01) * value)
    )
    assert found.known(0.02)
    assert not found.known(0.01)
    assert found.time is None
    place = found.place(0.01, 0.5)
    assert (place.max_von_mises, place.error_estimate) == (value, found.parts.total)
    assert (place.verdict, place.plastic_utilisation) == ("unconverged", 0.5)


def test_maxima_are_those_of_each_instant() -> None:
    times = np.linspace(0.0, 1.0, 7)
    case = swing(times)
    answer = SectionField(cantilever(), STEEL, ("start",), (case,))
    every = [answer.largest(case.at(np.array([k])))[0] for k in range(7)]
    assert answer.maxima(case) == pytest.approx(every)
    least = 0.5 * max(every)
    assert answer.maxima(case, least) == pytest.approx(np.maximum(every, least))
    value, instant = answer.largest(case)
    assert value == pytest.approx(max(every))
    assert instant == int(np.argmax(every))
