"""Results of a run about the limit load of a pin in a case."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pinbase.dimensions import Floats, Force, Length, Lengths, Stresses, Time


@dataclass(frozen=True)
class PlasticMesh:
    """One mesh of the solid.

    lower: the load factor that equilibrium reached, of which the lower bound is made.
    upper: the upper bound.
    volume: change of volume over the equivalent strain of its mechanism.
    charge: what that adds to the upper bound.
    steps, iterations: of the loads.
    """

    unknowns: int
    lower: float
    upper: float
    volume: float
    charge: float
    steps: int
    iterations: int


@dataclass(frozen=True)
class LoadCurve:
    """Load factors (S,) from zero on and the largest displacement at them.

    permanent: (S,) the part of it that remains when the loads are removed.
    """

    factor: Floats
    displacement: Lengths
    permanent: Lengths


@dataclass(frozen=True)
class FlowField:
    """The pin, or the modelled part of its turn, when its limit load is reached, at a load factor.

    points: (N, 3) in pin axes.
    cells: (M, 20) in the order of VTK.
    displacement: (N, 3).
    plastic_strain: (N,) equivalent.
    von_mises: (N,).
    """

    points: Lengths
    cells: NDArray[np.int64]
    displacement: Lengths
    plastic_strain: Floats
    von_mises: Stresses
    factor: float


@dataclass(frozen=True)
class LimitLoad:
    """The load factor at which a pin collapses, between lower and upper.

    All loads of the case grow in proportion, at the instant (`time`, s; None without a motion) at
    which the pin, as a beam, collapses at the least factor.
    method: beam or solid; "none" without an answer, with the reason in `note`.
    carries: whether the pin carries its loads (factor 1) without collapse; None where that is open.
    permanent_set: the part of the largest displacement that remains after the loads reached the
    factor permanent_at and were removed.
    curve, flow: of the finest mesh.
    stopped: there is no answer because it would have taken longer than a limit load may that nobody
    asked for.
    """

    method: Literal["beam", "solid", "none"]
    lower: float | None = None
    upper: float | None = None
    carries: bool | None = None
    hardening: bool = False
    permanent_set: Length | None = None
    permanent_at: float | None = None
    seconds: float = 0.0
    meshes: tuple[PlasticMesh, ...] = ()
    curve: LoadCurve | None = None
    flow: FlowField | None = None
    note: str = ""
    stopped: bool = False
    time: Time | None = None


@dataclass(frozen=True)
class LugCollapse:
    """The limit load of a lug, N, that its pin pulls along the shank, between lower and upper.

    needs: what is missing where there is none. ultimate: the load at which it breaks, of a material
    with a failure strain; breaks_by: what ends it, or what is missing. ultimate_ends: both at the
    lower and upper end of the yield strength, where that has a range.
    """

    connection: str
    lower: Force | None = None
    upper: Force | None = None
    needs: str = ""
    ultimate: Force | None = None
    breaks_by: str = ""
    ultimate_ends: tuple[tuple[Force | None, str], ...] = ()
