"""The exponents of stress at corners and clamps: stress grows like d^-s with the distance d.

At a corner of interior angle w the displacements in plane strain vary like r^L, so s = 1 - Re L for
the root L with the least real part in 0 < Re L < 1 (Williams), k = 3 - 4 nu:

    free - free         sin^2 Lw = L^2 sin^2 w
    clamped - clamped   k^2 sin^2 Lw = L^2 sin^2 w
    clamped - free      4 k sin^2 Lw = (k + 1)^2 - 4 L^2 sin^2 w

The real and the imaginary part of these equations show where that root lies, so that it is
bracketed, not searched for.

Equal sides, x = Lw: sin x = q x or sin x = -q x, with q = |sin w| / w, divided by k if clamped. For
complex x, tan a / a = tanh b / b < 1 (a, b the parts of x) forbids Re x < pi, and so does sin x =
-q x for real x. There remains the real root of sin x = q x, in (0, pi]; it is below w only for w >
pi.

Different sides, z = 2 Lw: F = cos z + A - B z^2 = 0, A = (k + 1/k) / 2, B = (sin w / w)^2 / (2 k).
For complex z = a + ib, Im F = 0 is sin a / a = -2 B b / sinh b, so a > pi. F falls on (0, pi]: a
real root there is the one sought. Otherwise only w > pi/2 matters, and then F' = 0 has real roots
a0 < a1 only in Re z < 2 pi. F falls to a0, and is monotonic along the curve Im F = 0 that leaves a0
towards a = pi, b = infinity, where F < 0. So the root is real in (pi, a0] if F(a0) <= 0, and
otherwise the one on that curve.

A wider angle is not always a stronger singularity: with different sides the least root turns back
before it meets the next one and both become complex (nu = 0.3: s falls from 0.388 at 131 degrees to
0.34 at 142).

Source: M. L. Williams, J. Appl. Mech. 19 (1952) 526, for the equations.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Literal

Side = Literal["free", "clamped"]

STEEPEST_ANGLE = 4.493409457909064  # the root of tan a = a, where sin a / a is least
MAX_IMAGINARY_PART = 5.0  # of b: 0.217 cosh b > A + B b^2 there for all -1 < nu < 0.5
EXPONENT_ROUND_OFF = 1e-12  # with a smaller exponent there is no singularity


def plane_exponent(omega: float, nu: float, first: Side, second: Side) -> float:
    """The exponent s of stress ~ d^-s in plane strain at a corner; 0 where stress stays finite.

    omega: angle (rad) of the material, 0 to 2 pi.
    nu: Poisson's ratio.
    first, second: conditions on the sides of the corner.

    Source: as the module.
    """
    return _positive(1.0 - plane_eigenvalue(omega, nu, first, second).real)


def plane_eigenvalue(omega: float, nu: float, first: Side, second: Side) -> complex:
    """The least L of displacement ~ r^L; of a conjugate pair the upper one; 1 where stress is
    finite.

    With a complex L the stress changes sign ever faster towards the corner. The arguments are those
    of `plane_exponent`.

    Source: as the module.
    """
    kappa = 3.0 - 4.0 * nu
    if first == second:
        if omega <= math.pi:
            return 1.0 + 0.0j
        return complex(_equal_sides(omega, kappa if first == "clamped" else 1.0) / omega)
    root = _different_sides(omega, kappa) / (2.0 * omega)
    return root if root.real < 1.0 else 1.0 + 0.0j


def antiplane_exponent(omega: float, first: Side, second: Side) -> float:
    """The exponent s of stress ~ d^-s in torsion at a corner; 0 where stress stays finite.

    omega: angle (rad) of the material, 0 to 2 pi.
    first, second: conditions on the sides of the corner.

    Source: the displacement is harmonic: r^L cos L theta, L = pi / omega, or half that if the sides
    differ.
    """
    return _positive(1.0 - math.pi / ((1.0 if first == second else 2.0) * omega))


def notch_factor(omega: float, nu: float, torsion: bool = False) -> float:
    """The notch stress intensity factor over the factor C of von Mises stress C d^-s along a free
    side.

    The governing stress is that of plane strain (opening; K1) or of torsion (K3). Both sides are
    free, omega > pi. K1 = sqrt(2 pi) lim d^s sigma_theta on the bisector, K3 is the same of the
    shear stress.

    Source: P. Lazzarin, R. Tovo, Int. J. Fract. 78 (1996) 3, for the ratio of the stress along the
    side to that on the bisector.
    """
    root = math.sqrt(2.0 * math.pi)
    if torsion:
        return root / math.sqrt(3.0)
    eigenvalue, half = plane_eigenvalue(omega, nu, "free", "free").real, omega / 2.0
    less, more = (1.0 - eigenvalue) * half, (1.0 + eigenvalue) * half
    chi = (1.0 - eigenvalue) * -math.sin(less) / math.sin(more)
    along = (3.0 - eigenvalue) * math.cos(less) - chi * math.cos(more)
    across = 1.0 + eigenvalue + chi
    return root * across / along / math.sqrt(1.0 - nu + nu * nu)


def _equal_sides(omega: float, kappa: float) -> float:
    """The root x = L omega for equal sides, omega > pi; kappa is 1 for free sides."""
    q = abs(math.sin(omega)) / (kappa * omega)
    return _root(lambda x: math.sin(x) - q * x, math.pi / 2.0, math.pi + 1e-9)


def _different_sides(omega: float, kappa: float) -> complex:
    """The root z = 2 L omega for different sides; infinite if Re z would exceed 2 omega."""
    A = (kappa + 1.0 / kappa) / 2.0
    B = (math.sin(omega) / omega) ** 2 / (2.0 * kappa)

    def F(a: float, b: float = 0.0) -> float:
        """The real part of F; on the curve below, F itself."""
        return math.cos(a) * math.cosh(b) + A - B * (a * a - b * b)

    def on_curve(b: float) -> float:
        """The a that belongs to b on the curve Im F = 0."""
        slope = 2.0 * B * (b / math.sinh(b) if b else 1.0)
        return _root(lambda a: math.sin(a) + slope * a, math.pi, STEEPEST_ANGLE)

    # The cases of the module's docstring in turn: a real root up to pi, no root that matters, a
    # real root up to a0, and the complex root on the curve.
    if F(math.pi) <= 0.0:
        return complex(_root(F, 0.0, math.pi))
    if omega <= math.pi / 2.0:
        return complex(math.inf)
    a0 = on_curve(0.0)
    if F(a0) <= 0.0:
        return complex(_root(F, math.pi, a0))
    b = _root(lambda b: F(on_curve(b), b), 0.0, MAX_IMAGINARY_PART)
    return complex(on_curve(b), b)


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    from scipy.optimize import brentq  # takes long to import

    return float(brentq(function, low, high, xtol=1e-15, rtol=1e-15))


def _positive(exponent: float) -> float:
    return exponent if exponent > EXPONENT_ROUND_OFF else 0.0
