"""Margins of safety, as rows and for display."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace

from assess.margin import RATIO_DIMENSION, Margin, PinMargin
from assess.strength.bending_arms import BendingArms
from pinbase.keys import lug_key, names_in
from reports.data.governing import governing, skipped
from reports.data.requirements import keys_in
from reports.data.results import Results
from reports.data.row import PinResult, Units
from reports.format.numbers import DASH, engineering, margin_text, short
from reports.format.ranges import used_text
from reports.format.units import unit_name
from reports.format.work_words import passing_text, work_text
from reports.tables.column import Column, Table, fields, headed, in_order, or_dash, read_only, texts

MARGIN_COLUMN_ORDER = "pin case method margin utilisation level at time demand allowable clause"
STRENGTH_SUFFIX = "_strength"  # end of the keys of strengths of materials
MARGINS_NOTE = (
    "Margin of safety = allowable / (factor × demand) − 1, of the check that governs each pin in "
    "each case beside the von Mises stress against yield, which the safety factors above judge. "
    "Checks against yield are made at limit load, those against rupture and collapse at "
    "ultimate load; all checks of a pin are with the pin, and in margins.csv. Bending and shear of "
    "a pin whose joint was solved take the moments and forces of the joint model, unless the study "
    "asks for those of the formulas; checks for comparison govern nothing."
)
BENDING_ARMS_NOTE = (
    "The largest bending moment along the pin, with the force of each link even over its band, "
    "as EN 1993-1-8 takes it, and concentrated at the band's middle, next to that of the joint "
    "model. Above 1, the formula is conservative."
)


@dataclass(frozen=True)
class MarginRow:
    """A margin of a pin in a case, with the units of the results."""

    pin: str
    case: str
    margin: Margin
    units: Units

    @property
    def unit(self) -> str:
        """The unit of demand and allowable."""
        dimension = self.margin.dimension
        return dimension if dimension == RATIO_DIMENSION else unit_name(dimension, self.units)

    def with_unit(self, value: float | None) -> str:
        """Return a demand or an allowable with its unit, for people."""
        unit = "" if self.unit == RATIO_DIMENSION else f" {self.unit}"
        return f"{engineering(value)}{unit}"


@dataclass(frozen=True)
class ArmsRow:
    """Bending moments of a pin in a case, with the units of the results."""

    arms: BendingArms
    units: Units


def _dimension(row: MarginRow) -> str:
    return row.margin.dimension


COLUMNS: list[Column[MarginRow]] = [
    *texts("pin"),
    *texts("case", show=or_dash),
    Column("method", lambda row: row.margin.method, "", "check",
           lambda row: row.margin.shown, numeric=False),
    *texts("margin.clause", rank=3),
    *texts("margin.at", show=or_dash, rank=2, drop_if_empty=True),
    Column("level", lambda row: row.margin.level, "", "loads",
           lambda row: f"{row.margin.level}\u00a0×\u00a0{short(row.margin.factor)}",
           numeric=False, rank=1),
    Column("demand", lambda row: row.margin.demand, _dimension, "demand",
           lambda row: row.with_unit(row.margin.demand)),
    Column("allowable", lambda row: row.margin.allowable, _dimension, "allowable",
           lambda row: row.with_unit(row.margin.allowable)),
    *fields("margin.factor"),
    *headed("margin.utilisation", text=lambda row: _per_cent(row.margin.utilisation)),
    *headed("margin.margin", show=margin_text),
    *fields("unit"),
    *headed("margin.time", "time", drop_if_empty=True),
    *fields("margin.basis"),
    Column("not_made", lambda row: f"needs {row.margin.needs}" if row.margin.needs else ""),
    *fields("margin.governs margin.code"),
    Column("work", lambda row: work_text(row.margin, row.units)),
    Column("would_pass", lambda row: passing_text(row.margin, row.units)),
    *fields("margin.scatter not_covered=margin.omits margin.over_joint"),
]  # fmt: skip
ARM_COLUMNS: list[Column[ArmsRow]] = [
    *texts("arms.pin arms.case"),
    *fields("arms.time", "time"),
    *texts("arms.layout"),
    *fields("moment_even=arms.even", "moment", heading="even"),
    *fields("moment_concentrated=arms.concentrated", "moment", heading="concentrated"),
    *fields("moment_joint=arms.joint", "moment", heading="joint model"),
    *fields("joint_model=arms.model"),
    Column("moment_unit", lambda row: unit_name("moment", row.units)),
    read_only("even / model", lambda row: _over_joint(row, row.arms.even)),
    read_only("concentrated / model", lambda row: _over_joint(row, row.arms.concentrated)),
]


def _rows(margins: Iterable[PinMargin], results: Results) -> list[MarginRow]:
    return [MarginRow(m.pin, m.case, m.margin, results.units) for m in margins]


def margins_table(results: Results) -> Table[MarginRow]:
    """Return a row for every check of every pin and case, with all digits."""
    return Table("margins", COLUMNS, _rows(results.margins, results))


def _shown(
    margins: Iterable[PinMargin], results: Results, without: Collection[str]
) -> Table[MarginRow]:
    columns = [c for c in in_order(COLUMNS, MARGIN_COLUMN_ORDER) if c.key not in without]
    return Table("margins", columns, _rows(margins, results))


def governing_table(results: Results) -> Table[MarginRow]:
    """Return the governing check of every pin and case, the worst first, for people."""
    return _shown(governing(results), results, without=("clause",))


def pin_margins(results: Results, pin: PinResult) -> Table[MarginRow]:
    """Return all checks that were made for a row, the worst first, those for comparison last."""
    margins = [margin for margin in pin.worst if margin.used >= 0.0]
    margins.sort(key=lambda margin: (not margin.governs, -margin.rank))
    rows = (PinMargin(pin.pin, pin.case, margin) for margin in margins)
    return _shown(rows, results, without=("pin", "case"))


def not_made_words(results: Results) -> list[str]:
    """Return a line for each datum that the study lacks, with the checks that need it."""
    pins = {p.pin for p in results.pins}
    lines = []
    for needs, of in skipped(results).items():
        named = list(dict.fromkeys(m.pin for m in of))
        where = (
            "" if len(named) == len(pins) else f" (pin{'s' * (len(named) > 1)} {', '.join(named)})"
        )
        methods = "; ".join(dict.fromkeys(m.margin.method for m in of))
        lines.append(f"Skipped{where}, {needs} missing: {methods}.")
    return lines


def not_made_briefly(results: Results) -> str:
    """Return the missing data as clauses, without the checks; empty if all checks were made.

    Materials are named with the data that they lack; lugs are counted.
    """
    materials: dict[str, dict[str, None]] = {}
    lugs: dict[str, dict[str, str]] = {}  # names by key of the lug, by missing datum
    others: dict[str, None] = {}
    for needs in skipped(results):
        keys = keys_in(needs)
        parts = [names_in(key) for key in keys]
        if not all(x[:1] == ["material"] or x[:3:2] == ["pin", "lug"] for x in parts):
            others |= dict.fromkeys(keys)
            continue
        for first, owner, *rest in parts:
            if first == "material":
                materials.setdefault(owner, {})[".".join(rest)] = None
            else:
                _, lug, *table = rest
                lugs.setdefault(".".join(table), {})[lug_key(owner, lug)] = lug
    clauses = [f"{owner} lacks {_joined(lacking)}" for owner, lacking in materials.items()]
    for name, owners in lugs.items():
        first, *more = owners.values()
        who = f"{len(owners)} lugs lack" if more else f"lug {first} lacks"
        clauses.append(f"{who} {name}")
    return "; ".join([*clauses, *([f"missing {', '.join(others)}"] if others else [])])


def _joined(keys: Collection[str]) -> str:
    """Return the keys as a list; the word "strength" appears once for several strengths."""
    strengths = [key.removesuffix(STRENGTH_SUFFIX) for key in keys if key.endswith(STRENGTH_SUFFIX)]
    if len(strengths) < 2:
        return ", ".join(keys)
    others = [key for key in keys if not key.endswith(STRENGTH_SUFFIX)]
    return ", ".join([*others, *strengths]) + " strength"


def arms_table(results: Results) -> Table[ArmsRow]:
    """Return the bending moments of formulas and models, with all digits."""
    rows = [ArmsRow(arms, results.units) for arms in results.arms]
    return Table("bending_arms", ARM_COLUMNS, rows)


def shown_arms(results: Results) -> Table[ArmsRow]:
    """Return the bending moments of the pins whose joint model has one, for people."""
    table = arms_table(results)
    return replace(table, rows=[row for row in table.rows if row.arms.joint])


def _over_joint(row: ArmsRow, moment: float) -> str:
    return engineering(moment / row.arms.joint, 3) if row.arms.joint else DASH


def _per_cent(used: float | None) -> str:
    return f"{DASH} %" if used is None else used_text(used)
