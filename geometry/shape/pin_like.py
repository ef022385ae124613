"""The interface of a pin for models, however its shape is given."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from geometry.shape.band import Band
from geometry.shape.features import Cut
from geometry.shape.pin import Pin


class PinLike(Protocol):
    """A pin along z, with named surfaces and bands.

    length, ends, volume: m, least and greatest z in m, m^3.
    source: origin of its shape, for people, if that is not the study.
    revolved: whether it is a body of revolution.
    meshed: whether it is given by a mesh, which can only be refined by halving its elements.
    profile: its body of revolution without cuts, itself where it has none; None for another body
    from a file.
    cuts: holes, flats, slots and passages by their names.
    connections: names of the links that bear on it.
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
        """The band of this name. Raises: GeometryError that lists the names there are."""
        ...

    def surface(self, name: str) -> str:
        """The mesh boundary for a name in a study. Raises: GeometryError as `band`."""
        ...


def body_of_revolution(pin: PinLike) -> Pin | None:
    """The profile of a pin without cuts; None for any other pin."""
    return pin.profile if pin.revolved else None
