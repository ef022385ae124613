"""Von Mises plasticity with isotropic hardening at a point: radial return, consistent tangent.

The yield stress s is a piecewise linear function of the equivalent plastic strain a, and so is
s(a) + 3 G a. The condition for a after a step, s(a) + 3 G a = q + 3 G a0 with the von Mises stress
q of the trial state, is therefore solved exactly by interpolation. The step is fully implicit.

Source: J. C. Simo, T. J. R. Hughes, Computational Inelasticity (1998), boxes 3.1 and 3.2.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from fea.core.material import Material
from geometry import ArgumentError
from pinbase.arrays import Floats

# Share of the elastic stiffness in the tangent. It keeps the tangent positive definite at the limit
# load, where Newton's method then converges linearly with this ratio. The solution is unaffected.
ELASTIC_SHARE = 1e-6
# Shear components count twice in the inner product of two tensors.
VOIGT_WEIGHTS = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])
_IDENTITY = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
DEVIATOR = np.diag([1.0, 1.0, 1.0, 0.5, 0.5, 0.5]) - np.outer(_IDENTITY, _IDENTITY) / 3.0


class Flow(NamedTuple):
    """The state of points (...) after a step.

    stress: (..., 6) Pa.
    plastic: plastic strain (..., 6) with tensor shears.
    equivalent: equivalent plastic strain (...).
    tangent: (..., 6, 6) Pa, consistent with the step, for strains with engineering shears.
    """

    stress: Floats
    plastic: Floats
    equivalent: Floats
    tangent: Floats


@dataclass(frozen=True)
class FlowRule:
    """The flow rule of an elastic-plastic material; without hardening the yield stress is constant.

    Raises: ArgumentError for a material without a yield strength.
    """

    material: Material

    def __post_init__(self) -> None:
        if self.material.yield_strength is None:
            raise ArgumentError(
                f"material {self.material.name} has no yield strength, which a limit load needs",
                "no-yield-strength",
            )

    @cached_property
    def curve(self) -> tuple[Floats, Floats]:
        """The equivalent plastic strains and yield stresses (Pa) at the ends of the linear pieces.

        The yield stress is constant beyond the last point.
        """
        strength = self.material.yield_strength
        assert strength is not None
        points = np.array([(0.0, strength), *self.material.hardening])
        strain = np.append(points[:, 0], points[-1, 0] + 1e6)
        return strain, np.append(points[:, 1], points[-1, 1])

    @property
    def strongest(self) -> float:
        """The largest yield stress, Pa."""
        return float(self.curve[1][-1])

    def step(self, strain: Floats, plastic: Floats, equivalent: Floats) -> Flow:
        """Return the state after a fully implicit step to a total strain, by radial return.

        strain: (..., 6) total, with tensor shears, at the end of the step.
        plastic: (..., 6) plastic strain at its start.
        equivalent: (...) equivalent plastic strain at its start.

        Source: Simo & Hughes, boxes 3.1 and 3.2.
        """
        shear = self.material.lame[1]
        # Elastic predictor: no plastic flow in the step. Plastic flow then changes only the
        # deviator.
        trial = self.material.stress(strain - plastic)
        pressure = trial[..., :3].sum(-1, keepdims=True) / 3.0
        deviator = trial - pressure * _IDENTITY
        mises = np.sqrt(1.5 * (deviator**2 @ VOIGT_WEIGHTS))
        # Plastic corrector: s(a) + 3 G a = q + 3 G a0 for the equivalent plastic strain a at the
        # end. The left side is piecewise linear and rises, so interpolation inverts it exactly;
        # where the trial state is below yield, a stays at a0.
        strains, stresses = self.curve
        line = stresses + 3.0 * shear * strains
        driving = mises + 3.0 * shear * equivalent
        after = np.maximum(np.interp(driving, line, strains), equivalent)
        yield_stress = np.where(after > equivalent, np.interp(after, strains, stresses), mises)
        # The deviator returns radially: it keeps its direction and shrinks to the yield stress.
        remaining = np.divide(yield_stress, mises, out=np.ones_like(mises), where=mises > 0.0)
        direction = deviator / np.where(mises > 0.0, mises, 1.0)[..., None]
        # Consistent tangent: the slope H of the hardening piece on which the step ends.
        slope = np.append(np.diff(stresses) / np.diff(strains), 0.0)
        piece = np.searchsorted(line, driving, side="right") - 1
        hardening = slope[np.maximum(piece, 0)]
        flowing = after > equivalent
        normal = np.where(flowing, remaining - hardening / (3.0 * shear + hardening), 0.0)
        # Plastic strain grows along the deviator (normality); 3/2 relates it to the equivalent one.
        flow = 1.5 * (after - equivalent)[..., None] * direction
        return Flow(
            stress=remaining[..., None] * deviator + pressure * _IDENTITY,
            plastic=plastic + flow,
            equivalent=after,
            tangent=self._tangent(remaining, normal, direction),
        )

    def _tangent(self, ratio: Floats, normal: Floats, unit: Floats) -> Floats:
        """Return the consistent tangent (..., 6, 6), Pa, for strains with engineering shears.

        ratio: (...) part of the elastic shear stiffness that remains for all deviators.
        normal: (...) additional part that is lost in the direction of flow.
        unit: (..., 6) deviators scaled to a von Mises stress of 1.
        """
        lam, shear = self.material.lame
        bulk = lam + 2.0 * shear / 3.0
        elastic = bulk * np.outer(_IDENTITY, _IDENTITY) + 2.0 * shear * DEVIATOR
        along = unit[..., :, None] * (3.0 * shear * normal[..., None, None] * unit[..., None, :])
        softer = elastic - 2.0 * shear * (1.0 - ratio)[..., None, None] * DEVIATOR - along
        return np.asarray((1.0 - ELASTIC_SHARE) * softer + ELASTIC_SHARE * elastic)

    def dissipation(self, strain: Floats) -> Floats:
        """Return the largest plastic work per volume (...), Pa, of a strain increment (..., 6).

        The work is the largest yield stress times the equivalent strain of the deviator.
        """
        deviator = strain - strain[..., :3].mean(-1, keepdims=True) * _IDENTITY
        return np.asarray(self.strongest * np.sqrt(2.0 / 3.0 * (deviator**2 @ VOIGT_WEIGHTS)))
