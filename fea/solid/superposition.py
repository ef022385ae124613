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

MAX_PAIRED_LOADS = 12  # unit loads up to which their products in pairs are fewer than the stresses
PRODUCT_BATCH = 16  # instants at once
KEPT_INSTANTS = 256  # instants whose squares at all points are kept at once
DIRECTION_COUNT = 9  # an odd number: opposite loads give the same von Mises stress


@dataclass(frozen=True)
class Envelope:
    """maximum: largest von Mises stress (Pa) at the governing `instant`, mean over directions;
    maxima: (T,) the same at every instant.

    scatter: half its range over the directions, Pa. location: where it is (m) with the loads as
    they are. field: (S,) each surface node's largest over all instants, Pa. inside: of regions that
    the maximum leaves out, the largest stress (Pa) and where it is (m).
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
    """Largest von Mises stress over the points of the fields and all instants of a case.

    fields: with all the unit loads of which `loads` are made. outside: points (S + P,) among which
    the maximum is looked for, all by default; within: regions of which the largest stress is
    wanted, too.
    """
    points, surface = fields.points, len(fields.surface.nodes)
    among = np.ones(len(points), dtype=bool) if outside is None else outside
    directions = directions if fields.revolved else 1
    found_by = squares(fields.read)
    turned = [
        fields.coefficients(loads.turned(2.0 * np.pi * k / directions)) for k in range(directions)
    ]
    peaks = np.zeros((directions, len(loads)))
    largest = np.zeros(len(points))  # at each point, over all instants
    for first in range(0, len(loads), KEPT_INSTANTS):
        here = slice(first, first + KEPT_INSTANTS)
        for k, c in enumerate(turned):
            found = found_by(c[here])
            peaks[k, here] = found[among].max(axis=0)
            if not k:
                np.maximum(largest, found.max(axis=1), out=largest)
    peaks = np.sqrt(np.maximum(peaks, 0.0))
    maxima = peaks.mean(axis=0)
    instant = int(maxima.argmax())
    governing = found_by(turned[0][instant : instant + 1])[:, 0]

    def place(here: Mask, values: Floats) -> Point:
        x, y, z = points[here][values[here].argmax()].tolist()
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
    """Von Mises squared (S, T) from loads (T, L), of unit stresses (S, 6, L)."""
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
