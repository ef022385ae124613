"""The landing of one leg as a drop of two masses with strut, tyre and wheel; cases of 14 CFR."""

from loads.landing.drop import Drop, LandingError
from loads.landing.ground import GroundedWheel, WheelForce
from loads.landing.landing import Landing, LandingHistory, land
from loads.landing.requirements import (
    DROP_RULES,
    GROUND_RULES,
    descent_velocity,
    required_velocity,
    spin_up_drag,
)
from loads.landing.strut import GasSpring, LinearSpring, Oil, Strut
from loads.landing.through import (
    AppliedOverTime,
    StrokeDrive,
    Touchdown,
    at_deflection,
    axes,
    effective_mass,
    laws,
    pushes,
    travel,
)
from loads.landing.travel import Levered, Telescopic
from loads.landing.tyre import PowerTyre, TableTyre
from loads.landing.wheel import Wheel

__all__ = [
    "DROP_RULES",
    "GROUND_RULES",
    "AppliedOverTime",
    "Drop",
    "GasSpring",
    "GroundedWheel",
    "Landing",
    "LandingError",
    "LandingHistory",
    "Levered",
    "LinearSpring",
    "Oil",
    "PowerTyre",
    "StrokeDrive",
    "Strut",
    "TableTyre",
    "Telescopic",
    "Touchdown",
    "Wheel",
    "WheelForce",
    "at_deflection",
    "axes",
    "descent_velocity",
    "effective_mass",
    "land",
    "laws",
    "pushes",
    "required_velocity",
    "spin_up_drag",
    "travel",
]
