"""The lug around a band of a pin: the eye of a link, with or without a bushing."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass, replace

import numpy as np

from fea.core.material import Material
from fea.core.pin_loads import Floats
from geometry import ArgumentError
from geometry.shape.lug_outline import HeadShape, LugOutline


@dataclass(frozen=True)
class Bushing:
    """A bushing in an eye, with a material of its own.

    thickness: of its wall, m.
    interference: on the diameter, before it was pressed in, m; 0 for a bonded bushing.
    outgrown: change of the interference with the temperature of a case, m.

    Raises: ArgumentError for a thickness that is not positive.
    """

    thickness: float
    material: Material
    interference: float = 0.0
    outgrown: float = 0.0

    @property
    def pressed(self) -> bool:
        """Whether the bushing is pressed in; otherwise it is bonded."""
        return self.interference > 0.0

    @property
    def misfit(self) -> float:
        """The interference at the temperature of a case, m; it may be negative for a bonded
        bushing.
        """
        return self.interference + self.outgrown

    def __post_init__(self) -> None:
        if not (math.isfinite(self.thickness) and self.thickness > 0.0):
            raise ArgumentError("the thickness of a bushing must be positive", "not-positive")
        if not (math.isfinite(self.interference) and self.interference >= 0.0):
            raise ArgumentError("the interference of a bushing must not be negative", "negative")


@dataclass(frozen=True)
class Shank:
    """The outline of a lug in its plane: the head around the bore, and the shank that holds it.

    shape: "round": a head of the lug's outer diameter, with a shank of parallel sides; "tapered":
    the same head, with sides tangent to it; "square": a plate with a straight end.
    width: of the shank where it is held, m; of the whole plate for "square".
    length: from the bore's centre to where the shank is held, m.
    end: from the bore's centre to the end of the head, m; a round head is eccentric where this is
    not half of the outer diameter.
    angle: of the shank from the x axis of the pin, seen from the bore, rad; None where the
    mechanism gives it.

    Raises: ArgumentError for a length that is not positive.
    """

    shape: HeadShape
    width: float
    length: float
    end: float
    angle: float | None = None

    def __post_init__(self) -> None:
        for name in ("width", "length", "end"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise ArgumentError(f"the {name} of a shank must be positive", "not-positive")


@dataclass(frozen=True)
class LugRange:
    """The ranges of the uncertain properties of a lug; None where the default range is used
    (fea.support.lugs.changes).

    clearance: on the diameter, m.
    stiffness: as a factor on that of the lug.
    tilt: stiffness, N m/rad.
    interference: of the bushing, m.

    Raises: ArgumentError for an upper end below the lower one, or a stiffness that is not positive.
    """

    clearance: tuple[float, float] | None = None
    stiffness: tuple[float, float] | None = None
    tilt: tuple[float, float] | None = None
    interference: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        for name in ("clearance", "stiffness", "tilt", "interference"):
            ends = getattr(self, name)
            if ends is not None and not ends[0] <= ends[1]:
                raise ArgumentError(
                    f"range of the {name}: give the smaller value first, then the larger one",
                    "range-order",
                )
        if self.stiffness is not None and not self.stiffness[0] > 0.0:
            raise ArgumentError("range of the stiffness: it must be positive", "not-positive")


@dataclass(frozen=True)
class Lug:
    """The eye of the link at a connection, as an annulus.

    outer_diameter: m.
    clearance: on the diameter, m; negative for interference.
    edge_radius: of the bore's edges, m.
    tilt: stiffness of the link's tilt relative to the others, about any axis across the pin,
    N m/rad; inf: guided, 0: free.
    bushing: on which the pin bears, if there is one.
    range: of the uncertain properties of the lug.
    shank: None where only the eye is known; no stress of the lug is computed then.
    growth: part of the clearance that the temperature of a case has added, m
    (fea.support.lugs.thermal).
    friction: Coulomb's coefficient between pin and bore; contact itself is solved without friction.
    axial: segments of the pin that take the link's axial force, towards the pin's start and towards
    its end; None: fea.support.lugs.axial finds them.

    Raises: ArgumentError for impossible values; fea.support.lugs.fit checks those that depend on
    the pin.
    """

    connection: str
    outer_diameter: float
    material: Material
    clearance: float = 0.0
    edge_radius: float = 0.0
    tilt: float = math.inf
    _: KW_ONLY
    bushing: Bushing | None = None
    range: LugRange = LugRange()
    shank: Shank | None = None
    growth: float = 0.0
    friction: float = 0.0
    axial: tuple[str, str] | None = None

    def __post_init__(self) -> None:
        what = f"lug {self.connection}"
        if not (math.isfinite(self.outer_diameter) and self.outer_diameter > 0.0):
            raise ArgumentError(f"{what}: its outer diameter must be positive", "not-positive")
        if not math.isfinite(self.clearance):
            raise ArgumentError(f"{what}: its clearance must be a number", "not-a-number")
        if not (math.isfinite(self.edge_radius) and self.edge_radius >= 0.0):
            raise ArgumentError(f"{what}: its edge radius must not be negative", "negative")
        if not self.tilt >= 0.0:
            raise ArgumentError(
                f"{what}: the stiffness of its tilt must not be negative", "negative"
            )

        if not 0.0 <= self.friction <= 1.0:
            raise ArgumentError(f"{what}: its friction must be from 0 to 1", "friction-range")

    @property
    def loosest(self) -> float:
        """The largest stated clearance, m."""
        return self.range.clearance[1] if self.range.clearance else self.clearance

    @property
    def bearing(self) -> Material:
        """The material on which the pin bears: the bushing's or the lug's."""
        return self.material if self.bushing is None else self.bushing.material

    @property
    def materials(self) -> tuple[Material, ...]:
        """The materials of the lug's section, from the inside out."""
        return (self.material,) if self.bushing is None else (self.bushing.material, self.material)

    def with_materials(self, change: Callable[[Material], Material]) -> Lug:
        """The same lug with its material and that of its bushing changed."""
        bushing = self.bushing and replace(self.bushing, material=change(self.bushing.material))
        return replace(self, material=change(self.material), bushing=bushing)

    def pressed_bushings(self) -> tuple[Bushing, ...]:
        """The bushing with its given interference, and with those at the ends of its range.

        The result is empty without a bushing, and has one item without a range.
        """
        if self.bushing is None:
            return ()
        ends = self.range.interference or ()
        interferences = dict.fromkeys((self.bushing.interference, *ends))
        return tuple(replace(self.bushing, interference=x) for x in interferences)

    def outline(self, radius: float) -> LugOutline:
        """The outline of a lug with a shank, around a band of a radius, m.

        Raises: ArgumentError for a lug without a shank, and for contradictory dimensions.
        """
        if self.shank is None:
            raise ArgumentError(f"lug {self.connection} has no shank", "no-shank")
        bore = 2.0 * radius
        hole = None if self.bushing is None else bore + 2.0 * self.bushing.thickness
        shank = self.shank
        try:
            return LugOutline(
                shank.shape, bore, self.outer_diameter, shank.width, shank.length, shank.end, hole
            )
        except ArgumentError as error:
            raise ArgumentError(f"lug {self.connection}: {error}", error.code) from None

    def gap(self, ends: Floats) -> Floats:
        """The mean radial gap over each ring before loading, (R,) m.

        It is half of the clearance plus the depth of the edge rounding.
        ends: of the rings, (R + 1,) m along z.
        """
        return 0.5 * self.clearance + np.diff(self._rounded(ends)) / np.diff(ends)

    def _rounded(self, z: Floats) -> Floats:
        """The integral of the depth of rounding of both edges up to z, m^2, but for a constant."""
        first, last = z[0], z[-1]
        return _segment(self.edge_radius, z - first) - _segment(self.edge_radius, last - z)


def _segment(radius: float, x: Floats) -> Floats:
    """The integral over t from 0 to x, m^2, of the depth of a rounded edge.

    At a distance t < r from the face the depth is r - sqrt(r^2 - (r - t)^2).
    """
    if radius == 0.0:
        return np.zeros_like(x)
    s = 1.0 - np.minimum(x / radius, 1.0)  # remaining fraction of the rounding
    total = 1.0 - np.pi / 4.0
    rest = s - 0.5 * (s * np.sqrt(1.0 - s * s) + np.arcsin(s))
    return np.asarray(radius**2 * (total - rest))
