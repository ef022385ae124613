"""What a model needs to know of a pin, whichever way its shape is given."""

from __future__ import annotations

from typing import Protocol

from geometry.shape.pin import Band


class PinLike(Protocol):
    """A pin along z between its `ends` (m), with named surfaces and bands; `volume` in m^3.

    source: where its shape comes from, for people, if not from the study.
    revolved: whether it is a body of revolution. meshed: whether it is given by a mesh, which
    can only be refined by halving.
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
        """A band by name. Raises: GeometryError listing the names there are."""
        ...

    def surface(self, name: str) -> str:
        """The mesh boundary for a name in a study. Raises: GeometryError as `band`."""
        ...
