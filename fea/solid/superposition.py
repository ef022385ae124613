"""The maximum over all instants and all points that are read, by superposing unit fields.

Von Mises squared is a quadratic form of the stress, so at every point it is c . M c with the
instant's loads c: two matrix products cover any number of instants. With many unit loads the
stresses themselves take fewer operations.

A body of revolution must answer the same whichever way round it is loaded; its mesh does not quite.
So all loads are also turned together about the axis: the mean over these directions is the maximum,
and how far they scatter is a part of its error that is seen directly. Any other body is loaded as
it is.
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

# They limit time and memory alone.
MAX_PAIRED_LOADS = 12  # unit loads up to which products in pairs take less time than stresses
PRODUCT_BATCH = 16  # instants of stresses at once
KEPT_INSTANTS = 256  # instants whose squares at all points are kept at once
# Directions to which loads are turned, chosen by judgement; odd, as opposite ones are equivalent.
DIRECTION_COUNT = 9


@dataclass(frozen=True)
class Envelope:
    """The largest von Mises stress of a case.

    maximum: Pa, at the governing `instant`, the mean over directions.
    maxima: (T,) the same at every instant.
    scatter: half its range over the directions, Pa.
    location: m, with the loads as they are.
    field: (S,) each surface node's largest over all instants, Pa.
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

    fields: with all the unit loads of which `loads` are made.
    outside: (S + P,) points among which the maximum is looked for, all by default.
    within: regions of which the largest stress is wanted as well.
    directions: number of turned loads for a body of revolution.
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
    """A function that gives von Mises squared (S, T) from amounts of loads (T, L).

    stress: (S, 6, L) unit stresses.
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
