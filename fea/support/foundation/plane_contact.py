"""The contact of a pin with the eye of a lug in plane strain, and its stiffness.

Pin and eye are annuli. Displacements and stresses of harmonic n are those of Michell's solution.
C_n is the radial displacement, in the direction of the pressure p cos n theta that causes it, per
pressure. For n = 1 the lug is held by a traction of constant direction on its outer surface, and
displacements are relative to the mean motion of that surface, as in
fea.support.contact.flexibility. The pin is held by a body force that is uniform over the section,
in place of the change of shear along a beam, and displacements are relative to the mean motion of
the section, as in Timoshenko's beam.

Source: J. R. Barber, Elasticity, tables 8.1 and 9.1 (Michell's solution); G. R. Cowper,
J. Appl. Mech. 33 (1966) 335 (the mean motion).
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from fea.core.material import Material
from fea.core.pin_loads import Floats
from fea.support.bands import Bands
from fea.support.contact.contact import ContactProblem
from fea.support.contact.flexibility import half_plane

MAX_PLANE_HARMONIC, PLANE_CONTACT_SECTORS = 16, 60
# The quadrature is exact for the powers of r, and accurate for 1 / r.
_GAUSS_POINTS, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(8)


@lru_cache(maxsize=512)  # eyes of a study are much alike
def plane_stiffness(
    radii: tuple[float, float], pin: Material, outer: float, lug: Material
) -> float:
    """The stiffness of plane contact without friction and clearance, N/m^2.

    It is the force per length over the displacement of the lug's outer surface relative to the
    pin's section.
    radii: of the pin's bore (0 if solid) and of its surface, m.
    pin, lug: the materials.
    outer: outer radius of the lug, m.
    """
    inner, r = radii
    flexible = pin_harmonics(inner, r, pin) + lug_harmonics(r, outer, lug)
    bands = Bands(np.zeros(1), np.ones(1), np.array([r]), np.zeros(1, dtype=np.int64), np.zeros(1))
    tail = np.array([half_plane(pin, r) + half_plane(lug, r)])
    problem = ContactProblem(
        bands, flexible[:, None, None], tail, (math.inf,), PLANE_CONTACT_SECTORS
    )
    return 1.0 / abs(float(problem.solve(np.array([[1.0, 0.0]])).shift[0, 0]))


def largest_pressure(gap: float) -> float:
    """The largest pressure p0 of a disc in a plate of the same material, as p0 R / Q, where Q is
    the load per length.

    gap: E / (1 - nu^2) times the radial clearance over Q.

    Source: Persson 1964; Ciavarella & Decuzzi, Int. J. Solids Struct. 38 (2001) 4507.
    """
    b = math.tan(half_angle(gap) / 2.0)
    even = b * b + 1.0
    tight = math.log(math.sqrt(even) + b) / (math.pi * b * b * even)
    return 2.0 / math.pi * b / math.sqrt(even) + tight


def half_angle(gap: float) -> float:
    """The half angle of contact of a disc in a plate of the same material, rad.

    gap and source: as in `largest_pressure`.
    """

    def off(angle: float) -> float:
        b2 = math.tan(angle / 2.0) ** 2
        return 2.0 - math.log(b2 + 1.0) - 2.0 * b2 * b2 - gap * math.pi * b2 * (b2 + 1.0)

    from scipy.optimize import brentq  # takes long to import

    return float(brentq(off, 1e-6, 0.5 * math.pi, xtol=1e-12))


def pin_harmonics(inner: float, outer: float, material: Material) -> Floats:
    """The flexibility C_n of a pin under pressure on its surface, (MAX_PLANE_HARMONIC + 1,) m/Pa,
    with displacements inwards.
    """
    hole = inner / outer  # lengths are divided by the loaded radius, so that powers do not overflow
    high = [-_many(n, hole, material) for n in range(2, MAX_PLANE_HARMONIC + 1)]
    return outer * np.array([_even(hole, material), _section(hole, material), *high])


def lug_harmonics(inner: float, outer: float, material: Material) -> Floats:
    """The flexibility C_n of a lug under pressure in its bore, (MAX_PLANE_HARMONIC + 1,) m/Pa, with
    displacements outwards.
    """
    wide = outer / inner
    high = [_many(n, wide, material) for n in range(2, MAX_PLANE_HARMONIC + 1)]
    return inner * np.array([_even(wide, material), _eye(wide, material), *high])


def _even(other: float, material: Material) -> float:
    """The radial displacement of harmonic 0, that of Lame's tube."""
    E, nu = material.youngs_modulus, material.poisson_ratio
    return (1.0 + nu) / E * (1.0 - 2.0 * nu + other**2) / abs(1.0 - other**2)


def _powers(n: int, r: float, kappa: float, solid: bool = False) -> Floats:
    """The terms of Michell's solution at r, one in each column; rows are 2 mu u_r, 2 mu u_theta,
    s_rr and s_rt.

    There are four terms, two for a solid. For n = 1 the rigid motion and the term with a resultant
    are left out.
    """
    up = [
        (-n, n, -n * (n - 1), n * (n - 1)),  # r^n
        (kappa - n - 1, kappa + n + 1, -(n + 1) * (n - 2), n * (n + 1)),  # r^(n + 2)
    ]
    down = [
        (n, n, -n * (n + 1), -n * (n + 1)),  # r^-n
        (kappa + n - 1, n - 1 - kappa, -(n + 2) * (n - 1), -n * (n - 1)),  # r^(2 - n)
    ]
    rows, powers = [*up, *down], [n, n + 2, -n, 2 - n]
    columns_used = [i for i in ((1, 2) if n == 1 else range(4)) if i < 2 or not solid]
    columns = [
        np.array(rows[i]) * r ** (powers[i] - np.array([1.0, 1.0, 2.0, 2.0])) for i in columns_used
    ]
    return np.stack(columns, axis=1)


def _terms_with_force(r: float, kappa: float) -> Floats:
    """The terms of `_powers` for n = 1, and the pair of terms with a resultant, combined so that
    the displacement is single-valued.

    A wall needs them whose inner and outer surfaces do not each balance.
    """
    k, ln = kappa, math.log(r)
    first = np.array([(k + 1.0) * ln - 1.0, -(k + 1.0) * ln - 1.0, 4.0 / r, 0.0]) / 2.0
    second = np.array([(k - 1.0) * ln - 1.0, -(k - 1.0) * ln - 1.0, 2.0 / r, 2.0 / r]) / 2.0
    return np.column_stack([_powers(1, r, k), first - (k - 1.0) / (k + 1.0) * second])


def _many(n: int, other: float, material: Material) -> float:
    """The radial displacement of a harmonic n > 1."""
    kappa, mu = 3.0 - 4.0 * material.poisson_ratio, material.lame[1]
    solid = other == 0.0
    here = _powers(n, 1.0, kappa, solid)
    rows = here[2:] if solid else np.vstack([here[2:], _powers(n, other, kappa)[2:]])
    scale, load = np.abs(rows).max(axis=0), -np.eye(len(rows))[0]
    constants = np.linalg.solve(rows / scale, load) / scale
    return float(here[0] @ constants) / (2.0 * mu)


def _section(hole: float, material: Material) -> float:
    """The displacement of a pin for harmonic 1.

    The pressure pushes along -x, and a uniform body force along x holds the pin. In a tube the
    particular solution leaves a resultant on the bore, which the terms with a force take away.
    """
    (lam, mu), kappa, solid = material.lame, 3.0 - 4.0 * material.poisson_ratio, hole == 0.0
    alpha = -3.0 / (8.0 * (lam + 2.0 * mu) * (1.0 - hole**2))
    beta = -alpha / 3.0
    stress = np.array([2.0 * alpha * (lam + 2.0 * mu) + lam * (alpha + beta), mu * (beta - alpha)])

    def terms(r: float) -> Floats:
        return _powers(1, r, kappa, solid) if solid else _terms_with_force(r, kappa)

    ends = (1.0,) if solid else (1.0, hole)
    rows = np.vstack([terms(r)[2:] for r in ends])
    load = np.concatenate([-stress * r for r in ends])
    load[0] -= 1.0
    constants = np.linalg.lstsq(rows, load)[0]  # equilibrium makes one row redundant

    def moved(r: float) -> Floats:
        return np.asarray(terms(r)[:2] @ constants / (2.0 * mu) + np.array([alpha, beta]) * r**2)

    at = 0.5 * (1.0 + hole) + 0.5 * (1.0 - hole) * _GAUSS_POINTS
    along = np.array([0.5 * (u - v) for u, v in map(moved, at.tolist())])
    mean = (_GAUSS_WEIGHTS * at) @ along / (_GAUSS_WEIGHTS @ at)
    return float(mean - moved(1.0)[0])


def _eye(wide: float, material: Material) -> float:
    """The displacement of a lug for harmonic 1."""
    kappa, mu = 3.0 - 4.0 * material.poisson_ratio, material.lame[1]
    held = 0.5 / wide  # of constant direction: s_rr = -held cos, s_rt = held sin
    rows = np.vstack([_terms_with_force(r, kappa)[2:] for r in (1.0, wide)])
    constants = np.linalg.lstsq(rows, np.array([-1.0, 0.0, -held, held]))[0]
    bore, outside = (_terms_with_force(r, kappa)[:2] @ constants / (2.0 * mu) for r in (1.0, wide))
    return float(bore[0] - 0.5 * (outside[0] - outside[1]))
