"""Probabilities of failure as tables and JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from pinbase.counted import counted
from pinbase.records import plain
from reports.data.reliability import ByErrors, Driver, Reliability, Risk, Spread
from reports.format.numbers import DASH, engineering, finite
from reports.tables.column import Column, Table, fields, read_only, texts

RELIABILITY_SCHEMA = "pinstress-reliability/1"
PROBABILITY_DIGITS = 3
OR_BENEATH_CONTACT = "or beneath contact"  # probability that a row fails or depends on this
OR_OVER_OPEN = "or over what is open"

R = TypeVar("R")


@dataclass(frozen=True)
class RiskRow:
    """The probability of failure of a pin in a case, with all results of the study (`whole`)."""

    risk: Risk
    whole: Reliability

    @property
    def by(self) -> str:
        """The method by which the probability was computed."""
        return "importance sampling" if self.risk.by_weights else "plain sampling"


@dataclass(frozen=True)
class DriverRow:
    """The contribution of a parameter to the failure of a pin in a case."""

    risk: Risk
    driver: Driver


def _ends(key: str, spread: Callable[[R], Spread | None]) -> list[Column[R]]:
    """Return the columns of a value and the ends of its interval."""

    def end(name: str) -> Callable[[R], float | None]:
        return lambda row: finite(getattr(spread(row), name, None))

    ends = {key: "value", f"{key}_low": "low", f"{key}_high": "high"}
    return [Column(name, end(part)) for name, part in ends.items()]


COLUMNS: list[Column[RiskRow]] = [
    *fields("risk.pin risk.case"),
    Column("result", lambda row: row.risk.result(row.whole.probability)),
    *fields("risk.verdict safety_factor=risk.factor limit_factor=whole.limit"),
    *_ends("probability", lambda row: row.risk.probability),
    *fields("probability_by=by"),
    *_ends("beneath", lambda row: row.risk.beneath),
    *_ends("over_open", lambda row: row.risk.over_open),
    *_ends("sampled", lambda row: row.risk.sampled),
    *fields("risk.failures whole.samples risk.unknown"),
    *_ends("weighted", lambda row: row.risk.weighted),
    *fields("form=risk.form?.probability form_index=risk.form?.index"),
    *fields("form_design_points=risk.form?.points mesh_error=risk.mesh?.most"),
    *fields("mesh_lower=risk.mesh?.lower.value mesh_higher=risk.mesh?.higher.value"),
    *fields("joint_least=risk.joint?.least joint_most=risk.joint?.most"),
    *fields("joint_lower=risk.joint?.lower.value joint_higher=risk.joint?.higher.value"),
    *fields("quantile_probability=whole.probability"),
    *_ends("quantile", lambda row: row.risk.quantile),
    *fields("quantile_form=risk.form?.quantile"),
    Column("remark", lambda row: remark(row.risk)),
]
DRIVER_COLUMNS: list[Column[DriverRow]] = [
    *texts("risk.pin risk.case driver.parameter"),
    Column("form_importance", lambda row: row.driver.importance, "", "importance (FORM)",
           lambda row: _per_cent(row.driver.importance)),
    *_ends("sobol_first", lambda row: row.driver.first),
    *_ends("sobol_total", lambda row: row.driver.total),
    read_only("Sobol index", lambda row: _share(row.driver.first), rank=1),
    read_only("total Sobol index", lambda row: _share(row.driver.total), rank=2),
]  # fmt: skip


def write_reliability(reliability: Reliability, directory: Path) -> None:
    """Write reliability.csv, drivers.csv and reliability.json with all digits."""
    rows = [RiskRow(risk, reliability) for risk in reliability.risks]
    Table("reliability", COLUMNS, rows).write(directory)
    drivers = [DriverRow(risk, driver) for risk in reliability.risks for driver in risk.drivers]
    Table("drivers", DRIVER_COLUMNS, drivers).write(directory)
    content = {"schema": RELIABILITY_SCHEMA, **plain(reliability)}
    for risk, record in zip(reliability.risks, content["risks"], strict=True):
        record |= {"result": risk.result(reliability.probability), "by_weights": risk.by_weights}
    text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False)
    path = directory / "reliability.json"
    path.write_text(text + "\n", encoding="utf-8", newline="\n")


def remark(risk: Risk) -> str:
    """Return a sentence on the limits of a row, or an empty text."""
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
    if risk.unbounded is not None and risk.verdict != "singular":
        said.append(
            "stress is unbounded at a corner or an edge in some designs, whose factors are those "
            "outside the excluded zones: the probability of that or of failure is "
            f"{chance_range(risk.unbounded)}"
        )
    if not risk.error_known:
        said.append("the error of its stress is unknown, so that no probability shows it safe")
    if risk.loose is not None:
        said.append(
            f"its press fit is lost with the probability {chance_range(risk.loose)}, and what else "
            "retains the pin is not judged"
        )
    if risk.unknown:
        count = f"count{'s' * (risk.unknown == 1)} both ways"
        said.append(f"{without_result(risk.unknown)} and {count}")
    return "; ".join(said)


def without_result(designs: int) -> str:
    """Return the clause that a number of designs have no result."""
    return f"{counted(designs, 'design')} {'has' if designs == 1 else 'have'} no result"


def chance(value: float | None) -> str:
    """Return a probability as text."""
    return DASH if value is None or not math.isfinite(value) else f"{value:.{PROBABILITY_DIGITS}g}"


def chance_range(value: Spread | None) -> str:
    """Return a probability with its interval; only the upper end if nothing failed."""
    if value is None:
        return DASH
    if value.value <= 0.0:
        return f"below {chance(value.high)}"
    return f"{chance(value.value)} ({chance(value.low)} to {chance(value.high)})"


def factor_interval(value: Spread | None) -> str:
    """Return a factor with its interval."""
    if value is None or math.isnan(value.value):
        return DASH
    ends = (
        engineering(end, PROBABILITY_DIGITS) if math.isfinite(end) else "?"
        for end in (value.low, value.high)
    )
    return f"{engineering(value.value, PROBABILITY_DIGITS)} ({' to '.join(ends)})"


def risks_table(reliability: Reliability) -> Table[Risk]:
    """Return the table for people with a row for each pin and case.

    The stress beneath contact and open values have columns only if they raise a probability.
    """
    per_cent, p = f"{100.0 * reliability.confidence:g} %", chance(reliability.probability)
    limit = engineering(reliability.limit, PROBABILITY_DIGITS)
    beneath: list[Column[Risk]] = [
        read_only(OR_BENEATH_CONTACT, lambda risk: chance_range(risk.beneath or risk.probability))
    ]
    over_open: list[Column[Risk]] = [
        read_only(OR_OVER_OPEN, lambda risk: chance_range(risk.over_open or risk.probability))
    ]
    columns: list[Column[Risk]] = [
        *texts("pin case"),
        read_only("result", lambda risk: risk.result(reliability.probability), numeric=False),
        read_only("factor", lambda risk: risk.factor, rank=1),
        read_only(
            f"factor at p = {p} ({per_cent})",
            lambda risk: factor_interval(risk.quantile), rank=2
        ),
        read_only(f"P(factor < {limit}) ({per_cent})", lambda risk: chance_range(risk.probability)),
        *beneath * reliability.deep,
        *over_open * reliability.open,
        read_only("by mesh error", lambda risk: _by_errors(risk.mesh), rank=3),
        read_only("over joint", lambda risk: _by_errors(risk.joint), rank=4),
    ]  # fmt: skip
    return Table("risks", columns, reliability.risks)


def ways_table(reliability: Reliability) -> Table[Risk]:
    """Return the probability of failure by method, for people."""
    per_cent, p = f"{100.0 * reliability.confidence:g} %", chance(reliability.probability)

    def form(name: str, text: Callable[[float | None], str]) -> Callable[[Risk], str]:
        return lambda risk: text(getattr(risk.form, name)) if risk.form else DASH

    columns: list[Column[Risk]] = [
        *texts("pin case"),
        read_only(f"plain sampling ({per_cent})", lambda risk: chance_range(risk.sampled)),
        read_only("failures", lambda risk: f"{risk.failures:,} of {reliability.samples:,}"),
        read_only(f"importance sampling ({per_cent})", lambda risk: chance_range(risk.weighted)),
        read_only("FORM", form("probability", chance)),
        read_only("reliability index", form("index", engineering), rank=1),
        read_only(
            f"factor at {p}, plain", lambda risk: factor_interval(risk.quantile_sampled), rank=4
        ),
        read_only(
            "factor, importance", lambda risk: factor_interval(risk.quantile_weighted), rank=3
        ),
        read_only(
            "factor, FORM", form("quantile", lambda x: engineering(x, PROBABILITY_DIGITS)), rank=2
        ),
    ]
    return Table("ways", columns, reliability.risks)


def _by_errors(probabilities: ByErrors | None) -> str:
    if probabilities is None:
        return DASH
    return f"{error_range(probabilities)} (stress {change(probabilities)})"


def error_range(probabilities: ByErrors) -> str:
    """Return the probabilities at both ends of an error; only an upper bound if nothing fails at
    either.
    """
    if probabilities.higher.value <= 0.0:
        return chance_range(probabilities.higher)
    return f"{chance(probabilities.lower.value)} to {chance(probabilities.higher.value)}"


def change(probabilities: ByErrors) -> str:
    """Return the relative change of the stresses as text."""
    least, most = 100.0 * probabilities.least, 100.0 * probabilities.most
    if least == -most:
        return f"±{most:.2g} %"
    return f"{least:+.2g} to {most:+.2g} %".replace("-", "−")


def drivers_table(reliability: Reliability) -> Table[DriverRow]:
    """Return the table for people of the parameters that matter to each row, the most important
    first.
    """
    rows = [
        DriverRow(risk, driver)
        for risk in reliability.risks
        for driver in sorted(risk.drivers, key=lambda d: -(d.importance or 0.0))
        if driver.importance is not None or driver.first is not None
    ]
    return Table("drivers", DRIVER_COLUMNS, rows)


def _per_cent(value: float | None) -> str:
    return DASH if value is None else f"{100.0 * value:.1f} %"


def _share(value: Spread | None) -> str:
    return DASH if value is None else f"{value.value:.2f} ± {0.5 * (value.high - value.low):.2f}"
