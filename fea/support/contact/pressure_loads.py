"""Contact pressures as loads on a pin whose bands are cut into rings, harmonic by harmonic.

Pressures at neighbouring instants are similar. A few patterns over the rings for each harmonic, the
singular vectors of the pressures, therefore make up all of them, and there are as few unit loads as
with prescribed pressures, however many rings there are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fea.core.pin_loads import Floats, LoadAmounts, PinLoads, UnitLoad
from fea.core.pressed import PressedArcs
from geometry import Pin
from geometry.shape.pin import SHOULDER
from geometry.shape.rings import ringed_name

# A pattern whose amplitude at every instant is below this fraction of the largest is left out.
MODE_TOLERANCE = 2e-3
ROUGH_MODE_TOLERANCE = 3e-2  # the same for instants that cannot govern
# Fraction of the largest mean pressure (n = 0) below which the pressure of harmonic 1 is round-off
# of a press fit without load.
EVEN_PRESSURE_ROUND_OFF = 1e-13


@dataclass(frozen=True)
class PressureLoads(PinLoads):
    """Loads on the rings of a pin, made of patterns of pressure.

    acting: amount of each unit load by phase, (T, 2).
    forces: resultants of the pressures on the rings, and the shares of axial forces; after the
    rings come other surfaces that take axial forces.
    of_links: loads of the links that the pressures carry, at the same instants.
    squeezing: largest sum over all rings of the mean pressure times the ring's area, N.
    """

    acting: Mapping[UnitLoad, Floats] = field(default_factory=dict)
    of_links: PinLoads | None = None
    squeezing: float = 0.0

    @property
    def links(self) -> PinLoads:
        """The loads of the links on the pin."""
        assert self.of_links is not None
        return self.of_links

    @property
    def on_rings(self) -> PinLoads:
        """The resultants of the pressures on the rings, and the shares of axial forces."""
        return PinLoads(
            self.case, self.surfaces, self.forces, self.moments, body=self.body,
            times=self.times, always=across_all(self.surfaces), bands=self.bands,
        )  # fmt: skip

    @property
    def in_sections(self) -> LoadAmounts:
        """The loads `on_rings`, and the shears along and about the axis that act on sections."""
        shear = {u: x for u, x in self.acting.items() if u.kind in ("axial", "around") and u.n < 2}
        return LoadAmounts(
            self.case, {**self.on_rings.coefficients(), **shear}, len(self), self.pressed
        )

    def coefficients(self) -> Mapping[UnitLoad, Floats]:
        """The amount of each unit load by phase, (T, 2)."""
        return self.acting

    def at(self, instants: NDArray[np.int64]) -> PressureLoads:
        """The loads at some of the instants, by their numbers."""
        some = super().at(instants)
        assert isinstance(some, PressureLoads)
        acting = {load: amount[instants] for load, amount in self.acting.items()}
        return replace(some, acting=acting, of_links=self.links.at(instants))

    def merged(self, other: PinLoads) -> PressureLoads:
        """The loads with the instants of other loads of the same motion added, in order of time."""
        assert isinstance(other, PressureLoads)
        assert self.times is not None
        assert other.times is not None
        both = _after_each_other([self, other])
        first = np.unique(np.concatenate([self.times, other.times]), return_index=True)[1]
        joined = super().merged(other)
        assert isinstance(joined, PressureLoads)
        acting = {load: x[first] for load, x in both.items()}
        squeezing = max(self.squeezing, other.squeezing)
        links = self.links.merged(other.links)
        return replace(joined, of_links=links, acting=acting, squeezing=squeezing)


@dataclass(frozen=True)
class PressureModes:
    """Patterns (K, R) in Pa over the rings of a pin, one array for each harmonic from 0 on."""

    pin: Pin
    rings: tuple[str, ...]
    by_harmonic: tuple[Floats, ...]

    def loads(
        self, waves: Floats, links: PinLoads, pressed: PressedArcs | None = None
    ) -> PressureLoads:
        """The loads of pressures on the rings, made of these patterns, and the links' other loads.

        waves: harmonics of the pressures, (N + 1, T, R, 2) Pa.
        links: loads of the links, whose surfaces are the uncut bands; they give the axial forces,
        the torques and the body force.
        pressed: where the pressures act.
        """
        ring_loads = resultants(self.pin, self.rings, waves, links)
        acting = dict(others_along(self.pin, self.rings, links).coefficients())
        acting.update(self.amounts(waves))
        areas = np.array([self.pin.band(name).area for name in self.rings])
        squeezing = np.abs(waves[0, :, :, 0]) @ areas
        return PressureLoads(
            links.case,
            ring_loads.surfaces,
            ring_loads.forces,
            ring_loads.moments,
            body=links.body,
            times=links.times,
            acting=acting,
            of_links=links,
            pressed=pressed,
            bands=ring_loads.bands,
            squeezing=float(squeezing.max(initial=0.0)),
        )

    def amounts(
        self, waves: Floats, kind: Literal["pressure", "axial"] = "pressure"
    ) -> dict[UnitLoad, Floats]:
        """The amount of each pattern by phase, (T, 2), in harmonics (N + 1, T, R, 2) Pa.

        kind: direction of the traction.
        """
        out: dict[UnitLoad, Floats] = {}
        for n, (wave, patterns) in enumerate(zip(waves, self.by_harmonic, strict=True)):
            units = (unit._replace(kind=kind) for unit in self._units[n])
            out.update(zip(units, np.einsum("trp,kr->ktp", wave, patterns), strict=True))
        return out

    @cached_property
    def _units(self) -> tuple[tuple[UnitLoad, ...], ...]:
        """The unit load of each pattern, by harmonic."""
        return tuple(
            tuple(
                UnitLoad("", "pressure", n, tuple(zip(self.rings, pattern, strict=True)))
                for pattern in patterns.tolist()
            )
            for n, patterns in enumerate(self.by_harmonic)
        )

    def left_out(self, waves: Floats) -> float:
        """The largest amplitude that these patterns miss of harmonics (N + 1, T, R, 2), relative to
        the largest amplitude.
        """
        largest, missed = float(np.abs(waves).max(initial=0.0)), 0.0
        for wave, patterns in zip(waves, self.by_harmonic, strict=True):
            rest = wave - (wave.swapaxes(1, 2) @ patterns.T @ patterns).swapaxes(1, 2)
            missed = max(missed, float(np.abs(rest).max()))
        return missed / largest if largest else 0.0


def resultants(pin: Pin, rings: tuple[str, ...], waves: Floats, links: PinLoads) -> PinLoads:
    """The resultants of pressures with harmonics (N + 1, T, R, 2) Pa, and the axial loads of the
    links.

    The resultants are set to zero where they are round-off of a press fit without load.
    """
    axial = others_along(pin, rings, links)
    area = np.array([pin.band(name).area for name in rings])
    if len(waves) > 1:
        even, across = (np.abs(x).max(axis=(1, 2), initial=0.0) for x in waves[:2])
        loaded = (across > EVEN_PRESSURE_ROUND_OFF * even)[:, None, None]
        axial.forces[:, : len(rings), :2] = np.where(loaded, -0.5 * waves[1] * area[:, None], 0.0)
    return replace(axial, always=(*axial.always, *across_all(rings)))


def across_all(surfaces: Sequence[str]) -> tuple[UnitLoad, ...]:
    """The unit loads across the pin on the given surfaces, without shoulders.

    All of them count, since contact may be open at a ring at some instants and closed at others.
    """
    return tuple(UnitLoad(x, "force", 1) for x in surfaces if not x.startswith(SHOULDER))


def pressure_modes(
    pin: Pin,
    rings: tuple[str, ...],
    parts: Sequence[tuple[Floats, float]],
    known: PressureModes | None = None,
) -> PressureModes:
    """The patterns that reproduce the harmonics of pressures.

    parts: harmonics (N + 1, T, R, 2) Pa, such as those of a case, each with the fraction of its
    largest amplitude that is negligible.
    known: existing patterns, which come first.
    """
    scaled = [x / (negligible * (np.abs(x).max(initial=0.0) or 1.0)) for x, negligible in parts]
    waves = np.concatenate(scaled, axis=1)
    before = [np.zeros((0, len(rings)))] * len(waves) if known is None else known.by_harmonic
    modes = []
    for wave, old in zip(waves, before, strict=True):
        amplitude = wave.transpose(0, 2, 1).reshape(-1, len(rings))
        for _ in range(2):  # the second pass removes round-off
            amplitude = amplitude - amplitude @ old.T @ old
        instants, size, patterns = np.linalg.svd(amplitude, full_matrices=False)
        most = np.abs(instants * size).max(axis=0)
        modes.append(np.concatenate([old, patterns[most > 1.0]]))
    return PressureModes(pin, rings, tuple(modes))


def stacked(loads: Sequence[PressureLoads]) -> PressureLoads:
    """The loads, which are made of the same patterns, as instants of one case without times."""
    acting = _after_each_other(loads)
    forces, moments, body = (
        np.concatenate([getattr(one, name) for one in loads])
        for name in ("forces", "moments", "body")
    )
    pressed = loads[0].pressed
    for one in loads[1:]:
        pressed = None if pressed is None or one.pressed is None else pressed.joined(one.pressed)
    return replace(
        loads[0], forces=forces, moments=moments, body=body, times=None, acting=acting,
        pressed=pressed,
    )  # fmt: skip


def _after_each_other(loads: Sequence[PressureLoads]) -> dict[UnitLoad, Floats]:
    none = [np.zeros((len(one), 2)) for one in loads]
    return {
        unit: np.concatenate([x.acting.get(unit, n) for x, n in zip(loads, none, strict=True)])
        for unit in dict.fromkeys(unit for one in loads for unit in one.acting)
    }


def amplitudes(pressure: Floats, highest: int, angle: float = 0.0) -> Floats:
    """The harmonics 0 to `highest`, cos and sin, (N + 1, R, 2), of pressures (R, M).

    The pressure is uniform on each sector. angle: from the x axis to the middle of the first
    sector, rad.
    """
    return np.asarray(pressure @ waves_of_sectors(pressure.shape[1], highest, angle))


def waves_of_sectors(sectors: int, highest: int, angle: float = 0.0) -> Floats:
    """The harmonics, cos and sin, of a unit pressure on each sector, (N + 1, M, 2)."""
    n = np.arange(highest + 1)
    factor = np.sinc(n / sectors) * np.where(n > 0, 2.0, 1.0) / sectors
    turns = np.outer(n, 2.0 * np.pi * np.arange(sectors) / sectors + angle)
    return np.stack([np.cos(turns), np.sin(turns)], axis=2) * factor[:, None, None]


def others_along(pin: Pin, rings: tuple[str, ...], links: PinLoads) -> PinLoads:
    """The axial forces and torques of the links, and the body force, as loads on the rings.

    After the rings come the other surfaces that take axial forces (PinLoads.seats).
    pin: with its bands cut into rings.
    """
    out = _along(pin, rings, links)
    if not links.pulls:
        return out
    # The unit loads that act under any loads of the problem follow from a unit of each axial force
    # and torque.
    units = np.zeros((3, len(links.surfaces), 3)), np.zeros((3, len(links.surfaces), 3))
    for surface, side in links.pulls:
        if surface in links.surfaces:
            turns = side == 2
            units[turns][side, links.surfaces.index(surface), 2] = (-1.0, 1.0, 1.0)[side]
    each = _along(pin, rings, PinLoads(links.case, links.surfaces, *units, seats=links.seats))
    return replace(out, always=tuple(each.coefficients()))


def _along(pin: Pin, rings: tuple[str, ...], links: PinLoads) -> PinLoads:
    """The same, without unit loads that act only under other loads of the problem."""
    here = {surface: links.seats.get(surface, (surface, surface)) for surface in links.surfaces}
    elsewhere = {x: ringed_name(pin, x) for both in here.values() for x in both if x not in here}
    surfaces = (*rings, *elsewhere.values())
    forces = np.zeros((len(links), len(surfaces), 3))
    moments = np.zeros_like(forces)
    share = ring_shares(pin, rings, links.surfaces)
    for c, surface in enumerate(links.surfaces):
        pull = links.forces[:, c, 2]
        both = np.minimum(pull, 0.0), np.maximum(pull, 0.0)
        for seat, part in zip(here[surface], both, strict=True):
            if seat in here:
                forces[:, : len(rings), 2] += np.outer(part, share[links.surfaces.index(seat)])
            else:
                forces[:, surfaces.index(elsewhere[seat]), 2] += part
    moments[:, : len(rings), 2] = links.moments[:, :, 2] @ share
    bands = tuple(
        tuple(name for name, x in zip(rings, on, strict=True) if x) for on in share.tolist()
    )
    return PinLoads(
        links.case, surfaces, forces, moments, body=links.body, times=links.times, bands=bands
    )


def ring_shares(pin: Pin, rings: tuple[str, ...], bands: tuple[str, ...]) -> Floats:
    """The share of each band's axial force that each ring takes, (C, R).

    The force per length is a parabola over the band, zero at its edges.
    """
    on_band = np.array([[name.startswith(f"{band} ring ") for name in rings] for band in bands])
    z0, z1 = np.array([(b.z0, b.z1) for b in map(pin.band, rings)]).T
    start = np.where(on_band, z0, np.inf).min(axis=1, keepdims=True)
    end = np.where(on_band, z1, -np.inf).max(axis=1, keepdims=True)
    before, after = ((z - 0.5 * (start + end)) / (end - start) for z in (z0, z1))
    part = on_band * (1.5 * (after - before) - 2.0 * (after**3 - before**3))
    return np.asarray(part / part.sum(axis=1, keepdims=True))
