"""A pin as a stepped Timoshenko beam: its exact internal forces under unit loads.

With w the load per length along x, q along z and t about z, the part beyond z exerts on the rest

    V' = -w    M' = -V    N' = -q    T' = -t

the shear V along x and the bending moment M about y, the axial force N and the torque T. So between
stations they are polynomials, found by marching along the pin from the left end of each free span.
The initial values are zero at a free end. After a clamp they are those that make the free right end
free. Between two clamps they are those that leave the sections at both clamps in place
(Castigliano: the derivatives of the complementary energy by the four redundant forces vanish). All
equations are linear and are solved exactly.

Source: S. P. Timoshenko, Phil. Mag. 41 (1921) 744, for the beam; the shear coefficients in
fea.beam.round_section.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fea.beam.line_load import line_couples, line_loads
from fea.beam.round_section import Circle, thinnest_section
from fea.core.material import Material
from fea.core.pin_loads import UnitLoad
from geometry import Pin
from pinbase.arrays import Floats

SHEAR, MOMENT, AXIAL, TORQUE = range(4)
# Largest change of a cone's diameter or bore over a cell, of the smallest wall or diameter; chosen
# by judgement.
MAX_CONE_CHANGE = 0.01
POINTS_PER_CELL = 33  # equally spaced points of a cell; those of largest moment are added
# The quadrature is exact for products of the cubic polynomials of internal forces.
_GAUSS_POINTS, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(4)


@dataclass(frozen=True)
class Span:
    """The cells first to last - 1 between clamps or free ends.

    left, right: whether the span is clamped at that end.
    """

    first: int
    last: int
    left: bool
    right: bool


@dataclass(frozen=True)
class InternalForces:
    """The internal forces V (N), M (N m), N (N), T (N m) of K unit loads between stations (C + 1,),
    m.

    coefficients: (C, 4, 4, K) of the powers 0 to 3 of the distance (m) from the cell's left end,
    for V, M, N, T.
    sections: of the C cells.
    spans: of cells outside the clamps.
    """

    stations: Floats
    sections: tuple[Circle, ...]
    spans: tuple[Span, ...]
    loads: tuple[UnitLoad, ...]
    coefficients: Floats

    @property
    def free(self) -> tuple[int, ...]:
        """Numbers of the cells outside the clamps."""
        return tuple(c for s in self.spans for c in range(s.first, s.last))

    @cached_property
    def samples(self) -> tuple[NDArray[np.intp], Floats]:
        """The cells (S,) and z (S,), m, at which stress is read.

        They lie densely in all cells outside the clamps, on both sides of every station, and where
        the moment of any unit load is largest.
        """
        cells, z = [], []
        for c in self.free:
            a, b = self.stations[c : c + 2]
            here = set(np.linspace(a, b, POINTS_PER_CELL).tolist())
            for shear in self.coefficients[c, :3, SHEAR].T:
                roots = a + np.polynomial.Polynomial(shear).trim().roots()
                here |= {float(x.real) for x in roots if abs(x.imag) == 0.0 and a < x.real < b}
            z += sorted(here)
            cells += [c] * len(here)
        return np.array(cells, dtype=np.intp), np.array(z)

    def inside(self, cells: NDArray[np.intp], z: Floats) -> Floats:
        """The forces V, M, N, T (S, 4, K) at z (S,), m, each as seen from its cell (S,)."""
        s = z - self.stations[cells]
        powers = s[:, None] ** np.arange(4)
        return np.asarray(np.einsum("sp,spqk->sqk", powers, self.coefficients[cells]))

    def at(self, z: Floats) -> Floats:
        """The forces V, M, N, T (S, 4, K) at z (S,), m; at a station as seen from the right."""
        cells = np.searchsorted(self.stations[1:-1], z, side="right")
        return self.inside(cells, z)

    def work(self, material: Material) -> Floats:
        """The work (K, K), J, of each load on the deflection by each load; reactions of clamps do
        none.
        """
        cells = np.array(self.free)
        lengths = np.diff(self.stations)[cells]
        soft = np.array([compliances(self.sections[c], material) for c in cells])
        at_gauss = _at_gauss(lengths, self.coefficients[cells])
        return _products(lengths, soft, at_gauss, at_gauss)


def stepped_beam(
    pin: Pin, material: Material, loads: tuple[UnitLoad, ...], clamps: tuple[str, ...] = ()
) -> InternalForces:
    """The internal forces of a pin under unit loads.

    clamps: names of the clamped surfaces (as in `pin.surface`): the section of a clamped face stays
    in place, a clamped band is rigid. Without clamps each load is balanced by the closing tractions
    on all connections (fea.core.tractions).

    Raises: GeometryError for a clamp that does not exist; SolveError as fea.beam.line_load.
    """
    constrained = [_constrained(pin, pin.surface(name)) for name in clamps]
    stations = _stations(pin, constrained)
    sections = tuple(_section(pin, a, b) for a, b in pairwise(stations.tolist()))
    w = line_loads(pin, material, stations, sections, loads, closed=not clamps)
    q = np.zeros((len(sections), 3, 4, len(loads)))  # minus the slope of each internal force
    for k, load in enumerate(loads):
        q[:, :, SHEAR if load.n else (AXIAL, TORQUE)[load.phases[0]], k] = w[:, :, k]
    q[:, 0, MOMENT] = line_couples(pin, stations, loads)
    out = np.zeros((len(sections), 4, 4, len(loads)))
    spans = _spans(stations, constrained)
    lengths, soft = np.diff(stations), np.array([compliances(s, material) for s in sections])
    for span in spans:
        here = slice(span.first, span.last)
        out[here] = _span(span, lengths[here], soft[here], q[here])
    return InternalForces(stations, sections, spans, loads, out)


def compliances(section: Circle, material: Material) -> Floats:
    """The compliances 1 / (kappa G A), 1 / (E I), 1 / (E A) and 1 / (G J) of a section."""
    E, G = material.youngs_modulus, material.lame[1]
    shear = section.shear_coefficient(material.poisson_ratio) * G * section.area
    return 1.0 / np.array([shear, E * section.inertia, E * section.area, G * section.polar])


def _constrained(pin: Pin, surface: str) -> tuple[float, float]:
    """The start and the end (z in m) of a clamp."""
    if surface == "start":
        return 0.0, 0.0
    if surface == "end":
        return pin.length, pin.length
    band = pin.band(surface)
    return band.z0, band.z1


def _stations(pin: Pin, constrained: list[tuple[float, float]]) -> Floats:
    ends = (e for b in pin.bands for e in (b.z0, b.z1))
    z = np.sort([*pin.stations, *ends, *_on_cones(pin), *np.ravel(constrained)])
    return np.asarray(z[np.r_[True, np.diff(z) > 1e-12 * pin.length]])


def _on_cones(pin: Pin) -> Iterator[float]:
    """The z (m) at which cones are divided into cells, as finely as MAX_CONE_CHANGE requires."""
    for s, z in zip(pin.segments, pin.stations, strict=False):
        (d0, d1), (b0, b1) = s.diameters, s.bores
        change = max(abs(d1 - d0), abs(b1 - b0)) / min(*s.walls, d0, d1)
        yield from np.linspace(z, z + s.length, math.ceil(change / MAX_CONE_CHANGE) + 1)[
            1:-1
        ].tolist()


def _section(pin: Pin, a: float, b: float) -> Circle:
    """The section from a to b (m); of a part of a cone the thinnest, which is on the safe side."""
    i = min(bisect_right(pin.stations, 0.5 * (a + b)), len(pin.segments)) - 1
    return thinnest_section(pin.segments[i], a - pin.stations[i], b - pin.stations[i])


def _spans(stations: Floats, constrained: list[tuple[float, float]]) -> tuple[Span, ...]:
    near = 1e-12 * stations[-1]
    spans, z, left = [], 0.0, False
    ends = [*((a, b, True) for a, b in sorted(constrained)), (stations[-1], stations[-1], False)]
    for a, b, right in ends:
        if a - z > near:
            first, last = (int(np.abs(stations - x).argmin()) for x in (z, a))
            spans.append(Span(first, last, left, right))
        left, z = left or right, max(z, b)
    return tuple(spans)


def _span(span: Span, lengths: Floats, soft: Floats, q: Floats) -> Floats:
    """The coefficients (C, 4, 4, K) of the internal forces in one span.

    q: (C, 3, 4, K) loads per length.
    """
    loaded = _march(lengths, q, np.zeros(q.shape[2:]))
    if not span.left:  # the left end is free, so the forces there are zero
        return loaded
    # The response to unit forces at the span's start: four redundants.
    unit = _march(lengths, np.zeros((*q.shape[:3], 4)), np.eye(4))
    # If both ends are clamped, the redundants make the deflection at the clamps zero. If the left
    # end alone is clamped, they make the forces at the free end zero.
    if span.right:
        m, f = (_at_gauss(lengths, x) for x in (unit, loaded))
        flexibility, moved = (_products(lengths, soft, m, x) for x in (m, f))
        start = np.asarray(np.linalg.solve(flexibility, -moved), np.float64)
    else:
        powers = lengths[-1] ** np.arange(4)
        ends = (np.einsum("p,pqk->qk", powers, x[-1]) for x in (unit, loaded))
        at_end, wanted = ends
        start = np.linalg.solve(at_end, -wanted)
    return _march(lengths, q, start)


def _at_gauss(lengths: Floats, coefficients: Floats) -> Floats:
    """The internal forces (C, G, 4, K) at the Gauss points of cells, from coefficients (C, 4, 4,
    K).
    """
    s = lengths[:, None] * 0.5 * (1.0 + _GAUSS_POINTS)
    return np.asarray(np.einsum("cgp,cpqk->cgqk", s[..., None] ** np.arange(4), coefficients))


def _products(lengths: Floats, soft: Floats, one: Floats, other: Floats) -> Floats:
    """The work (I, K) of forces (C, G, 4, I) on the strains by other forces (C, G, 4, K)."""
    scaled = np.einsum("c,g,cq,cgqi->cgqi", lengths / 2.0, _GAUSS_WEIGHTS, soft, one)
    return np.asarray(np.einsum("cgqi,cgqk->ik", scaled, other))


def _march(lengths: Floats, q: Floats, start: Floats) -> Floats:
    """The coefficients (C, 4, 4, K) of internal forces, cell after cell.

    q: loads per length (C, 3, 4, K); those across the pin are linear along it.
    start: V, M, N, T at the first cell's left end, (4, K).
    """
    out = np.zeros((len(lengths), 4, *q.shape[2:]))
    for c, h in enumerate(lengths):
        out[c, 0] = start
        out[c, 1] = -q[c, 0]
        out[c, 2] = -q[c, 1] / 2.0
        out[c, 3] = -q[c, 2] / 3.0
        out[c, 1:, MOMENT] = -out[c, :3, SHEAR] / np.array([1.0, 2.0, 3.0])[:, None]
        out[c, 1, MOMENT] -= q[c, 0, MOMENT]  # couples
        start = np.einsum("p,pqk->qk", h ** np.arange(4), out[c])
    return out
