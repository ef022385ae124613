"""Landing cases prescribed by 14 CFR, with their clauses: part 25, and part 23 before 2017.

Amendment 64 of 2017 removed the cases from part 23.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from pinbase.errors import ArgumentError

M_PER_FOOT = 0.3048
PA_PER_PSF = 4.4482216152605 / M_PER_FOOT**2  # lbf/ft^2 in Pa
# The largest sliding coefficient of a tyre that need be assumed: 25.473(e), appendix D to part 23.
MAX_TYRE_FRICTION = 0.8


@dataclass(frozen=True)
class DropRule:
    """The descent velocity and lift that a clause prescribes for a drop.

    velocity: m/s; None if it follows from the wing loading.
    lift: largest ratio of lift to weight.
    """

    clause: str
    velocity: float | None
    lift: float


DROP_RULES = {
    "25.473-landing-weight": DropRule(
        "14 CFR 25.473(a)(2): 10 ft/s at the design landing weight, lift at most the weight",
        10.0 * M_PER_FOOT,
        1.0,
    ),
    "25.473-take-off-weight": DropRule(
        "14 CFR 25.473(a)(3): 6 ft/s at the design take-off weight, lift at most the weight",
        6.0 * M_PER_FOOT,
        1.0,
    ),
    "25.723-reserve-energy": DropRule(
        "14 CFR 25.723(b): reserve energy, 12 ft/s at the design landing weight, lift at most the "
        "weight; the gear may not fail",
        12.0 * M_PER_FOOT,
        1.0,
    ),
    "23.473": DropRule(
        "14 CFR 23.473(d), (e): 4.4 (W/S)^(1/4) ft/s, from 7 to 10 ft/s, lift at most 2/3 of the "
        "weight",
        None,
        2.0 / 3.0,
    ),
}


@dataclass(frozen=True)
class GroundRule:
    """The load at a wheel that a clause prescribes.

    vertical, drag, side: ratios to the reference load; drag is positive aft, negative forward.
    base: the reference load, LARGEST_REACTION or STATIC_REACTION.
    deflection: deflection of strut and tyre, relative to that at the reference load.
    spins: whether the drag comes from spin-up or spring-back; `drag` is then its limit.
    """

    clause: str
    vertical: float
    drag: float
    side: float
    base: str
    deflection: float = 1.0
    spins: bool = False


LARGEST_REACTION, STATIC_REACTION = "largest vertical reaction", "static load on the wheel"
GROUND_RULES = {
    "25.473-spin-up": GroundRule(
        "14 CFR 25.473, spin-up: the largest vertical reaction with the drag aft of appendix D to "
        "part 23, at most 0.8 of it",
        1.0, MAX_TYRE_FRICTION, 0.0, LARGEST_REACTION, spins=True,
    ),
    "25.473-spring-back": GroundRule(
        "14 CFR 25.473, spring-back: the largest vertical reaction with the spin-up drag of "
        "appendix D to part 23 forward, at most 0.8 of it",
        1.0, -MAX_TYRE_FRICTION, 0.0, LARGEST_REACTION, spins=True,
    ),
    "25.479-drag": GroundRule(
        "14 CFR 25.479(d)(1): the largest vertical reaction with a quarter of it aft",
        1.0, 0.25, 0.0, LARGEST_REACTION,
    ),
    "25.479-drift": GroundRule(
        "14 CFR 25.479(d)(2): 75 % of the largest vertical reaction, with 40 % of that aft and "
        "25 % to the side, at 75 % of the deflection of strut and tyres at that reaction",
        0.75, 0.75 * 0.40, 0.75 * 0.25, LARGEST_REACTION, 0.75,
    ),
    "23.D-spin-up": GroundRule(
        "14 CFR part 23, appendix D, spin-up: the largest vertical reaction with its drag aft, at "
        "most 0.8 of it",
        1.0, MAX_TYRE_FRICTION, 0.0, LARGEST_REACTION, spins=True,
    ),
    "23.D-spring-back": GroundRule(
        "14 CFR part 23, appendix D, spring-back: the largest vertical reaction with the spin-up "
        "drag forward, at most 0.8 of it",
        1.0, -MAX_TYRE_FRICTION, 0.0, LARGEST_REACTION, spins=True,
    ),
    "23.479-drag": GroundRule(
        "14 CFR 23.479(b): the largest vertical reaction with a quarter of it aft, the least drag",
        1.0, 0.25, 0.0, LARGEST_REACTION,
    ),
    "23.499-aft": GroundRule(
        "14 CFR 23.499(a): 2.25 times the static load, with 0.8 of that aft",
        2.25, 2.25 * 0.8, 0.0, STATIC_REACTION,
    ),
    "23.499-forward": GroundRule(
        "14 CFR 23.499(b): 2.25 times the static load, with 0.4 of that forward",
        2.25, -2.25 * 0.4, 0.0, STATIC_REACTION,
    ),
    "23.499-side": GroundRule(
        "14 CFR 23.499(c): 2.25 times the static load, with 0.7 of that to the side",
        2.25, 0.0, 2.25 * 0.7, STATIC_REACTION,
    ),
}  # fmt: skip
# The rules of each part of 14 CFR for a main wheel and for a nose wheel.
RULES_OF_PART = {
    ("25", "main"): ("25.473-spin-up", "25.473-spring-back", "25.479-drag", "25.479-drift"),
    ("25", "nose"): (),
    ("23", "main"): ("23.D-spin-up", "23.D-spring-back", "23.479-drag"),
    ("23", "nose"): ("23.499-aft", "23.499-forward", "23.499-side"),
}


def descent_velocity(wing_loading: float) -> float:
    """Descent velocity of 14 CFR 23.473(d), m/s. wing_loading: Pa."""
    return min(max(4.4 * math.sqrt(math.sqrt(wing_loading / PA_PER_PSF)), 7.0), 10.0) * M_PER_FOOT


def required_velocity(rule: str, wing_loading: float | None) -> float:
    """Descent velocity that a rule prescribes, m/s.

    rule: a key of DROP_RULES.
    wing_loading: Pa.

    Raises: ArgumentError where the rule needs the wing loading and it is None.
    """
    fixed = DROP_RULES[rule].velocity
    if fixed is not None:
        return fixed
    if wing_loading is None:
        raise ArgumentError(
            f"{DROP_RULES[rule].clause}: give wing_loading or velocity", "no-wing-loading"
        )
    return descent_velocity(wing_loading)


def spin_up_drag(
    inertia: float, radius: float, speed: float, vertical: float, time: float
) -> float:
    """Largest spin-up drag on a wheel, N: sqrt(2 I v n F / t) / r, at most n F.

    n = 0.8 is the effective coefficient of friction; spring-back is the same force forward.
    inertia: moment of inertia I of the wheel, kg m^2.
    radius: effective radius r, m.
    speed: speed v of the ground past the axle, less the tyre's peripheral speed by pre-rotation,
    m/s.
    vertical: largest vertical force F, N.
    time: time t from touch-down to that force, s.

    Source: appendix D to 14 CFR part 23.
    """
    drag = math.sqrt(2.0 * inertia * speed * MAX_TYRE_FRICTION * vertical / time) / radius
    return min(drag, MAX_TYRE_FRICTION * vertical)
