"""A speed-accuracy chart in words: the cheapest model, the cost of equal errors, and the table."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from reports.data.chart import Chart, ChartPoint, error
from reports.format.numbers import engineering, percent, seconds
from reports.tables.chart import chart_table
from reports.text.fitted_table import fitted_table

if TYPE_CHECKING:
    from rich.console import Console


FOUNDATION_MODEL = "foundation"  # its error does not come from the mesh
HARMONIC_MODEL_NAMES = {
    "harmonic": "the harmonic model",
    "harmonic+local": "the harmonic model with local solids",
    "contact": "contact by the harmonic model",
}
SOLID_MODEL_NAMES = {"solid": "the solid model", "calculix": "CalculiX"}
SHORT_MODEL_NAMES = {
    "foundation": "foundation",
    "calculix": "CalculiX",
    "Timoshenko beam": "beam",
    "quadratic triangles": "harmonic",
    "triangles and local tetrahedra": "local solids",
    "linear tetrahedra": "solid, linear",
    "straight quadratic tetrahedra": "solid, straight",
    "curved quadratic tetrahedra": "solid, curved",
}
Curve = Sequence[ChartPoint]


@dataclass(frozen=True)
class Cost:
    """The cost at which a curve reaches an error.

    memory: MB.
    at_most: whether this is the coarsest mesh, whose error is smaller than the wanted one.
    """

    seconds: float
    memory: float
    at_most: bool = False


def staying(curve: Curve, wanted: float) -> Curve:
    """Return the last points of a curve, all of which are within the wanted error.

    An isolated point that is within the error by chance does not count.
    """
    last = max((i for i, p in enumerate(curve) if error(p) > wanted), default=-1)
    return curve[last + 1 :]


def cost(curve: Curve, wanted: float) -> Cost | None:
    """Return the cost of the wanted error, interpolated linearly on the log-log chart.

    The result is None if the curve does not stay within the error.
    """
    within = staying(curve, wanted)
    if not within:
        return None
    first = within[0]
    before = curve[len(curve) - len(within) - 1] if len(within) < len(curve) else None
    if before is None:
        return Cost(first.seconds or 0.0, first.memory or 0.0, at_most=True)
    part = math.log(error(before) / wanted) / math.log(error(before) / error(first))

    def between(a: float | None, b: float | None) -> float:
        assert a is not None
        assert b is not None
        return math.exp(math.log(a) + part * math.log(b / a))

    return Cost(between(before.seconds, first.seconds), between(before.memory, first.memory))


def summary(chart: Chart) -> str:
    """Return the sentences under the table.

    They give the cheapest model within the tolerance, the cost of equal errors, and the error of
    the beam on foundations.
    """
    said = (_cheapest(chart), _ratio(chart), _foundation_error(chart))
    return " ".join(text for text in said if text)


def _cheapest(chart: Chart) -> str:
    tolerance = percent(chart.tolerance)
    tails = [
        staying(curve, chart.tolerance)
        for (model, _), curve in chart.curves.items()
        if model != FOUNDATION_MODEL
    ]
    first = [within[0] for within in tails if within]
    if not first:
        return f"No model stays within {tolerance}."
    best = min(first, key=lambda p: p.seconds or 0.0)
    text = (
        f"Cheapest within {tolerance}: {label(best)}, {seconds(best.seconds)}, "
        f"{engineering(best.memory, 2)} MB, error {percent(error(best))}."
    )
    if best.model == "beam" and not best.chosen:
        beam_error = chart.beam_error
        why = "unknown" if beam_error is None else percent(beam_error)
        text += f" (auto does not use it: the estimated error of the beam is {why}.)"
    return text


def _foundation_error(chart: Chart) -> str:
    """Return the error of the beam on foundations, which finer meshes do not reduce."""
    _, beams = _curves(chart, {FOUNDATION_MODEL: ""})
    return "".join(
        f"Error of the beam on foundations: {percent(error(beam[-1]))}." for beam in beams.values()
    )


def _curves(chart: Chart, models: dict[str, str]) -> tuple[str, dict[str, Curve]]:
    """Return the name and the curves, by element, of the first of the given models that
    is charted.
    """
    for model, name in models.items():
        by_element = {element: c for (m, element), c in chart.curves.items() if m == model}
        if by_element:
            return name, dict(by_element)
    return "", {}


def _fastest(curves: dict[str, Curve], wanted: float) -> tuple[str, Cost] | None:
    costs = [(name, curve_cost) for name, c in curves.items() if (curve_cost := cost(c, wanted))]
    return min(costs, key=lambda c: c[1].seconds, default=None)


def _ratio(chart: Chart) -> str:
    """Return sentences that compare our model with the fastest solid element at equal error."""
    (ours, planes), (theirs, solids) = (
        _curves(chart, HARMONIC_MODEL_NAMES),
        _curves(chart, SOLID_MODEL_NAMES),
    )
    if not planes or not solids:
        return ""
    text, wanted = "", chart.tolerance
    solid = _fastest(solids, wanted)
    if solid is None:
        wanted = min(error(c[-1]) for c in solids.values()) * (1.0 + 1e-9)
        text = (
            f"{_start(theirs)} does not stay within {percent(chart.tolerance)} on these meshes; "
            f"its smallest error is {percent(wanted)}. "
        )
        solid = _fastest(solids, wanted)
    plane = _fastest(planes, wanted)
    if solid is None or plane is None:
        return text + f"{_start(ours)} does not stay within {percent(wanted)}."
    (_, plane_cost), (name, body) = plane, solid
    least = "at least " if plane_cost.at_most else ""
    if body.at_most:
        least = "about " if plane_cost.at_most else "at most "
    times = [body.seconds / plane_cost.seconds, body.memory / plane_cost.memory]
    slow, large = (f"{least}{engineering(x, 2)}" for x in times)
    ends = [who for who, c in ((ours, plane_cost), (theirs, body)) if c.at_most]
    verb = "are" if len(ends) > 1 else "is"
    also = f"; {' and '.join(ends)} {verb} within it on the coarsest mesh" if ends else ""
    return (
        f"{text}At an equal error of {percent(wanted)} {theirs} ({name}) takes {slow} times the "
        f"time and {large} times the memory of {ours} (interpolated on the log-log chart{also})."
    )


def _start(text: str) -> str:
    """Return the text with a capital letter."""
    return text[0].upper() + text[1:]


def curve_name(model: str, element: str) -> str:
    """Return a short name of a curve for labels."""
    return SHORT_MODEL_NAMES.get(model) or SHORT_MODEL_NAMES.get(element) or f"{model}, {element}"


def label(point: ChartPoint) -> str:
    """Return a point as text."""
    if point.model in ("beam", FOUNDATION_MODEL):
        return point.model
    dofs = f", {point.dofs:,} unknowns" if point.dofs else ""
    return f"{point.model} ({point.element}{dofs})"


def reference_line(chart: Chart) -> str:
    """Return the line on the reference solution."""
    r = chart.reference
    charted = [p.dofs for p in chart.points if p.model == r.model and p.dofs]
    more = f", {engineering(r.dofs / max(charted), 2)} times the finest charted" if charted else ""
    smaller = any(p.error is not None and p.error < r.error for p in chart.points)
    return (
        f"Reference: {r.model} model, {r.element}, {r.dofs:,} unknowns{more}: "
        f"{engineering(r.max_von_mises, 5)} {chart.stress_unit}, with an error of "
        f"{percent(r.error)}{', which smaller errors above may have as well' * smaller}."
    )


def failures(chart: Chart) -> list[str]:
    """Return the failed meshes with the reason, equal ones together."""
    meshes: dict[tuple[str, str], int] = {}
    mesh_numbers: dict[tuple[str, str, str], list[int]] = {}
    for p in chart.points:
        meshes[p.model, p.element] = number = meshes.get((p.model, p.element), 0) + 1
        if p.failed:
            mesh_numbers.setdefault((p.model, p.element, p.failed), []).append(number)
    out = []
    for (model, element, why), numbers in mesh_numbers.items():
        if meshes[model, element] == len(numbers):
            which = "" if len(numbers) == 1 else ", all meshes"
        else:
            which = f", mesh{'es' if len(numbers) > 1 else ''} {', '.join(map(str, numbers))}"
        what = f"{model} ({element})" if model == "solid" else model
        out.append(f"Failed: {what}{which}: {why}")
    return out


def print_chart(chart: Chart, console: Console) -> None:
    """Print the table of meshes, the reference, failures and a summary."""
    from rich.text import Text

    table = chart_table(chart)
    inside = [p.error is not None and p.error <= chart.tolerance for p in chart.points]
    tints = {heading: ["green" * good for good in inside] for heading in table.grid().head}
    console.print(fitted_table(table, None, console.width, tints, gap=1))
    of = f"median of {chart.runs} runs" if chart.runs > 1 else "one run"
    console.print(
        Text(
            f"Time: {of}, including meshing. Memory: above the bare process ({chart.bare:.0f} MB)."
        )
    )
    for line in (reference_line(chart), chart.note, *failures(chart), summary(chart)):
        if line:
            console.print(Text(line))
