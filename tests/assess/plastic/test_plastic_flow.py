"""The material point: uniaxial paths are exact, and the tangent is the derivative of the stress."""

import numpy as np
import pytest

from assess.plastic.flow import Flow, FlowRule
from fea.core.material import Material
from geometry import ArgumentError
from tests.support.each import each

Points = tuple[tuple[float, float], ...]

E, NU, YIELD = 200e9, 0.3, 250e6
PERFECT = FlowRule(Material("steel", E, NU, None, YIELD))
HARD = FlowRule(Material("steel", E, NU, None, YIELD, hardening=((0.01, 350e6), (0.05, 400e6))))


def _uniaxial(rule: FlowRule, total: float) -> Flow:
    """Stress along x at a strain along x, with the strains across that leave no stress there."""
    across = -0.5 * total
    for _ in range(60):
        found = rule.step(
            np.array([total, across, across, 0.0, 0.0, 0.0]), np.zeros(6), np.array(0.0)
        )
        slope = found.tangent[1, 1] + found.tangent[1, 2]
        across -= found.stress[1] / slope
    return found


@each("rule", [PERFECT, HARD])
@each("plastic", [0.0, 0.004, 0.03, 0.2])
def test_a_uniaxial_path_is_exact(rule: FlowRule, plastic: float) -> None:
    stress = np.interp(plastic, *rule.curve)
    found = _uniaxial(rule, plastic + stress / E)
    assert found.stress[0] == pytest.approx(stress, rel=1e-6)
    assert np.abs(found.stress[1:]).max() < 1e-4 * stress
    assert found.equivalent == pytest.approx(plastic, rel=1e-4, abs=1e-12)


@pytest.mark.parametrize("rule", [PERFECT, HARD])
def test_the_tangent_is_the_derivative_of_the_stress(rule: FlowRule) -> None:
    rng = np.random.default_rng(1)
    strain = rng.normal(size=(40, 6)) * 3e-3
    before = rule.step(rng.normal(size=(40, 6)) * 2e-3, np.zeros((40, 6)), np.zeros(40))
    now = rule.step(strain, before.plastic, before.equivalent)
    assert (now.equivalent > before.equivalent).sum() > 10
    h = 1e-9
    for column in range(6):
        moved = strain.copy()
        moved[:, column] += h / (1.0 if column < 3 else 2.0)
        after = rule.step(moved, before.plastic, before.equivalent)
        slope = (after.stress - now.stress) / h
        assert np.abs(slope - now.tangent[:, :, column]).max() < 2e-5 * E


def test_stress_stays_on_the_yield_surface_and_never_flows_back() -> None:
    rng = np.random.default_rng(2)
    state = HARD.step(np.zeros((50, 6)), np.zeros((50, 6)), np.zeros(50))
    for _ in range(20):
        after = HARD.step(rng.normal(size=(50, 6)) * 2e-3, state.plastic, state.equivalent)
        deviator = after.stress.copy()
        deviator[:, :3] -= deviator[:, :3].mean(axis=1, keepdims=True)
        mises = np.sqrt(1.5 * (deviator**2 @ [1, 1, 1, 2, 2, 2]))
        assert (mises <= np.interp(after.equivalent, *HARD.curve) * (1 + 1e-9)).all()
        assert (after.equivalent >= state.equivalent).all()
        assert np.abs(after.plastic[:, :3].sum(axis=1)).max() < 1e-15
        state = after


def test_a_material_without_yield_strength_does_not_flow() -> None:
    with pytest.raises(ArgumentError) as error:
        FlowRule(Material("glass", E, NU))
    assert error.value.code == "no-yield-strength"


@each("points", [((0.0, 300e6),), ((0.02, 300e6), (0.01, 310e6)), ((0.01, 200e6),)])
def test_hardening_that_softens_or_returns_is_refused(
    points: Points,
) -> None:
    with pytest.raises(ArgumentError) as error:
        Material("steel", E, NU, None, YIELD, hardening=points)
    assert error.value.code == "bad-hardening"
