"""Loads on a pin, and the unit loads of which they are made.

Every load is a sum of Fourier harmonics about the pin's axis. With psi = n theta - p pi / 2, a load
of harmonic n and phase p has the components (R cos psi, T sin psi, Z cos psi) along r, theta and z,
whose amplitudes R, T, Z depend on z alone:

    force x, y           n = 1, p = 0, 1    a traction of constant direction: R = -T
    force z              n = 0, p = 0       a shear that fades towards the band's edges ("pull")
    moment about y, x    n = 1, p = 0, 1    as the forces, but linear in z about the band's middle;
                                            with bearing pressures a pressure, too ("tilt")
    moment about z       n = 0, p = 1       a tangential traction that fades likewise ("twist")
    bearing pressure     n = 0, 1, 2, 4, .. the series of a cosine on the loaded half
    weight and inertia   n = 1 and 0        a force per mass, the same everywhere

A unit load of harmonic n therefore serves all directions: its phases differ by a rotation about the
axis.

A shear that jumps at the edge of its band makes stress infinite there, like a logarithm. No link or
press fit does this; therefore shears along and about the axis fade (fea.core.tractions).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fea.core.pressed import PressedArcs
from geometry import ArgumentError
from geometry.shape.band import SHOULDER

Floats = NDArray[np.float64]
Kind = Literal[
    "force", "moment", "pull", "twist", "tilt", "pressure", "axial", "around", "body", "shift",
    "turn",
]  # fmt: skip
Distribution = Literal["uniform", "cosine"]

# Fraction of the largest force times the pin's length below which a moment across the axis is
# round-off.
MOMENT_ROUND_OFF = 1e-9
LOAD_ROUND_OFF = 1e-9  # fraction of a load's largest amount below which a phase is round-off

BODY_SURFACE = ""  # the `surface` of a load on the whole pin


class UnitLoad(NamedTuple):
    """A load of one harmonic on a surface (by name), or a rigid motion of a clamp.

    Amounts are in N, N m, or (kind "body") m/s^2. Kinds "shift" and "turn" have the distributions
    of "force" and "moment", but are motions of a clamp, in m, and in rad about the pin's origin.
    n: the harmonic.
    parts: instead of one surface, several surfaces with their amplitudes, Pa: of a pressure, or of
    a traction along the axis ("axial") or about it ("around"). For a "pull" or "twist", the rings
    of the band, each with 1.
    """

    surface: str
    kind: Kind
    n: int
    parts: tuple[tuple[str, float], ...] = ()

    @property
    def surfaces(self) -> tuple[str, ...]:
        """The names of the surfaces on which the load acts; none for a load on the whole pin."""
        if self.parts:
            return tuple(name for name, _ in self.parts)
        return (self.surface,) if self.surface else ()

    @property
    def single_surface_loads(self) -> dict[UnitLoad, float]:
        """The unit loads of which the load is the sum, with their amounts, Pa.

        A traction on several surfaces is the sum of tractions of unit amplitude on each of them.
        Any other load is returned as it is.
        """
        if not self.parts or self.fades:
            return {self: 1.0}
        return {self._replace(parts=((name, 1.0),)): amount for name, amount in self.parts}

    @property
    def fades(self) -> bool:
        """Whether the load is a shear, axial or about the axis, that fades at the band's edges."""
        return self.kind in ("pull", "twist")

    @property
    def shears(self) -> bool:
        """Whether the traction has a shear that jumps at the band's edge."""
        return self.kind in ("force", "moment") and not self.surface.startswith(SHOULDER)

    @property
    def phases(self) -> tuple[int, ...]:
        """The phases of the load: 0 and 1; for n = 0 only 0 (along the axis, pressure) or only 1
        (about the axis).
        """
        if self.n:
            return (0, 1)
        return (1,) if self.kind in ("moment", "twist", "around", "turn") else (0,)


Unit = tuple[UnitLoad, int]  # a unit load and its phase


@dataclass(frozen=True)
class PinLoads:
    """Loads on one pin in one case: a force and a moment at each surface's middle, in pin axes.

    surfaces: C names.
    forces: (T, C, 3) N.
    moments: (T, C, 3) N m, or an array that broadcasts to this shape.
    distribution: of transverse forces over their bands: "uniform" (a traction of constant
    direction) or "cosine" (a bearing pressure on the loaded half, with harmonics up to `terms`).
    body: gravity minus the pin's own acceleration, (T, 3) m/s^2, or an array that broadcasts to
    this shape.
    times: of the instants of a motion, in increasing order, (T,) s; None without a motion.
    pressed: where lugs press on the pin.
    tilting: surfaces whose links state moments across the axis in the whole case; None: those with
    such moments at these instants (`tilting_links`).
    seats: for each surface, the surfaces that take the axial force of its link, towards the start
    of the pin and towards its end; links without an entry bear on their own bands.
    pulls: links that exert axial forces or torques in any load of the problem: the surface, and 0
    for towards the start of the pin, 1 for towards its end, 2 for a torque.
    always: unit loads that count even if they are zero at all these instants, since they act under
    other loads of the problem, which are superposed from the same fields.
    bands: groups of surfaces that are the rings of one band, over which its axial force and its
    torque fade; other surfaces are bands of their own.
    """

    case: str
    surfaces: tuple[str, ...]
    forces: Floats
    moments: Floats = field(default_factory=lambda: np.zeros(3))
    distribution: Distribution = "uniform"
    body: Floats = field(default_factory=lambda: np.zeros(3))
    terms: int = 6
    times: Floats | None = None
    pressed: PressedArcs | None = None
    tilting: tuple[str, ...] | None = None
    seats: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    pulls: tuple[tuple[str, int], ...] = ()
    always: tuple[UnitLoad, ...] = ()
    bands: tuple[tuple[str, ...], ...] = ()

    def __post_init__(self) -> None:
        moments = np.broadcast_to(self.moments, self.forces.shape)
        object.__setattr__(self, "moments", moments)
        body = np.broadcast_to(self.body, (len(self.forces), 3))
        object.__setattr__(self, "body", body)

    def __len__(self) -> int:
        return len(self.forces)

    def time(self, instant: int = 0) -> float | None:
        """The time of an instant, by its number, s; None without a motion."""
        return None if self.times is None else float(self.times[instant])

    @property
    def links(self) -> PinLoads:
        """The loads of the links: these loads themselves, unless contact carries them."""
        return self

    @property
    def on_rings(self) -> PinLoads:
        """The loads that sections carry: these loads, or the resultants of contact pressures."""
        return self

    @property
    def squeezing(self) -> float:
        """The largest force, N, of pressures that squeeze the pin and are in balance on their own.

        An imbalance within their round-off is not a load.
        """
        return 0.0

    def tilting_links(self, length: float) -> tuple[str, ...]:
        """The surfaces whose links state moments across the axis.

        length: of the pin, m; the round-off of moments is judged by forces times this length.
        """
        if self.tilting is not None:
            return self.tilting
        moments = np.linalg.norm(self.moments[..., :2], axis=2).max(axis=0, initial=0.0)
        forces = np.linalg.norm(self.forces, axis=2).max(initial=0.0)
        least = MOMENT_ROUND_OFF * max(length * forces, moments.max(initial=0.0))
        return tuple(s for s, m in zip(self.surfaces, moments, strict=True) if m > least)

    @property
    def pressures(self) -> tuple[int, ...]:
        """The harmonics of the bearing pressure that are taken into account."""
        return (0, 1, *range(2, self.terms + 1, 2))

    def coefficients(self) -> Mapping[UnitLoad, Floats]:
        """The amount by phase, (T, 2), of each unit load that acts at any instant.

        The mapping and its arrays are read-only, since they are made only once.
        """
        return MappingProxyType(self._coefficients)

    @cached_property
    def _coefficients(self) -> dict[UnitLoad, Floats]:
        out: dict[UnitLoad, Floats] = {}

        def add(load: UnitLoad, first: Floats, second: Floats) -> None:
            if first.any() or second.any():
                both = np.stack([first, second], axis=1)
                both.flags.writeable = False
                out[load] = both

        zero = np.zeros(len(self))
        rings = {name for band in self.bands for name in band}
        tilt: Kind = "moment" if self.distribution == "uniform" else "tilt"
        for c, name in enumerate(self.surfaces):
            (x, y, z), (mx, my, mz) = self.forces[:, c].T, self.moments[:, c].T
            # A transverse force is a traction of constant direction, or the series of a bearing
            # pressure. Harmonic n of the series is turned by n times the angle of the force.
            if self.distribution == "uniform":
                add(UnitLoad(name, "force", 1), x, y)
            else:
                size, angle = np.hypot(x, y), np.arctan2(y, x)
                for n in self.pressures:
                    turned = (size * np.cos(n * angle), size * np.sin(n * angle))
                    add(UnitLoad(name, "pressure", n), *turned)
            # A moment about y has phase 0, like a force along x; a moment about x has phase 1, with
            # its sign changed.
            add(UnitLoad(name, tilt, 1), my, -mx)
            if name not in rings:
                face = name.startswith(SHOULDER)
                add(UnitLoad(name, "force" if face else "pull", 0), z, zero)
                add(UnitLoad(name, "twist", 0), zero, mz)
        for band in self.bands:
            on = [self.surfaces.index(name) for name in band]
            parts = tuple((name, 1.0) for name in band)
            add(UnitLoad("", "pull", 0, parts), self.forces[:, on, 2].sum(axis=1), zero)
            add(UnitLoad("", "twist", 0, parts), zero, self.moments[:, on, 2].sum(axis=1))
        add(UnitLoad(BODY_SURFACE, "body", 1), *self.body[:, :2].T)
        add(UnitLoad(BODY_SURFACE, "body", 0), self.body[:, 2], zero)
        for load in self.always:
            if load not in out:
                out[load] = np.zeros((len(self), 2))
                out[load].flags.writeable = False
        return out

    @property
    def _vectors(self) -> tuple[Floats, Floats, Floats]:
        return self.forces, self.moments, self.body

    def turned(self, angle: float) -> PinLoads:
        """The same loads, rotated about the pin's axis by `angle` (rad)."""
        c, s = np.cos(angle), np.sin(angle)
        about_z = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        forces, moments, body = (x @ about_z for x in self._vectors)
        return replace(self, forces=forces, moments=moments, body=body)

    def at(self, instants: NDArray[np.int64]) -> PinLoads:
        """The loads at some of the instants, by their numbers."""
        times = None if self.times is None else self.times[instants]
        forces, moments, body = (x[instants] for x in self._vectors)
        pressed = self.pressed and self.pressed.at(instants)
        return replace(
            self, forces=forces, moments=moments, body=body, times=times, pressed=pressed
        )

    def merged(self, other: PinLoads) -> PinLoads:
        """The loads with the instants of other loads of the same motion added, in order of time."""
        assert self.times is not None
        assert other.times is not None
        times, first = np.unique(np.concatenate([self.times, other.times]), return_index=True)
        both = zip(self._vectors, other._vectors, strict=True)
        forces, moments, body = (np.concatenate(pair)[first] for pair in both)
        pressed = None
        if self.pressed is not None and other.pressed is not None:
            pressed = self.pressed.joined(other.pressed).at(first)
        return replace(
            self, forces=forces, moments=moments, body=body, times=times, pressed=pressed
        )


@dataclass(frozen=True)
class LoadAmounts:
    """Amounts of unit loads at T instants, which need not belong to any forces.

    acting: amount of each unit load by phase, (T, 2).
    count: T.
    pressed: where lugs press on the pin at these instants.
    """

    case: str
    acting: Mapping[UnitLoad, Floats]
    count: int
    pressed: PressedArcs | None = None

    def __len__(self) -> int:
        return self.count

    def coefficients(self) -> Mapping[UnitLoad, Floats]:
        """The amount of each unit load by phase, (T, 2)."""
        return self.acting

    def at(self, instants: NDArray[np.int64]) -> LoadAmounts:
        """The amounts at some of the instants, by their numbers."""
        acting = {load: both[instants] for load, both in self.acting.items()}
        pressed = self.pressed and self.pressed.at(instants)
        return LoadAmounts(self.case, acting, len(instants), pressed)

    def turned(self, angle: float) -> LoadAmounts:
        """The amounts of the loads rotated about the pin's axis by `angle` (rad)."""
        acting = {}
        for load, both in self.acting.items():
            c, s = np.cos(load.n * angle), np.sin(load.n * angle)
            acting[load] = both @ np.array([[c, s], [-s, c]])
        return LoadAmounts(self.case, acting, self.count)


Loads = PinLoads | LoadAmounts


def require_solved(case: str, acting: Iterable[UnitLoad], solved: Iterable[UnitLoad]) -> None:
    """Check that all unit loads of a case are among those solved.

    Raises: ArgumentError.
    """
    if missing := set(acting) - set(solved):
        raise ArgumentError(
            f"case {case}: no unit fields were solved for {sorted(missing)}", "missing-fields"
        )


def amounts_of(units: tuple[Unit, ...], loads: Loads) -> Floats:
    """The amount of each of L units at each instant, (T, L).

    Raises: ArgumentError where a part of the loads is not among the units.
    """
    number = {unit: k for k, unit in enumerate(units)}
    out = np.zeros((len(loads), len(units)))
    for load, amounts in loads.coefficients().items():
        least = LOAD_ROUND_OFF * np.abs(amounts).max()
        for phase in load.phases:
            if (load, phase) in number:
                out[:, number[load, phase]] = amounts[:, phase]
            elif np.abs(amounts[:, phase]).max() > least:
                require_solved(loads.case, (load,), ())
    return out


def chord_deviation(loads: PinLoads, middle: PinLoads) -> LoadAmounts:
    """The deviation of the loads in the middle of each interval from the mean of its ends, at T - 1
    instants.

    middle: the loads in the middles of the T - 1 intervals.
    """
    ends, amid = loads.coefficients(), middle.coefficients()
    none = np.zeros((len(loads), 2))
    acting = {}
    for load in dict.fromkeys([*ends, *amid]):
        c = ends.get(load, none)
        acting[load] = amid.get(load, none[1:]) - 0.5 * (c[1:] + c[:-1])
    return LoadAmounts(loads.case, acting, len(loads) - 1, loads.pressed and loads.pressed.amid())
