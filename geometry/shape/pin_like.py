"""The interface of a pin for models, however its shape is given."""

from __future__ import annotations

from typing import Protocol

from geometry.shape.pin import Band


class PinLike(Protocol):
    """A pin along z, with named surfaces and bands.

    length, ends, volume: m, least and greatest z in m, m^3.
    source: origin of its shape, for people, if that is not the study.
    revolved: whether it is a body of revolution.
    meshed: whether it is given by a mesh, which can only be refined by halving its elements.
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
    def connections(self) -> tuple[str, ...]: ...
    def band(self, name: str) -> Band:
        """The band of this name. Raises: GeometryError that lists the names there are."""
        ...

    def surface(self, name: str) -> str:
        """The mesh boundary for a name in a study. Raises: GeometryError as `band`."""
        ...
