"""Item 6: rules of fatigue that cannot see a history, and planes that were not looked at.

Alternating torsion had half its amplitude by `signed-von-mises` (in pure shear the sign was always
positive) and none by `fkm-p-ram`; components 90 degrees out of phase had a third of the damage that
the critical plane finds. Nothing warned. The critical plane itself was looked for on twelve planes
and directions, which missed up to 61 % of the damage.

Independent values: torsion by Mohr's circle (von Mises stress sqrt(3) tau) and the S-N curve by
hand; P_RAM by the same course in tension, whose sign was never in doubt; planes by the components
of stress on a grid of 2 degrees, written down here, with ranges of shear stress in place of a count
as there are no more than two cases; counts of many planes by pyLife's rainflow, plane by plane.
"""

from __future__ import annotations

import numpy as np
import pytest

from assess.fatigue.assess import FatigueMaterial, Spectrum, assess
from assess.fatigue.critical_plane import _counted, findley_k, worst_plane
from assess.fatigue.critical_points import signed_von_mises
from assess.fatigue.fkm import FkmMaterial, p_ram_life
from assess.fatigue.flight import Flight, flight
from assess.fatigue.many_planes import on_planes
from assess.fatigue.proportional import SIGNED_SHEAR_RULE
from assess.fatigue.records import CaseHistory, PointFatigue, PointHistory
from assess.fatigue.sn_curve import SnCurve
from fea.core.voigt import TENSOR_TO_VOIGT
from pinbase.arrays import Floats
from pinbase.errors import ArgumentError
from tests.support.each import each

CURVE = SnCurve((200e6, 1e6), 5.0, scatter=3.0, rule="fkm", parameter=0.25)
STEEL = FatigueMaterial(CURVE, 0.25, FkmMaterial("Steel", 1000e6, 6.3e-6, 1.7))
ALONG, SHEAR = 2, 3  # zz and yz


def _history(**cases: Floats) -> PointHistory:
    found = []
    for name, stress in cases.items():
        signed = signed_von_mises(stress)
        found.append(CaseHistory(name, None, stress, abs(signed), signed))
    return PointHistory("P", 1, (0.0, 0.0, 0.0), "here", tuple(found))


def _component(values: Floats | list[float], component: int) -> Floats:
    stress = np.zeros((len(values), 6))
    stress[:, component] = values
    return stress


def _assessed(
    history: PointHistory, method: str, material: FatigueMaterial = STEEL
) -> PointFatigue:
    once = dict.fromkeys((case.case for case in history.cases), 1.0)
    found = assess(history, Spectrum(once, method), material)  # type: ignore[arg-type]
    assert found is not None
    return found


TORSION = _history(plus=_component([287e6], SHEAR), minus=_component([-287e6], SHEAR))
VON_MISES = np.sqrt(3.0) * 287e6  # 497 MPa
TURN = np.linspace(0.0, 2.0 * np.pi, 25)
OUT_OF_PHASE = _history(
    turn=_component(400e6 * np.cos(TURN), ALONG)
    + _component(400e6 / np.sqrt(3.0) * np.sin(TURN), SHEAR)
)


def test_alternating_torsion_has_its_whole_range() -> None:
    found = _assessed(TORSION, "signed-von-mises")
    assert (found.amplitude, found.mean) == pytest.approx((VON_MISES, 0.0))
    assert found.life == pytest.approx(1e6 * (VON_MISES / 200e6) ** -5)
    assert found.method == "signed-von-mises"
    assert SIGNED_SHEAR_RULE in found.note


def test_alternating_torsion_by_local_strains_is_that_of_the_same_tension() -> None:
    assert STEEL.fkm is not None
    tension = p_ram_life(np.array([0.0, VON_MISES, -VON_MISES, 0.0]), STEEL.fkm)
    assert not tension.infinite
    found = _assessed(TORSION, "fkm-p-ram")
    assert found.life == pytest.approx(tension.repetitions, rel=1e-6)


def test_torsion_in_one_direction_is_as_before() -> None:
    pulse = _history(plus=_component([-500e6], SHEAR))
    found = _assessed(pulse, "signed-von-mises")
    size = 0.5 * np.sqrt(3.0) * 500e6
    assert (found.amplitude, found.mean) == pytest.approx((size, size))


@pytest.mark.parametrize("method", ["signed-von-mises", "fkm-p-ram"])
def test_out_of_phase_the_critical_plane_is_taken_and_it_is_said(method: str) -> None:
    found = _assessed(OUT_OF_PHASE, method)
    plane = _assessed(OUT_OF_PHASE, "critical-plane")
    assert (found.damage, found.method) == (plane.damage, "critical-plane")
    assert f"{method} cannot see" in found.note
    # Once around, by hand on the grid: the shear stress in every direction is a sine, whose cycle
    # has its amplitude at least, and the largest normal stress is that of the cosine and the sine.
    k, (normals, ways) = findley_k(0.25), _grid(4.0)
    shear, normal = _on(OUT_OF_PHASE.cases[0].stress, normals, ways)
    findley = 0.5 * np.ptp(shear, axis=1) + k * normal.max(axis=1)
    least = (2.0 / (k + np.hypot(1.0, k)) * findley.max() / 200e6) ** 5 / 1e6
    assert found.damage >= 0.995 * least


@pytest.mark.parametrize("method", ["signed-von-mises", "fkm-p-ram"])
def test_torsion_with_a_steady_tension_is_not_taken_for_constant(method: str) -> None:
    """Its von Mises stress never changes, and its sign neither: half of its cycles were none."""
    course = _component([200e6] * 20, ALONG) + _component([300e6, -300e6] * 10, SHEAR)
    found = _assessed(_history(both=course), method)
    assert found.method == "critical-plane"
    assert found.counts.sum() >= 10.0


def test_a_history_that_no_rule_can_see_is_refused() -> None:
    for material in (FatigueMaterial(fkm=STEEL.fkm), FatigueMaterial(CURVE, None, STEEL.fkm)):
        with pytest.raises(ArgumentError, match="not proportional") as caught:
            _assessed(OUT_OF_PHASE, "fkm-p-ram", material)
        assert caught.value.code == "unseen-history"


def test_a_small_stress_is_harmless_in_every_direction() -> None:
    small = _history(turn=0.05 * OUT_OF_PHASE.cases[0].stress)
    found = _assessed(small, "fkm-p-ram", FatigueMaterial(fkm=STEEL.fkm))
    assert (found.damage, found.method) == (0.0, "fkm-p-ram")


def test_tension_before_torsion_does_damage_below_the_knee() -> None:
    """A tension of 0.86 of the knee, then torsion either way of as much von Mises stress: on the
    plane across the tension f is that of 1.11 of the knee in alternating tension.
    """
    small, k = 0.86 * CURVE.knee[0], findley_k(0.25)
    course = _component([small, 0.0, 0.0], ALONG)
    course += _component([0.0, small / np.sqrt(3.0), -small / np.sqrt(3.0)], SHEAR)
    found = _assessed(_history(both=course), "signed-von-mises")
    least = 2.0 / (k + np.hypot(1.0, k)) * (small / np.sqrt(3.0) + k * small)
    assert least > 1.1 * CURVE.knee[0]
    assert found.amplitudes[0] >= 0.999 * least
    assert found.method == "critical-plane"
    assert found.damage > 0.0


def test_a_proportional_history_stays_with_its_rule() -> None:
    rng = np.random.default_rng(2)
    courses = {name: rng.normal(size=7) * 300e6 for name in "abc"}
    tensor = np.array([20.0, 10.0, 100.0, 5.0, 3.0, 1.0]) / 100.0
    history = _history(**{name: np.outer(course, tensor) for name, course in courses.items()})
    found = _assessed(history, "signed-von-mises")
    assert (found.method, found.note) == ("signed-von-mises", "here")


def _grid(step: float) -> tuple[Floats, Floats]:
    """Normals and directions in planes (M, 3), `step` degrees apart."""
    normals, ways = [], []
    for a in np.radians(np.arange(0.0, 90.1, step)):
        count = max(1, round(360.0 * np.sin(a) / step))
        for b in 2.0 * np.pi * np.arange(count) / count:
            along = np.array([np.cos(b) * np.cos(a), np.sin(b) * np.cos(a), -np.sin(a)])
            across = np.array([-np.sin(b), np.cos(b), 0.0])
            turns = np.radians(np.arange(0.0, 180.0, step))[:, None]
            ways.append(np.cos(turns) * along + np.sin(turns) * across)
            normal = np.array([np.cos(b) * np.sin(a), np.sin(b) * np.sin(a), np.cos(a)])
            normals.append(np.broadcast_to(normal, ways[-1].shape))
    return np.concatenate(normals), np.concatenate(ways)


def _on(stress: Floats, normals: Floats, ways: Floats) -> tuple[Floats, Floats]:
    """Shear and normal stress (M, T) by the tensor's definition."""
    across = np.stack([normals @ tensor for tensor in stress[:, TENSOR_TO_VOIGT]])  # (T, M, 3)
    return np.einsum("tma,ma->mt", across, ways), np.einsum("tma,ma->mt", across, normals)


@each("seed", range(3))
def test_the_worst_of_all_planes_is_found_without_mean_stress(seed: int) -> None:
    """Two static cases: shear stresses of opposite sign make one cycle, others two."""
    rng = np.random.default_rng(seed)
    one, two = 400e6 * rng.normal(size=(2, 1, 6))
    life = SnCurve((200e6, 1e6), 6.0, 11.0).life()
    shear, _ = _on(np.concatenate([one, two]), *_grid(2.0))
    a, b = shear.T
    ranges = np.where(a * b < 0.0, np.stack([np.abs(a - b), 0.0 * a]), np.abs([a, b]))
    ratio = ranges / 200e6  # equivalent amplitude: twice half the range
    damage = (np.where(ratio >= 1.0, ratio**6, ratio**11) / 1e6).sum(axis=0).max()
    found = worst_plane([one, two], Flight((0, 1), 1), 0.0, life)
    assert life.damage(found.equivalent).sum() >= 0.995 * damage


def test_the_worst_of_all_planes_is_found_with_mean_stress() -> None:
    stress = np.array([[300e6, -100e6, 200e6, 150e6, -80e6, 220e6]])
    k, life = 0.3, SnCurve((200e6, 1e6), 8.0).life()
    shear, normal = _on(stress, *_grid(2.0))
    findley = 0.5 * np.abs(shear) + k * np.maximum(normal, 0.0)
    ratio = 2.0 / (k + np.hypot(1.0, k)) * findley.max() / 200e6
    found = worst_plane([stress], Flight((0,), 1), k, life)
    damage = life.damage(found.equivalent).sum()
    assert damage == pytest.approx(ratio**8 / 1e6, rel=5e-3)


def test_cycles_of_many_planes_are_those_of_each_by_pylife() -> None:
    rng = np.random.default_rng(5)
    order = flight([2.0, 0.25, 7.0])
    cases = [100e6 * rng.normal(size=(n, 6)).cumsum(axis=0) for n in (30, 1, 12)]
    zero = np.zeros((1, 6))
    tensors = [np.concatenate([zero, stress, zero])[:, TENSOR_TO_VOIGT] for stress in cases]
    normals, ways = (x[::97] for x in _grid(15.0))
    life = CURVE.life(0.1)
    found = on_planes(cases, order, (normals, ways), 0.2, life)
    for j, plane in enumerate(zip(normals, ways, strict=True)):
        counted = _counted(tensors, order, plane, 0.2)
        assert found.damage[j] == pytest.approx(
            CURVE.damage(counted.equivalent, 1.0, 0.1), rel=1e-3
        )
        assert found.largest[j] == pytest.approx(counted.equivalent.max(), rel=1e-4)
