"""The exponent of pressure at the sharp edge of a lug on a smooth pin: it grows like d^-s.

The pin is a half-plane -pi < theta < 0, the lug a wedge 0 < theta < w. They touch without friction
at theta = 0, and their other sides are free. With Williams' stress function r^(L + 1) f(theta), f a
sum of cos and sin of (L + 1) theta and (L - 1) theta, consider a wedge of angle w under the normal
stress p r^(L - 1) on its side, without shear. It moves along the normal there by u r^L,

    u / p = c k N(w) / D(w),    N = sin 2 L w + L sin 2 w,    D = sin^2 L w - L^2 sin^2 w,

where k = (1 - nu^2) / E, and c = 1 / L is the same for all wedges. For the half-plane N / D is 2
cos L pi / sin L pi. Under the same stress both stay in contact if their displacements sum to zero:

    h(L) = 2 k_pin cos(L pi) D(w) + k_lug sin(L pi) N(w) = 0,    s = 1 - Re L.

D > 0 for 0 < L < 1 and 0 < w < pi, so h > 0 at L = 1/2. Towards L = 1, h goes to zero, from below
where there is a singularity: always for w >= pi/2. Then the least root is real and lies between. No
other root has 0 < Re L < 1; tests/fea/singular/test_lug_edge.py counts them by the argument
principle.

Contact without friction transmits no shear out of the plane, so in torsion there is no singularity.

Source: J. Dundurs & M. S. Lee, J. Elasticity 2 (1972) 109, for the problem; M. L. Williams, J.
Appl. Mech. 19 (1952) 526, for the stress functions.
"""

from __future__ import annotations

import math

from fea.core.material import Material

RIGHT_ANGLE = math.pi / 2.0  # the angle of a lug's edge
MIN_EXPONENT = 1e-9  # with a smaller exponent there is no singularity


def lug_edge_exponent(pin: Material, lug: Material, angle: float = RIGHT_ANGLE) -> float:
    """The exponent s of pressure and stress ~ d^-s at the sharp edge of a lug; 0 where they are
    finite.

    lug: the material that touches the pin, a bushing's if there is one.
    angle: of the edge, rad.

    Source: as the module.
    """
    return edge_exponent(pin.plane_compliance, lug.plane_compliance, angle)


def edge_exponent(pin: float, lug: float, angle: float = RIGHT_ANGLE) -> float:
    """Return what `lug_edge_exponent` does, from plane compliances (1 - nu^2) / E, whose ratio
    counts.

    pin, lug: 1/Pa; 0 for a rigid body.
    angle: rad, between 0 and pi.
    """
    share = lug / (pin + lug)
    if _h(1.0 - MIN_EXPONENT, share, angle) >= 0.0:
        return 0.0
    from scipy.optimize import brentq  # takes long to import

    return float(brentq(lambda s: _h(1.0 - s, share, angle), MIN_EXPONENT, 0.5, xtol=1e-15))


def next_power(pin: Material, lug: Material) -> float:
    """The power of distance of the next term of pressure at the edge of a lug of 90 degrees.

    It is 0.5 for a rigid lug and up to 1 for a very soft one. Regular terms have no lower power.
    """
    pin_part, lug_part = pin.plane_compliance, lug.plane_compliance
    share = lug_part / (pin_part + lug_part)
    from scipy.optimize import brentq

    return float(brentq(lambda L: _h(L, share, RIGHT_ANGLE), 1.2, 2.0, xtol=1e-12)) - 1.0


def _h(L: float, share: float, angle: float) -> float:
    """The function h(L) of the module over the sum of both compliances.

    share: the lug's part of that sum.
    """
    N = math.sin(2.0 * L * angle) + L * math.sin(2.0 * angle)
    D = math.sin(L * angle) ** 2 - (L * math.sin(angle)) ** 2
    return 2.0 * (1.0 - share) * math.cos(L * math.pi) * D + share * math.sin(L * math.pi) * N
