"""The equilibrium of an unconstrained pin: the imbalance of its loads, and whether it is solved.

There is one rule for forces and couples, stated only here (MIN_WARNED_IMBALANCE, MAX_IMBALANCE).
The imbalance of the forces is relative to the largest force. A couple across the axis is relative
to that force times the length of the pin, or to the largest given moment if that is larger. A
torque about the axis is relative to the largest torque. Above MIN_WARNED_IMBALANCE there is a
warning; above MAX_IMBALANCE the pin is not solved. Below, its bands share the imbalance
(`fea.core.tractions.closing_tractions`).

Loads that supports carry are not an imbalance (`Carried`). Clamps carry all loads, so that clamped
pins are not checked. Lugs of a structure carry forces across the axis; two of them also carry
couples. A lug whose tilt has a stiffness, or that is guided, carries couples, as in single shear,
unless its link states the moment that it transmits. Where all lugs are free to tilt, contact has no
solution with any couple, except that links which state moments share a small one. Lugs of a
structure also carry axial forces and torques (`fea.support.lugs.axial`); without them, links must
be in balance.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np

from fea.core.pin_loads import PinLoads
from geometry import PinLike
from pinbase.arrays import Floats
from pinbase.keys import key_part, lug_key

# Both limits are chosen by judgement, as fractions of the largest force or torque.
MIN_WARNED_IMBALANCE = 0.01  # a smaller one is round-off of typed numbers
MAX_IMBALANCE = 0.1  # a larger one means that a load or a support is missing
# Fraction of the largest load, or of the force that squeezes the pin, below which an imbalance is
# zero.
BALANCE_NOISE = 1e-9
# Fraction of the largest couple above which lugs that are all free to tilt have no solution.
MAX_FREE_COUPLE = 1e-6
# Fraction of the largest force times the length that may remain if changing one force is enough.
SINGLE_FORCE_TOLERANCE = 1e-6


class Carried(NamedTuple):
    """The kinds of load that supports react, in addition to the small imbalance that bands share.

    force, couple: across the axis.
    along: axial forces and torques.
    lugs: whether lugs hold the pin.
    moments: whether some links state moments across the axis, and so share a small couple.
    """

    force: bool = False
    couple: bool = False
    along: bool = False
    lugs: bool = False
    moments: bool = False


NO_SUPPORT = Carried()


@dataclass(frozen=True)
class Balance:
    """The imbalance of the loads, the largest over all instants.

    force: resultant of the loads, N.
    couple: about the pin's middle, N m.
    largest: largest force in the case, N.
    refusal: reason why the pin cannot be solved; None if it can.
    code: of the refusal.
    left: force, N, couple across the axis and torque, N m, that no support carries.
    shares: the same, relative to the scales of the rule.
    instant: number of the instant at which the largest of the shares occurs.
    """

    force: float
    couple: float
    largest: float
    refusal: str | None
    code: str = ""
    left: tuple[float, ...] = (0.0, 0.0, 0.0)
    shares: tuple[float, ...] = (0.0, 0.0, 0.0)
    instant: int = 0

    @property
    def notable(self) -> bool:
        """Whether the imbalance is more than round-off of typed numbers."""
        return max(self.shares) > MIN_WARNED_IMBALANCE


def out_of_balance(
    pin: PinLike, loads: PinLoads, density: float | None = None, carried: Carried = NO_SUPPORT
) -> Balance:
    """The balance of a pin without clamps under its loads.

    density: kg/m^3; if it is given, the pin's own weight and inertia count.
    carried: kinds of load that the supports react.
    """
    force, couple = _left(pin, loads)
    largest = _largest(loads.forces)
    if density is not None:
        body_force = density * pin.volume * loads.body
        force = force + body_force
        arm = centre_of_volume(pin) - sum(pin.ends) / 2.0
        couple = couple + np.cross([0.0, 0.0, arm], body_force)
        largest = max(largest, _largest(body_force))
    # The scales by which imbalances are measured, and the noise below which they are zero.
    moments = loads.moments
    turning = max(largest * pin.length, _largest(moments[..., :2]))
    twisting = float(np.abs(moments[..., 2]).max(initial=0.0))
    least = BALANCE_NOISE * max(largest, loads.squeezing, _largest(moments) / pin.length)
    across, along = not carried.force, not carried.along
    measures = (
        (np.maximum(across * _size(force[:, :2]), along * np.abs(force[:, 2])), largest, least),
        ((not carried.couple) * _size(couple[:, :2]), turning, least * pin.length),
        (along * np.abs(couple[:, 2]), twisting, least * pin.length),
    )
    over_time = np.array([_over(*x) for x in measures])
    shares = tuple(map(float, over_time.max(axis=1)))
    kind = int(np.argmax(shares))
    refusal, code = _refusal(pin, shares, carried)
    return Balance(
        _largest(force), _largest(couple), largest, refusal, code,
        tuple(float(size.max(initial=0.0)) for size, *_ in measures), shares,
        int(np.argmax(over_time[kind])),
    )  # fmt: skip


def _left(pin: PinLike, loads: PinLoads) -> tuple[Floats, Floats]:
    """The resultant of the forces, (T, 3) N, and the couple about the pin's middle, (T, 3) N m."""
    z = np.array([pin.band(name).middle for name in loads.surfaces]) - sum(pin.ends) / 2.0
    couple = np.cross(z[:, None] * [0.0, 0.0, 1.0], loads.forces) + loads.moments
    return loads.forces.sum(axis=1), couple.sum(axis=1)


def centre_of_volume(pin: PinLike) -> float:
    """The z of the centre of volume, m; for a body from a file the middle of its length."""
    profile = pin.profile
    if profile is None:
        return sum(pin.ends) / 2.0
    area = np.array([s.mean_area for s in profile.segments])
    ends = np.array(profile.stations)
    return float(area @ np.diff(ends**2) / 2.0 / (area @ np.diff(ends)))


def _over(left: Floats, scale: float, least: float) -> Floats:
    """The imbalance (T,) divided by its scale; zero where it is round-off.

    least: imbalance below which it is round-off, in the unit of the imbalance.
    """
    return np.where(left > least, left / max(scale, least, np.finfo(float).tiny), 0.0)


def _refusal(pin: PinLike, shares: tuple[float, ...], carried: Carried) -> tuple[str | None, str]:
    """The reason why a pin with these relative imbalances is not solved, None if it is, and the
    code of the refusal.
    """
    force, couple, torque = shares
    name = f"pin.{key_part(pin.name)}"
    loose, react = "the pin is not clamped and its loads are not in equilibrium: ", "bands react"
    clamp = f"name its clamped surfaces in {name}.clamp"
    if carried.lugs:
        loose, react = "the loads of the pin in its lugs are not in equilibrium: ", "links share"
        clamp = f"load all its links, or {_structure(pin)}"
    elif len(pin.connections) < 2:
        why = "the pin is not clamped and only one connection bears on it, so nothing reacts its "
        return f"{why}load; {clamp}", "one-band"
    if force > MAX_IMBALANCE:
        said = f"their resultant is {force:.2g} of the largest load (its {react} "
        return f"{loose}{said}at most {MAX_IMBALANCE:g}); {clamp}", "force-imbalance"
    if torque > MAX_IMBALANCE:
        said = f"their torque about the axis is {torque:.2g} of the largest applied (its {react} "
        return f"{loose}{said}at most {MAX_IMBALANCE:g}); {clamp}", "torque-imbalance"
    said = f"their couple across the axis is {couple:.2g} of the largest force times the length of "
    most = MAX_IMBALANCE if carried.moments else MAX_FREE_COUPLE + force / 2.0  # links share force
    if carried.lugs and couple > most:
        said += "the pin, which no lug reacts, since all "
        said += "links state moments or " if carried.moments else ""
        said += "are free to tilt; "
        return f"{loose}{said}give a lug the stiffness of its tilt", "couple-imbalance"
    if couple > MAX_IMBALANCE:
        said += f"the pin (its bands react at most {MAX_IMBALANCE:g}); give it lugs, whose tilt "
        return f"{loose}{said}carries couples ({name}.lug), or {clamp}", "couple-imbalance"
    return None, ""


def _structure(pin: PinLike) -> str:
    """The advice to let a structure hold the pin at segments on which no link bears."""
    segments = () if pin.profile is None else pin.profile.segments
    idle = [s.name for s in segments if s.name and s.name not in pin.connections]
    lugs = ", ".join(lug_key(pin.name, name) for name in idle)
    if lugs:
        return f"add a lug for each segment that a structure holds: {lugs}"
    return (
        "name a segment that a structure holds, and give it a lug "
        f"(pin.{key_part(pin.name)}.lug.NAME)"
    )


def balancing_forces(pin: PinLike, loads: PinLoads, instant: int) -> dict[str, Floats] | None:
    """The smallest changes (2,) N of forces across the axis that balance an instant, by surface.

    One force is changed if that is enough, otherwise the two that need the smallest change. The
    result is None where only zero loads, or couples, would balance the instant.
    """
    force, couple = _left(pin, loads.at(np.array([instant])))
    middle = sum(pin.ends) / 2.0
    left = force[0, :2]
    first = np.array([couple[0, 1], -couple[0, 0]])  # sum of z F, including the given couples
    z = {name: pin.band(name).middle - middle for name in loads.surfaces}
    now = dict(zip(loads.surfaces, loads.forces[instant, :, :2], strict=True))
    largest = _largest(loads.forces)
    alone = [
        n
        for n in z
        if np.linalg.norm(z[n] * left - first) <= SINGLE_FORCE_TOLERANCE * largest * pin.length
    ]
    changes = [{name: -left} for name in alone]
    if not changes:
        for a, b in combinations(z, 2):
            if abs(z[a] - z[b]) > BALANCE_NOISE * pin.length:
                at_b = (first - z[a] * left) / (z[a] - z[b])
                changes.append({a: -left - at_b, b: at_b})
    changes = [x for x in changes if _remains(now, x, largest)]
    return min(changes, key=_total, default=None)


def _remains(now: dict[str, Floats], change: dict[str, Floats], largest: float) -> bool:
    """Whether more than a tenth of the largest load remains after a change of forces."""
    after = [force + change.get(name, 0.0) for name, force in now.items()]
    return _largest(np.array(after)) > 0.1 * largest


def _total(change: dict[str, Floats]) -> float:
    """The sum of the sizes of changed forces, N."""
    return sum(float(np.linalg.norm(x)) for x in change.values())


def _size(vectors: Floats) -> Floats:
    """The lengths (...) of vectors (..., 2 or 3)."""
    return np.asarray(np.linalg.norm(vectors, axis=-1))


def _largest(vectors: Floats) -> float:
    """The largest length of vectors (..., 2 or 3)."""
    return float(np.linalg.norm(vectors, axis=-1).max(initial=0.0))
