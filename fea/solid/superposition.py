"""The maximum over all instants and all points that are read, by superposing unit fields.

Von Mises squared is a quadratic form of the stress, so at every point it is c . M c with the
amounts c of the unit loads at an instant: two matrix products cover any number of instants. With
many unit loads, computing the stresses themselves takes fewer operations.

The maximum of a body of revolution must not depend on the direction of its loads about the axis;
because of the mesh it does slightly. So all loads are also turned together about the axis. The mean
over these directions is the maximum, and their scatter is a directly observed part of its error.
Any other body is loaded as it is.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fea.core.mesh_result import Point
from fea.core.pin_loads import Loads
from fea.core.voigt import VON_MISES
from fea.solid.model import UnitFields
from pinbase.arrays import Floats, Mask

# These limit time and memory, and do not change the result.
MAX_PAIRED_LOADS = 12  # most unit loads for which products of pairs take less time than stresses
PRODUCT_BATCH = 16  # instants whose stresses are computed together
KEPT_INSTANTS = 256  # instants whose squares at all points are held in memory together
# Number of directions to which loads are turned, chosen by judgement; odd, since opposite
# directions are equivalent.
DIRECTION_COUNT = 9


@dataclass(frozen=True)
class Envelope:
    """The largest von Mises stress of a case.

    maximum: Pa, at the governing `instant`, the mean over directions.
    scatter: half the range of that stress over the directions, Pa.
    location: m, with the loads as they are.
    field: (S,) Pa, the largest stress of each surface node over all instants.
    maxima: (T,) Pa, the maximum at every instant.
    inside: the largest stress (Pa) and its location (m) in each excluded region.
    """

    maximum: float
    scatter: float
    instant: int
    location: Point
    field: Floats
    maxima: Floats
    inside: tuple[tuple[float, Point], ...] = ()


def envelope(
    fields: UnitFields,
    loads: Loads,
    outside: Mask | None = None,
    within: Sequence[Mask] = (),
    directions: int = DIRECTION_COUNT,
) -> Envelope:
    """The largest von Mises stress over the points of the fields and all instants of a case.

    fields: of all the unit loads of which `loads` consist.
    outside: (S + P,) mask of the points that are searched, all by default.
    within: masks of regions whose largest stress is found, too.
    directions: number of directions to which the loads of a body of revolution are turned.
    """
    points, surface = fields.points, len(fields.surface.nodes)
    among = np.ones(len(points), dtype=bool) if outside is None else outside
    directions = directions if fields.revolved else 1
    square_of = squares(fields.read)
    turned = [
        fields.coefficients(loads.turned(2.0 * np.pi * k / directions)) for k in range(directions)
    ]
    peaks = np.zeros((directions, len(loads)))
    largest = np.zeros(len(points))  # at each point, over all instants
    for first in range(0, len(loads), KEPT_INSTANTS):
        here = slice(first, first + KEPT_INSTANTS)
        for k, c in enumerate(turned):
            square = square_of(c[here])
            peaks[k, here] = square[among].max(axis=0, initial=0.0)
            if not k:
                np.maximum(largest, square.max(axis=1), out=largest)
    peaks = np.sqrt(np.maximum(peaks, 0.0))
    maxima = peaks.mean(axis=0)
    instant = int(maxima.argmax())
    governing = square_of(turned[0][instant : instant + 1])[:, 0]

    def place(here: Mask, values: Floats) -> Point:
        x, y, z = points[np.where(here, values, -np.inf).argmax()].tolist()
        return (x, y, z)

    return Envelope(
        maximum=float(maxima[instant]),
        scatter=float(np.ptp(peaks[:, instant])) / 2.0,
        instant=instant,
        location=place(among, governing),
        field=np.sqrt(largest[:surface]),
        maxima=maxima,
        inside=tuple((float(np.sqrt(largest[m].max())), place(m, largest)) for m in within),
    )


def squares(stress: Floats) -> Callable[[Floats], Floats]:
    """Return a function that gives von Mises squared (S, T), Pa^2, from amounts of loads (T, L).

    stress: (S, 6, L) Pa, unit stresses.
    """
    if stress.shape[2] > MAX_PAIRED_LOADS:

        def direct(c: Floats) -> Floats:
            parts = (stress @ c[k : k + PRODUCT_BATCH].T for k in range(0, len(c), PRODUCT_BATCH))
            return np.concatenate(
                [np.einsum("sit,ij,sjt->st", s, VON_MISES, s, optimize=True) for s in parts], axis=1
            )

        return direct
    a, b = np.triu_indices(stress.shape[2])
    form = np.einsum("nik,ij,njl->nkl", stress, VON_MISES, stress, optimize=True)[:, a, b]
    twice = np.where(a == b, 1.0, 2.0)
    return lambda c: np.asarray(form @ (c[:, a] * c[:, b] * twice).T)
