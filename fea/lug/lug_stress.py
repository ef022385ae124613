"""The largest stress at the bore of a lug over all instants of a case, with its error.

The hoop stress is that of the plane lug with its shank, in its own contact with the pin under the
load averaged through the thickness, plus what uneven pressure through the thickness adds
(fea.lug.through_thickness). Where the pin does not touch the bore, the hoop stress is the only
stress. Beneath the pin the pressure p acts, too, and with the hoop stress s von Mises' stress in
plane stress is

    sqrt(s^2 + s p + p^2)

Hoop stress plus pressure is smooth along the bore, but the pressure is not: it rises as a square
root from where contact ends. So the sum is read at the end of contact itself, not at the nearest
point.

At the sharp edges of a bore the pressure is unbounded. Beneath the pin the outermost rings are not
read there, as on the pin. Beside the contact they are read.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from fea.core.material import Material
from fea.lug.lug_load import LugLoad
from fea.lug.plane_contact import PlaneContact
from fea.lug.plane_fields import USUAL_AROUND, Elasticity, plane_fields
from fea.lug.shank_bending import bent
from fea.lug.slipping import SlippingBushing, TwoWalls
from fea.lug.through_thickness import EyeStress
from fea.support.lugs.lug import Lug
from pinbase.arrays import Floats
from pinbase.memo import Memo

COARSER = 2  # how much coarser the elements and sectors are with which the result is compared
# Contact is solved for forces above this part of the largest force on a lug. Smaller ones cannot
# govern, since stress per force differs by a factor of 4 between directions, and in a clearance
# they touch less than a sector. The stress of a press fit alone is the same for every force.
MIN_FORCE_SHARE = 0.05
MIN_RINGS_OF_SHARP_BORE = 2  # with more rings, the outermost are not read beneath the pin


@dataclass(frozen=True)
class BoreStress:
    """The largest stress at one wall of a lug, beside the contact or beneath it.

    wall: "bore", "bushing" (its bore) or "hole" (of the lug about a bushing).
    place: "free" where nothing presses on the wall, "beneath" the pin, or beneath a "bushing".
    von_mises: Pa, at `angle`.
    hoop: Pa, the largest tension.
    angle: rad, from the shank.
    ring: number of the ring.
    instant, time: of the largest von_mises.
    mesh, rings, sampling: parts of the error of von_mises, Pa.
    interface: for a pressed bushing, "bonded" or "frictionless", whichever gives the larger stress;
    otherwise empty.
    other: von_mises with the other interface, Pa; otherwise None.
    """

    wall: str
    place: str
    material: Material
    von_mises: float
    hoop: float
    angle: float
    ring: int
    instant: int
    time: float | None
    mesh: float = 0.0
    rings: float = 0.0
    sampling: float = 0.0
    interface: str = ""
    other: float | None = None

    @property
    def error(self) -> float:
        """The error of von_mises, Pa: the sum of those of mesh and sectors, rings, and sampling in
        time.
        """
        return self.mesh + self.rings + self.sampling


class LugInPlane:
    """A lug with its shank about a pin, in its plane, with a bonded bushing if it has one.

    pin: material of the pin.
    inner, radius: of the pin's bore and of its band, m.
    around: number of elements and sectors around the bore.
    """

    def __init__(
        self,
        lug: Lug,
        pin: Material,
        inner: float,
        radius: float,
        around: int = USUAL_AROUND,
        memo: Memo | None = None,
    ) -> None:
        self.lug, self.outline, elastic = lug, lug.outline(radius), _elasticity(lug)
        scaled = self.outline.in_radii()
        self.fields = plane_fields(scaled, elastic, around, memo)
        E = lug.material.youngs_modulus
        self.contact = PlaneContact(
            self.fields, E, lug.bearing, pin, inner, radius, lug.clearance, around
        )
        misfit = 0.0 if lug.bushing is None else lug.bushing.misfit
        self.misfit = misfit / self.outline.hole * E

    def amounts(self, pressures: Floats) -> Floats:
        """The amounts (T, K) of the unit loads under pressures (T, M), Pa, on the sectors, and the
        misfit.
        """
        misfit = np.full((len(pressures), 1), self.misfit)
        return np.hstack([pressures @ self.contact.waves, misfit])


def _elasticity(lug: Lug) -> Elasticity:
    nu, bearing = lug.material.poisson_ratio, lug.bearing
    return Elasticity(
        nu, bearing.youngs_modulus / lug.material.youngs_modulus, bearing.poisson_ratio
    )


def bore_stresses(
    make: Callable[..., LugInPlane],
    eye: EyeStress,
    load: LugLoad,
    slipping: Callable[..., SlippingBushing] | None = None,
) -> tuple[BoreStress, ...]:
    """The largest stress at the walls of a lug over the instants of a load.

    A pressed bushing is computed both bonded and slipping without friction. With friction the truth
    lies between, and the larger stress counts.
    make: gives the plane lug for `around`, its number of elements around the bore.
    eye: the stress of the eye of the lug as a body of revolution.
    slipping: gives the plane lug with a slipping bushing; None if the bushing is not pressed in.

    Raises: MeshError, SolveError.
    """
    bonded = stresses_of(make, eye, load)
    if slipping is None:
        return bonded
    return tuple(_larger(bonded, stresses_of(slipping, eye, load)))


def _larger(bonded: Iterable[BoreStress], slipping: Iterable[BoreStress]) -> Iterator[BoreStress]:
    """Yield the larger of two stresses at each wall and place, together with the other one."""
    named = {(x.wall, x.place): replace(x, interface="bonded") for x in bonded}
    others = {(x.wall, x.place): replace(x, interface="frictionless") for x in slipping}
    for at in dict.fromkeys((*named, *others)):
        both = [x for x in (named.get(at), others.get(at)) if x is not None]
        largest = max(both, key=lambda x: x.von_mises + x.error)
        yield replace(largest, other=next((x.von_mises for x in both if x is not largest), None))


def stresses_of(
    make: Callable[..., LugInPlane | SlippingBushing], eye: EyeStress, load: LugLoad
) -> tuple[BoreStress, ...]:
    """The largest stress at the walls with one kind of bushing; the arguments are those of
    `bore_stresses`.

    The errors of mesh and rings are the changes on a mesh with fewer elements and sectors, and with
    the pressure averaged over pairs of rings.
    """
    usual, coarse = (make(around=x) for x in (USUAL_AROUND, USUAL_AROUND // COARSER))
    out = []
    for stress in at_walls(usual, eye, load):
        here = load.at(stress.instant)
        others = at_walls(coarse, eye, here), at_walls(usual, eye, _on_pairs(here))
        mesh, rings = (abs(stress.von_mises - _same(x, stress).von_mises) for x in others)
        out.append(replace(stress, mesh=mesh, rings=rings))
    return tuple(out)


def _same(among: list[BoreStress], stress: BoreStress) -> BoreStress:
    """The stress at the same wall and place; if there is none, the largest at the same wall."""
    of_wall = [x for x in among if x.wall == stress.wall]
    alike = [x for x in of_wall if x.place == stress.place]
    return max(alike or of_wall, key=lambda x: x.von_mises)


@dataclass(frozen=True)
class _Around:
    """The stress around a wall of a lug at T instants on R rings, at P points where it may be
    largest.

    angle: (T, P) rad, from the shank.
    hoop, von_mises: (T, R, P) Pa, -inf where they are not read.
    """

    angle: Floats
    hoop: Floats
    von_mises: Floats

    def largest(
        self, wall: str, place: str, material: Material, times: Floats | None
    ) -> Iterator[BoreStress]:
        """Yield the largest stress over all instants, rings and points; nothing if none is read."""
        by_instant = self.von_mises.max(axis=(1, 2), initial=-np.inf)
        if not by_instant.max() > 0.0:
            return
        t, r, k = np.unravel_index(int(self.von_mises.argmax()), self.von_mises.shape)
        yield BoreStress(
            wall,
            place,
            material,
            float(by_instant.max()),
            float(self.hoop.max()),
            float(self.angle[t, k]),
            int(r),
            int(t),
            None if times is None else float(times[t]),
            sampling=0.0 if times is None else _beyond(times, by_instant),
        )


def _beyond(times: Floats, values: Floats) -> float:
    """The excess over the largest of values (T,) of the parabola through it and its neighbours in
    time.
    """
    k = int(values.argmax())
    if not 0 < k < len(values) - 1 or not np.isfinite(values[k - 1 : k + 2]).all():
        return 0.0
    x, y = times[k - 1 : k + 2] - times[k], values[k - 1 : k + 2] - values[k]
    bend = (y[0] / x[0] - y[2] / x[2]) / (x[0] - x[2])
    slope = y[0] / x[0] - bend * x[0]
    return float(-0.25 * slope * slope / bend) if bend < 0.0 else 0.0


def at_walls(
    plane: LugInPlane | SlippingBushing, eye: EyeStress, load: LugLoad
) -> list[BoreStress]:
    """The largest stress at each wall. Of the parts of its error, only that of sampling is set."""
    bushing, lug = plane.lug.bushing, plane.lug
    forces = load.along_shank / load.length.sum()
    size = np.hypot(*forces.T)
    strong = size > MIN_FORCE_SHARE * size.max()
    if isinstance(plane, SlippingBushing):
        hole: _Around | None
        bore, hole = _slipping(plane, eye, load, plane.pressures_where(forces, strong))
    else:
        pressure = np.zeros((len(forces), plane.contact.sectors))
        pressure[strong] = plane.contact.pressures(forces[strong])
        amounts = plane.amounts(pressure)
        bore = _bore(plane, eye, load, pressure, amounts)
        hole = _hole(plane, eye, load, amounts) if bushing else None
    wall, material = ("bushing", bushing.material) if bushing else ("bore", lug.material)
    free, beneath = bore
    out = [
        *free.largest(wall, "free", material, load.times),
        *beneath.largest(wall, "beneath", material, load.times),
    ]
    if hole:
        out += hole.largest("hole", "bushing", lug.material, load.times)
    return out


def _added(
    plane: LugInPlane | SlippingBushing,
    eye: EyeStress,
    load: LugLoad,
    angles: Floats,
    hole: bool = False,
) -> Floats:
    """The stress (T, R, P), Pa, that pressure adds because it is uneven through the thickness.

    angles: (P,) rad, from the shank.
    hole: whether at the hole of the lug about a bushing.
    """
    amplitude = eye.added(load.pressure, load.length, hole)
    turns = angles + load.angle[:, None]  # (T, P)
    n = np.arange(len(amplitude))[:, None, None]
    cos, sin = np.cos(n * turns), np.sin(n * turns)
    first = np.einsum("ntr,ntp->trp", amplitude[..., 0], cos)
    out = np.asarray(first + np.einsum("ntr,ntp->trp", amplitude[..., 1], sin))
    of_lug = hole or plane.lug.bushing is None
    return out + bent(plane.outline, load, angles) if of_lug else out


def _bore(
    plane: LugInPlane, eye: EyeStress, load: LugLoad, pressure: Floats, amounts: Floats
) -> tuple[_Around, _Around]:
    """The stress of the wall on which the pin bears, where it is free and where it is beneath the
    pin.
    """
    wall = plane.fields.bore
    total = (amounts @ (wall.hoop - wall.radial))[:, None] + _added(plane, eye, load, wall.angles)
    return _of_wall(plane.lug, load, wall.angles, total, pressure)


def _of_wall(
    lug: Lug, load: LugLoad, angles: Floats, total: Floats, pressure: Floats
) -> tuple[_Around, _Around]:
    """The stress of the wall on which the pin bears, where it is free and where it is beneath the
    pin.

    total: (T, R, P) Pa, hoop stress plus pressure at angles (P,), rad, two in each sector.
    pressure: (T, P / 2) Pa, on the sectors, the mean of the rings.
    """
    # The middles of sectors are every second point of the wall.
    middles, here = angles[::2], pressure[:, None] * load.shares[:, :, None]
    at_middles = np.broadcast_to(middles, pressure.shape)
    hoop = total[:, :, ::2] - here
    # The wall is also free at the ends of contact, of which there are usually two or none.
    edge, known = _ends_of_contact(pressure)
    at = np.where(known, edge, 0.0)
    beside = np.where(known[:, None], _between(total, 2.0 * at), -np.inf)
    open_hoop = np.where(pressure[:, None] > 0.0, -np.inf, hoop)
    free = np.concatenate([open_hoop, beside], axis=2)
    angle = np.hstack([at_middles, at * (middles[1] - middles[0])])
    read = np.broadcast_to(pressure[:, None] > 0.0, hoop.shape).copy()
    if not lug.edge_radius and len(load.length) > MIN_RINGS_OF_SHARP_BORE:
        read[:, [0, -1]] = False
    under = np.sqrt(hoop * hoop + hoop * here + here * here)
    unread = np.full_like(hoop, -np.inf)
    return (
        _Around(angle, free, np.where(np.isfinite(free), np.abs(free), -np.inf)),
        _Around(at_middles, np.where(read, hoop, unread), np.where(read, under, unread)),
    )


def _slipping(
    plane: SlippingBushing, eye: EyeStress, load: LugLoad, pressures: TwoWalls
) -> tuple[tuple[_Around, _Around], _Around]:
    """The stress of a slipping bushing's bore (free, beneath the pin), and of the hole about the
    bushing.
    """
    angles = plane.angles
    bore, hole = (x[:, None] for x in plane.stress_and_pressure(pressures))
    bore = bore + _added(plane, eye, load, angles)
    walls = _of_wall(plane.lug, load, angles, bore, pressures.bore)
    # Beneath the bushing the pressure of the fit is even through the thickness. Where the fit
    # opens, stress is also read at the ends of contact, as at a bore.
    total, pressed = hole + _added(plane, eye, load, angles, hole=True), pressures.hole[:, None]
    edge, known = _ends_of_contact(pressures.hole)
    at = np.where(known, edge, 0.0)
    beside = np.where(known[:, None], _between(total, 2.0 * at), 0.0)
    hoop = np.concatenate([total[:, :, ::2] - pressed, beside], axis=2)
    middles = np.broadcast_to(angles[::2], pressures.hole.shape)
    angle = np.hstack([middles, at * (angles[2] - angles[0])])
    pressed = np.concatenate([pressed, np.zeros((*pressed.shape[:2], beside.shape[2]))], axis=2)
    von_mises = np.sqrt(hoop * hoop + hoop * pressed + pressed * pressed)
    return walls, _Around(angle, hoop, von_mises)


def _ends_of_contact(
    pressure: Floats,
) -> tuple[Floats, np.ndarray[tuple[int, int], np.dtype[np.bool_]]]:
    """The ends of contact, (T, 2 M), in sectors from the middle of the first one, and which of them
    exist.

    If pressure rises as a square root from the end of contact, the mean pressure of the last
    pressed sector, over that of the one before, determines how far contact reaches into it.
    """
    last = pressure > 0.0
    M = pressure.shape[1]
    ends, known = [], []
    for step in (1, -1):
        beyond, before = np.roll(last, -step, axis=1), np.roll(pressure, step, axis=1)
        is_end = last & ~beyond
        ratio = np.where(
            is_end & (before > 0.0), pressure / np.where(before > 0.0, before, 1.0), 1.0
        )
        reach = 1.0 / ((1.0 + 1.0 / np.maximum(ratio, 1e-9)) ** (2.0 / 3.0) - 1.0)
        ends.append(np.arange(M) + step * (np.minimum(reach, 1.0) - 0.5))
        known.append(is_end)
    return np.hstack(ends), np.hstack(known)


def _between(values: Floats, at: Floats) -> Floats:
    """The values (T, R, E) at points between others, by linear interpolation.

    values: (T, R, P) at equally spaced points around the wall.
    at: (T, E) positions, in steps between these points.
    """
    P = values.shape[2]
    low = np.floor(at).astype(np.int64)
    part = (at - low)[:, None]
    first = np.take_along_axis(values, np.mod(low, P)[:, None], axis=2)
    second = np.take_along_axis(values, np.mod(low + 1, P)[:, None], axis=2)
    return np.asarray((1.0 - part) * first + part * second)


def _hole(plane: LugInPlane, eye: EyeStress, load: LugLoad, amounts: Floats) -> _Around:
    """The stress of the lug at the hole about its bonded bushing."""
    assert plane.fields.hole is not None
    wall = plane.fields.hole.at(amounts)
    hoop = wall.hoop[:, None] + _added(plane, eye, load, wall.angles, hole=True)
    radial, shear = wall.radial[:, None], wall.shear[:, None]
    von_mises = np.sqrt(hoop * hoop - hoop * radial + radial * radial + 3.0 * shear * shear)
    return _Around(np.broadcast_to(wall.angles, wall.hoop.shape), hoop, von_mises)


def _on_pairs(load: LugLoad) -> LugLoad:
    """The load with the pressure averaged over each pair of rings."""
    pressure, length = load.pressure.copy(), load.length
    for first in range(0, len(length) - 1, 2):
        pair = slice(first, first + 2)
        share = length[pair] / length[pair].sum()
        pressure[:, :, pair] = np.einsum("ntrp,r->ntp", pressure[:, :, pair], share)[:, :, None]
    return replace(load, pressure=pressure)
