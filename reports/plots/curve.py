"""The safety factors of pins against one number of the study."""

from __future__ import annotations

from reports.data.curve import CURVE_NAME, CurvePoint, FactorCurve
from reports.plots.spec import (
    NUMBER_FORMAT,
    Plot,
    Spec,
    clipped,
    headed,
    instant,
    labels,
    level,
    rows,
)

MIN_FACTOR_SHARE = 1e-3  # least end of an error bar over the factor, for the logarithmic axis


def curve_plot(curve: FactorCurve) -> Plot:
    """Return a line for each pin through its smallest factors, with the errors as bars."""
    names = {pin: f"pin {label}" for pin, label in labels(curve.pins).items()}
    data = [_row(point, names[pin]) for pin in curve.pins for point in curve.least(pin)]
    unit = f" [{curve.unit}]" if curve.unit else ""
    x = {"field": "x", "type": "quantitative", "title": f"{clipped(curve.key, 60)}{unit}",
         "scale": {"nice": False, "zero": False, "padding": 12}}  # fmt: skip
    y = {"field": "factor", "type": "quantitative", "title": "factor of safety",
         "scale": {"type": "log", "nice": False, "padding": 12}}  # fmt: skip
    key = {"field": "pin", "type": "nominal", "title": None,
           "scale": {"domain": list(names.values())}}  # fmt: skip
    tooltip = [{"field": name, "title": title, "format": NUMBER_FORMAT}
               for name, title in (("x", "value"), ("factor", "factor"))]  # fmt: skip
    tooltip += [{"field": name, "title": name} for name in ("pin", "case", "outcome")]
    bars = {"mark": {"type": "rule", "size": 2},
            "encoding": {"y": {**y, "field": "low"}, "y2": {"field": "high"},
                         "color": key}}  # fmt: skip
    lines = {"mark": {"type": "line", "point": {"size": 40, "filled": True}},
             "encoding": {"y": y, "color": key, "tooltip": tooltip}}  # fmt: skip
    # Texts point away from the nearer end and from each other.
    late = curve.nominal > 0.5 * sum(f([p.value for p in curve.points]) for f in (min, max))
    required = curve.required
    levels = [] if required is None else [level(required, "required", right=not late)]
    spec: Spec = {
        "title": headed(f"factor of safety against {clipped(curve.key, 60)}"),
        "usermeta": {"columns": [f"{curve.key}{unit}", "factor of safety"]},
        "data": rows(data),
        "width": 420,
        "height": 260,
        "encoding": {"x": x},
        "layer": [*levels, instant(curve.nominal, "study", late), bars, lines],
    }
    caption = f"Factor of safety against {curve.key}; bars: numerical error."
    return Plot(CURVE_NAME, caption, spec)


def _row(point: CurvePoint, name: str) -> Spec:
    """Return a point of a line; a point without a factor breaks the line."""
    ends, factor = point.factor_ends, point.safety_factor
    row: Spec = {"x": point.value, "factor": factor, "pin": name,
                 "case": point.case, "outcome": point.outcome}  # fmt: skip
    if factor is None or ends is None:
        return row
    low, high = ends
    return {**row, "low": max(low, MIN_FACTOR_SHARE * factor), "high": min(high, 1e3 * factor)}
