"""The way in which stress is read at the governing point, found from the number of the point."""

from __future__ import annotations

import numpy as np

from assess.derivatives.reading_point import (
    AtJump,
    Continued,
    FromInside,
    OnSkin,
    ReadingPoint,
    Relieved,
    Samples,
    at_node,
    at_rough,
    nearest,
    on_axis,
    on_skin,
)
from assess.derivatives.records import SolvedCase
from fea.core.zone import Zone
from fea.harmonic.assembly import Section
from fea.harmonic.free_surface import surface_points
from fea.harmonic.model import HarmonicModel
from fea.harmonic.pressure_edge import EDGE_DIRECTIONS, jumps
from fea.harmonic.surface_stress import EDGE_STATIONS
from pinbase.arrays import Floats


def point_of(
    model: HarmonicModel, solved: SolvedCase, traction: Floats, number: int
) -> ReadingPoint:
    """Return the reading point with a number as in fea.harmonic.stress_recovery: Reading.

    Where lugs press on the pin, the numbers are those of fea.harmonic.free_surface: SurfacePoints.
    traction: (E, 3, 3, K) Pa.
    """
    fields, pressed = solved.solution.fields, solved.loads.pressed
    if pressed is None:
        return _of_section(model, solved, traction, number)
    of = surface_points(fields, pressed.rings, solved.material.poisson_ratio)
    cusp = of.cusps.get(number)
    if cusp is not None:
        edges, at = np.divmod(cusp.near, len(EDGE_STATIONS))
        nodes = model.space.nodes
        ring_end = int(np.hypot(*(nodes - cusp.place).T).argmin())
        return Continued(on_skin(model.outline, traction, edges, at), cusp, ring_end)
    point = _of_section(model, solved, traction, int(of.on_skin[number]))
    if of.relieved[number] < 0:
        return point
    assert isinstance(point, OnSkin)
    return Relieved(point)


def _of_section(
    model: HarmonicModel, solved: SolvedCase, traction: Floats, number: int
) -> ReadingPoint:
    """Return the reading point with a number among the points of a section."""
    space, outline, fields = model.space, model.outline, solved.solution.fields
    # The order of points is that of Reading: skin, inner nodes, rims of zones, jumps.
    if number < fields.skin:
        edge, at = divmod(number, len(EDGE_STATIONS))
        clamped = outline.constrained(model.clamps)[edge]
        if clamped or on_axis(space, float(fields.points[number, 0])):
            return at_rough(space, outline, edge, at)
        return on_skin(outline, traction, np.array([edge]), np.array([at]))
    if number < len(fields.displacement):
        inner = np.setdiff1d(np.arange(len(space.nodes)), outline.nodes)
        return at_node(space, int(inner[number - fields.skin]))
    ends = solved.solution.ends
    first = len(fields.points) - EDGE_DIRECTIONS * len(ends)
    if number >= first:
        which, direction = divmod(number - first, EDGE_DIRECTIONS)
        (jump,) = jumps(space, outline, solved.material, ends[which : which + 1])
        return AtJump(outline, jump, Samples(space, jump.samples), direction)
    return _on_rim(space, solved.zones, fields.points[number])


def _on_rim(space: Section, zones: tuple[Zone, ...], at: Floats) -> FromInside:
    """Return the reading point on the rim of the zone whose circle passes closest to it."""
    off = [abs(np.hypot(at[0] - p.r, at[1] - p.z) / p.radius - 1.0) for p in zones]
    zone = int(np.argmin(off))
    p, (r, z) = zones[zone], (float(x) for x in at)
    return FromInside(nearest(space, [at]), (1.0,), (), (r, z), zone, (p.r, p.z, p.radius))
