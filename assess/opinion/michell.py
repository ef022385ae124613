"""Michell's constant term in the axial stress of a round bar under a uniform transverse load.

Beam theory is not exact while a load acts along the bar. For a solid circle of radius a under w
per length along +x, moment M and shear V = -dM/dz, the stress away from the ends is, exactly,

    s_zz = -M x / I + w f(x, y),   shears s_xz, s_yz = V times Saint-Venant's flexure shears t,

and s_xx, s_yy, s_xy are the same in every section. Five conditions leave one f, odd in x:
in the plane, equilibrium under the body force -w t and the load on the boundary; compatibility of
the plane strains, to which f adds by Poisson's ratio; from d^2 M / dz^2 = w and the flexure shears,
the second derivatives by x and y of the constant part of e_zz; int f dA = 0; int x f dA = 0,
because equilibrium makes M the moment of s_zz.

Load (a), a traction w / (2 pi a) of constant direction all round (n: Poisson's ratio):

    f = (2 + n) / (6 (1 + n)) x (3 r^2 - 2 a^2) / (pi a^4)

Load (b), w on the axis. It differs from (a) by a load without resultant, hence by plane strain:
Kelvin's line force, and a linear part that frees the surface of traction and the section of moment:

    f_b - f = n / (2 (1 - n)) x (2 r^2 - a^2) / (pi a^2 r^2)

On the surface f = k (x / a) / (pi a), with the k below: where a cantilever is in tension (-x), the
stress is k w / (pi a) below the beam's, and so is the compression opposite. On a bore of radius b
instead of the axis, k is larger: for n = 0.3 by 1.7 % at b = a / 20 and 6.8 % at a / 10.

Sources: J. H. Michell, Quart. J. Math. 32 (1901) 28; A. E. H. Love, A Treatise on the Mathematical
Theory of Elasticity, ch. XVI, for the method; f for these two loads is worked out here and checked
in tests/assess/opinion/test_distributed_load.py.
"""

from __future__ import annotations

import math


def surface_load_term(nu: float) -> float:
    """Michell's k (no unit) at Poisson's ratio `nu`, load (a): uniform traction on the surface.

    Source: as the module.
    """
    return (2.0 + nu) / (6.0 * (1.0 + nu))


def axis_load_term(nu: float) -> float:
    """Michell's k (no unit) at Poisson's ratio `nu`, load (b): a line load on the axis.

    Source: as the module.
    """
    return (1.0 + nu + nu**2) / (3.0 * (1.0 - nu**2))


def constant_stress(k: float, load: float, radius: float) -> float:
    """By how much (Pa) the axial stress in tension is below the beam's: term `k`, `load` in N/m,
    `radius` in m.

    Source: as the module.
    """
    return k * load / (math.pi * radius)
