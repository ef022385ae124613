"""Stress on the surface from the displacements there and the known tractions.

Along the outline (arc length s, tangent t, counter-clockwise) the strains in the surface are

    e_ss = t . d(U, W)/ds      e_tt = (U + n V) / r
    2 e_st = dV/ds - (t_r (n U + V) + t_z n W) / r

and with the traction they give all stress components. The strains e_ss and e_st are computed at the
two Gauss points of each edge, at which those of quadratic elements are most exact, and interpolated
by the cubic through the four nearest Gauss points. Where the outline has a corner, or the traction
a jump, they are interpolated by the line through the edge's own two points. The strains are
interpolated and not the derivatives: derivatives turn with the outline, so that a mere rotation
would leave stresses where the curvature of the outline jumps. `python -m benchmarks recovery`
compares this with the average of extrapolated stresses: at a fillet the error is several times
smaller.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.core.material import Material
from fea.harmonic.assembly import Section
from fea.harmonic.boundary import Outline, shapes, slopes
from fea.solid.boundary import MIN_SMOOTH_COSINE
from pinbase.arrays import Floats, Ints

EDGE_STATIONS = np.array([-1.0, -0.5, 0.0, 0.5, 1.0])  # points of an edge at which stress is read
_GAUSS_POINT = 1.0 / np.sqrt(3.0)
_TRACTION_JUMP = 1e-9  # of the largest traction; a smaller jump is round-off


@dataclass(frozen=True)
class Skin:
    """Amplitudes of stress and displacement at five points on each edge of the outline.

    points: (E, 5, 2) r, z in m.
    tangent: (E, 5, 2).
    displacement: (E, 5, 3, K) m.
    stress: (E, 5, 6, K) Pa.
    """

    points: Floats
    tangent: Floats
    displacement: Floats
    stress: Floats


def skin(
    space: Section, outline: Outline, material: Material, n: Ints | int, u: Floats, traction: Floats
) -> Skin:
    """The stress on the outline from displacements and tractions.

    On the axis (r = 0) the stresses are finite but meaningless.
    n: harmonics, one or (K,).
    u: (N, 3, K) m.
    traction: (E, 3, 3, K) Pa, at the ends and the middle of the edges.
    """
    x = space.nodes[outline.nodes]
    return on_edges(
        material, n, x, u[outline.nodes], traction, smooth_neighbours(outline, x, traction)
    )


def on_edges(
    material: Material,
    n: Ints | int,
    x: Floats,
    moved: Floats,
    traction: Floats,
    neighbours: tuple[Ints, Ints],
) -> Skin:
    """The stress on edges from the displacements of their nodes.

    n: harmonics, one or (K,).
    x: (E, 3, 2) m, position of the nodes.
    moved: (E, 3, 3, K) m, displacement of the nodes.
    traction: (E, 3, 3, K) Pa.
    neighbours: the edges that continue each edge smoothly before and after it
    (`smooth_neighbours`).
    """
    at = np.einsum("qi,eia->eqa", shapes(EDGE_STATIONS), x)
    tangent = np.einsum("qi,eia->eqa", slopes(EDGE_STATIONS), x)
    tangent /= np.linalg.norm(tangent, axis=2, keepdims=True)
    U = np.einsum("qi,eiak->eqak", shapes(EDGE_STATIONS), moved)
    r = np.maximum(at[..., 0], 1e-6 * at[..., 0].max())[..., None]
    stretch, shear = _strains(neighbours, n, x, moved)
    e_tt = (U[..., 0, :] + n * U[..., 1, :]) / r
    applied = np.einsum("qi,eiak->eqak", shapes(EDGE_STATIONS), traction)
    return Skin(at, tangent, U, _stress(material, tangent, stretch, e_tt, shear, applied))


def _strains(
    neighbours: tuple[Ints, Ints], n: Ints | int, x: Floats, moved: Floats
) -> tuple[Floats, Floats]:
    """The strains e_ss and 2 e_st at the points, (E, 5, K) each; both are zero in rigid-body
    motions.
    """
    at = np.array([-_GAUSS_POINT, _GAUSS_POINT])
    along = slopes(at)
    path = np.einsum("qi,eia->eqa", along, x)
    step = np.linalg.norm(path, axis=2)
    change = np.einsum("qi,eiak->eqak", along, moved) / step[..., None, None]
    direction = path / step[..., None]
    stretch = np.einsum("eqa,eqak->eqk", direction, change[:, :, [0, 2]])
    u_r, u_t, u_z = np.moveaxis(np.einsum("qi,eiak->eqak", shapes(at), moved), 2, 0)
    t_r, t_z = direction[..., 0, None], direction[..., 1, None]
    r = np.einsum("qi,ei->eq", shapes(at), x[..., 0])[..., None]
    shear = change[:, :, 1] - (t_r * (n * u_r + u_t) + t_z * n * u_z) / r
    value = np.stack([stretch, shear], axis=2)  # (E, 2, 2, K)
    weights = np.stack(
        [(1.0 - EDGE_STATIONS / _GAUSS_POINT) / 2.0, (1.0 + EDGE_STATIONS / _GAUSS_POINT) / 2.0],
        axis=1,
    )
    # First by the line through an edge's own two Gauss points.
    out = np.einsum("pq,eqck->epck", weights, value)
    half = np.linalg.norm(np.einsum("qi,eia->eqa", slopes(np.zeros(1)), x), axis=2)[:, 0]
    before, after = neighbours
    a, c = half * _GAUSS_POINT, half * (1.0 - _GAUSS_POINT)
    left, right = before >= 0, after >= 0

    def cubic(rows: Ints, p: int, samples: list[Floats], places: list[Floats]) -> None:
        w = _lagrange(half[rows] * EDGE_STATIONS[p], np.stack(places, axis=1))
        out[rows, p] = np.einsum("eq,eqck->eck", w, np.stack(samples, axis=1))

    # Where the outline continues smoothly, by the cubic through the four nearest Gauss points
    # instead: at the edge's end, at its start, and at the three points between.
    e, f = np.flatnonzero(right), after[right]
    places = [-a[e], a[e], half[e] + c[f], half[e] + c[f] + 2.0 * a[f]]
    cubic(e, 4, [value[e, 0], value[e, 1], value[f, 0], value[f, 1]], places)
    e, f = np.flatnonzero(left), before[left]
    places = [-half[e] - c[f] - 2.0 * a[f], -half[e] - c[f], -a[e], a[e]]
    cubic(e, 0, [value[f, 0], value[f, 1], value[e, 0], value[e, 1]], places)
    e = np.flatnonzero(left & right)
    f, g = before[e], after[e]
    places = [-half[e] - c[f], -a[e], a[e], half[e] + c[g]]
    for p in (1, 2, 3):
        cubic(e, p, [value[f, 1], value[e, 0], value[e, 1], value[g, 0]], places)
    return out[:, :, 0], out[:, :, 1]


def smooth_neighbours(outline: Outline, x: Floats, traction: Floats) -> tuple[Ints, Ints]:
    """The edges (E,) before and after each edge, or -1.

    A neighbour counts if surface and traction are smooth across the shared node.
    """
    after = outline.after.copy()
    ends = np.einsum("qi,eia->eqa", slopes(np.array([-1.0, 1.0])), x)
    ends /= np.linalg.norm(ends, axis=2, keepdims=True)
    edge = np.flatnonzero(after >= 0)
    following = after[edge]
    jump = np.abs(traction[edge, 1] - traction[following, 0]).max(axis=(1, 2))
    broken = (np.sum(ends[edge, 1] * ends[following, 0], axis=1) < MIN_SMOOTH_COSINE) | (
        jump > _TRACTION_JUMP * np.abs(traction).max(initial=0.0)
    )
    after[edge[broken]] = -1
    before = np.full(len(after), -1)
    e = np.flatnonzero(after >= 0)
    before[after[e]] = e
    return before, after


def _lagrange(at: Floats, places: Floats) -> Floats:
    """The weights (E, 4) of values at `places` (E, 4) in the cubic through them, evaluated at `at`
    (E,).
    """
    w = np.ones_like(places)
    for i in range(4):
        for j in range(4):
            if i != j:
                w[:, i] *= (at - places[:, j]) / (places[:, i] - places[:, j])
    return w


def _stress(
    material: Material, tangent: Floats, e_ss: Floats, e_tt: Floats, shear: Floats, applied: Floats
) -> Floats:
    """The stress (E, 5, 6, K), Pa, from the strains in the surface and the tractions (E, 5, 3, K),
    Pa.
    """
    E, nu = material.youngs_modulus, material.poisson_ratio
    t_r, t_z = tangent[..., 0, None], tangent[..., 1, None]
    n_r, n_z = t_z, -t_r
    T_r, T_t, T_z = (applied[..., a, :] for a in range(3))
    # Normal and shear tractions; the in-plane stresses follow from Hooke's law with s_nn known.
    s_nn, s_ns = n_r * T_r + n_z * T_z, t_r * T_r + t_z * T_z
    plane = E / (1.0 - nu**2)
    s_ss = plane * (e_ss + nu * e_tt) + nu / (1.0 - nu) * s_nn
    s_tt = plane * (e_tt + nu * e_ss) + nu / (1.0 - nu) * s_nn
    s_st = material.lame[1] * shear
    return in_axes(tangent, s_ss, s_tt, s_nn, s_ns, s_st, T_t)


def in_axes(
    tangent: Floats, ss: Floats, tt: Floats, nn: Floats, ns: Floats, st: Floats, nt: Floats
) -> Floats:
    """The stress (..., 6, K), rr, tt, zz, tz, rz, rt, from its components in the axes of a surface.

    tangent: (..., 2).
    ss, tt, nn, ns, st, nt: (..., K) each, along the tangent (s), about the axis (t) and along the
    outward normal (n).
    """
    t_r, t_z = tangent[..., 0, None], tangent[..., 1, None]
    n_r, n_z = t_z, -t_r
    return np.stack(
        [
            n_r**2 * nn + t_r**2 * ss + 2.0 * n_r * t_r * ns,
            tt,
            n_z**2 * nn + t_z**2 * ss + 2.0 * n_z * t_z * ns,
            n_z * nt + t_z * st,
            n_r * n_z * nn + t_r * t_z * ss + (n_r * t_z + n_z * t_r) * ns,
            n_r * nt + t_r * st,
        ],
        axis=-2,
    )
