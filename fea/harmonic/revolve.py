"""The fields of a section revolved about the axis: the outer skin as a surface, or the whole body
as a solid.
"""

from __future__ import annotations

import numpy as np

from fea.core.pin_loads import PinLoads
from fea.core.solution import Picture
from fea.harmonic.fields import MeridianFields
from fea.harmonic.shown_surface import ShownStress, shown_surface
from fea.harmonic.superposition import Circumference
from pinbase.arrays import Floats, Ints


def revolve(fields: MeridianFields, loads: PinLoads, instant: int, nu: float) -> Picture:
    """The skin of a pin as a surface, at an instant; nu: Poisson's ratio."""
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
    """The whole body as wedges at an instant, without an envelope.

    Wedges are straight between the corners of the section's triangles. The surface is that of
    `revolve`.
    """
    rows, numbers = np.unique(fields.triangles, return_inverse=True)
    shown = shown_surface(fields, loads, nu)
    stress = Circumference(fields, loads).stress(rows, instant, shown.angles)
    pressed = np.zeros(stress.shape[:2], dtype=bool)
    if loads.pressed is not None:
        # On the surface, the stress that `revolve` shows replaces that of the section's points.
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
    """The position (P, 3), m, displacement (P, 3), m, and stress (P, 6), Pa, of rows on all
    meridians, in x, y, z.

    stress: (rows, A, 6) Pa, in cylindrical coordinates.
    """
    sectors = len(shown.angles)
    r, z = np.repeat(fields.points[rows], sectors, axis=0).T
    angle = np.tile(shown.angles, len(rows))
    rr, tt, zz, tz, rz, rt = stress.reshape(-1, 6).T
    u_r, u_t, u_z = _moved(fields, loads, rows, instant, shown.angles).T
    c, s = np.cos(angle), np.sin(angle)
    # Rotation of the tensor from cylindrical to Cartesian axes.
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
    """The quadrilaterals between adjacent rows and sectors, which close over the circumference."""
    i = np.arange(count - 1)[:, None] * sectors
    j = np.arange(sectors)[None]
    k = (j + 1) % sectors
    return np.stack([i + j, i + k, i + sectors + k, i + sectors + j], axis=2).reshape(-1, 4)


def _wedges(triangles: Ints, sectors: int) -> Ints:
    """The wedges (.., 6) between adjacent sectors over triangles (M, 3) of numbered rows."""
    turn = np.arange(sectors)[:, None]
    meridian = triangles[:, None] * sectors + turn
    next_meridian = triangles[:, None] * sectors + (turn + 1) % sectors
    return np.concatenate([next_meridian, meridian], axis=2).reshape(-1, 6)


def _moved(
    fields: MeridianFields, loads: PinLoads, rows: Ints, instant: int, angles: Floats
) -> Floats:
    """The displacements (P, 3), m, along r, theta, z of rows on all meridians."""
    amounts: dict[tuple[int, int], Floats] = {}  # of every harmonic and phase, (P, 3)
    for load, both in loads.coefficients().items():
        unit = fields.displacement[rows, :, fields.loads.index(load)]
        for phase, amount in enumerate(both[instant]):
            amounts[load.n, phase] = amounts.get((load.n, phase), 0.0) + amount * unit
    out = np.zeros((len(angles), len(rows), 3))
    if amounts:
        turns = np.array([n * angles - phase * np.pi / 2.0 for n, phase in amounts]).T
        whole = np.stack(list(amounts.values()))
        out[..., [0, 2]] = np.tensordot(np.cos(turns), whole[..., [0, 2]], axes=1)
        out[..., 1] = np.sin(turns) @ whole[..., 1]
    return out.swapaxes(0, 1).reshape(-1, 3)
