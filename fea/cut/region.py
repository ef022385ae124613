"""How much of a pin about its cuts is solid, and which cut pins can be solved so at all."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from fea.core.peak import Note
from fea.cut.inside import crosses_end, extent, is_inside
from fea.singular.singularities import Singularity
from geometry import CutPin, Hole, Pin
from geometry.mesh.cut_piece import Piece, clipped

BEYOND = 1.4  # of the diameter, past a hole: in a shaft, ends there change stress by 0.1 %
LONGER = 1.6  # times that, where it is seen not to be enough, as in tubes
NEXT = 1.0  # of the diameter: holes closer to each other are in one piece
LEFT = 0.25  # of the diameter: less than that beyond a piece is part of it
CLEAR = 0.1  # of the diameter, at least between the end of a piece and a step
SAME_ANGLE = 1e-9


@dataclass(frozen=True)
class RingedCutPin(CutPin):
    """A pin with cuts whose bands are cut into rings, for contact pressures. whole: the same pin
    without rings.
    """

    whole: CutPin | None = None


def unringed(pin: CutPin) -> CutPin:
    """The pin without rings."""
    return (pin.whole or pin) if isinstance(pin, RingedCutPin) else pin


def refused(pin: CutPin, clamps: tuple[str, ...], loaded: Sequence[str]) -> Note | None:
    """Why a local solid does not do for this pin, clamped and loaded at surfaces (by name); None
    where it does.
    """
    if pin.flats:
        return _solid("flats have inner corners where stress is unbounded", "flat")
    for name in (*clamps, *loaded):
        if name.startswith("hole "):
            return _solid(f"{name} carries load", "hole-loaded")
    for i, hole in enumerate(pin.holes, 1):
        low, high = extent(hole)
        for name in dict.fromkeys((*loaded, *clamps)):
            z0, z1 = surface_ends(pin, name)
            if name in clamps and low < z1 and z0 < high:
                return _solid(f"hole {i} lies in the clamped surface {name}", "hole-in-clamped")
            if crosses_end(hole, z0, z1):
                return _solid(f"hole {i} lies at an end of the band {name}", "hole-at-end")
    return None


def loaded_bands(pin: CutPin, loaded: Sequence[str]) -> tuple[tuple[float, float], ...]:
    """The z of both ends, m, of loaded bands (by name) with holes in them."""
    found = (surface_ends(pin, name) for name in dict.fromkeys(loaded) if name in pin.connections)
    return tuple((z0, z1) for z0, z1 in found if any(is_inside(h, z0, z1) for h in pin.holes))


def at_corner(pin: CutPin, singularities: Sequence[Singularity]) -> Note | None:
    """The same, where a hole lies at one of the singularities of the pin without holes."""
    for i, hole in enumerate(pin.holes, 1):
        low, high = extent(hole)
        if any(low <= s.z <= high for s in singularities):
            return _solid(f"hole {i} lies at a sharp corner", "hole-at-corner")
    return None


def _solid(why: str, code: str) -> Note:
    return Note(
        f"solid: the pin is not a body of revolution, and {why}", ("not-axisymmetric", code)
    )


def surface_ends(pin: CutPin, name: str) -> tuple[float, float]:
    """z of both ends of a surface, m; what is no band is somewhere on the pin."""
    if name in ("start", "end"):
        z = 0.0 if name == "start" else pin.length
        return z, z
    if name in pin.profile.labels or name.startswith("bore "):
        band = pin.band(name)
        return band.z0, band.z1
    return 0.0, pin.length


def zone(piece: Piece) -> tuple[float, float]:
    """Between which z (m) the stress of the uncut pin does not count."""
    ends = [extent(hole) for hole in piece.holes]
    low, high = min(a for a, _ in ends), max(b for _, b in ends)
    if "z" in piece.mirrors:
        low = -high
    return low + piece.origin, high + piece.origin


def pieces(
    pin: CutPin,
    clamps: tuple[str, ...],
    beyond: float = BEYOND,
    bands: Sequence[tuple[float, float]] = (),
) -> tuple[Piece, ...]:
    """One about each hole, or about holes that are close to each other, along the pin; beyond: how
    far past these, of the diameter. bands: loaded ones with holes in them (loaded_bands).
    """
    holes = sorted(pin.holes, key=lambda hole: hole.z)
    groups = [[holes[0]]]
    for before, hole in pairwise(holes):
        near = NEXT * beyond / BEYOND * _diameter(pin.profile, before.z, hole.z)
        if extent(hole)[0] - max(extent(h)[1] for h in groups[-1]) < near:
            groups[-1].append(hole)
        else:
            groups.append([hole])
    return tuple(_piece(pin.profile, group, clamps, beyond, bands) for group in groups)


def _diameter(pin: Pin, low: float, high: float) -> float:
    """The largest between two z, m."""
    ends = zip(pin.segments, pin.stations, pin.stations[1:], strict=False)
    return max(max(s.diameters) for s, a, b in ends if b >= low and a <= high)


def _piece(
    pin: Pin,
    holes: list[Hole],
    clamps: tuple[str, ...],
    beyond: float,
    bands: Sequence[tuple[float, float]],
) -> Piece:
    low, high = min(extent(h)[0] for h in holes), max(extent(h)[1] for h in holes)
    reach = beyond * _diameter(pin, low, high)
    reach = beyond * _diameter(pin, max(low - reach, 0.0), min(high + reach, pin.length))
    z0, z1 = _end(pin, low - reach, -1.0), _end(pin, high + reach, 1.0)
    angle = holes[0].angle
    mirrors: tuple[str, ...] = ()
    if all(abs(math.sin(2.0 * (hole.angle - angle))) < SAME_ANGLE for hole in holes):
        mirrors = ("x", "y")
    middle = 0.5 * (low + high)
    clamped = any(z0 <= b and a <= z1 for a, b in (surface_ends(CutPin(pin), c) for c in clamps))
    parted = any(a < high and low < b and not (a < low and high < b) for a, b in bands)
    if not clamped and not parted and _even(pin, holes, z0, z1, middle):
        half = max(middle - z0, z1 - middle)
        z0, z1, mirrors = middle - half, middle + half, (*mirrors, "z")
    start = middle if "z" in mirrors else z0
    shifted = [Hole(h.z - start, h.diameter, h.angle - angle) for h in holes]
    if "z" in mirrors:
        shifted = [h for h in shifted if extent(h)[1] > 0.0]
    part, open_ends = clipped(pin, start, z1), (z0 > pin.tolerance, z1 < pin.length - pin.tolerance)
    return Piece(part, z0, z1, angle, tuple(shifted), mirrors, open_ends)


def _end(pin: Pin, z: float, way: float) -> float:
    """Where a piece ends: past steps and fillets that are close, or with the pin."""
    margin = CLEAR * pin.smallest_diameter
    order = range(len(pin.segments) - 1)
    for i in order if way > 0.0 else reversed(order):
        a, b = pin.segments[i], pin.segments[i + 1]
        if a.cylindrical and b.cylindrical and (a.diameter, a.bore) == (b.diameter, b.bore):
            continue
        reach = pin.fillet_at(i) + margin
        if abs(z - pin.stations[i + 1]) < reach:
            z = pin.stations[i + 1] + way * reach
    least = LEFT * pin.smallest_diameter
    return 0.0 if z < least else pin.length if z > pin.length - least else z


def _even(pin: Pin, holes: list[Hole], z0: float, z1: float, middle: float) -> bool:
    """Whether the pin is the same on both sides of z = middle, as far as the piece goes."""
    half = max(middle - z0, z1 - middle)
    inside = middle - half >= -pin.tolerance and middle + half <= pin.length + pin.tolerance
    ends = zip(pin.segments, pin.stations, pin.stations[1:], strict=False)
    here = [s for s, a, b in ends if b > middle - half and a < middle + half]
    plain = {(s.diameter, s.bore, s.cylindrical) for s in here}
    near = 1e-9 * pin.smallest_diameter

    def mirrored(h: Hole) -> bool:
        return any(
            abs(h.z + o.z - 2.0 * middle) < near
            and abs(h.diameter - o.diameter) < near
            and abs(math.sin(h.angle - o.angle)) < SAME_ANGLE
            for o in holes
        )

    straight = len(plain) == 1 and here[0].cylindrical
    return inside and straight and all(mirrored(h) for h in holes)
