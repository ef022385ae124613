"""The interface of a pin for models, whatever the source of its shape."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from geometry.shape.band import Band
from geometry.shape.features import Cut
from geometry.shape.pin import Pin


class PinLike(Protocol):
    """A pin along z, with named surfaces and bands.

    length: axial length, m.
    ends: least and greatest z, m.
    volume: m^3.
    source: origin of the shape, for people, if that is not the study.
    revolved: whether the pin is a body of revolution.
    meshed: whether a mesh defines the pin, which can only be refined by halving its elements.
    profile: the body of revolution before cutting, which for a pin without cuts is the pin itself;
    None for any other body from a file.
    cuts: holes, flats, slots, passages and recesses, by name.
    connections: names of the links that bear on the pin.
    """

    @property
    def name(self) -> str: ...
    @property
    def length(self) -> float: ...
    @property
    def ends(self) -> tuple[float, float]: ...
    @property
    def volume(self) -> float: ...
    @property
    def source(self) -> str: ...
    @property
    def revolved(self) -> bool: ...
    @property
    def meshed(self) -> bool: ...
    @property
    def profile(self) -> Pin | None: ...
    @property
    def cuts(self) -> Mapping[str, Cut]: ...
    @property
    def connections(self) -> tuple[str, ...]: ...
    def band(self, name: str) -> Band:
        """The band of this name. Raises: GeometryError for an unknown name, listing all names."""
        ...

    def surface(self, name: str) -> str:
        """The mesh boundary for a name in a study. Raises: GeometryError as for `band`."""
        ...


def body_of_revolution(pin: PinLike) -> Pin | None:
    """The profile of a pin without cuts; None for any other pin."""
    return pin.profile if pin.revolved else None
