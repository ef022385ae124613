"""A pin from the corners of its section's outline, each with a radius to round it."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from geometry.shape.band import GeometryError
from geometry.shape.pin import Pin
from geometry.shape.polygon import turn_at
from geometry.shape.segment import Segment
from geometry.shape.tolerance import LENGTH_TOLERANCE, merged


@dataclass(frozen=True)
class Bend:
    """A corner of the outline at (z, r), m, rounded to `radius` (m)."""

    z: float
    r: float
    radius: float = 0.0


@dataclass(frozen=True)
class Stripe:
    """A part of the outer surface with a name, from z0 to z1 (m).

    connection: whether a link of that name bears on it.
    """

    name: str
    z0: float
    z1: float
    connection: bool = True


def pin_of_polyline(name: str, outside: Sequence[Bend], bore: Sequence[Bend] = ()) -> Pin:
    """The pin between two outlines, each from z = 0 to the other end.

    outside: corners of the outer surface. bore: corners of the bore; empty for a solid pin.

    Raises: GeometryError where an outline goes back in z, or the two outlines do not have the same
    ends; also the errors of Pin.
    """
    where = f"pin {name}"
    _require_forward(f"{where}: meridian", outside)
    tolerance, end = 2.0 * LENGTH_TOLERANCE * min(bend.r for bend in outside), outside[-1].z
    inside = bore or (Bend(0.0, 0.0), Bend(end, 0.0))
    _require_forward(f"{where}: bore_meridian", inside)
    for line, what in ((outside, "meridian"), (inside, "bore_meridian")):
        if abs(line[0].z) > tolerance or abs(line[-1].z - end) > tolerance:
            raise GeometryError(
                f"{where}: {what} must begin at z = 0 and end where meridian does",
                "not-whole",
                ("key", what),
            )
    # The corners of both outlines divide the pin into segments.
    merged_z = merged((bend.z for bend in (*outside, *inside)), tolerance)
    stations = sorted(set(merged_z.values()))
    outer, core = (
        [_at([replace(bend, z=merged_z[bend.z]) for bend in line], z) for z in stations]
        for line in (outside, inside)
    )
    for places in (outer, core):
        places[0] = places[0][0], places[0][0]
    segments = [
        _segment(b - a, outer[k : k + 2], core[k : k + 2])
        for k, (a, b) in enumerate(pairwise(stations))
    ]
    for k in range(len(segments) - 1):
        segments[k : k + 2] = _joined(segments[k], segments[k + 1], *outer[k + 1])
    return Pin(name, tuple(segments))


def _require_forward(where: str, line: Sequence[Bend]) -> None:
    """Raise GeometryError for an outline with too few corners, or that goes back in z.

    The same for more than two corners at one z, and for an end face in the outline.
    """
    what = ("key", where.rsplit(" ", 1)[1])
    if len(line) < 2:
        raise GeometryError(f"{where} needs at least two corners", "too-few-corners", what)
    for i, (a, b) in enumerate(pairwise(line), 1):
        if b.z < a.z:
            raise GeometryError(
                f"{where} goes back from corner {i} to {i + 1}; z must not decrease",
                "goes-back",
                what,
            )
    for i, (a, b, c) in enumerate(zip(line, line[1:], line[2:], strict=False), 1):
        if a.z == b.z == c.z:
            raise GeometryError(
                f"{where}: corners {i} to {i + 2} share one z; at most two may (a step)",
                "three-at-one-z",
                what,
            )
    for (a, b), end in (((line[0], line[1]), "first"), ((line[-2], line[-1]), "last")):
        if a.z == b.z:
            raise GeometryError(
                f"{where}: its {end} two corners share one z; leave out the end face",
                "face-in-outline",
                what,
            )


def _at(line: Sequence[Bend], z: float) -> tuple[Bend, Bend]:
    """The corners of an outline at z, before and after a step there.

    Where there is only one corner, the second is the same corner without a radius.
    """
    corners = [bend for bend in line if bend.z == z]
    if corners:
        return corners[0], corners[1] if corners[1:] else replace(corners[0], radius=0.0)
    a, b = next((a, b) for a, b in pairwise(line) if a.z < z < b.z)
    r = a.r if a.r == b.r else a.r + (z - a.z) / (b.z - a.z) * (b.r - a.r)
    return Bend(z, r), Bend(z, r)


def _segment(
    length: float, outer: Sequence[tuple[Bend, Bend]], core: Sequence[tuple[Bend, Bend]]
) -> Segment:
    """The segment between two stations.

    outer, core: corners (before, after) of shaft and bore at both stations. `_joined` sets the
    final radii of the outer surface.
    """
    (_, mouth), (far, _) = core
    first, last = outer[0][1], outer[1][0]
    plain = Segment(length, 2.0 * first.r, fillet=0.0, bore_radii=(mouth.radius, far.radius))
    plain = replace(plain, edge_radii=(first.radius, last.radius))
    return plain.with_diameters((2.0 * first.r, 2.0 * last.r), (2.0 * mouth.r, 2.0 * far.r))


def _joined(left: Segment, right: Segment, one: Bend, other: Bend) -> list[Segment]:
    """Two segments with the radii of their common corners; an inner corner has a fillet.

    one, other: corners at the end of the left segment and at the start of the right segment.
    """
    turn, rises = turn_at(left, right), one.r < other.r
    fillet, ends = 0.0, [one.radius, other.radius]
    if turn == "smooth":
        ends = [0.0, 0.0]
    elif turn != "edge":
        inner = 0 if turn == "inner" or rises else 1
        fillet, ends[inner] = ends[inner], 0.0
    return [
        replace(left, fillet=fillet, edge_radii=(left.edge_radii[0], ends[0])),
        replace(right, edge_radii=(ends[1], right.edge_radii[1])),
    ]


def with_stripes(pin: Pin, stripes: Iterable[Stripe], origin: float = 0.0) -> Pin:
    """The pin with parts of its cylinders named.

    If an end of a stripe is within a rounding, it is moved to the end of the cylinder. If the start
    of a stripe is within the tolerance of the end of another stripe, it is moved there.

    origin: z of the start face in messages, m.

    Raises: GeometryError where a stripe is not on one cylinder, or stripes overlap; also the errors
    of Pin.
    """
    on: dict[int, list[Stripe]] = {}
    for stripe in sorted(stripes, key=lambda stripe: stripe.z0):
        i, whole = _on_cylinder(pin, stripe, origin)
        before = on.setdefault(i, [])
        if before and whole.z0 < before[-1].z1 - pin.tolerance:
            raise GeometryError(
                f"pin {pin.name}: bands {before[-1].name} and {stripe.name} overlap",
                "bands-overlap",
                ("band", stripe.name),
            )
        if before and whole.z0 <= before[-1].z1 + pin.tolerance:
            whole = replace(whole, z0=before[-1].z1)
        before.append(whole)
    segments: list[Segment] = []
    for i, s in enumerate(pin.segments):
        segments += _cut(s, pin.stations[i], on.get(i, []))
    return replace(pin, segments=tuple(segments))


def _on_cylinder(pin: Pin, stripe: Stripe, origin: float) -> tuple[int, Stripe]:
    """Number of the segment on which a stripe lies, and the stripe with its ends there.

    An end of the stripe within a rounding or the tolerance is moved to the end of the segment.
    """
    what, at = f"pin {pin.name}: band {stripe.name}", ("band", stripe.name)
    if not stripe.z0 < stripe.z1:
        raise GeometryError(f"{what}: z = [a, b] requires a < b", "z-reversed", at)
    middle, near = 0.5 * (stripe.z0 + stripe.z1), pin.tolerance
    if stripe.z0 < -near or stripe.z1 > pin.length + near:
        raise GeometryError(
            f"{what} is not on the pin, which extends from z = {origin:.6g} to "
            f"{origin + pin.length:.6g} m",
            "band-not-found",
            at,
        )
    i = bisect_right(pin.stations, middle) - 1
    low, high = pin.stations[i], pin.stations[i + 1]
    if pin.segments[i].cone:
        raise GeometryError(
            f"{what} is on a cone, where a link cannot bear; give it z on a cylinder",
            "band-on-cone",
            at,
        )
    straight = pin.bands[i]
    if stripe.z0 < low - near or stripe.z1 > high + near or straight.length <= near:
        raise GeometryError(
            f"{what} is not on one cylinder, which here extends from z = {origin + low:.6g} to "
            f"{origin + high:.6g} m",
            "band-on-step",
            at,
        )
    z0 = low if stripe.z0 <= straight.z0 + near else stripe.z0
    z1 = high if stripe.z1 >= straight.z1 - near else stripe.z1
    return i, replace(stripe, z0=z0, z1=z1)


def _cut(segment: Segment, start: float, stripes: Sequence[Stripe]) -> Iterable[Segment]:
    """The parts of a segment that begins at `start` (m); parts on stripes have their names."""
    end = start + segment.length
    cuts = sorted({start, end, *(z for s in stripes for z in (s.z0, s.z1))})
    named = {s.z0: s for s in stripes}
    for z, part in zip(cuts, segment.cut([z - start for z in cuts]), strict=False):
        stripe = named.get(z)
        if stripe is None:
            yield part
        elif stripe.connection:
            yield replace(part, connection=stripe.name)
        else:
            yield replace(part, name=stripe.name)
