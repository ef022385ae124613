"""Results of a run for the limit load of a pin in a load case, and of its lugs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pinbase.dimensions import Floats, Force, Length, Lengths, Stresses, Time


@dataclass(frozen=True)
class PlasticMesh:
    """One mesh of the solid.

    lower: the load factor reached in equilibrium, from which the lower bound is computed.
    upper: the upper bound.
    volume: mean volume change of the mechanism relative to its equivalent strain.
    charge: the amount that the volume change adds to the upper bound.
    steps, iterations: the numbers of load steps and of Newton iterations.
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
    """The load factors (S,), starting at zero, and the largest displacement (S,) at each.

    permanent: (S,) the part of the displacement that remains when the loads are removed.
    """

    factor: Floats
    displacement: Lengths
    permanent: Lengths


@dataclass(frozen=True)
class FlowField:
    """The pin, or its modelled sector, in the last state in equilibrium, at the limit load.

    points: (N, 3) in pin axes.
    cells: (M, 20) node numbers in VTK's order.
    displacement: (N, 3).
    plastic_strain: (N,) equivalent plastic strain.
    von_mises: (N,).
    factor: the load factor of the state.
    """

    points: Lengths
    cells: NDArray[np.int64]
    displacement: Lengths
    plastic_strain: Floats
    von_mises: Stresses
    factor: float


@dataclass(frozen=True)
class LimitLoad:
    """The load factor at which a pin collapses; it lies between `lower` and `upper`.

    All loads of the case grow in proportion. The instant (`time`, s; None without a motion) is the
    one at which the pin, as a beam, collapses at the smallest factor.
    method: beam or solid; "none" without a result, with the reason in `note`.
    carries: whether the pin carries its loads (factor 1) without collapse; None where this is not
    decided.
    permanent_set: the part of the largest displacement that remains after the loads have reached
    the factor permanent_at and have been removed.
    seconds: wall-clock time.
    curve, flow: of the finest mesh.
    stopped: there is no result, because it would have taken longer than allowed for a limit load
    that the user has not requested.
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
    """The limit load, N, of a lug that its pin pulls along the shank; it lies between `lower` and
    `upper`.

    needs: what is missing if there is no limit load. ultimate: the load at which the lug breaks, if
    the material has a failure strain. breaks_by: what ends the rise of the load, or what is
    missing. ultimate_ends: ultimate and breaks_by at the lower and at the upper end of the yield
    strength, if the strength has a range.
    """

    connection: str
    lower: Force | None = None
    upper: Force | None = None
    needs: str = ""
    ultimate: Force | None = None
    breaks_by: str = ""
    ultimate_ends: tuple[tuple[Force | None, str], ...] = ()
