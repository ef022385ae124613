"""The landing of one leg as a drop of two masses with strut, tyre and wheel; cases of 14 CFR."""

from loads.landing.drop import Drop, LandingError
from loads.landing.ground import GroundedWheel, WheelForce
from loads.landing.landing import Landing, land
from loads.landing.requirements import (
    DROP_RULES,
    GROUND_RULES,
    descent_velocity,
    required_velocity,
    spin_up_drag,
)
from loads.landing.strut import GasSpring, LinearSpring, Oil, Strut
from loads.landing.through import (
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
