"""How much of a pin about its cuts is solid, and which cut pins can be solved so at all."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

from fea.core.peak import Reason
from fea.core.zone import Zone
from fea.cut.inside import crosses_end, is_inside
from geometry import Cut, CutPin, Pin
from geometry.mesh.cut_piece import Piece, clipped

PIECE_REACH = 1.4  # of the diameter, past a cut: in a shaft, ends there change stress by 0.1 %
REACH_FACTOR = 1.6  # times that, where it is seen not to be enough, as in tubes
MERGE_DISTANCE = 0.5  # of the diameter: cuts closer to each other are in one piece
MIN_REMAINDER = 0.25  # of the diameter: less than that beyond a piece is part of it
STEP_CLEARANCE = 0.1  # of the diameter, at least between the end of a piece and a step
PIECE_LENGTH_TOLERANCE = 1e-9  # of the diameter: two lengths


@dataclass(frozen=True)
class RingedCutPin(CutPin):
    """A pin with cuts whose bands are cut into rings, for contact pressures. whole: the same pin
    without rings.
    """

    whole: CutPin | None = None

    @cached_property
    def volume(self) -> float:
        """Of the pin without cuts, m^3: contact balances the weight of that. (Rounded mouths cannot
        be made where rings meet.)
        """
        return self.profile.volume


def unringed(pin: CutPin) -> CutPin:
    """The pin without rings."""
    return (pin.whole or pin) if isinstance(pin, RingedCutPin) else pin


def refusal(pin: CutPin, clamps: tuple[str, ...], loaded: Sequence[str]) -> Reason | None:
    """Why a local solid does not do for this pin, clamped and loaded at surfaces (by name); None
    where it does.
    """
    for name in (*clamps, *loaded):
        if name.removesuffix(" end") in pin.cuts:
            return _solid(f"{name} carries load", f"{name.split()[0]}-loaded")
    for cut, feature in pin.cuts.items():
        low, high = feature.opens
        for name in dict.fromkeys((*loaded, *clamps)):
            z0, z1 = surface_ends(pin, name)
            if not (low < z1 and z0 < high) and name not in feature.faces:
                continue
            if name in clamps:
                text = f"{cut} lies in the clamped surface {name}"
                return _solid(text, f"{feature.what}-in-clamped")
            if name not in pin.connections:
                text = f"{cut} lies in the loaded surface {name}"
                return _solid(text, f"{feature.what}-in-loaded")
            if crosses_end(feature, pin.profile, z0, z1):
                text = f"{cut} lies at an end of the band {name}"
                return _solid(text, f"{feature.what}-at-end")
    return _joined(pin, loaded)


def _joined(pin: CutPin, loaded: Sequence[str]) -> Reason | None:
    """The same, where a passage may join cuts in several loaded bands, so that what each loses is
    not known.
    """
    bands = loaded_bands(pin, loaded)
    for name, cut in pin.cuts.items():
        low, high = cut.extent
        if cut.opens != cut.extent and sum(low < b and a < high for a, b in bands) > 1:
            return _solid(f"{name} lies under cuts in several loaded bands", "passage-under-bands")
    return None


def loaded_bands(pin: CutPin, loaded: Sequence[str]) -> tuple[tuple[float, float], ...]:
    """The z of both ends, m, of loaded bands (by name) with cuts in them."""
    found = (surface_ends(pin, name) for name in dict.fromkeys(loaded) if name in pin.connections)
    cuts = pin.cuts.values()
    return tuple(
        (z0, z1) for z0, z1 in found if any(is_inside(c, pin.profile, z0, z1) for c in cuts)
    )


def corner_refusal(pin: CutPin, singularities: Sequence[Zone]) -> Reason | None:
    """The same, where a cut lies at one of the singularities of the pin without cuts."""
    for cut, feature in pin.cuts.items():
        low, high = feature.opens
        if any(low <= s.z <= high for s in singularities):
            return _solid(f"{cut} lies at a sharp corner", f"{feature.what}-at-corner")
    return None


def _solid(why: str, code: str) -> Reason:
    return Reason(
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
    apart: float = 1.0,
) -> tuple[Piece, ...]:
    """One about each cut, or about cuts that are close to each other, along the pin; beyond: how
    far past these, of the diameter. bands: loaded ones with cuts in them (loaded_bands). apart:
    how much farther from each other than usual cuts are in one piece.
    """
    cuts = sorted(pin.cuts.items(), key=lambda named: named[1].extent)
    groups = [dict(cuts[:1])]
    for name, cut in cuts[1:]:
        (low, high), end = cut.extent, _ends(groups[-1].values())[1]
        near = (
            MERGE_DISTANCE
            * apart
            * beyond
            / PIECE_REACH
            * _diameter(pin.profile, min(end, low), high)
        )
        if low - end < near:
            groups[-1][name] = cut
        else:
            groups.append({name: cut})
    return tuple(_piece(pin.profile, group, clamps, beyond, bands) for group in groups)


def _diameter(pin: Pin, low: float, high: float) -> float:
    """The largest between two z, m."""
    ends = zip(pin.segments, pin.stations, pin.stations[1:], strict=False)
    return max(max(s.diameters) for s, a, b in ends if b >= low and a <= high)


def _piece(
    pin: Pin,
    cuts: dict[str, Cut],
    clamps: tuple[str, ...],
    beyond: float,
    bands: Sequence[tuple[float, float]],
) -> Piece:
    low, high = _ends(cuts.values())
    low, high = max(low, 0.0), min(high, pin.length)
    reach = beyond * _diameter(pin, low, high)
    reach = beyond * _diameter(pin, max(low - reach, 0.0), min(high + reach, pin.length))
    z0, z1 = _end(pin, low - reach, -1.0), _end(pin, high + reach, 1.0)
    angle, mirrors = _about(pin, list(cuts.values()))
    middle = 0.5 * (low + high)
    clamped = any(z0 <= b and a <= z1 for a, b in (surface_ends(CutPin(pin), c) for c in clamps))
    parted = any(a < high and low < b and not (a < low and high < b) for a, b in bands)
    amid = [cut.moved(middle, angle) for cut in cuts.values()]
    if not clamped and not parted and _even(pin, z0, z1, middle) and _symmetric(pin, amid, "z"):
        half = max(middle - z0, z1 - middle)
        z0, z1, mirrors = middle - half, middle + half, (*mirrors, "z")
    start = middle if "z" in mirrors else z0
    moved = {name: cut.moved(start, angle) for name, cut in cuts.items()}
    there = {n: cut for n, cut in moved.items() if start == z0 or cut.extent[1] > 0.0}
    part, open_ends = clipped(pin, start, z1), (z0 > pin.tolerance, z1 < pin.length - pin.tolerance)
    return Piece(part, z0, z1, angle, there, mirrors, open_ends)


def _about(pin: Pin, cuts: list[Cut]) -> tuple[float, tuple[str, ...]]:
    """The angle by which the frame is turned that has most mirror planes along the axis, and those:
    of single cuts and amid two of them.
    """
    angles = [cut.angle for cut in cuts]
    angles += [0.5 * (a.angle + b.angle) for a, b in combinations(cuts, 2)]
    best: tuple[float, tuple[str, ...]] = (angles[0], ())
    for angle in angles:
        turned = [cut.moved(0.0, angle) for cut in cuts]
        if _symmetric(pin, turned, "y"):
            mirrors = ("x", "y") if _symmetric(pin, turned, "x") else ("y",)
            if len(mirrors) > len(best[1]):
                best = angle, mirrors
    return best


def _symmetric(pin: Pin, cuts: list[Cut], plane: str) -> bool:
    """Whether a plane through the origin mirrors cuts to cuts."""
    near = PIECE_LENGTH_TOLERANCE * pin.smallest_diameter
    return all(any(cut.mirrored(plane).like(o, near) for o in cuts) for cut in cuts)


def _end(pin: Pin, z: float, way: float) -> float:
    """Where a piece ends: past steps and fillets that are close, or with the pin."""
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


def _even(pin: Pin, z0: float, z1: float, middle: float) -> bool:
    """Whether the profile is the same on both sides of z = middle, as far as the piece goes."""
    half = max(middle - z0, z1 - middle)
    inside = middle - half >= -pin.tolerance and middle + half <= pin.length + pin.tolerance
    ends = zip(pin.segments, pin.stations, pin.stations[1:], strict=False)
    here = [s for s, a, b in ends if b > middle - half and a < middle + half]
    plain = {(s.diameter, s.bore, s.cylindrical) for s in here}
    return inside and len(plain) == 1 and here[0].cylindrical
