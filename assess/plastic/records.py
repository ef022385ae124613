"""What a run says about the limit load of a pin in a case."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pinbase.dimensions import Floats, Length, Lengths, Stresses


@dataclass(frozen=True)
class PlasticMesh:
    """One mesh of the solid: unknowns, the load factor that equilibrium reached on it (lower, of
    which the lower bound is made) and the upper bound, change of volume over the equivalent strain
    of its mechanism and what is charged for it in the upper bound, load steps and iterations.
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
    """Load factors (S,) and the largest displacement at them, from zero on; permanent: what is left
    of it (S,) when the loads are taken off.
    """

    factor: Floats
    displacement: Lengths
    permanent: Lengths


@dataclass(frozen=True)
class FlowField:
    """The pin, or the part of its turn that was computed, when its limit load is reached, at a load
    factor: points (N, 3) in pin axes, cells (M, 20) in the order of VTK, displacement (N, 3),
    equivalent plastic strain and von Mises stress (N,).
    """

    points: Lengths
    cells: NDArray[np.int64]
    displacement: Lengths
    plastic_strain: Floats
    von_mises: Stresses
    factor: float


@dataclass(frozen=True)
class LimitLoad:
    """The load factor at which a pin collapses is between lower and upper: all loads of the case at
    its governing instant, in proportion. method: beam or solid, or why there is no answer ("none",
    with the reason in `note`).

    carries: whether the pin carries its loads (factor 1) without collapse; None where that is not
    decided. permanent_set: what is left of the largest displacement after the loads reached the
    factor permanent_at and were taken off. curve, flow: of the finest mesh. stopped: there is no
    answer because it would have taken longer than a limit load may that nobody asked for.
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
