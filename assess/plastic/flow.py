"""Von Mises plasticity with isotropic hardening at a point: radial return, consistent tangent.

The yield stress grows with the plastic strain a along straight pieces, so s(a) + 3 G a does too,
and the condition for the plastic strain after a step, s(a) + 3 G a = q + 3 G a0 with the Mises
stress q of the trial state, is solved exactly by looking it up. The step is fully implicit.

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

# Part of the elastic stiffness in the tangent: keeps it positive definite at the limit load, where
# Newton's method then converges linearly, by this ratio. The solution does not depend on it.
ELASTIC_SHARE = 1e-6
VOIGT_WEIGHTS = np.array(
    [1.0, 1.0, 1.0, 2.0, 2.0, 2.0]
)  # shears count twice in a product of tensors
_IDENTITY = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
DEVIATOR = np.diag([1.0, 1.0, 1.0, 0.5, 0.5, 0.5]) - np.outer(_IDENTITY, _IDENTITY) / 3.0


class Flow(NamedTuple):
    """Of points (...): stress (..., 6) Pa, plastic strain (..., 6), equivalent plastic strain
    (...), and their tangent (..., 6, 6) Pa for strains with doubled shears.
    """

    stress: Floats
    plastic: Floats
    equivalent: Floats
    tangent: Floats


@dataclass(frozen=True)
class FlowRule:
    """An elastic-plastic material; without hardening its yield stress stays as it is.

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
        """Equivalent plastic strain and yield stress (Pa) where straight pieces meet; constant
        after the last.
        """
        strength = self.material.yield_strength
        assert strength is not None
        points = np.array([(0.0, strength), *self.material.hardening])
        strain = np.append(points[:, 0], points[-1, 0] + 1e6)
        return strain, np.append(points[:, 1], points[-1, 1])

    @property
    def strongest(self) -> float:
        """Largest yield stress, Pa."""
        return float(self.curve[1][-1])

    def step(self, strain: Floats, plastic: Floats, equivalent: Floats) -> Flow:
        """After a step to a strain (..., 6) with tensor shears from a plastic strain (..., 6) and
        an equivalent plastic strain (...).
        """
        shear = self.material.lame[1]
        trial = self.material.stress(strain - plastic)
        pressure = trial[..., :3].sum(-1, keepdims=True) / 3.0
        deviator = trial - pressure * _IDENTITY
        mises = np.sqrt(1.5 * (deviator**2 @ VOIGT_WEIGHTS))
        strains, stresses = self.curve
        line = stresses + 3.0 * shear * strains
        driving = mises + 3.0 * shear * equivalent
        after = np.maximum(np.interp(driving, line, strains), equivalent)
        left = np.where(after > equivalent, np.interp(after, strains, stresses), mises)
        ratio = np.divide(left, mises, out=np.ones_like(mises), where=mises > 0.0)
        unit = deviator / np.where(mises > 0.0, mises, 1.0)[..., None]
        slope = np.append(np.diff(stresses) / np.diff(strains), 0.0)
        piece = np.searchsorted(line, driving, side="right") - 1
        hardening = slope[np.maximum(piece, 0)]
        flowing = after > equivalent
        normal = np.where(flowing, ratio - hardening / (3.0 * shear + hardening), 0.0)
        flow = 1.5 * (after - equivalent)[..., None] * unit
        return Flow(
            stress=ratio[..., None] * deviator + pressure * _IDENTITY,
            plastic=plastic + flow,
            equivalent=after,
            tangent=self._tangent(ratio, normal, unit),
        )

    def _tangent(self, ratio: Floats, normal: Floats, unit: Floats) -> Floats:
        """ratio, normal: parts of the elastic shear stiffness of all deviators, and that is missing
        along the flow; unit: deviators (..., 6) of a Mises stress of one.
        """
        lam, shear = self.material.lame
        bulk = lam + 2.0 * shear / 3.0
        elastic = bulk * np.outer(_IDENTITY, _IDENTITY) + 2.0 * shear * DEVIATOR
        along = unit[..., :, None] * (3.0 * shear * normal[..., None, None] * unit[..., None, :])
        softer = elastic - 2.0 * shear * (1.0 - ratio)[..., None, None] * DEVIATOR - along
        return np.asarray((1.0 - ELASTIC_SHARE) * softer + ELASTIC_SHARE * elastic)

    def dissipation(self, strain: Floats) -> Floats:
        """Largest work per volume (...), Pa, that flow by a strain (..., 6) can take: of its
        deviator.
        """
        deviator = strain - strain[..., :3].mean(-1, keepdims=True) * _IDENTITY
        return np.asarray(self.strongest * np.sqrt(2.0 / 3.0 * (deviator**2 @ VOIGT_WEIGHTS)))
