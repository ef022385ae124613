"""The eye of a lug as the clauses model it, and the force on it along and across its shank."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from assess.check import WorstPlace
from assess.situation import Situation
from assess.work import would_pass
from fea.core.material import Material
from fea.support.lugs.lug import Lug
from geometry import ArgumentError
from pinbase.arrays import Floats

EyeUtilisation = Callable[["PlateEye"], float]
MAX_UTILISATION = 1e9  # utilisation of an impossible eye, so that the root search can continue
ROOT_TOLERANCE = (
    0.01  # from a utilisation of 1; beyond it the search ended at the last possible eye
)
ROUND_OFF = 1e-9  # relative to a force: a smaller component is zero
AXIAL_BASIS = "the force taken along the shank, whose direction is not given"


@dataclass(frozen=True)
class PlateEye:
    """The head of a lug, m.

    width: W, at the centre of the bore. hole: D, the hole in the lug itself, which is around the
    bushing if there is one. pin: Dp. thickness: t.
    end: e, from the centre of the bore to the end of the head; None for a round head, W / 2.
    square: whether the end is straight. eccentric: whether the width is less than the diameter of
    the round head, which then does not follow from the width. shank: the width of the shank.

    Raises: ArgumentError for a head that is not wider than its hole or ends within the hole.
    """

    width: float
    hole: float
    pin: float
    thickness: float
    bushed: bool = False
    end: float | None = None
    square: bool = False
    eccentric: bool = False
    shank: float = math.inf

    def __post_init__(self) -> None:
        if not (0.0 < self.pin <= self.hole < min(self.width, 2.0 * self.e)):
            raise ArgumentError(
                "the eye of a lug must be wider than its bore, not "
                f"{self.width / self.hole:.4g} of it, and reach further than its radius, not "
                f"{2.0 * self.e / self.hole:.4g} of it",
                "out-of-range",
            )

    @property
    def e(self) -> float:
        """The distance from the centre of the bore to the end of the head, m."""
        return self.width / 2.0 if self.end is None else self.end

    @property
    def a(self) -> float:
        """The distance from the hole to the end of the head, m."""
        return self.e - self.hole / 2.0

    @property
    def bearer(self) -> float:
        """The diameter of the part that bears in the hole, m: the pin, or a bushing."""
        return self.hole if self.bushed else self.pin

    @property
    def side(self) -> float:
        """The width of the net section on one side of the hole, m."""
        return (self.width - self.hole) / 2.0

    def would_pass(self, dimension: str, utilisation: EyeUtilisation) -> float | None:
        """Return the value of a dimension, m, at which a utilisation of the eye is 1.

        None if there is no such value nearby, if every possible eye passes, and for the width of an
        eccentric head.
        """
        if self.eccentric and dimension == "width":
            return None

        def used(x: float) -> float:
            try:
                changed: PlateEye = replace(self, **{dimension: x})  # type: ignore[arg-type]
                return min(utilisation(changed), MAX_UTILISATION)
            except ArgumentError:
                return MAX_UTILISATION

        value = would_pass(used, getattr(self, dimension))
        return value if value and abs(used(value) - 1.0) < ROOT_TOLERANCE else None


@dataclass(frozen=True)
class LoadedEye:
    """An eye with its materials and the force of its link at every instant.

    connection: name of the lug's connection. lug: material of the lug. bushing: material of the
    bushing, if there is one.
    size: (T,) magnitude of the transverse force on the pin, N. axial: (T,) its component along the
    shank that pulls the lug, N, zero where it pushes. transverse: (T,) its component across the
    shank, N. basis: how these were found.
    """

    connection: str
    eye: PlateEye
    lug: Material
    bushing: Material | None
    size: Floats
    axial: Floats
    transverse: Floats
    basis: str = ""


def eye_of(s: Situation, lug: Lug) -> PlateEye:
    """Return the eye of a lug on its band of the pin; its thickness is the length of the band.

    Without a shank the head is round, with its end half its width from the centre. The hole is
    larger than the pin by the largest stated clearance and the walls of a bushing.
    """
    band, bushed, shank = s.pin.band(lug.connection), lug.bushing is not None, lug.shank
    pin = 2.0 * band.radius
    ring = max(lug.loosest, 0.0) + (2.0 * lug.bushing.thickness if lug.bushing else 0.0)
    if shank is None:
        return PlateEye(lug.outer_diameter, pin + ring, pin, band.length, bushed)
    square, width = shank.shape == "square", lug.outline(band.radius).width_at_bore
    end = None if shank.end == width / 2.0 else shank.end
    eccentric = not square and width < lug.outer_diameter
    return PlateEye(
        width, pin + ring, pin, band.length, bushed, end, square, eccentric, shank.width
    )


def loaded_eyes(s: Situation) -> list[LoadedEye]:
    """Return the eyes of all lugs whose size the study gives and which load the pin.

    If the direction of the shank is unknown, the whole force is assumed to pull along the shank.
    """
    eyes = []
    for lug in s.sized:
        if lug.connection not in s.loads.surfaces:
            continue
        force = s.loads.forces[:, s.loads.surfaces.index(lug.connection), :2]
        size = np.hypot(force[:, 0], force[:, 1])
        if not size.any():
            continue
        axial, transverse, basis = size, np.zeros_like(size), AXIAL_BASIS
        angle = shank_angle(s, lug)
        if angle is not None:
            # A link that pulls draws the pin towards its shank.
            x, y = np.cos(angle), np.sin(angle)
            axial = _beyond_round_off(force[:, 0] * x + force[:, 1] * y, size)
            transverse = _beyond_round_off(np.abs(force[:, 1] * x - force[:, 0] * y), size)
            basis = ""
        bushing = lug.bushing.material if lug.bushing else None
        eye = eye_of(s, lug)
        eyes.append(
            LoadedEye(lug.connection, eye, lug.material, bushing, size, axial, transverse, basis)
        )
    return eyes


def place_of(s: Situation, loaded: LoadedEye, instant: int) -> WorstPlace:
    """Return the middle of the eye's band, at an instant of the loads."""
    return WorstPlace.at_band(s.pin.band(loaded.connection), s.loads, instant)


def shank_angle(s: Situation, lug: Lug) -> Floats | None:
    """Return the angle of a lug's shank at the instants of the loads, (T,) rad; None if unknown."""
    if lug.shank is None:
        return None
    turning = s.shank_angles.get(lug.connection)
    if turning is not None:
        return turning.at(s.loads.times, len(s.loads))
    return None if lug.shank.angle is None else np.full(len(s.loads), lug.shank.angle)


def _beyond_round_off(component: Floats, size: Floats) -> Floats:
    """Return the positive part of a force component, without round-off."""
    return np.where(component > ROUND_OFF * size, component, 0.0)
