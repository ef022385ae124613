"""The speed-accuracy chart of a pin as plain data and as CSV."""

from __future__ import annotations

from dataclasses import dataclass

from pinbase.grouped import grouped

MIN_CHART_ERROR = 1e-12  # replaces an error of zero
CHART_NAME = "chart"


@dataclass(frozen=True)
class ChartPoint:
    """The cost and the error of one mesh of one element type of a model.

    All numbers are None if the solution failed; `failed` then states the reason.
    dofs: number of unknowns, 0 for a beam.
    seconds: median wall time from the mesh to the maximum over the motion.
    memory: peak memory above that of the process with its libraries loaded, MB.
    error: relative error of the maximum with respect to the reference.
    chosen: whether the model `auto` ends on this mesh.
    """

    model: str
    element: str
    dofs: int | None = None
    seconds: float | None = None
    memory: float | None = None
    max_von_mises: float | None = None
    error: float | None = None
    chosen: bool = False
    failed: str = ""


@dataclass(frozen=True)
class Reference:
    """The solution against which errors are measured.

    error: its own estimated relative error.
    """

    model: str
    element: str
    dofs: int
    max_von_mises: float
    error: float


@dataclass(frozen=True)
class Chart:
    """The speed-accuracy chart of a pin in a case.

    points: by model and element, coarse to fine.
    bare: memory of the process with its libraries loaded, MB.
    runs: the number of runs of which `seconds` are medians.
    beam_error: the relative error that the beam estimates for itself, if any.
    note: the part of the pin whose maximum is charted, where it is not the whole pin.
    """

    pin: str
    case: str
    stress_unit: str
    tolerance: float
    points: tuple[ChartPoint, ...]
    reference: Reference
    bare: float
    runs: int
    beam_error: float | None = None
    note: str = ""

    @property
    def curves(self) -> dict[tuple[str, str], list[ChartPoint]]:
        """Return the points that did not fail, by model and element."""
        return grouped(((p.model, p.element), p) for p in self.points if not p.failed)


def error(point: ChartPoint) -> float:
    """Return the relative error of a point that did not fail; it is never zero."""
    assert point.error is not None
    return max(point.error, MIN_CHART_ERROR)
