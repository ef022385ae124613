"""The speed-accuracy chart of a pin as plain data and as CSV."""

from __future__ import annotations

from dataclasses import dataclass

MIN_CHART_ERROR = 1e-12  # replaces an error of zero
CHART_NAME = "chart"


@dataclass(frozen=True)
class ChartPoint:
    """One mesh of one element of a model. dofs: unknowns, 0 of a beam. seconds: median wall time
    from the mesh to the maximum over the motion. memory: the most it took above the process with
    its libraries loaded, MB. error: of the maximum relative to the reference. chosen: whether
    `auto` ends on it. All are None where it `failed`, for that reason.
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
    """What the errors are measured by, with its own estimated error, relative."""

    model: str
    element: str
    dofs: int
    max_von_mises: float
    error: float


@dataclass(frozen=True)
class Chart:
    """points: by model and element, coarse to fine. bare: memory of the process with its libraries
    loaded, MB. runs: of which seconds are medians. beam_error: what the beam says of its own error,
    relative, if anything. note: of what the maximum is one, where not of the whole pin.
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
        """Points that did not fail, by model and element."""
        out: dict[tuple[str, str], list[ChartPoint]] = {}
        for p in self.points:
            if not p.failed:
                out.setdefault((p.model, p.element), []).append(p)
        return out


def error(point: ChartPoint) -> float:
    """Relative error of a point that did not fail, never zero."""
    assert point.error is not None
    return max(point.error, MIN_CHART_ERROR)
