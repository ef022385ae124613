"""What loads add to the von Mises stress at the governing point, to first order."""

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

FORCE_STEP = 1e-3  # step of a force, of the largest
AXIS_NAMES = "xyz"
PARITY_MASKS = COSINE_COMPONENTS.astype(np.float64), 1.0 - COSINE_COMPONENTS
By = dict[tuple[str, str], float]


@dataclass(frozen=True)
class Wave:
    """What goes as cos (part 0), or as sin (1), of psi at the governing angle, of one harmonic:
    amounts of unit loads, and what each stress (6,) of it adds to von Mises.
    """

    n: int
    part: int
    amounts: dict[UnitLoad, float]
    weight: Floats


def waves_of(
    at: dict[UnitLoad, Floats], loads: PinLoads, top: Crest
) -> tuple[tuple[Wave, ...], Floats]:
    """At the governing angle, without those that add nothing; and the gradient (6,) of von Mises
    stress there. at: stress (6,) Pa of each unit load at the governing point.
    """
    acting = loads.coefficients()
    amounts: dict[tuple[int, int], dict[UnitLoad, float]] = {}
    for load, both in acting.items():
        for part, amount in enumerate(rotated(load.n, both[0], top.angle).tolist()):
            if amount:
                amounts.setdefault((load.n, part), {})[load] = amount
    stress = np.zeros(6)
    for (_, part), mine in amounts.items():
        for load, x in mine.items():
            stress += x * PARITY_MASKS[part] * at[load]
    weight = von_mises_gradient(stress)
    found = sorted(amounts.items(), key=lambda item: item[0])
    waves = tuple(Wave(n, part, mine, PARITY_MASKS[part] * weight) for (n, part), mine in found)
    return waves, weight


def rotated(n: int, both: Floats, angle: float) -> Floats:
    """Of a load's phases, (2, ..), what goes as BACK does and what as the others do, (2, ..), at an
    angle (rad).
    """
    c, s = np.cos(n * angle), np.sin(n * angle)
    return np.asarray(np.stack([both[0] * c + both[1] * s, both[0] * s - both[1] * c]))


def von_mises_gradient(stress: Floats) -> Floats:
    """(6,) of stress (6,) Pa: rr, tt, zz, tz, rz, rt; zero of none."""
    normal, shear = stress[:3], stress[3:]
    deviator = normal - normal.mean()
    value = np.sqrt(1.5 * (deviator @ deviator + 2.0 * shear @ shear))
    return np.concatenate([1.5 * deviator, 3.0 * shear]) / (value or 1.0)


def by_loads(
    at: dict[UnitLoad, Floats], loads: PinLoads, weight: Floats, top: Crest
) -> tuple[By, By]:
    """Pa/N and Pa/(N m) of forces and moments, by surface and axis, of the loads that were solved
    in any case.
    """
    found: tuple[By, By] = {}, {}
    before = loads.coefficients()
    for kind, given in enumerate((loads.forces, loads.moments)):
        step = FORCE_STEP * (float(np.abs(given).max()) or 1.0)
        for c, surface in enumerate(loads.surfaces):
            if loads.distribution == "cosine" and not loads.forces[0, c, :2].any():
                continue  # a pressure that comes from anywhere
            for a, axis in enumerate(AXIS_NAMES):
                one = np.zeros_like(given)
                one[:, c, a] = 1.0
                stress = partial(_of_change, at, (loads, before), (weight, top.angle), (kind, one))
                if np.isfinite(derivative := float(rate(stress, step))):
                    found[kind][surface, axis] = derivative
    return found


def _of_change(
    at: dict[UnitLoad, Floats],
    given: tuple[PinLoads, Mapping[UnitLoad, Floats]],
    where: tuple[Floats, float],
    change: tuple[int, Floats],
    times: float,
) -> Floats:
    """What is added to von Mises stress, () Pa, at an angle with a gradient, by `times` more of a
    force (0) or moment (1); NaN where it was not solved.
    """
    (weight, angle), (kind, one), (loads, before) = where, change, given
    if kind:
        more = replace(loads, moments=loads.moments + times * one)
    else:
        more = replace(loads, forces=loads.forces + times * one)
    now, total = more.coefficients(), np.zeros(6)
    none = np.zeros((1, 2))
    for load in dict.fromkeys([*now, *before]):
        parts = rotated(load.n, now.get(load, none)[0] - before.get(load, none)[0], angle)
        if load not in at:
            total += np.nan if parts.any() else 0.0
            continue
        for part, mask in zip(parts, PARITY_MASKS, strict=True):
            total += part * mask * at[load]
    return np.array(weight @ total)
