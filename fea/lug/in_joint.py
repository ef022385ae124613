"""The stress of a pin's lugs at all instants of a case whose contact is solved."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from fea.core.material import Material
from fea.lug.lug_stress import BoreStress, LugInPlane, LugLoad, bore_stresses
from fea.lug.slipping import SlippingBushing
from fea.lug.through_thickness import EyeStress, eye_stress
from fea.support.contact.pressed_cases import PressedCases
from fea.support.lugs.lug import Lug
from fea.support.records import LugStress
from pinbase.arrays import Floats
from pinbase.memo import Memo

ANGLE_DECIMALS = 6  # of degrees, which are far fewer than a mesh resolves
ALONG_FORCE = "shank along the largest force, in tension"


@dataclass(frozen=True)
class ShankAngle:
    """The angle of a shank from the pin's x axis, (T,) rad, at times (T,) s; one angle and None
    where it does not turn.

    assumed: what is assumed of it, in words.
    """

    angle: Floats
    times: Floats | None = None
    assumed: str = ""

    def at(self, times: Floats | None, count: int) -> Floats:
        """The angle at times (count,) of the same motion, which may be None for one instant."""
        if self.times is None or times is None:
            return np.full(count, float(self.angle[0]))
        return np.asarray(np.interp(times, self.times, np.unwrap(self.angle)))


def lug_stresses(
    contact: PressedCases, case: str, angles: Mapping[str, ShankAngle], memo: Memo
) -> tuple[LugStress, ...]:
    """The stress at the bores of all lugs that have a shank, in one case.

    angles: of shanks, by connection; a shank without one lies along the largest force.

    Raises: ArgumentError for an impossible outline; MeshError, SolveError.
    """
    model, links = contact.model, contact.instants[case]
    waves = model.waves(contact.states(links))
    count, out = waves.shape[1], list[LugStress]()
    for rows, lug, ends in model.by_lug():
        if lug.shank is None:
            continue
        pressure = waves[:, :, rows]
        band = model.whole.band(lug.connection)
        length = np.diff(ends)
        force = 0.5 * np.einsum("trp,r->tp", pressure[1], 2.0 * math.pi * band.radius * length)
        if not force.any():
            continue
        given = angles.get(lug.connection)
        angle = _along(force, count) if given is None else given.at(links.times, count)
        load = LugLoad(force, pressure, length, angle, links.times)
        inner = max(max(s.bores) for s in model.whole.segments if s.connection == lug.connection)
        of = model.material, inner / 2.0, band.radius
        eye = _eye(contact, lug, ends, memo)
        assumed = ALONG_FORCE if given is None else given.assumed
        middles = band.z0 + 0.5 * (ends[1:] + ends[:-1])
        out += [
            _record(at, stress, float(middles[stress.ring]), assumed)
            for at, stress in _over_interference(lug, of, eye, load, memo)
        ]
    return tuple(out)


def _over_interference(
    lug: Lug, of: tuple[Material, float, float], eye: EyeStress, load: LugLoad, memo: Memo
) -> list[tuple[Lug, BoreStress]]:
    """Return the largest stress at each wall and place over the range of the interference of a
    lug's bushing, with the lug in which it is.

    of: material of the pin, radius of its bore and of its band, m.
    """
    largest: dict[tuple[str, str], tuple[Lug, BoreStress]] = {}
    for bushing in lug.pressed_bushings() or (None,):
        at = replace(lug, bushing=bushing)
        bonded = partial(LugInPlane, at, *of, memo=memo)
        pressed = bushing is not None and bushing.pressed
        slipping = partial(SlippingBushing, at, *of, memo=memo) if pressed else None
        for stress in bore_stresses(bonded, eye, load, slipping):
            place, size = (stress.wall, stress.place), stress.von_mises + stress.error
            if place not in largest or size > largest[place][1].von_mises + largest[place][1].error:
                largest[place] = at, stress
    return list(largest.values())


def _along(force: Floats, count: int) -> Floats:
    """The angle of a shank that pulls against the largest force on its lug, (count,) rad."""
    x, y = -force[np.hypot(*force.T).argmax()]
    return np.full(count, math.atan2(y, x))


def _eye(contact: PressedCases, lug: Lug, ends: Floats, memo: Memo) -> EyeStress:
    model = contact.model
    alike, highest = model.likeness(lug, ends), model.cells.highest
    return memo.get(
        ("eye stress", alike, model.cells),
        lambda: eye_stress(model.on_lugs[alike], lug, highest),
    )


def degrees_from_shank(angle: float) -> float:
    """The angle from a shank, from -180 to 180 degrees, without the round-off that a zero has.

    angle: rad.
    """
    return round(math.degrees(math.remainder(angle, 2.0 * math.pi)), ANGLE_DECIMALS) + 0.0


def _record(lug: Lug, stress: BoreStress, z: float, assumed: str) -> LugStress:
    pressed = lug.bushing if lug.range.interference else None
    return LugStress(
        connection=lug.connection,
        wall=stress.wall,
        place=stress.place,
        material=stress.material.name,
        max_von_mises=stress.von_mises,
        max_hoop_stress=stress.hoop,
        angle=degrees_from_shank(stress.angle),
        z=z,
        time=stress.time,
        error_estimate=stress.error,
        mesh=stress.mesh,
        rings=stress.rings,
        sampling=stress.sampling,
        yield_strength=stress.material.yield_strength,
        assumed=assumed,
        interface=stress.interface,
        other_interface=stress.other,
        interference=pressed.interference if pressed else None,
    )
