"""Pins with shoulders, grooves and bores in lugs, drawn at random from a seed, on which rows are
tested with an independent reader of the surface.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fea.core.material import Material
from fea.core.over_time import Between
from fea.core.pin_loads import Floats, PinLoads
from fea.core.places import PressedCell
from fea.core.requirement import Requirement
from fea.harmonic.fields import MeridianFields
from fea.solve.solve import solve_in_lugs
from fea.support.lugs.lug import Lug
from fea.support.support import PinProblem, Solution
from geometry import Pin, Segment

STEEL = Material("steel", 2.1e11, 0.3, 7850.0, 1e9)
ALUMINIUM = Material("aluminium", 7e10, 0.33)
STRESS = 1e8  # force over the diameter squared, Pa
EVERY = 720  # angles at which the surface is read
AHEAD = 1e-6  # relative; a point nearer than this to the end of a cell is on the cell


@dataclass(frozen=True)
class PinTrial:
    """A pin in its lugs in one case."""

    given: PinProblem

    @property
    def name(self) -> str:
        """The name of the pin, which describes its shape."""
        return self.given.pin.name


def pin_trials(count: int, seed: int) -> list[PinTrial]:
    """Return pins in two to four lugs, 0.3 to 1.5 diameters thick and up to 0.5 diameters apart.

    Half of the gaps with room for it have a fillet 0.02 to 0.2 diameters from the edge of a lug,
    some have a groove. One pin in three is a tube. Edges are sharp or rounded by up to 0.05
    diameters, clearances are up to 0.002. One pin in three has a motion of four instants.
    """
    rng = np.random.default_rng(seed)
    return [_trial(rng, k) for k in range(count)]


def _trial(rng: np.random.Generator, k: int) -> PinTrial:
    d = 0.005 * 12.0 ** float(rng.random())
    names = "ABCD"[: int(rng.integers(2, 5))]
    bore = float(rng.uniform(0.2, 0.55)) * d if k % 3 == 1 else 0.0
    segments, own = [Segment(d * float(rng.uniform(0.05, 0.4)), d, bore)], d
    lugs: list[Lug] = []
    shape = []
    for b, name in enumerate(names):
        if b:
            parts, own, kind = _gap(rng, own, d, bore)
            segments += parts
            shape.append(kind)
        thick = d * float(rng.uniform(0.3, 1.5))
        segments.append(Segment(thick, own, bore, connection=name))
        lugs.append(_lug(rng, name, own, thick))
    segments.append(Segment(d * float(rng.uniform(0.05, 0.4)), own, bore))
    title = f"{k}: {' '.join(shape)}{', a tube' if bore else ''}"
    loads = _loads(rng, names, d, 4 if k % 3 == 2 else 1)
    between = {} if loads.times is None else {"pull": _between(loads)}
    return PinTrial(PinProblem(Pin(title, tuple(segments)), STEEL, tuple(lugs), (loads,), between))


def _gap(
    rng: np.random.Generator, own: float, d: float, bore: float
) -> tuple[list[Segment], float, str]:
    """Return the segments between two lugs, the diameter beyond, and a word for the gap."""
    draw, near = float(rng.random()), d * float(rng.uniform(0.02, 0.2))
    height = d * float(rng.uniform(0.04, 0.15))
    rho = height * float(rng.uniform(0.3, 0.9))
    if draw < 0.2:
        return [], own, "touching"
    if draw < 0.45:
        return [Segment(d * float(rng.uniform(0.01, 0.5)), own, bore)], own, "gap"
    if draw < 0.7 and own > d * 1.01:  # down again
        rho *= (own - d) / (2.0 * height)
        rest = Segment(near + rho, d, bore)
        return [Segment(d * float(rng.uniform(0.02, 0.2)), own, bore, fillet=rho), rest], d, "step"
    if draw < 0.85 and own < d * 1.01:
        thick = own + 2.0 * height
        rest = Segment(d * float(rng.uniform(0.02, 0.2)), thick, bore)
        return [Segment(near + rho, own, bore, fillet=rho), rest], thick, "shoulder"
    wide = 2.0 * rho + d * float(rng.uniform(0.02, 0.15))
    parts = [
        Segment(near, own, bore, fillet=rho),
        Segment(wide, own - 2.0 * height, bore, fillet=rho),
        Segment(d * float(rng.uniform(0.02, 0.2)), own, bore),
    ]
    return parts, own, "groove"


def _lug(rng: np.random.Generator, name: str, own: float, thick: float) -> Lug:
    radius = 0.0 if rng.random() < 0.4 else own * float(rng.uniform(0.005, 0.05))
    clearance = 0.0 if rng.random() < 0.5 else own * float(rng.uniform(0.0, 0.002))
    material = ALUMINIUM if rng.random() < 0.25 else STEEL
    across = own * float(rng.uniform(1.8, 3.0))
    shank = material.youngs_modulus * across * thick**3 / (12.0 * 2.0 * across)
    return Lug(name, across, material, clearance, min(radius, 0.2 * thick), tilt=shank)


def _loads(rng: np.random.Generator, names: str, d: float, instants: int) -> PinLoads:
    """Return loads in equilibrium at each instant: inner lugs pull against outer ones."""
    shares = {2: (-1.0, 1.0), 3: (-0.5, 1.0, -0.5), 4: (-0.5, 0.5, 0.5, -0.5)}[len(names)]
    of_all = np.zeros((instants, len(names), 3))
    for axis, most in ((0, 1.0), (1, 0.5)):
        part = np.array(shares) * rng.uniform(0.6, 1.4, (instants, len(names)))
        part *= rng.uniform(0.3, 1.0, (instants, 1)) * most * STRESS * d * d
        of_all[:, :, axis] = part - part.mean(axis=1, keepdims=True)
    times = None if instants == 1 else np.linspace(0.0, 1.0, instants)
    return PinLoads("pull", tuple(names), of_all, times=times)


def _between(loads: PinLoads) -> Between:
    """Return the loads between the instants, interpolated linearly."""
    known = loads.times
    assert known is not None

    def at(times: Floats) -> PinLoads:
        flat = loads.forces.reshape(len(loads), -1)
        rows = np.stack([np.interp(times, known, column) for column in flat.T], axis=1)
        forces = rows.reshape(len(times), *loads.forces.shape[1:])
        return PinLoads(loads.case, loads.surfaces, forces, times=times)

    return at


@dataclass(frozen=True)
class Checked:
    """A row compared with the other reader.

    row, error: the maximum of the row and its error, Pa.
    read: the largest stress that the other reader finds, Pa. z, angle: its place, m and degrees.
    """

    row: float
    error: float
    governs: str
    verdict: str
    read: float
    z: float
    angle: float

    @property
    def violates(self) -> bool:
        """Whether the reader finds more than the row's maximum with its error."""
        return self.read > (self.row + self.error) * (1.0 + 1e-9)


def check(trial: PinTrial, requirement: Requirement | None = None) -> Checked:
    """Solve a pin and read its surface again.

    Raises: as solve_in_lugs.
    """
    (found,) = solve_in_lugs(trial.given, requirement or Requirement())
    return checked(found)


def checked(found: Solution) -> Checked:
    """Return the row of a solution compared with the other reader's result at the row's instant.

    Raises: ValueError for a pin without contact or maximum.
    """
    peak, places = found.peak, found.peak.places
    if places is None or places.contact is None or peak.max_von_mises is None:
        raise ValueError(peak.note)
    pressed = [cell for band in places.contact.bands for cell in band.pressed]
    answer, loads = found.answer, found.loads
    fields: MeridianFields = answer.fields  # type: ignore[union-attr]
    value, z, angle = read_surface(fields, loads, found.instant, pressed)
    error = peak.error_estimate or 0.0
    return Checked(peak.max_von_mises, error, places.governs, peak.verdict, value, z, angle)


def read_surface(
    fields: MeridianFields, loads: PinLoads, instant: int, pressed: Sequence[PressedCell]
) -> tuple[float, float, float]:
    """Return the largest von Mises stress of a surface, Pa, with its z, m, and angle, degrees.

    Pressed cells and their neighbours are left out.
    """
    x, unit = fields.points[: fields.skin], fields.stress[: fields.skin]
    theta = np.linspace(0.0, 2.0 * np.pi, EVERY, endpoint=False)
    total = np.zeros((len(x), EVERY, 6))
    for load, both in loads.coefficients().items():
        own = unit[:, :, fields.loads.index(load)]
        for phase, amount in enumerate(both[instant]):
            if amount:
                psi = load.n * theta - phase * np.pi / 2.0
                c, s = np.cos(psi), np.sin(psi)
                total += amount * own[:, None] * np.stack([c, c, c, s, c, s], axis=1)
    rr, tt, zz, tz, rz, rt = np.moveaxis(total, 2, 0)
    square = 0.5 * ((rr - tt) ** 2 + (tt - zz) ** 2 + (zz - rr) ** 2)
    square += 3.0 * (tz**2 + rz**2 + rt**2)
    square[_shut(x, np.degrees(theta), pressed)] = 0.0
    i, j = np.unravel_index(square.argmax(), square.shape)
    return float(np.sqrt(square[i, j])), float(x[i, 1]), float(np.degrees(theta[j]))


def _shut(x: Floats, theta: Floats, pressed: Sequence[PressedCell]) -> np.ndarray:
    """Return the points (S, A) that are on a pressed cell, or within the size of the cell
    from it.
    """
    out = np.zeros((len(x), len(theta)), dtype=bool)
    for z0, z1, low, high in pressed:
        long, wide = (z1 - z0) * (1.0 + AHEAD), high - low
        along = (x[:, 1] >= z0 - long) & (x[:, 1] <= z1 + long)
        turn = np.abs((theta - 0.5 * (low + high) + 180.0) % 360.0 - 180.0)
        out |= along[:, None] & (turn <= 1.5 * wide + AHEAD)[None, :]
    return out
