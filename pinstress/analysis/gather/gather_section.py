"""Section of a pin through its maximum, as reports draw it."""

from __future__ import annotations

from math import atan2, hypot

import numpy as np

from fea.core.pin_loads import Floats, PinLoads
from fea.core.unit_surface import SectionPlane
from geometry.shape.chords import needed
from reports.data.surface import HalfSection, Mask

# There are up to 2.5 times as many stations, of which few are kept.
SECTION_STATIONS, SECTION_ROWS = 200, 33
# Relative to the length: distance from a shoulder, on both sides, at which stress is read
SHOULDER_OFFSET = 1e-6
SECTION_STRESS_TOLERANCE = 7e-3  # relative to the maximum
RADIUS_TOLERANCE = 2e-3  # relative to the largest radius


def half_section(
    plane: SectionPlane, loads: PinLoads, instant: int, maximum: float, at: tuple[float, ...]
) -> HalfSection:
    """Return the half section through the surface's maximum, which lies outside the excluded zones.

    Stress above the maximum is limited to it, except beneath lugs.

    at: the point of the maximum (x, y, z), m.
    """
    x, y, z = at
    angle, r = atan2(y, x), hypot(x, y)
    stations = np.union1d(_stations(plane), [z])
    inner, outer = plane.walls(stations)
    k = int(np.searchsorted(stations, z))
    fraction = np.clip((r - inner[k]) / (outer[k] - inner[k]), 0.0, 1.0)
    part = np.union1d(np.sin(np.linspace(0.0, 0.5 * np.pi, SECTION_ROWS)), [fraction])
    j = int(np.searchsorted(part, fraction))
    grid = _grid(stations, inner, outer, part)
    stress = plane.von_mises(loads, instant, angle, grid)
    if loads.pressed is None:
        stress = np.minimum(stress, maximum)
    stress[0, k, j] = maximum
    allowed = np.broadcast_to(
        np.where(plane.outside(grid), SECTION_STRESS_TOLERANCE * maximum, np.inf), stress.shape
    )
    walls = np.stack([inner, outer], axis=1)
    rows = _needed(stations, stress, allowed, k, walls)
    stress, allowed = (np.swapaxes(x[:, rows], 1, 2) for x in (stress, allowed))
    columns = _needed(part, stress, allowed, j)
    stress = np.swapaxes(stress[:, columns], 1, 2)
    return HalfSection(angle, stations[rows], inner[rows], outer[rows], part[columns], stress)


def _stations(plane: SectionPlane) -> Floats:
    """Return stations along z, close together where the mesh is fine, and in pairs at shoulders."""
    r, z = plane.skin.T
    low, high = float(z.min()), float(z.max())
    near = SHOULDER_OFFSET * (high - low)
    faces = z[:-1][(np.abs(np.diff(z)) < near) & (np.abs(np.diff(r)) > near)]
    fine = np.round((z - low) / (high - low) * 2 * SECTION_STATIONS) / (2 * SECTION_STATIONS)
    along = low + (high - low) * np.union1d(fine, np.linspace(0.0, 1.0, SECTION_STATIONS // 2))
    clear = np.abs(along[:, None] - faces).min(axis=1) > 2.0 * near
    both = np.concatenate([[low, high], along[clear], faces - near, faces + near])
    return np.unique(np.clip(both, low, high))


def _grid(z: Floats, inner: Floats, outer: Floats, part: Floats) -> Floats:
    """Return points (Z, R, 2), r and z, slightly inside the pin, so that round-off puts none
    outside.
    """
    safe = 1.0 - SHOULDER_OFFSET
    r = inner[:, None] + (outer - inner)[:, None] * (0.5 + safe * (part - 0.5))
    near = SHOULDER_OFFSET * (z[-1] - z[0])
    within = np.clip(z, z[0] + near, z[-1] - near)
    return np.stack([r, np.broadcast_to(within[:, None], r.shape)], axis=2)


def _needed(
    at: Floats, stress: Floats, allowed: Floats, peak: int, radii: Floats | None = None
) -> Mask:
    """Return which of N positions to keep.

    stress, allowed: (2, N, ..), the stress and its tolerance.
    peak: index of a position that is kept in any case.
    radii: (N, 2), inner and outer radius.
    """
    values, within = (np.moveaxis(x, 1, 0).reshape(len(at), -1) for x in (stress, allowed))
    if radii is not None:
        values = np.concatenate([values, radii], axis=1)
        within = np.concatenate(
            [within, np.full(radii.shape, RADIUS_TOLERANCE * radii.max())], axis=1
        )
    # A pin without any stress has zero tolerance; a tiny one lets its zeros pass.
    return needed(at, values, within + np.finfo(float).tiny, np.arange(len(at)) == peak)
