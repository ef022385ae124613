"""The contribution of each load to the von Mises stress at the governing point, to first order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from fea.core.pin_loads import PinLoads, UnitLoad
from fea.harmonic.five_numbers import COSINE_COMPONENTS
from fea.harmonic.superposition import Crest
from geometry.mesh.outline_motion import rate
from pinbase.arrays import Floats

FORCE_STEP = 1e-3  # of the largest force: step of central differences; chosen by judgement
AXIS_NAMES = "xyz"
PARITY_MASKS = COSINE_COMPONENTS.astype(np.float64), 1.0 - COSINE_COMPONENTS
By = dict[tuple[str, str], float]


@dataclass(frozen=True)
class Wave:
    """One harmonic's part that varies as a cosine (part 0) or as a sine (part 1) about the
    governing angle.

    amounts: the amount of each unit load.
    weight: (6,) derivative of the von Mises stress by the stress components of this part.
    """

    n: int
    part: int
    amounts: dict[UnitLoad, float]
    weight: Floats


def waves_of(
    at: dict[UnitLoad, Floats], loads: PinLoads, top: Crest
) -> tuple[tuple[Wave, ...], Floats]:
    """Return the waves that act at the governing angle, and the gradient (6,) of the von Mises
    stress there by its components. Waves without an amount are left out.

    at: stress (6,), Pa, of each unit load at the governing point.
    """
    acting = loads.coefficients()
    # Loads by harmonic and by the part that varies as cosine or sine at the governing angle.
    amounts: dict[tuple[int, int], dict[UnitLoad, float]] = {}
    for load, both in acting.items():
        for part, amount in enumerate(rotated(load.n, both[0], top.angle).tolist()):
            if amount:
                amounts.setdefault((load.n, part), {})[load] = amount
    stress = np.zeros(6)
    for (_, part), part_amounts in amounts.items():
        for load, x in part_amounts.items():
            stress += x * PARITY_MASKS[part] * at[load]
    weight = von_mises_gradient(stress)
    ordered = sorted(amounts.items(), key=lambda item: item[0])
    waves = tuple(
        Wave(n, part, part_amounts, PARITY_MASKS[part] * weight)
        for (n, part), part_amounts in ordered
    )
    return waves, weight


def rotated(n: int, both: Floats, angle: float) -> Floats:
    """Return the cosine and the sine part, (2, ..), about an angle (rad), of the two phases (2, ..)
    of harmonic n.
    """
    c, s = np.cos(n * angle), np.sin(n * angle)
    return np.asarray(np.stack([both[0] * c + both[1] * s, both[0] * s - both[1] * c]))


def von_mises_gradient(stress: Floats) -> Floats:
    """Return the gradient (6,) of the von Mises stress by the stress components; zero without
    stress.

    stress: (6,) Pa, components rr, tt, zz, tz, rz, rt.
    """
    normal, shear = stress[:3], stress[3:]
    deviator = normal - normal.mean()
    value = np.sqrt(1.5 * (deviator @ deviator + 2.0 * shear @ shear))
    return np.concatenate([1.5 * deviator, 3.0 * shear]) / (value or 1.0)


def by_loads(
    at: dict[UnitLoad, Floats], loads: PinLoads, weight: Floats, top: Crest
) -> tuple[By, By]:
    """Return the derivatives by forces, Pa/N, and by moments, Pa/(N m), by surface and axis.

    A load has a derivative only if all the unit loads that it needs were solved.
    at: as in `waves_of`.
    weight: (6,) gradient of the von Mises stress.
    """
    derivatives: tuple[By, By] = {}, {}
    before = loads.coefficients()
    for kind, vectors in enumerate((loads.forces, loads.moments)):
        step = FORCE_STEP * (float(np.abs(vectors).max()) or 1.0)
        for c, surface in enumerate(loads.surfaces):
            # A cosine pressure without a force has no direction and therefore no derivative.
            if loads.distribution == "cosine" and not loads.forces[0, c, :2].any():
                continue
            for a, axis in enumerate(AXIS_NAMES):
                one = np.zeros_like(vectors)
                one[:, c, a] = 1.0
                stress = partial(_of_change, at, (loads, before), (weight, top.angle), (kind, one))
                if np.isfinite(derivative := float(rate(stress, step))):
                    derivatives[kind][surface, axis] = derivative
    return derivatives


def _of_change(
    at: dict[UnitLoad, Floats],
    base: tuple[PinLoads, Mapping[UnitLoad, Floats]],
    where: tuple[Floats, float],
    change: tuple[int, Floats],
    times: float,
) -> Floats:
    """Return the change of the von Mises stress, Pa, when `times` the vectors of a change are added
    to the forces (kind 0) or to the moments (kind 1); NaN if a needed unit load was not solved.
    """
    (weight, angle), (kind, one), (loads, before) = where, change, base
    if kind:
        changed = replace(loads, moments=loads.moments + times * one)
    else:
        changed = replace(loads, forces=loads.forces + times * one)
    after, total = changed.coefficients(), np.zeros(6)
    none = np.zeros((1, 2))
    for load in dict.fromkeys([*after, *before]):
        parts = rotated(load.n, after.get(load, none)[0] - before.get(load, none)[0], angle)
        if load not in at:
            total += np.nan if parts.any() else 0.0
            continue
        for part, mask in zip(parts, PARITY_MASKS, strict=True):
            total += part * mask * at[load]
    return np.array(weight @ total)
