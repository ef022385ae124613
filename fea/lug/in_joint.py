"""The stress of a pin's lugs at all instants of a case whose contact is solved."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial

import numpy as np

from fea.core.material import Material
from fea.lug.lug_load import LugLoad
from fea.lug.lug_stress import BoreStress, LugInPlane, bore_stresses
from fea.lug.slipping import SlippingBushing
from fea.lug.through_thickness import EyeStress, eye_stress
from fea.support.contact.bending import SAME_FORCE
from fea.support.contact.joint_changes import VariedPressures
from fea.support.contact.pressed_cases import PressedCases
from fea.support.contact.variations import varied_pressures
from fea.support.lugs.lug import Lug
from fea.support.records import LugStress
from pinbase.arrays import Floats
from pinbase.memo import Memo

ANGLE_DECIMALS = 6  # of degrees, far finer than a mesh resolves
BENEATH = "beneath"  # the place at a bore on which the pin presses
ALONG_FORCE = "shank along the largest force, in tension"


@dataclass(frozen=True)
class ShankAngle:
    """The angle of a shank from the pin's x axis, at the instants of a motion.

    angle: (T,) rad; a single angle for a shank that does not turn.
    times: (T,) s; None for a shank that does not turn.
    assumed: what is assumed about the angle, as text.
    """

    angle: Floats
    times: Floats | None = None
    assumed: str = ""

    def at(self, times: Floats | None, count: int) -> Floats:
        """The angle (count,), rad, at times (count,) of the same motion.

        times: s; None for loads without a motion.
        """
        if self.times is None or times is None:
            return np.full(count, float(self.angle[0]))
        return np.asarray(np.interp(times, self.times, np.unwrap(self.angle)))


@dataclass(frozen=True)
class _LoadedLug:
    """A lug on its band, whose stress under any pressures is superposed.

    rows: its rings among those of the pin.
    pin_section: the material of the pin, and the radii of its bore and of its band, m.
    length: (R,) m, of the rings.
    """

    lug: Lug
    rows: slice
    pin_section: tuple[Material, float, float]
    eye: EyeStress
    length: Floats
    memo: Memo

    def force(self, waves: Floats) -> Floats:
        """The force (T, 2), N, of the pin on the lug under pressures.

        waves: (N + 1, T, rings of the pin, 2) Pa, harmonics of the pressures.
        """
        around = 2.0 * math.pi * self.pin_section[2] * self.length
        return np.asarray(0.5 * np.einsum("trp,r->tp", waves[1][:, self.rows], around))

    def load(self, waves: Floats, angle: Floats, times: Floats | None) -> LugLoad:
        """The load of the lug under pressures.

        waves: as for `force`.
        angle: (T,) rad, of the shank.
        times: (T,) s, or None.
        """
        load = LugLoad(self.force(waves), waves[:, :, self.rows], self.length, angle, times)
        # In a clearance, a force that is round-off brings nothing into contact, so it is removed.
        # With an interference there is contact under any force.
        return load if self.lug.clearance < 0.0 else load.without_round_off()

    def largest(
        self, waves: Floats, angle: Floats, times: Floats | None
    ) -> dict[tuple[str, str], tuple[Lug, BoreStress]]:
        """The largest stress for each wall and place, and the lug in which it occurs.

        The lug is computed with either end of the interference of its bushing, and the larger
        stress counts.
        waves: as for `force`.
        angle: (T,) rad, of the shank.
        times: (T,) s; None for one instant.
        """
        load = self.load(waves, angle, times)
        largest: dict[tuple[str, str], tuple[Lug, BoreStress]] = {}
        for at, bonded, slipping in self.planes(self.lug.clearance):
            for stress in bore_stresses(bonded, self.eye, load, slipping):
                place, size = (stress.wall, stress.place), stress.von_mises + stress.error
                before = largest.get(place)
                if before is None or size > before[1].von_mises + before[1].error:
                    largest[place] = at, stress
        return largest

    def planes(
        self, clearance: float
    ) -> Iterator[tuple[Lug, Callable[..., LugInPlane], Callable[..., SlippingBushing] | None]]:
        """Yield the lug with a clearance, m, and either end of the interference of its bushing.

        With each lug come the functions that make it in its plane, with a bonded bushing and, if
        the bushing is pressed in, with a slipping one.
        """
        for bushing in self.lug.pressed_bushings() or (None,):
            at = replace(self.lug, bushing=bushing, clearance=clearance)
            bonded = partial(LugInPlane, at, *self.pin_section, memo=self.memo)
            pressed = bushing is not None and bushing.pressed
            slipping = (
                partial(SlippingBushing, at, *self.pin_section, memo=self.memo) if pressed else None
            )
            yield at, bonded, slipping


def lug_stresses(
    contact: PressedCases, case: str, angles: Mapping[str, ShankAngle], varied: bool, memo: Memo
) -> tuple[LugStress, ...]:
    """The stress at the bores of all lugs that have a shank, in one case.

    angles: of shanks, by connection; a shank without an entry lies along the largest force.
    varied: whether the stress is also varied over the uncertain properties of the joint.

    Raises: ArgumentError for an impossible outline; MeshError, SolveError.
    """
    model, links = contact.model, contact.instants[case]
    waves, out = model.waves(contact.states(links)), list[LugStress]()
    # The governing instant of a lug may differ from that of the pin, at which the load on the lug
    # may be small.
    over = cache(lambda t: varied_pressures(model, contact.joined(links, t)))
    for rows, lug, ends in model.by_lug():
        if lug.shank is None:
            continue
        band = model.whole.band(lug.connection)
        inner = max(max(s.bores) for s in model.whole.segments if s.connection == lug.connection)
        pin_section = model.material, inner / 2.0, band.radius
        eye = _eye(contact, lug, ends, memo)
        loaded = _LoadedLug(lug, rows, pin_section, eye, np.diff(ends), memo)
        force = loaded.force(waves)
        if not force.any():
            continue
        given = angles.get(lug.connection)
        angle = _along(force, len(force)) if given is None else given.at(links.times, len(force))
        assumed = ALONG_FORCE if given is None else given.assumed
        middles = band.z0 + 0.5 * (ends[1:] + ends[:-1])
        ratios = dict[int, dict[tuple[str, str], float]]()
        for place, (at, stress) in loaded.largest(waves, angle, links.times).items():
            t = stress.instant
            if varied and stress.place != BENEATH and t not in ratios:
                least = SAME_FORCE * float(np.linalg.norm(links.forces[t], axis=-1).max())
                ratios[t] = _over_joint(loaded, over(t), angle[[t]], least)
            record = _record(at, stress, float(middles[stress.ring]), assumed)
            out.append(replace(record, over_joint=ratios.get(t, {}).get(place, 1.0)))
    return tuple(out)


def _over_joint(
    loaded: _LoadedLug, pressures: Sequence[VariedPressures], angle: Floats, least: float
) -> dict[tuple[str, str], float]:
    """The largest stress under any of some pressures over that under the first ones, for each wall
    and place.

    Stresses include their error. Places beneath the pin are left out.
    least: N, a force below which the load is round-off, which brings nothing into contact.
    """

    def sizes(joint: VariedPressures) -> dict[tuple[str, str], float]:
        if np.linalg.norm(loaded.force(joint.waves)) <= least:
            return {}
        # Only the clearance is varied here. A variation of the lug's stiffness represents other
        # links, not another material of this lug.
        (loose,) = (x.clearance for x in joint.lugs if x.connection == loaded.lug.connection)
        load, largest = loaded.load(joint.waves, angle, None), dict[tuple[str, str], float]()
        for _, bonded, slipping in loaded.planes(loose):
            for x in bore_stresses(bonded, loaded.eye, load, slipping):
                place = x.wall, x.place
                largest[place] = max(largest.get(place, 0.0), x.von_mises + x.error)
        return {place: size for place, size in largest.items() if place[1] != BENEATH}

    given, *varied = map(sizes, pressures)
    return {
        place: max([1.0, *(x.get(place, 0.0) / size for x in varied)])
        for place, size in given.items()
        if size > 0.0
    }


def _along(force: Floats, count: int) -> Floats:
    """The angle (count,), rad, of a shank that pulls against the largest force on its lug."""
    x, y = -force[np.hypot(*force.T).argmax()]
    return np.full(count, math.atan2(y, x))


def _eye(contact: PressedCases, lug: Lug, ends: Floats, memo: Memo) -> EyeStress:
    model = contact.model
    alike, highest = model.flexibility_key(lug, ends), model.cells.highest
    return memo.get(
        ("eye stress", alike, model.cells),
        lambda: eye_stress(model.on_lugs[alike], lug, highest),
    )


def degrees_from_shank(angle: float) -> float:
    """The angle from a shank, from -180 to 180 degrees; rounded, so that round-off does not show.

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
