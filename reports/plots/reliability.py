"""The distribution of a safety factor on a normal-probability axis."""

from __future__ import annotations

from statistics import NormalDist

from reports.data.reliability import Reliability, Risk
from reports.plots.spec import Plot, Spec, clipped, rows

PROBABILITY_TICKS = (
    *(1e-8, 1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.1),
    *(0.3, 0.5, 0.7, 0.9, 0.99, 0.999, 0.9999),
)
SAMPLING_NAMES = "plain sampling", "importance sampling"


def distribution_plot(reliability: Reliability, risk: Risk) -> Plot | None:
    """Return the probability of a lower factor, on an axis on which a normal distribution is a
    straight line; None without samples.
    """
    deviate = NormalDist().inv_cdf
    data: list[Spec] = [
        {"x": factor, "y": deviate(p), "p": p, "way": SAMPLING_NAMES[way]}
        for factor, p, way in risk.curve
    ]
    if not data:
        return None
    low, high = (end(row["y"] for row in data) for end in (min, max))
    low = min(low, deviate(reliability.probability))
    ticks = [p for p in PROBABILITY_TICKS if low - 0.5 <= deviate(p) <= high + 0.5]
    named = " : ".join(f"abs(datum.value - ({deviate(p):.6f})) < 1e-4 ? '{p:g}'" for p in ticks)
    x: Spec = {"field": "x", "type": "quantitative", "title": "factor of safety",
               "scale": {"zero": False, "nice": False}}  # fmt: skip
    y: Spec = {"field": "y", "type": "quantitative", "title": "probability of a lower factor",
               "axis": {"values": [deviate(p) for p in ticks], "labelExpr": f"{named} : ''",
                     "tickCount": 2 * len(ticks)},
               "scale": {"zero": False}}  # fmt: skip
    colour: Spec = {"field": "way", "type": "nominal", "title": None,
                    "scale": {"domain": list(SAMPLING_NAMES)}}  # fmt: skip
    layers: list[Spec] = [
        {"mark": {"type": "line"}, "encoding": {"color": colour, "strokeDash": colour}},
        {"data": rows([{"x": reliability.limit}]), "mark": {"type": "rule", "style": "governs"},
         "encoding": {"y": None}},
        {"data": rows([{"y": deviate(reliability.probability)}]),
         "mark": {"type": "rule", "style": "level"}, "encoding": {"x": None}},
    ]  # fmt: skip
    title = f"pin {clipped(risk.pin)}, {clipped(risk.case)}"
    spec: Spec = {"title": title, "data": rows(data), "width": 420, "height": 320,
                  "encoding": {"x": x, "y": y}, "layer": layers}  # fmt: skip
    caption = (
        "Distribution of the factor of safety; a normal law would be a straight line. Dashed: the "
        "factor below which the pin fails, and the allowed probability."
    )
    return Plot("reliability", caption, spec)
