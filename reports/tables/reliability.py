"""Probabilities of failure as tables and JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import asdict, is_dataclass
from pathlib import Path
from typing import Any

from reports.data.reliability import ByErrors, Reliability, Risk, Spread
from reports.format.files.csv import Cell, write_csv
from reports.format.grid import Grid
from reports.format.numbers import DASH, engineering, finite

RELIABILITY_SCHEMA = "pinstress-reliability/1"
PROBABILITY_DIGITS = 3
OR_BENEATH_CONTACT = "or beneath contact"  # probability that a row fails, or depends on that
COLUMNS = (
    "pin", "case", "result", "verdict", "safety_factor", "limit_factor",
    "probability", "probability_low", "probability_high", "probability_by",
    "beneath", "beneath_low", "beneath_high",
    "sampled", "sampled_low", "sampled_high", "failures", "samples", "unknown",
    "weighted", "weighted_low", "weighted_high",
    "form", "form_index", "form_design_points",
    "mesh_error", "mesh_lower", "mesh_higher", "joint_least", "joint_most",
    "joint_lower", "joint_higher",
    "quantile_probability", "quantile", "quantile_low", "quantile_high", "quantile_form", "remark",
)  # fmt: skip
DRIVER_COLUMNS = (
    "pin", "case", "parameter", "form_importance",
    "sobol_first", "sobol_first_low", "sobol_first_high",
    "sobol_total", "sobol_total_low", "sobol_total_high",
)  # fmt: skip


def write_reliability(found: Reliability, directory: Path) -> None:
    """Write reliability.csv, drivers.csv and reliability.json with all digits."""
    write_csv(directory / "reliability.csv", COLUMNS, (_cells(found, r) for r in found.risks))
    write_csv(directory / "drivers.csv", DRIVER_COLUMNS, _driver_cells(found))
    content = {"schema": RELIABILITY_SCHEMA, **_plain(found)}
    for risk, made in zip(found.risks, content["risks"], strict=True):
        made |= {"result": risk.result(found.probability), "by_weights": risk.by_weights}
    text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False)
    path = directory / "reliability.json"
    path.write_text(text + "\n", encoding="utf-8", newline="\n")


def _plain(value: Any) -> Any:
    """As JSON: what is not finite is null."""
    if is_dataclass(value) and not isinstance(value, type):
        return _plain(asdict(value))
    if isinstance(value, dict):
        return {str(key): _plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    return finite(value) if isinstance(value, float) else value


def _cells(found: Reliability, risk: Risk) -> list[Cell]:
    form = risk.form
    return [
        risk.pin,
        risk.case,
        risk.result(found.probability),
        risk.verdict,
        risk.factor,
        found.limit,
        *_ends(risk.probability),
        "importance sampling" if risk.by_weights else "plain sampling",
        *_ends(risk.beneath),
        *_ends(risk.sampled),
        risk.failures,
        found.samples,
        risk.unknown,
        *_ends(risk.weighted),
        *((None,) * 3 if form is None else (finite(form.probability), finite(form.index),
                                            form.points)),
        *_errors(risk.mesh)[1:],
        *_errors(risk.joint),
        found.probability,
        *_ends(risk.quantile),
        None if form is None else finite(form.quantile),
        remark(risk),
    ]  # fmt: skip


def remark(risk: Risk) -> str:
    """What is to be known of a row, in a sentence or none."""
    said = []
    if risk.disagrees:
        said.append(
            "plain and importance sampling contradict each other: failure occurs where FORM did "
            "not find it, or its samples are too few"
        )
    if risk.form is not None and risk.form.why:
        said.append(f"no design point: {risk.form.why}")
    if risk.form is not None and risk.form.points > 1:
        said.append(f"{risk.form.points} design points; FORM is of the nearest one alone")
    if risk.unknown:
        said.append(f"{risk.unknown} designs have no result and count both ways")
    return "; ".join(said)


def _ends(value: Spread | None) -> tuple[float | None, ...]:
    if value is None:
        return None, None, None
    return finite(value.value), finite(value.low), finite(value.high)


def _errors(found: ByErrors | None) -> tuple[float | None, ...]:
    if found is None:
        return None, None, None, None
    return found.least, found.most, found.lower.value, found.higher.value


def _driver_cells(found: Reliability) -> Iterator[list[Cell]]:
    for risk in found.risks:
        for each in risk.drivers:
            yield [risk.pin, risk.case, each.parameter, each.importance,
                   *_ends(each.first), *_ends(each.total)]  # fmt: skip


def chance(value: float | None) -> str:
    """A probability as text."""
    return DASH if value is None or not math.isfinite(value) else f"{value:.{PROBABILITY_DIGITS}g}"


def chance_range(value: Spread | None) -> str:
    """A probability with its interval; only the upper end where nothing failed."""
    if value is None:
        return DASH
    if value.value <= 0.0:
        return f"below {chance(value.high)}"
    return f"{chance(value.value)} ({chance(value.low)} to {chance(value.high)})"


def factor_interval(value: Spread | None) -> str:
    """A factor with its interval."""
    if value is None or math.isnan(value.value):
        return DASH
    ends = (
        engineering(end, PROBABILITY_DIGITS) if math.isfinite(end) else "?"
        for end in (value.low, value.high)
    )
    return f"{engineering(value.value, PROBABILITY_DIGITS)} ({' to '.join(ends)})"


def risks_grid(found: Reliability) -> Grid:
    """A row per pin and case; with what lies beneath contact, where that is ever more."""
    deep = found.deep
    per_cent, p = f"{100.0 * found.confidence:g} %", chance(found.probability)
    head = ["pin", "case", "result", "FoS", f"FoS at probability {p} ({per_cent})",
            f"P(FoS < {engineering(found.limit, PROBABILITY_DIGITS)}) ({per_cent})",
            *[OR_BENEATH_CONTACT] * deep, "by mesh error", "over joint"]  # fmt: skip
    body = [
        [
            risk.pin,
            risk.case,
            risk.result(found.probability),
            engineering(risk.factor),
            factor_interval(risk.quantile),
            chance_range(risk.probability),
            *[chance_range(risk.beneath or risk.probability)] * deep,
            *(_by_errors(each) for each in (risk.mesh, risk.joint)),
        ]
        for risk in found.risks
    ]
    return Grid(head, body, [False, False, False, *[True] * (len(head) - 3)])


def ways_grid(found: Reliability) -> Grid:
    """The same by each way of finding it."""
    per_cent, p = f"{100.0 * found.confidence:g} %", chance(found.probability)
    head = ["pin", "case", f"plain sampling ({per_cent})", "failures",
            f"importance sampling ({per_cent})", "FORM", "reliability index",
            f"FoS at {p}, plain", "FoS, importance", "FoS, FORM"]  # fmt: skip
    body = []
    for risk in found.risks:
        form = risk.form
        body.append([
            risk.pin,
            risk.case,
            chance_range(risk.sampled),
            f"{risk.failures:,} of {found.samples:,}",
            chance_range(risk.weighted),
            chance(form.probability) if form else DASH,
            engineering(finite(form.index), 4) if form else DASH,
            factor_interval(risk.quantile_sampled),
            factor_interval(risk.quantile_weighted),
            engineering(finite(form.quantile), PROBABILITY_DIGITS) if form else DASH,
        ])  # fmt: skip
    return Grid(head, body, [False, False, *[True] * 8])


def _by_errors(found: ByErrors | None) -> str:
    if found is None:
        return DASH
    ends = f"{chance(found.lower.value)} to {chance(found.higher.value)}"
    return f"{ends} (stress {change(found)})"


def change(found: ByErrors) -> str:
    """By how much stresses are changed, as text."""
    least, most = 100.0 * found.least, 100.0 * found.most
    if least == -most:
        return f"±{most:.2g} %"
    return f"{least:+.2g} to {most:+.2g} %".replace("-", "−")


def drivers_grid(found: Reliability) -> Grid:
    """What drives each row, the most important first."""
    body = []
    for risk in found.risks:
        known = [d for d in risk.drivers if d.importance is not None or d.first is not None]
        for each in sorted(known, key=lambda d: -(d.importance or 0.0)):
            body.append([risk.pin, risk.case, each.parameter, _per_cent(each.importance),
                         _share(each.first), _share(each.total)])  # fmt: skip
    head = ["pin", "case", "parameter", "importance (FORM)", "Sobol index", "total Sobol index"]
    return Grid(head, body, [False, False, False, True, True, True])


def _per_cent(value: float | None) -> str:
    return DASH if value is None else f"{100.0 * value:.1f} %"


def _share(value: Spread | None) -> str:
    return DASH if value is None else f"{value.value:.2f} ± {0.5 * (value.high - value.low):.2f}"
