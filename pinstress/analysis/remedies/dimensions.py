"""The dimensions of a pin, by the keys of its table in the study."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from itertools import groupby

from geometry import Pin, PinLike, body_of_revolution
from geometry.shape.dimensions import KEY_JOINT, Dimension, dimensions
from pinbase.keys import key_part
from pinstress.study.model.pins import by_corners
from pinstress.study.reading.file import Study
from pinstress.study.schema.pins import PinTable

TableChange = Callable[[PinTable, float], PinTable]
MERIDIAN_KEYS = "meridian", "bore_meridian"
Z_INDEX, R_INDEX, RADIUS_INDEX = range(3)  # positions of the numbers of a corner


def dimensions_of(study: Study, pin: PinLike) -> Iterator[Dimension]:
    """Yield the non-zero dimensions of a body of revolution, m; none of other pins or of a pin from
    a file.

    The dimensions are those of the profile (geometry.shape.dimensions) or of the outline's corners,
    where "meridian[3][2]" is the radius of the third corner.
    """
    table = study.table.pin[pin.name]
    profile = body_of_revolution(pin)
    if profile is None or table.geometry is not None:
        return
    if table.profile is not None:
        yield from dimensions(profile)
        return
    for key, value, changes in (*_along(table), *_across(table), *_radii(table)):
        yield Dimension(key, value, partial(_changed, pin.name, table, changes))


def _changed(name: str, table: PinTable, changes: list[TableChange], value: float) -> Pin:
    for change in changes:
        table = change(table, value)
    return by_corners(name, table)


def _corner(line: str, corner: int, at: int) -> TableChange:
    def change(table: PinTable, value: float) -> PinTable:
        corners = list(getattr(table, line))
        numbers = corners[corner]
        corners[corner] = (*numbers[:at], value, *numbers[at + 1 :])
        return table.model_copy(update={line: corners})

    return change


def _band(name: str, end: int) -> TableChange:
    def change(table: PinTable, value: float) -> PinTable:
        band = table.band[name]
        first, last = band.z or (0.0, 0.0)
        moved = band.model_copy(update={"z": (first, value) if end else (value, last)})
        return table.model_copy(update={"band": {**table.band, name: moved}})

    return change


def _along(table: PinTable) -> Iterator[tuple[str, float, list[TableChange]]]:
    """Yield the dimensions along z; corners and bands at one z change together."""
    coordinates: list[tuple[float, str, TableChange]] = []
    for line in MERIDIAN_KEYS:
        for k, corner in enumerate(getattr(table, line) or ()):
            coordinates.append((corner[Z_INDEX], f"{line}[{k + 1}][1]", _corner(line, k, Z_INDEX)))
    for name, band in table.band.items():
        for end, z in enumerate(band.z or ()):
            coordinates.append((z, f"band.{key_part(name)}.z[{end + 1}]", _band(name, end)))
    for z, run in groupby(sorted(coordinates, key=lambda one: one[0]), lambda one: one[0]):
        some = list(run)
        if z:
            keys = KEY_JOINT.join(key for _, key, __ in some)
            yield keys, z, [change for _, __, change in some]


def _across(table: PinTable) -> Iterator[tuple[str, float, list[TableChange]]]:
    """Yield the dimensions along r; neighbours of equal radius change together."""
    for line in MERIDIAN_KEYS:
        corners = enumerate(getattr(table, line) or ())
        for r, run in groupby(corners, lambda one: one[1][R_INDEX]):
            some = [k for k, _ in run]
            where = f"{some[0] + 1}" if not some[1:] else f"{some[0] + 1}-{some[-1] + 1}"
            if r:
                yield f"{line}[{where}][2]", r, [_corner(line, k, R_INDEX) for k in some]


def _radii(table: PinTable) -> Iterator[tuple[str, float, list[TableChange]]]:
    for line in MERIDIAN_KEYS:
        for k, corner in enumerate(getattr(table, line) or ()):
            if len(corner) > RADIUS_INDEX and corner[RADIUS_INDEX]:
                yield f"{line}[{k + 1}][3]", corner[RADIUS_INDEX], [_corner(line, k, RADIUS_INDEX)]
