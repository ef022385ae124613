"""Fatigue against hand calculations and the printed examples of the FKM guideline."""

import math

import numpy as np
import pandas
import pytest

from assess.fatigue.assess import FatigueMaterial, Spectrum, assess
from assess.fatigue.critical_plane import PLANE_STEP, _grid, findley_k, worst_plane
from assess.fatigue.critical_points import signed_von_mises
from assess.fatigue.fkm import FkmMaterial, _parameters, _repetitions, p_ram_life
from assess.fatigue.flight import Flight, case_by_case, flight, rainflow, turning_points
from assess.fatigue.many_planes import on_planes
from assess.fatigue.records import CaseHistory, PointFatigue, PointHistory
from assess.fatigue.sn_curve import SOFTENED_KNEE_RATIO, MeanStress, SnCurve
from pinbase.arrays import Floats
from pinbase.errors import ArgumentError
from tests.support.each import each

Direction = tuple[float, float, float]
CURVE = SnCurve((300e6, 1e6), 5.0)


def _uniaxial(values: list[float], direction: Direction = (0.0, 0.0, 1.0)) -> Floats:
    d = np.array(direction) / float(np.linalg.norm(direction))
    tensor = np.outer(d, d)
    six = np.array([tensor[0, 0], tensor[1, 1], tensor[2, 2], *tensor[[1, 0, 0], [2, 2, 1]]])
    return np.outer(np.array(values), six)


def _history(**cases: Floats) -> PointHistory:
    found = []
    for name, stress in cases.items():
        signed = signed_von_mises(stress)
        found.append(CaseHistory(name, None, stress, abs(signed), signed))
    return PointHistory("P", 1, (0.0, 0.0, 0.0), "", tuple(found))


def _assessed(history: PointHistory, spectrum: Spectrum, material: FatigueMaterial) -> PointFatigue:
    found = assess(history, spectrum, material)
    assert found is not None
    return found


def test_the_sign_is_that_of_the_largest_principal_stress() -> None:
    rng = np.random.default_rng(3)
    stress = rng.normal(size=(200, 6))
    tensors = stress[:, [[0, 5, 4], [5, 1, 3], [4, 3, 2]]]
    values = np.linalg.eigvalsh(tensors)
    largest = values[np.arange(200), np.abs(values).argmax(axis=1)]
    assert np.array_equal(np.sign(signed_von_mises(stress)), np.sign(largest))
    assert signed_von_mises(_uniaxial([-7.0]))[0] == pytest.approx(-7.0)


def test_pure_shear_of_either_direction_is_positive() -> None:
    shear = np.zeros((2, 6))
    shear[:, 3] = [1.0, -1.0]
    assert signed_von_mises(shear) == pytest.approx(np.sqrt([3.0, 3.0]))


@each("cylindrical", [False, True])
def test_the_normal_of_the_plane_is_in_the_axes_of_the_pin(cylindrical: bool) -> None:
    """Alternating tension along the tangent at 90 degrees from x, which is -x: without mean stress
    the plane of largest shear is at 45 degrees to it.
    """
    stress = _uniaxial([100.0, -100.0], (0.0, 1.0, 0.0))
    case = CaseHistory("a", None, stress, abs(signed_von_mises(stress)), signed_von_mises(stress))
    history = PointHistory("P", 1, (0.0, 1.0, 0.5), "", (case,), cylindrical)
    curve = FatigueMaterial(SnCurve((50.0, 1e6), 5.0))
    found = _assessed(history, Spectrum({"a": 1.0}, "critical-plane"), curve)
    assert found.normal is not None
    along = found.normal[0 if cylindrical else 1]
    assert abs(along) == pytest.approx(math.sqrt(0.5), abs=1e-6)
    assert np.linalg.norm(found.normal) == pytest.approx(1.0)
    assert found.amplitude == pytest.approx(50.0)
    plain = _assessed(history, Spectrum({"a": 1.0}), curve)
    assert plain.normal is None


def test_turning_points_keep_the_ends_and_no_plateau_twice() -> None:
    course = np.array([0.0, 1.0, 2.0, 2.0, 1.0, 1.0, 3.0, 0.0])
    assert course[turning_points(course)].tolist() == [0.0, 2.0, 1.0, 3.0, 0.0]


def test_a_pulse_is_one_cycle_from_zero() -> None:
    found = rainflow(case_by_case(np.array([80.0]))[0])
    assert found.amplitude == pytest.approx([40.0])
    assert found.mean == pytest.approx([40.0])


def test_cycles_of_the_standard_example() -> None:
    # ASTM E1049-85, figures 6 and 7, repeated: ranges 3, 4, 7, 9; the zero load put into it at its
    # ends, between two valleys at -2, makes one of 2.
    found = rainflow(np.array([0.0, -2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0]))
    assert sorted((2.0 * found.amplitude).tolist()) == [2.0, 3.0, 4.0, 7.0, 9.0]


def test_cases_of_opposite_sign_make_one_cycle_of_both() -> None:
    order = flight([1.0, 1.0])
    found = rainflow(order.sequence([case_by_case(np.array([x]))[0] for x in (60.0, -40.0)]))
    assert (found.amplitude.max(), found.mean[found.amplitude.argmax()]) == (50.0, 10.0)


def test_cases_that_are_rare_come_in_every_so_many_units() -> None:
    assert flight([2.0, 0.25]) == Flight((0, 0, 0, 0, 0, 0, 0, 0, 1), 4)


@each(
    ("often", "code"),
    [([1.0, 0.0123456], "not-a-fraction"), ([50_000.0], "too-many-occurrences")],
)
def test_spectra_that_cannot_be_counted(often: list[float], code: str) -> None:
    with pytest.raises(ArgumentError) as caught:
        flight(often)
    assert caught.value.code == code


def test_cases_follow_each_other_in_the_order_of_the_spectrum() -> None:
    """Up and down in turn is two cycles of 400 MPa, whatever the order of the cases in the study;
    twice up before twice down is one, and two of 200 MPa, a little more than half of the damage.
    """
    up, down = _uniaxial([400e6]), _uniaxial([-400e6])
    history = _history(up=up, over=up, down=down, under=down)
    material = FatigueMaterial(SnCurve((300e6, 1e6), 5.0, 5.0))
    for names, cycles in (
        (("up", "down", "over", "under"), [400.0, 400.0]),
        (("up", "over", "down", "under"), [400.0, 200.0, 200.0]),
    ):
        for method in ("signed-von-mises", "critical-plane"):
            spectrum = Spectrum(dict.fromkeys(names, 1.0), method)
            found = _assessed(history, spectrum, material)
            assert found.damage == pytest.approx(sum((x / 300.0) ** 5 * 1e-6 for x in cycles))


def test_damage_by_hand() -> None:
    # 2 pulses of 600 MPa and 1 of 800: amplitudes 300, 400 and, without mean stress, N = 1e6 and
    # 1e6 (300/400)^5.
    history = _history(pull=_uniaxial([600e6]), jerk=_uniaxial([800e6]))
    spectrum = Spectrum({"pull": 2.0, "jerk": 1.0}, life=1e5)
    found = _assessed(history, spectrum, FatigueMaterial(CURVE))
    assert found.damage == pytest.approx(2e-6 + 1e-6 * (4.0 / 3.0) ** 5)
    assert found.utilisation == pytest.approx(1e5 * found.damage)
    assert found.life == pytest.approx(1.0 / found.damage)
    assert found.amplitudes / 1e6 == pytest.approx([400.0, 300.0], rel=1e-5)
    assert found.counts.tolist() == [1.0, 2.0]


def test_below_the_knee_there_is_no_damage_without_a_slope() -> None:
    history = _history(pull=_uniaxial([500e6]))
    found = _assessed(history, Spectrum({"pull": 1.0}), FatigueMaterial(CURVE))
    assert (found.damage, found.life) == (0.0, None)
    haibach = FatigueMaterial(SnCurve((300e6, 1e6), 5.0, 9.0))
    found = _assessed(history, Spectrum({"pull": 1.0}), haibach)
    assert found.life == pytest.approx(1e6 * (300.0 / 250.0) ** 9)


def test_a_softened_knee_goes_on_above_it_alone() -> None:
    """Its life is that of the slope above, down to a part of the knee, and the curve's elsewhere;
    no cycles do no damage.
    """
    life = SnCurve((300e6, 1e6), 5.0, 9.0).life()
    amplitude = 300e6 * np.array([1.2, 0.99, 0.9 * SOFTENED_KNEE_RATIO])
    ratio = amplitude / 300e6
    expected = 1e-6 * np.array([ratio[0] ** 5, ratio[1] ** 5, ratio[2] ** 9])
    assert life.softer(amplitude) == pytest.approx(expected, rel=1e-9)
    assert CURVE.damage(np.zeros(0)) == 0.0


@each("ratio", [1.5, 2.0])
def test_a_third_of_the_sensitivity_holds_in_high_tension(ratio: float) -> None:
    """FKM: above R = 0 the slope of Haigh's line is M / 3; both lines meet there."""
    M, amplitude = 0.3, 100e6
    at_zero = amplitude * (1.0 + M / 3.0 * ratio) / (1.0 + M / 3.0)
    curve = SnCurve((300e6, 1e6), 5.0, rule="fkm", parameter=M)
    found = curve.equivalent(np.array([amplitude]), np.array([ratio * amplitude]))
    assert found == pytest.approx([at_zero * (1.0 + M)])


def test_a_sequence_that_breaks_within_its_first_run() -> None:
    """Equation 2.6-90: damage of 4 in the first run is a quarter of it; of 0.4 and then 0.3 per
    run, two more runs.
    """
    cycles = pandas.DataFrame({"run_index": [1, 1, 2]})
    assert _repetitions(cycles, np.array([3.0, 1.0, 1.0])) == pytest.approx(0.25)
    assert _repetitions(cycles, np.array([0.1, 0.3, 0.3])) == pytest.approx(3.0)
    assert _repetitions(cycles, np.array([0.1, 0.3, 0.0])) == math.inf


def test_without_a_notch_there_is_no_support() -> None:
    """The area of the guideline's specimen, and no gradient."""
    plain = _parameters(FkmMaterial("Steel", 600e6, 1e-4, 2.0))
    assert plain["A_sigma"] == pytest.approx(plain["A_ref"])
    assert plain["G"] == 0.0


def test_scatter_of_lives() -> None:
    curve = SnCurve((300e6, 1e6), 5.0, scatter=4.0)
    found = _assessed(
        _history(pull=_uniaxial([800e6])), Spectrum({"pull": 1.0}), FatigueMaterial(curve)
    )
    early, middle, late = found.lives
    assert early is not None
    assert middle is not None
    assert late is not None
    assert late / early == pytest.approx(4.0)
    assert middle == pytest.approx(np.sqrt(early * late))
    assert found.life == pytest.approx(middle)


@each(
    ("rule", "parameter", "expected"),
    [
        ("none", 0.0, 100.0),
        ("fkm", 0.3, 130.0),  # stress ratio 0: (1 + M) S_a
        ("goodman", 500.0, 125.0),
        ("swt", 0.0, np.sqrt(2.0) * 100.0),
        ("walker", 0.4, 100.0 * 2.0**0.6),
    ],
)
def test_mean_stress_of_pulsating_tension(
    rule: MeanStress, parameter: float, expected: float
) -> None:
    curve = SnCurve((300.0, 1e6), 5.0, rule=rule, parameter=parameter)
    both = np.array([100.0])
    assert curve.equivalent(both, both) == pytest.approx(expected)
    assert curve.equivalent(both, 0.0 * both) == pytest.approx(100.0)


@each("direction", [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0)])
@each("course", [[700e6, -700e6], [900e6], [800e6, 100e6, 500e6]])
def test_critical_plane_and_signed_von_mises_agree_in_tension(
    direction: Direction, course: list[float]
) -> None:
    curve = SnCurve((300e6, 1e6), 5.0, rule="fkm", parameter=0.3)
    history = _history(pull=_uniaxial(course, direction))
    material = FatigueMaterial(curve, 0.3)
    one, other = (
        _assessed(history, Spectrum({"pull": 1.0}, method), material)
        for method in ("signed-von-mises", "critical-plane")
    )
    # The grid of planes misses the largest value by a little, never exceeds it at ratios -1 and 0.
    assert other.amplitudes[0] == pytest.approx(one.amplitudes[0], rel=5e-3)


def test_alternating_torsion_has_its_whole_range_on_the_critical_plane() -> None:
    shear = np.zeros((2, 6))
    shear[:, 3] = [100.0, -100.0]
    k = findley_k(0.3)
    worst = worst_plane([shear], Flight((0,), 1), k, SnCurve((50.0, 1e6), 5.0).life())
    expected = 2.0 * 100.0 * np.hypot(1.0, k) / (k + np.hypot(1.0, k))
    assert worst.equivalent.max() == pytest.approx(expected, rel=5e-3)


@each("direction", [(1.0, 0.0, 0.0), (0.3, -0.5, 0.8), (-0.7, 0.2, 0.4)])
def test_the_critical_plane_of_alternating_tension(direction: Direction) -> None:
    """Findley's f, S / 2 sin 2 phi + k S cos^2 phi at phi between force and normal, is largest
    where tan 2 phi = 1 / k, and found to within 0.1 degrees, the last step of the search.
    """
    k, stress = findley_k(0.3), _uniaxial([100.0, -100.0], direction)
    worst = worst_plane([stress], Flight((0,), 1), k, SnCurve((50.0, 1e6), 5.0).life())
    along = abs(worst.normal @ np.array(direction)) / np.linalg.norm(direction)
    phi = math.degrees(math.acos(along))
    assert phi == pytest.approx(math.degrees(0.5 * math.atan(1.0 / k)), abs=0.1)


def test_every_plane_has_one_of_the_grid_beside_it() -> None:
    """At most 0.75 steps from any direction, either way; its frames are orthonormal."""
    frames = _grid()
    product = frames @ frames.swapaxes(-1, -2)
    assert product == pytest.approx(np.broadcast_to(np.eye(3), product.shape), abs=1e-12)
    any_ = np.random.default_rng(5).standard_normal((2000, 3))
    any_ /= np.linalg.norm(any_, axis=1)[:, None]
    nearest = np.abs(any_ @ frames[:, 0, 0].T).max(axis=1)
    assert np.degrees(np.arccos(nearest.min())) < 0.75 * PLANE_STEP


def test_the_search_finds_what_a_fine_grid_finds() -> None:
    """A random walk of all components, on the worst plane and direction of a grid of 2 degrees
    (python -m benchmarks planes has the grid): 0.3 % less is allowed. 3.6 % less was found from
    planes that are larger than all within 13.5 degrees.
    """
    rng = np.random.default_rng(1)
    cases = [150e6 * np.cumsum(rng.standard_normal((12, 6)), axis=0) for _ in range(2)]
    plane = np.array([[0.96793213, -0.24133259, 0.06975647]])
    way = np.array([[0.15593503, 0.79490497, 0.58635344]])
    order, k, life = Flight((0, 1, 1), 2), findley_k(0.3), SnCurve((300e6, 1e6), 5.0).life()
    there = float(on_planes(cases, order, (plane, way), k, life).damage[0])
    found = float(life.damage(worst_plane(cases, order, k, life).equivalent).sum())
    assert found > 0.997 * there


def test_academic_example_of_the_guideline() -> None:
    # FKM nonlinear (2019), 2.7.1: P_RAM 13,935 cycles, 3,483 repetitions.
    loads = np.array([100.0, -200.0, 100.0, -250.0, 200.0, 0.0, 200.0, -200.0])
    material = FkmMaterial("Steel", 600e6, 250e-6, 3.5, 339.4e-6, 2.0 / 15e-3)
    found = p_ram_life(1.4e6 * loads, material, 7.2e-5, (2.5, 14e6))
    assert found.cycles == pytest.approx(13_935, rel=0.01)
    assert found.repetitions == pytest.approx(3_483, rel=0.01)


def test_notched_shaft_of_the_guideline() -> None:
    # FKM nonlinear (2019), 2.7.2: P_RAM 624.65 cycles, 69 repetitions.
    parts = np.array([0.3, 0.5, 0.6, 0.3, 0.7, 0.2, 0.6, 0.8, 0.8])
    sequence = 1266.25e6 * np.stack([parts, -parts], axis=1).ravel()
    material = FkmMaterial("Steel", 1251e6, 200e-6, 3.5, 4.71e-6, 2.0 / 0.5e-3)
    found = p_ram_life(sequence, material, 7.2e-5)
    assert found.cycles == pytest.approx(624.65, rel=0.01)
    assert found.repetitions == pytest.approx(69, rel=0.01)
