"""The pieces of a pin about its cuts that are solid, and the pins to which local solids apply."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import TypeVar

from fea.core.peak import Reason
from fea.core.zone import Zone
from geometry import Cut, CutPin, Hole, Pin, PinLike
from geometry.mesh.cut_piece import Piece, clipped
from geometry.shape.band_cuts import crosses_end, is_inside

# Lengths are parts of the diameter. The reach was found on shafts, where ends at that distance
# change stress by 0.1 %; `python -m benchmarks cut-pins` checks it. The others are chosen by
# judgement.
PIECE_REACH = 1.4  # length of a piece beyond its cuts
REACH_FACTOR = 1.6  # factor of the reach where it proves too short, as in tubes
MERGE_DISTANCE = 0.5  # cuts closer to each other are in one piece
MIN_REMAINDER = 0.25  # a shorter remainder of the pin beyond a piece is made part of the piece
STEP_CLEARANCE = 0.1  # least distance between the end of a piece and a step
PIECE_LENGTH_TOLERANCE = 1e-9  # lengths that differ by less are equal

AnyPin = TypeVar("AnyPin", bound=PinLike)


@dataclass(frozen=True)
class RingedCutPin(CutPin):
    """A pin with cuts whose bands are divided into rings, for contact pressures.

    whole: the same pin without rings.
    """

    whole: CutPin | None = None

    @cached_property
    def volume(self) -> float:
        """The volume of the pin without cuts, m^3, since contact balances the weight of the uncut
        pin.

        (The volume with cuts would need rounded mouths, which cannot be made where rings meet.)
        """
        return self.profile.volume


def unringed(pin: AnyPin) -> AnyPin | CutPin:
    """The pin whose bands are not divided into rings."""
    return (pin.whole or pin) if isinstance(pin, RingedCutPin) else pin


def refusal(pin: CutPin, clamps: tuple[str, ...], loaded: Sequence[str]) -> Reason | None:
    """The reason why a local solid does not apply to a pin, or None.

    clamps, loaded: names of the clamped and of the loaded surfaces.
    """
    for name in (*clamps, *loaded):
        if name.removesuffix(" end") in pin.cuts:
            return Reason(f"{name} carries load", (f"{name.split()[0]}-loaded",))
    for cut, feature in pin.cuts.items():
        low, high = feature.opens
        for name in dict.fromkeys((*loaded, *clamps)):
            z0, z1 = surface_ends(pin, name)
            # A cut affects a surface if it opens into it or lies in its face.
            if not (low < z1 and z0 < high) and name not in feature.faces:
                continue
            if name in clamps:
                text = f"{cut} lies in the clamped surface {name}"
                return Reason(text, (f"{feature.what}-in-clamped",))
            if name not in pin.connections:
                text = f"{cut} lies in the loaded surface {name}"
                return Reason(text, (f"{feature.what}-in-loaded",))
            if crosses_end(feature, pin.profile, z0, z1):
                text = f"{cut} lies at an end of the band {name}"
                return Reason(text, (f"{feature.what}-at-end",))
    return _joined(pin, loaded)


def _joined(pin: CutPin, loaded: Sequence[str]) -> Reason | None:
    """A refusal where a passage joins cuts in several loaded bands, or None.

    In that case the load that each band loses is not known.
    """
    bands = loaded_bands(pin, loaded)
    for name, cut in pin.cuts.items():
        low, high = cut.extent
        if cut.opens != cut.extent and sum(low < b and a < high for a, b in bands) > 1:
            text = f"{name} lies under cuts in several loaded bands"
            return Reason(text, ("passage-under-bands",))
    return None


def loaded_bands(pin: CutPin, loaded: Sequence[str]) -> tuple[tuple[float, float], ...]:
    """The ends (z, m) of the loaded bands that have cuts.

    loaded: names of the loaded surfaces.
    """
    ends = (surface_ends(pin, name) for name in dict.fromkeys(loaded) if name in pin.connections)
    cuts = pin.cuts.values()
    return tuple(
        (z0, z1) for z0, z1 in ends if any(is_inside(c, pin.profile, z0, z1) for c in cuts)
    )


def corner_refusal(pin: CutPin, singularities: Sequence[Zone]) -> Reason | None:
    """A refusal where a cut lies at a singularity of the pin without cuts, or None."""
    for cut, feature in pin.cuts.items():
        low, high = feature.opens
        if any(low <= s.z <= high for s in singularities):
            return Reason(f"{cut} lies at a sharp corner", (f"{feature.what}-at-corner",))
    return None


def surface_ends(pin: CutPin, name: str) -> tuple[float, float]:
    """The z of both ends of a surface, m; those of the pin for a surface that is not a band."""
    if name in ("start", "end"):
        z = 0.0 if name == "start" else pin.length
        return z, z
    if name in pin.profile.labels or name.startswith("bore "):
        band = pin.band(name)
        return band.z0, band.z1
    return 0.0, pin.length


def zone(piece: Piece) -> tuple[float, float]:
    """The interval of z, m, in which the stress of the uncut pin does not count."""
    low, high = _ends(piece.cuts.values())
    if "z" in piece.mirrors:
        low = -high
    return low + piece.origin, high + piece.origin


def _ends(cuts: Iterable[Cut]) -> tuple[float, float]:
    ends = [cut.extent for cut in cuts]
    return min(a for a, _ in ends), max(b for _, b in ends)


def pieces(
    pin: CutPin,
    clamps: tuple[str, ...],
    beyond: float = PIECE_REACH,
    bands: Sequence[tuple[float, float]] = (),
    spacing: float = 1.0,
) -> tuple[Piece, ...]:
    """The pieces along the pin, each about one cut or several cuts that are close to each other.

    beyond: length of a piece beyond its cuts, of the diameter.
    bands: ends of the loaded bands that have cuts (loaded_bands).
    spacing: factor of the usual distance up to which cuts share a piece.
    """
    cuts = sorted(pin.cuts.items(), key=lambda named: named[1].extent)
    groups = [dict(cuts[:1])]
    for name, cut in cuts[1:]:
        (low, high), end = cut.extent, _ends(groups[-1].values())[1]
        # Cuts are merged if the gap to the group before is short, in proportion to the piece's
        # reach.
        near = MERGE_DISTANCE * spacing * beyond / PIECE_REACH
        if low - end < near * _diameter(pin.profile, min(end, low), high):
            groups[-1][name] = cut
        else:
            groups.append({name: cut})
    return tuple(_piece(pin.profile, group, clamps, beyond, bands) for group in groups)


def _diameter(pin: Pin, low: float, high: float) -> float:
    """The largest diameter between two z, m."""
    ends = zip(pin.segments, pin.stations, pin.stations[1:], strict=False)
    return max(max(s.diameters) for s, a, b in ends if b >= low and a <= high)


def _piece(
    pin: Pin,
    cuts: dict[str, Cut],
    clamps: tuple[str, ...],
    beyond: float,
    bands: Sequence[tuple[float, float]],
) -> Piece:
    """The piece about a group of cuts."""
    low, high = _ends(cuts.values())
    low, high = max(low, 0.0), min(high, pin.length)
    reach = beyond * _diameter(pin, low, high)
    reach = beyond * _diameter(pin, max(low - reach, 0.0), min(high + reach, pin.length))
    z0, z1 = _end(pin, low - reach, -1.0), _end(pin, high + reach, 1.0)
    # A mirror plane across the axis is used only if profile, cuts, clamps and loaded bands allow
    # it; then the piece is centred on it and half of it is meshed.
    angle, mirrors = _about(pin, list(cuts.values()))
    middle = 0.5 * (low + high)
    half = max(middle - z0, z1 - middle)
    clamp_ends = [surface_ends(CutPin(pin), name) for name in clamps]
    clamped = any(max(a - middle, middle - b) <= half + pin.tolerance for a, b in clamp_ends)
    parted = any(a < high and low < b and not (a < low and high < b) for a, b in bands)
    amid = [cut.moved(middle, angle) for cut in cuts.values()]
    if not clamped and not parted and _even(pin, middle, half) and _symmetric(pin, amid, "z"):
        z0, z1, mirrors = middle - half, middle + half, (*mirrors, "z")
    start = middle if "z" in mirrors else z0
    moved = {name: cut.moved(start, angle) for name, cut in cuts.items()}
    cuts_of_piece = {n: cut for n, cut in moved.items() if start == z0 or cut.extent[1] > 0.0}
    part, open_ends = clipped(pin, start, z1), (z0 > pin.tolerance, z1 < pin.length - pin.tolerance)
    return Piece(part, z0, z1, angle, cuts_of_piece, mirrors, open_ends)


def _about(pin: Pin, cuts: list[Cut]) -> tuple[float, tuple[str, ...]]:
    """The angle by which the piece's frame is turned, and its mirror planes that contain the axis.

    Of the angles of single cuts and those midway between two, it is the one with most mirror
    planes.
    """
    angles = [cut.angle for cut in cuts]
    angles += [0.5 * (a.angle + b.angle) for a, b in combinations(cuts, 2)]
    # A hole that misses the axis is its own mirror image in the plane across its direction.
    angles += [cut.angle + 0.5 * math.pi for cut in cuts if isinstance(cut, Hole) and cut.offset]
    best: tuple[float, tuple[str, ...]] = (angles[0], ())
    for angle in angles:
        turned = [cut.moved(0.0, angle) for cut in cuts]
        if _symmetric(pin, turned, "y"):
            mirrors = ("x", "y") if _symmetric(pin, turned, "x") else ("y",)
            if len(mirrors) > len(best[1]):
                best = angle, mirrors
    return best


def _symmetric(pin: Pin, cuts: list[Cut], plane: str) -> bool:
    """Whether a plane through the origin mirrors the cuts onto each other."""
    near = PIECE_LENGTH_TOLERANCE * pin.smallest_diameter
    return all(any(cut.mirrored(plane).like(o, near) for o in cuts) for cut in cuts)


def _end(pin: Pin, z: float, way: float) -> float:
    """The z, m, at which a piece ends: clear of steps and fillets, or with the pin.

    way: 1 or -1, the direction in which the piece extends.
    """
    margin = STEP_CLEARANCE * pin.smallest_diameter
    order = range(len(pin.segments) - 1)
    for i in order if way > 0.0 else reversed(order):
        a, b = pin.segments[i], pin.segments[i + 1]
        if a.cylindrical and b.cylindrical and (a.diameter, a.bore) == (b.diameter, b.bore):
            continue
        reach = pin.fillet_at(i) + margin
        if abs(z - pin.stations[i + 1]) < reach:
            z = pin.stations[i + 1] + way * reach
    least = MIN_REMAINDER * pin.smallest_diameter
    return 0.0 if z < least else pin.length if z > pin.length - least else z


def _even(pin: Pin, middle: float, half: float) -> bool:
    """Whether the profile is a plain cylinder up to the distance `half` on both sides of z =
    middle, m.
    """
    inside = middle - half >= -pin.tolerance and middle + half <= pin.length + pin.tolerance
    ends = zip(pin.segments, pin.stations, pin.stations[1:], strict=False)
    here = [s for s, a, b in ends if b > middle - half and a < middle + half]
    plain = {(s.diameter, s.bore, s.cylindrical) for s in here}
    return inside and len(plain) == 1 and here[0].cylindrical
