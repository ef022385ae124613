"""Reduction of a pin's surface to the meridian points and unit loads that suffice to draw it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fea.core.pin_loads import Floats
from fea.core.unit_surface import UnitSurface
from geometry.shape.chords import needed
from reports.data.surface import Mask, SurfaceCase

# Relative to the stress at a point, at least to MIN_STRESS_SHARE of the largest at the instant
STRESS_TOLERANCE = 8e-3
MIN_STRESS_SHARE = 0.1
SAMPLE_ANGLES = 16
# Rows of the eight components of a surface: five stresses, three displacements
STRESS_COMPONENTS, DISPLACEMENT_COMPONENTS = slice(0, 5), slice(5, 8)
SAMPLE_INSTANTS = 8  # approximate number of instants of a motion, besides the governing one
DISPLACEMENT_TOLERANCE = 5e-3  # relative to the largest displacement
OUTLINE_TOLERANCE = 2e-4  # relative to the length
# Relative to the largest stress of a case: the least contribution of a unit load that is kept
MIN_UNIT_LOAD_SHARE = 1e-2
GOVERNING_WEIGHT = 5.0
MAX_CORNER_COSINE = 0.94  # the largest cosine of the change of direction that counts as a corner
COINCIDENCE_DISTANCE = 1e-9  # relative to the length: closer points coincide


def meridian_points(surface: UnitSurface, cases: Sequence[SurfaceCase], required: Mask) -> Mask:
    """Return which points (P,) of a meridian to keep.

    The kept points preserve the shape, displacements and stresses in all cases, except stresses
    that every case excludes.

    required: (P,) points that are kept in any case.
    """
    x, excluded = surface.points, np.all([c.excluded for c in cases], axis=0)
    size = float(np.ptp(x, axis=0).max())
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(x, axis=0), axis=1))])
    values, allowed = [x[:, [0, 2]]], [np.full((len(x), 2), OUTLINE_TOLERANCE * size)]
    for case in cases:
        for instant in sorted({case.instant, *range(0, len(case.amounts), _step(case))}):
            stress = np.linalg.norm(
                _around(surface, case.amounts[instant], STRESS_COMPONENTS), axis=1
            )
            top = max(stress[~excluded].max(initial=0.0), MIN_STRESS_SHARE * case.maxima.max())
            values.append(stress)
            allowed.append(STRESS_TOLERANCE * np.maximum(stress, MIN_STRESS_SHARE * top))
            allowed[-1][excluded] = np.inf
        moved = _around(surface, case.amounts[case.instant], DISPLACEMENT_COMPONENTS).reshape(
            len(x), -1
        )
        values.append(moved)
        allowed.append(np.full(moved.shape, DISPLACEMENT_TOLERANCE * float(np.abs(moved).max())))
    keep = required | _corners(x, COINCIDENCE_DISTANCE * size) | _ends(excluded)
    # A case without stress has zero tolerance; a tiny one lets its zeros pass.
    within = np.concatenate(allowed, axis=1) + np.finfo(float).tiny
    return needed(along, np.concatenate(values, axis=1), within, keep)


def fewer_loads(
    surface: UnitSurface, cases: Sequence[SurfaceCase]
) -> tuple[UnitSurface, list[SurfaceCase]]:
    """Return the surface with as few unit loads as reproduce the fields of all cases.

    The significant singular vectors of each harmonic replace its unit loads, of which there are
    many under contact.
    """
    fields = np.concatenate([surface.stress, surface.displacement * _scale(surface, cases)], axis=1)
    acting = [_weighed(c) for c in cases]
    n: list[int] = []
    mixes: list[Floats] = []  # of the old unit loads, (K, K')
    now: list[list[Floats]] = [[] for _ in cases]
    for harmonic in np.unique(surface.n).tolist():
        columns = np.flatnonzero(surface.n == harmonic)
        root = np.linalg.qr(fields[:, :, columns].reshape(-1, len(columns)), mode="r")
        together = np.concatenate(
            [a[:, columns].transpose(1, 0, 2).reshape(len(columns), -1) for a in acting], 1
        )
        vectors, size, times = np.linalg.svd(root @ together, full_matrices=False)
        most = np.abs(size[:, None] * times).max(axis=1, initial=0.0)
        vectors = vectors[:, most > MIN_UNIT_LOAD_SHARE]
        mix = np.zeros((len(surface.n), vectors.shape[1]))
        mix[columns] = np.linalg.lstsq(root, vectors)[0]
        mixes.append(mix)
        n += [harmonic] * vectors.shape[1]
        for case, out in zip(cases, now, strict=True):
            out.append(np.einsum("jk,tkp->tjp", vectors.T @ root, case.amounts[:, columns]))
    mix = np.concatenate(mixes, axis=1)
    fewer = replace(
        surface,
        n=np.array(n, dtype=np.int64),
        stress=surface.stress @ mix,
        displacement=surface.displacement @ mix,
    )
    return fewer, [
        replace(c, amounts=np.concatenate(out, axis=1)) for c, out in zip(cases, now, strict=True)
    ]


def by_instants(
    surface: UnitSurface, cases: Sequence[SurfaceCase]
) -> tuple[UnitSurface, list[SurfaceCase]]:
    """Return the surface of a body that is not of revolution, with the fields at all instants of
    its cases in place of the fields of unit loads, if there are fewer instants than unit loads.
    """
    amounts = np.concatenate([case.amounts[:, :, 0] for case in cases])
    if len(amounts) >= len(surface.n):
        return surface, list(cases)
    fields = replace(
        surface,
        n=np.zeros(len(amounts), dtype=np.int64),
        stress=surface.stress @ amounts.T,
        displacement=surface.displacement @ amounts.T,
    )
    each = np.stack([np.eye(len(amounts)), np.zeros((len(amounts),) * 2)], axis=2)
    ends = np.cumsum([len(case.amounts) for case in cases])
    own = np.split(each, ends[:-1])
    return fields, [replace(c, amounts=a) for c, a in zip(cases, own, strict=True)]


def _weighed(case: SurfaceCase) -> Floats:
    """Return amounts for which the largest stress is one, with more weight on the governing
    instant.
    """
    weight = np.ones(len(case.amounts))
    weight[case.instant] = GOVERNING_WEIGHT
    return np.asarray(case.amounts * weight[:, None, None] / (case.maxima.max() or 1.0))


def _scale(surface: UnitSurface, cases: Sequence[SurfaceCase]) -> float:
    """Return the ratio of stress to displacement, Pa/m, in the first case that moves the pin."""
    for case in cases:
        stress, moved = (
            float(np.abs(_around(surface, case.amounts[case.instant], x)).max())
            for x in (STRESS_COMPONENTS, DISPLACEMENT_COMPONENTS)
        )
        if moved:
            return stress / moved
    return 0.0


def _step(case: SurfaceCase) -> int:
    return max(1, len(case.amounts) // SAMPLE_INSTANTS)


def _around(surface: UnitSurface, amount: Floats, which: slice) -> Floats:
    """Return some components of the surface (`which`), (P, C, SAMPLE_ANGLES), under amounts
    (K, 2).
    """
    turns = surface.n * np.linspace(0.0, 2.0 * np.pi, SAMPLE_ANGLES, endpoint=False)[:, None]
    c, s = np.cos(turns), np.sin(turns)
    first, second = amount.T
    eight = np.concatenate([surface.stress, surface.displacement], axis=1)[:, which]
    even = np.array(surface.even)[which, None]
    values = np.where(even, eight @ (c * first + s * second).T, eight @ (s * first - c * second).T)
    return np.asarray(values)


def _ends(mask: Mask) -> Mask:
    """Return the points whose neighbour has the other value of the mask."""
    differs = mask[1:] != mask[:-1]
    return np.asarray(np.append(differs, False) | np.insert(differs, 0, False))


def _corners(x: Floats, close: float) -> Mask:
    """Return the points (P,) at which the meridian changes direction sharply.

    A corner has two points of one position.
    """
    step = np.diff(x, axis=0)
    length = np.linalg.norm(step, axis=1)
    corners = np.zeros(len(x), dtype=bool)
    for k in np.flatnonzero(length[1:-1] < close) + 1:
        turn = step[k - 1] @ step[k + 1]
        if turn < MAX_CORNER_COSINE * length[k - 1] * length[k + 1]:
            corners[[k, k + 1]] = True
    return corners
