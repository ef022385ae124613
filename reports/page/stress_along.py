"""The governing case of a pin for its drawing: the stress along the pin, and its loads."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import atan2, cos, degrees, radians, sin

import numpy as np

from pinbase.dimensions import Floats
from reports.data.decision import worst_first
from reports.data.results import PinShape, Results
from reports.data.row import PinResult
from reports.data.surface import Surface, SurfaceCase
from reports.plots.stress.surface import outline_sides, unread_points

MIN_OUT_OF_PLANE_SHARE = 0.3  # of a force; a smaller part out of the plane is not drawn
SOLID_BINS = 120  # along a pin that is not a body of revolution; each has one stress


@dataclass(frozen=True)
class LoadMark:
    """The force of a link on the pin.

    band: on which the force acts. z: middle of the band. size: of the force.
    up, towards: its components upwards on the drawing and towards the viewer; both 0 where the band
    is clamped.
    """

    band: str
    z: float
    size: float
    up: float
    towards: float

    @property
    def out_of_plane(self) -> bool:
        """Whether the force leaves the plane of the drawing."""
        return abs(self.towards) > MIN_OUT_OF_PLANE_SHARE * self.size


@dataclass(frozen=True)
class StressAlong:
    """The stress along a pin in a case, and its loads, at the governing instant.

    angle: of the drawing's upward direction from x, degrees.
    loads: of the links.
    surface: curves of z (N,) and stress (N,), which is NaN where stress is not read.
    section: the largest stress of sections, likewise; without points where it is not known.
    line_loads: of the lugs on the pin: start z, end z and load per length upwards of each ring.
    z, maximum: of the row.
    allowed: the stress that the required factor permits.
    """

    case: str
    angle: float
    loads: tuple[LoadMark, ...]
    surface: tuple[tuple[Floats, Floats], ...]
    section: tuple[Floats, Floats]
    line_loads: tuple[tuple[float, float, float], ...]
    z: float | None
    maximum: float | None
    allowed: float | None

    @property
    def drawn(self) -> bool:
        """Whether there is any curve."""
        return bool(self.surface or len(self.section[0]))

    @property
    def top(self) -> float:
        """The largest stress of surface, section and row; 1 for a pin without stress."""
        curves = [s for _, s in self.surface] + [self.section[1]]
        largest = [float(np.nanmax(s)) for s in curves if np.isfinite(s).any()]
        return max([*largest, self.maximum or 0.0]) or 1.0


def governing_rows(results: Results) -> dict[str, PinResult]:
    """Return the worst row of every pin."""
    return {row.pin: row for row in reversed(worst_first(results))}


def stress_along(results: Results, shape: PinShape) -> StressAlong | None:
    """Return the stress and loads of a pin's governing case; None if the pin was not solved."""
    row = governing_rows(results).get(shape.pin)
    if row is None or row.max_von_mises is None:
        return None
    surface, case = surface_of(results, row)
    forces = _forces(row, shape, case)
    angle = 0.0 if shape.cuts else _upwards([force for *_, force in forces])
    section = row.places.section.course if row.places and row.places.section else ()
    allowed = None if row.yield_strength is None else row.yield_strength / (row.required or 1.0)
    marks = tuple(_mark(band, z, force, angle) for band, z, force in forces)
    return StressAlong(
        row.case,
        angle,
        marks,
        () if surface is None or case is None else _curves(surface, case),
        (np.array([z for z, _ in section]), np.array([s for _, s in section])),
        tuple(_line_loads(row, marks)),
        None if row.location is None else row.location[2],
        row.max_von_mises,
        allowed,
    )


def surface_of(results: Results, row: PinResult) -> tuple[Surface, SurfaceCase] | tuple[None, None]:
    """Return the surface of a row's pin with the row's case; a pair of None if there is none."""
    for surface in results.surfaces:
        for case in surface.cases:
            if (surface.pin, case.case) == (row.pin, row.case):
                return surface, case
    return None, None


def _forces(
    row: PinResult, shape: PinShape, case: SurfaceCase | None
) -> list[tuple[str, float, Floats]]:
    """Return band, z and force (3,) of every link, and of the lugs on which no link acts.

    The forces are in pin axes, or without fields of the pin in world axes.
    """
    bands = _bands(shape)
    if case is None:
        return [
            (x.connection, bands[x.connection][0], x.force)
            for x in row.loads
            if x.connection in bands
        ]
    links = {x.connection for x in case.loads}
    reactions = [
        (k, bands[k][0], f) for k, f in _lugs(row).items() if k in bands and k not in links
    ]
    return [(x.connection, x.z, x.forces[case.instant]) for x in case.loads] + reactions


def _lugs(row: PinResult) -> dict[str, Floats]:
    """Return the force (3,) of every lug on the pin; empty where they are not known."""
    along = row.joint.along if row.joint else None
    if along is None:
        return {}
    instant = 0
    if along.times is not None and row.time is not None:
        instant = int(np.abs(along.times - row.time).argmin())
    return {k: np.append(along.forces[instant, n], 0.0) for n, k in enumerate(along.lugs)}


def _bands(shape: PinShape) -> dict[str, tuple[float, float]]:
    """Return the z of the middle and the diameter of every segment, by label."""
    z, bands = 0.0, {}
    for length, diameter, _, label, _ in shape.segments:
        bands[label] = z + 0.5 * length, diameter
        z += length
    return bands


def _upwards(forces: list[Floats]) -> float:
    """Return the angle of the largest force from x, degrees, reversed if that points it towards x
    and y.
    """
    x, y, _ = max(forces, key=lambda f: float(np.hypot(f[0], f[1])), default=np.zeros(3)).tolist()
    if x + y < 0.0:
        x, y = -x, -y
    return degrees(atan2(y, x))


def _mark(band: str, z: float, force: Floats, angle: float) -> LoadMark:
    c, s = cos(radians(angle)), sin(radians(angle))
    x, y, _ = force.tolist()
    return LoadMark(band, z, float(np.linalg.norm(force)), c * x + s * y, c * y - s * x)


def _curves(surface: Surface, case: SurfaceCase) -> tuple[tuple[Floats, Floats], ...]:
    z = surface.points[:, 2]
    read = np.where(case.excluded | unread_points(case), np.nan, case.largest)
    if surface.revolved:
        return tuple((z[part], read[part]) for part in outline_sides(z).values())
    edges = np.linspace(float(z.min()), float(z.max()), SOLID_BINS + 1)
    bins = np.clip(np.searchsorted(edges, z, side="right") - 1, 0, SOLID_BINS - 1)
    largest = np.full(SOLID_BINS, np.nan)
    for k in np.unique(bins[np.isfinite(read)]).tolist():
        largest[k] = float(np.nanmax(read[bins == k]))
    return ((0.5 * (edges[1:] + edges[:-1]), largest),)


def _line_loads(
    row: PinResult, marks: tuple[LoadMark, ...]
) -> Iterator[tuple[float, float, float]]:
    """Yield the ends of each ring, and the component of its load per length upwards on
    the drawing.
    """
    by_band = {mark.band: mark for mark in marks if mark.size > 0.0}
    for band in row.joint.bands if row.joint else ():
        if band.name in by_band:
            mark = by_band[band.name]
            z = band.ends or tuple(z for z, _ in band.line_load)
            for start, end, (_, load) in zip(z, z[1:], band.line_load, strict=False):
                yield start, end, load * mark.up / mark.size
