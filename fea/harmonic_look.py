"""What the harmonic model says of a pin's cases on one mesh."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from fea.answer import Picture
from fea.circumference import Circumference, Mask, Top
from fea.exponent import growth_exponent
from fea.harmonic import HarmonicModel
from fea.look import FELT, Inside, Look, Point
from fea.material import Material
from fea.meridian_fields import MeridianFields
from fea.pin_loads import Floats, PinLoads, UnitLoad
from fea.revolved import revolve
from fea.rims import rim
from fea.section_stress import NOWHERE
from fea.zones import Place, smooth_edges
from geometry import Pin
from geometry.grading import Grade, SectionSize, Spot, size_at
from geometry.meridian_mesh import meridian_mesh

SIZE = SectionSize()  # of the first mesh
CLOSE = (1e-2, 1e-3, 1e-4)  # element at a corner or clamp's edge, of the diameter, mesh by mesh
EDGE = 0.04  # element at the edge of any band, of the diameter
LOGARITHM = 0.2  # element at a load's edge, of the excluded distance
MATTERS = 0.5  # of the maximum elsewhere
REST = 0.6  # of a pressure's last harmonic, at most what follows it: terms go as +-1/(n^2 - 1)
ELSEWHERE = 0.5  # power of the refinement where stresses are low
HIGH, APART, MOST_HIGH = 0.95, 0.1, 3  # places where they are: of the maximum, of r apart, so many
PATCH = 2.0  # elements of the first mesh about such a place, in which all are refined
READ = (4.0, 0.01)  # exponents: from so many elements to so much of the diameter


@dataclass(frozen=True)
class HarmonicSolution:
    """Fields on one mesh, and how fine (of the diameter) that mesh is at each singular place."""

    fields: MeridianFields
    close: tuple[float, ...]


def harmonic_solution(
    pin: Pin,
    material: Material,
    clamps: tuple[str, ...],
    cases: tuple[PinLoads, ...],
    places: tuple[Place, ...],
    level: int,
    ratio: float,
    before: Collection[Look] = (),
) -> HarmonicSolution:
    """All unit loads of the cases on mesh number `level`, each `ratio` times finer than the one
    before, from which the looks `before` are: where these have high stresses, that is, and
    elsewhere by the root of that; all over, without looks before.

    Raises: MeshError, SolveError.
    """
    close = tuple(
        CLOSE[min(level, len(CLOSE) - 1) if _matters(k, before) else 0] for k in range(len(places))
    )
    spots = partial(_spots, pin, cases, places, close)
    high = dict.fromkeys(place for look in before for place in look.high)
    finer = []
    for place in high:
        first = size_at(pin, SIZE, spots(1.0), place)
        now = size_at(pin, SIZE.finer(ratio**level), spots(ratio**level), place)
        finer.append(Grade((place,), now, PATCH * first, SIZE.growth))
    factor = ratio ** (level * ELSEWHERE if high else level)
    section = meridian_mesh(pin, SIZE.finer(factor), spots(factor), finer)
    loads = tuple(dict.fromkeys(load for case in cases for load in case.coefficients()))
    loads = loads or (UnitLoad(cases[0].surfaces[0], "force", 1),)  # of which there is nought
    read = [rim(pin, p, part * p.radius) for p in places for part in (1.0, FELT)]
    rims = np.concatenate([NOWHERE, *read])
    model = HarmonicModel(pin, section, material, clamps)
    return HarmonicSolution(model.solve(loads, rims, _ends(pin, clamps, loads)), close)


def _ends(
    pin: Pin, clamps: tuple[str, ...], loads: tuple[UnitLoad, ...]
) -> tuple[tuple[float, float], ...]:
    """Where a pressure ends on a smooth surface, (r, z) in m."""
    pushed = {load.surface for load in loads if load.kind == "pressure"}
    if not clamps and any(load.n <= 1 and not load.shears for load in loads):
        pushed |= set(pin.connections)  # which close the balance
    return smooth_edges(pin, pushed, clamps)


def _spots(
    pin: Pin,
    cases: tuple[PinLoads, ...],
    places: tuple[Place, ...],
    close: tuple[float, ...],
    factor: float,
) -> list[Spot]:
    """At singular places, with elements `close` (of the diameter), and at edges of bands, `factor`
    times finer than on the first mesh.
    """
    spots = [
        Spot(p.r, p.z, near * 2.0 * p.r, p.radius)
        if p.kind != "edge of a load"
        else Spot(p.r, p.z, LOGARITHM * p.radius / factor, p.radius)
        for p, near in zip(places, close, strict=True)
    ]
    taken = {(s.r, s.z) for s in spots}
    for name in dict.fromkeys(name for case in cases for name in case.surfaces):
        band = pin.band(name)
        for at in {(band.radius, band.z0), (band.radius, band.z1)} - taken:
            d = 2.0 * band.radius
            spots.append(Spot(*at, EDGE * d / factor, 4.0 * EDGE * d))
    return sorted(spots)


def _matters(place: int, before: Collection[Look]) -> bool:
    """Whether stress in a place is so large that it may govern, so that its growth is measured."""
    return any(look.places[place].felt >= MATTERS * look.maximum for look in before)


class HarmonicAnswer:
    """What a solution says of any loads made of its unit loads (fea.answer)."""

    def __init__(self, solution: HarmonicSolution, places: tuple[Place, ...]) -> None:
        self.fields, self.places = solution.fields, places

    def maxima(self, loads: PinLoads) -> Floats:
        """Largest von Mises stress (T,) Pa at every instant outside the places."""
        return Circumference(self.fields, loads).largest(self.fields.outside(self.places))[0]

    def picture(self, loads: PinLoads, instant: int) -> Picture:
        """The surface at one instant, with its envelope over all."""
        return revolve(self.fields, loads, instant)


def harmonic_look(
    solution: HarmonicSolution,
    places: tuple[Place, ...],
    loads: PinLoads,
    own: Collection[Place] | None = None,
) -> Look:
    """Maximum outside the places, and what is inside them. own: those of this case, where others
    have more; all by default.
    """
    fields = solution.fields
    around = Circumference(fields, loads)
    mine = places if own is None else own
    r, z = fields.points.T
    among = fields.outside(mine)
    top = around.top(among)
    return Look(
        unknowns=fields.unknowns,
        maximum=top.value,
        instant=top.instant,
        location=_location(fields.points[top.point], top.angle),
        places=tuple(
            replace(_inside(solution, around, p, np.hypot(r - p.r, z - p.z), close), acts=p in mine)
            for p, close in zip(places, solution.close, strict=True)
        ),
        left_out=_left_out(around, loads, top),
        high=_high(around, fields.points, among, top),
    )


def _high(
    around: Circumference, points: Floats, among: Mask, top: Top
) -> tuple[tuple[float, float], ...]:
    """Points (r, z) where stress is nearly the maximum, the highest first, well apart."""
    rows = np.flatnonzero(among)
    now = slice(top.instant, top.instant + 1)
    for bound in (around.reach, around.bound):
        rows = rows[bound(rows, now)[:, 0] >= HIGH * top.value]
    value, _ = around.round(rows, np.full(len(rows), top.instant))
    found: list[Floats] = []
    for k in np.argsort(-value, kind="stable"):
        if value[k] < HIGH * top.value or len(found) == MOST_HIGH:
            break
        at = points[rows[k]]
        if all(np.hypot(*(at - other)) > APART * at[0] for other in found):
            found.append(at)
    return tuple((float(r), float(z)) for r, z in found)


def _left_out(around: Circumference, loads: PinLoads, top: Top) -> float:
    """Of a bearing pressure's series, by its last harmonic at the maximum (a thin tube that becomes
    oval feels more of it than a solid pin).
    """
    n, largest = around.last(np.array([top.point]))
    if loads.distribution != "cosine" or n != loads.terms:
        return 0.0
    return REST * float(largest[0, top.instant])


def _location(point: Floats, angle: float) -> Point:
    r, z = (float(x) for x in point)
    return (r * float(np.cos(angle)), r * float(np.sin(angle)), z)


def _inside(
    solution: HarmonicSolution,
    around: Circumference,
    place: Place,
    distance: Floats,
    close: float,
) -> Inside:
    within = distance <= place.radius
    top = around.top(within)
    felt = around.top(within & (distance >= FELT * place.radius * (1.0 - 1e-9))).value
    location = _location(np.array([place.r, place.z]), top.angle)
    exponent = None
    if place.kind != "edge of a load" and close == CLOSE[-1]:
        exponent = _exponent(solution, around, place, distance, top.instant)
    return Inside(top.value, felt, location, exponent)


def _exponent(
    solution: HarmonicSolution, around: Circumference, place: Place, distance: Floats, instant: int
) -> float | None:
    """From the side of the place on which stress is larger."""
    skin = solution.fields.skin
    d = distance[:skin] / (2.0 * place.r)
    near = np.flatnonzero((d >= READ[0] * CLOSE[-1]) & (d <= READ[1]))
    if not len(near):
        return None
    value, _ = around.round(near, np.full(len(near), instant))
    first = int(np.argmin(distance[:skin]))
    sides = [near < first, near > first]
    side = max(sides, key=lambda s: float(np.median(value[s])) if s.any() else 0.0)
    following = place.following_torsion if around.twists else place.following
    return growth_exponent(d[near[side]], value[side], following)
