"""A section's fields revolved into space: its outer skin as a surface, or all of it as a solid."""

from __future__ import annotations

import numpy as np

from fea.core.pin_loads import PinLoads
from fea.core.solution import Picture
from fea.harmonic.fields import MeridianFields
from fea.harmonic.shown_surface import ShownStress, shown_surface
from fea.harmonic.superposition import Circumference
from pinbase.arrays import Floats, Ints


def revolve(fields: MeridianFields, loads: PinLoads, instant: int, nu: float) -> Picture:
    """Skin and loads as they are at an instant; nu: Poisson's ratio."""
    shown = shown_surface(fields, loads, nu)
    stress, pressed = shown.stress(instant)
    points, displacement, turned = _turned(fields, loads, shown, shown.rows, instant, stress)
    return Picture(
        points=points,
        cells=_quads(len(shown.rows), len(shown.angles)),
        cell_type="quad",
        displacement=displacement,
        stress=turned,
        envelope=shown.envelope(instant).ravel(),
        pressed=None if loads.pressed is None else pressed.ravel(),
    )


def revolve_solid(fields: MeridianFields, loads: PinLoads, instant: int, nu: float) -> Picture:
    """The whole body as wedges, straight between the corners of the section's triangles, its
    surface as `revolve` shows it; without an envelope.
    """
    rows, numbers = np.unique(fields.triangles, return_inverse=True)
    shown = shown_surface(fields, loads, nu)
    stress = Circumference(fields, loads).stress(rows, instant, shown.angles)
    pressed = np.zeros(stress.shape[:2], dtype=bool)
    if loads.pressed is not None:
        outer = np.flatnonzero(rows < fields.skin)
        place = np.searchsorted(shown.rows, rows[outer], side="right") - 1
        on_skin, on = shown.stress(instant)
        stress[outer], pressed[outer] = on_skin[place], on[place]
    points, displacement, turned = _turned(fields, loads, shown, rows, instant, stress)
    return Picture(
        points=points,
        cells=_wedges(numbers.reshape(-1, 3), len(shown.angles)),
        cell_type="wedge",
        displacement=displacement,
        stress=turned,
        envelope=np.full(len(points), np.nan),
        pressed=None if loads.pressed is None else pressed.ravel(),
    )


def _turned(
    fields: MeridianFields,
    loads: PinLoads,
    shown: ShownStress,
    rows: Ints,
    instant: int,
    stress: Floats,
) -> tuple[Floats, Floats, Floats]:
    """Of every point on all meridians: x, y, z (P, 3), displacement (P, 3), stress (P, 6), which is
    (rows, A, 6) in cylindrical coordinates.
    """
    sectors = len(shown.angles)
    r, z = np.repeat(fields.points[rows], sectors, axis=0).T
    angle = np.tile(shown.angles, len(rows))
    rr, tt, zz, tz, rz, rt = stress.reshape(-1, 6).T
    u_r, u_t, u_z = _moved(fields, loads, rows, instant, shown.angles).T
    c, s = np.cos(angle), np.sin(angle)
    twice = 2.0 * c * s * rt
    return (
        np.stack([r * c, r * s, z], axis=1),
        np.stack([c * u_r - s * u_t, s * u_r + c * u_t, u_z], axis=1),
        np.stack(
            [
                c * c * rr - twice + s * s * tt,
                s * s * rr + twice + c * c * tt,
                zz,
                s * rz + c * tz,
                c * rz - s * tz,
                c * s * (rr - tt) + (c * c - s * s) * rt,
            ],
            axis=1,
        ),
    )


def _quads(count: int, sectors: int) -> Ints:
    i = np.arange(count - 1)[:, None] * sectors
    j = np.arange(sectors)[None]
    k = (j + 1) % sectors
    return np.stack([i + j, i + k, i + sectors + k, i + sectors + j], axis=2).reshape(-1, 4)


def _wedges(triangles: Ints, sectors: int) -> Ints:
    """Of triangles (M, 3) of numbered rows."""
    turn = np.arange(sectors)[:, None]
    here = triangles[:, None] * sectors + turn
    there = triangles[:, None] * sectors + (turn + 1) % sectors
    return np.concatenate([there, here], axis=2).reshape(-1, 6)


def _moved(
    fields: MeridianFields, loads: PinLoads, rows: Ints, instant: int, angles: Floats
) -> Floats:
    """Displacement along r, theta, z (P, 3) at points on all meridians."""
    amounts: dict[tuple[int, int], Floats] = {}  # of every harmonic and phase
    for load, both in loads.coefficients().items():
        unit = fields.displacement[rows, :, fields.loads.index(load)]
        for phase, amount in enumerate(both[instant]):
            amounts[load.n, phase] = amounts.get((load.n, phase), 0.0) + amount * unit
    out = np.zeros((len(rows), len(angles), 3))
    for (n, phase), u in amounts.items():
        psi = n * angles - phase * np.pi / 2.0
        out += u[:, None] * np.stack([np.cos(psi), np.sin(psi), np.cos(psi)], axis=1)
    return out.reshape(-1, 3)
