"""The surroundings of a band of a pin: the eye of a link, with or without a bushing."""

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
    """A ring of its own material in an eye; thickness in m.

    interference: of the diameters before it was pressed in, m; 0 for a bonded ring.
    outgrown: by how much its outer diameter has outgrown the hole at the temperature of a case, m.

    Raises: ArgumentError for a thickness that is not positive.
    """

    thickness: float
    material: Material
    interference: float = 0.0
    outgrown: float = 0.0

    @property
    def pressed(self) -> bool:
        """Whether it is pressed in; otherwise it is bonded."""
        return self.interference > 0.0

    @property
    def misfit(self) -> float:
        """Its interference at the temperature of a case, m; a bonded ring's may be negative."""
        return self.interference + self.outgrown

    def __post_init__(self) -> None:
        if not (math.isfinite(self.thickness) and self.thickness > 0.0):
            raise ArgumentError("the thickness of a bushing must be positive", "not-positive")
        if not (math.isfinite(self.interference) and self.interference >= 0.0):
            raise ArgumentError("the interference of a bushing must not be negative", "negative")


@dataclass(frozen=True)
class Shank:
    """The outline of a lug in its plane: the head about the bore, and the shank that holds it, m.

    shape: "round": a head of the lug's outer diameter, with a shank of parallel sides; "tapered":
    the same head, with sides that leave it as tangents; "square": a plate whose end is straight.
    width: of the shank where it is held; of the whole plate for "square".
    length: from the bore's centre to where the shank is held.
    end: from the bore's centre to the end of the head; a round head is eccentric where it is not
    half of the outer diameter.
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
    """The ranges of the uncertain properties of a lug, None where the usual ones are tried
    (fea.support.lugs.changes).

    clearance: m.
    stiffness: times that of the lug.
    tilt: N m/rad.
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
    """The eye of the link at a connection, as an annulus, m.

    clearance: of the diameters, negative for interference.
    growth: what of the clearance the temperature of a case has added (fea.support.lugs.thermal), m.
    edge_radius: of the bore's edges.
    tilt: N m/rad, stiffness of the link's tilt against the others about any axis across the pin;
    inf: guided, 0: free.
    bushing: the pin bears on it, if there is one.
    shank: None where only the eye is known, of which no stress is computed then.
    friction: Coulomb's coefficient between pin and bore; contact itself is solved without it.
    axial: segments of the pin that take the link's force along the axis, towards the pin's start
    and towards its end; None: fea.support.lugs.axial finds them.
    range: of the uncertain properties of the lug.

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
        """The largest clearance that is stated, m."""
        return self.range.clearance[1] if self.range.clearance else self.clearance

    @property
    def bearing(self) -> Material:
        """The material on which the pin bears: the bushing's or the lug's."""
        return self.material if self.bushing is None else self.bushing.material

    @property
    def materials(self) -> tuple[Material, ...]:
        """The materials of its section, from the inside out."""
        return (self.material,) if self.bushing is None else (self.bushing.material, self.material)

    def with_materials(self, change: Callable[[Material], Material]) -> Lug:
        """The same lug with its materials, and its bushing's, changed."""
        bushing = self.bushing and replace(self.bushing, material=change(self.bushing.material))
        return replace(self, material=change(self.material), bushing=bushing)

    def pressed_bushings(self) -> tuple[Bushing, ...]:
        """Its bushing as the study has it, and at the ends of the range of its interference; none
        without one, one without a range.
        """
        if self.bushing is None:
            return ()
        ends = self.range.interference or ()
        interferences = dict.fromkeys((self.bushing.interference, *ends))
        return tuple(replace(self.bushing, interference=x) for x in interferences)

    def outline(self, radius: float) -> LugOutline:
        """The outline of a lug that has a shank, about a band of some radius, m.

        Raises: ArgumentError where its dimensions contradict each other.
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
        """The gap on the radius, (R,) m, on the mean over each ring, before anything moves.

        It is half of the clearance, and the depth of the edges' rounding.
        ends: of the rings, (R + 1,) m along z.
        """
        return 0.5 * self.clearance + np.diff(self._rounded(ends)) / np.diff(ends)

    def _rounded(self, z: Floats) -> Floats:
        """The integral of the depth of rounding of both edges, from the bore's start to z."""
        first, last = z[0], z[-1]
        return _segment(self.edge_radius, z - first) - _segment(self.edge_radius, last - z)


def _segment(radius: float, x: Floats) -> Floats:
    """The integral, m^2, from 0 to x of the depth r - sqrt(r^2 - (r - t)^2) of a quarter round at t
    < r from the edge.
    """
    if radius == 0.0:
        return np.zeros_like(x)
    s = 1.0 - np.minimum(x / radius, 1.0)  # of the way that is left
    total = 1.0 - np.pi / 4.0
    rest = s - 0.5 * (s * np.sqrt(1.0 - s * s) + np.arcsin(s))
    return np.asarray(radius**2 * (total - rest))
