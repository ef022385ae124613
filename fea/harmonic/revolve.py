"""A section's fields revolved into space: its outer skin as a surface, or all of it as a solid."""

from __future__ import annotations

import numpy as np

from fea.core.pin_loads import PinLoads
from fea.core.solution import Picture
from fea.harmonic.fields import MeridianFields
from fea.harmonic.superposition import Circumference
from geometry.arrays import Floats, Ints

SECTORS = 60
CLOSE = 1e-9  # of the length: points that are one


def revolve(fields: MeridianFields, loads: PinLoads, instant: int) -> Picture:
    """Skin and loads as they are at an instant."""
    rows = _skin(fields)
    around = Circumference(fields, loads)
    points, displacement, stress = _turned(fields, around, loads, rows, instant)
    return Picture(
        points=points,
        cells=_quads(len(rows)),
        cell_type="quad",
        displacement=displacement,
        stress=stress,
        envelope=_envelope(around, rows, _angles()),
    )


def revolve_solid(fields: MeridianFields, loads: PinLoads, instant: int) -> Picture:
    """The whole body as wedges, straight between the corners of the section's triangles; without an
    envelope.
    """
    rows, numbers = np.unique(fields.triangles, return_inverse=True)
    around = Circumference(fields, loads)
    points, displacement, stress = _turned(fields, around, loads, rows, instant)
    here = numbers.reshape(-1, 3)[:, None] * SECTORS + np.arange(SECTORS)[:, None]
    there = numbers.reshape(-1, 3)[:, None] * SECTORS + (np.arange(SECTORS)[:, None] + 1) % SECTORS
    return Picture(
        points=points,
        cells=np.concatenate([there, here], axis=2).reshape(-1, 6),
        cell_type="wedge",
        displacement=displacement,
        stress=stress,
        envelope=np.full(len(points), np.nan),
    )


def _angles() -> Floats:
    return np.asarray(np.arange(SECTORS) * 2.0 * np.pi / SECTORS)


def _turned(
    fields: MeridianFields, around: Circumference, loads: PinLoads, rows: Ints, instant: int
) -> tuple[Floats, Floats, Floats]:
    """Of every point on all meridians: x, y, z (P, 3), displacement (P, 3), stress (P, 6)."""
    r, z = np.repeat(fields.points[rows], SECTORS, axis=0).T
    angle = np.tile(_angles(), len(rows))
    rr, tt, zz, tz, rz, rt = around.stress(rows, instant, _angles()).reshape(-1, 6).T
    u_r, u_t, u_z = _moved(fields, loads, rows, instant).T
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


def _skin(fields: MeridianFields) -> Ints:
    """Points of the skin in order, those that coincide once, if neither is a corner's."""
    x = fields.points[: fields.skin]
    step = np.linalg.norm(np.diff(x, axis=0), axis=1)
    return np.flatnonzero(np.concatenate([[True], step > CLOSE * np.ptp(x[:, 1])]))


def _quads(count: int) -> Ints:
    i = np.arange(count - 1)[:, None] * SECTORS
    j = np.arange(SECTORS)[None]
    k = (j + 1) % SECTORS
    return np.stack([i + j, i + k, i + SECTORS + k, i + SECTORS + j], axis=2).reshape(-1, 4)


def _moved(fields: MeridianFields, loads: PinLoads, rows: Ints, instant: int) -> Floats:
    """Displacement along r, theta, z (P, 3) at points on all meridians."""
    amounts: dict[tuple[int, int], Floats] = {}  # of every harmonic and phase
    for load, both in loads.coefficients().items():
        unit = fields.displacement[rows, :, fields.loads.index(load)]
        for phase, amount in enumerate(both[instant]):
            amounts[load.n, phase] = amounts.get((load.n, phase), 0.0) + amount * unit
    out = np.zeros((len(rows), SECTORS, 3))
    for (n, phase), u in amounts.items():
        psi = n * _angles() - phase * np.pi / 2.0
        out += u[:, None] * np.stack([np.cos(psi), np.sin(psi), np.cos(psi)], axis=1)
    return out.reshape(-1, 3)


def _envelope(around: Circumference, rows: Ints, theta: Floats) -> Floats:
    """Largest von Mises stress over all instants at rows x angles, flat."""
    turn = len(theta) // 2 if around.odd else len(theta)  # odd harmonics: half a turn says it all
    found = around.envelope(rows, theta[:turn])
    return np.tile(found, len(theta) // turn).ravel()
