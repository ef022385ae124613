"""reliability.html: probabilities of failure in one offline file."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from reports.data.reliability import Reliability
from reports.format.template import rendered
from reports.plots.reliability import distribution_plot
from reports.plots.spec import Plot
from reports.tables.column import Column, Table, read_only
from reports.tables.reliability import drivers_table, risks_table, ways_table
from reports.text.reliability import remarks, sentence, solved, ways_title

MAX_DISTRIBUTION_PLOTS = 12
LAW_COLUMNS: list[Column[tuple[str, str]]] = [
    read_only("number", lambda parameter: parameter[0], numeric=False),
    read_only("law", lambda parameter: parameter[1], numeric=False),
]


def distribution_plots(reliability: Reliability) -> list[Plot]:
    """Return the plots of the page, for the rows with the largest probabilities."""
    worst = sorted(reliability.risks, key=lambda risk: -risk.most)[:MAX_DISTRIBUTION_PLOTS]
    return [plot for risk in worst if (plot := distribution_plot(reliability, risk))]


def write_reliability_page(
    reliability: Reliability, plots: Iterable[tuple[Plot, str]], path: Path
) -> None:
    """Write reliability.html. plots: each with its drawing as SVG."""
    laws = Table("laws", LAW_COLUMNS, reliability.parameters)
    text = rendered(
        "reliability.html.j2",
        reliability=reliability,
        sentence=sentence(reliability, reliability.risks[0]) if reliability.risks else "",
        sections=[
            ("Pins and cases", risks_table(reliability).grid()),
            (ways_title(reliability), ways_table(reliability).grid()),
            ("What drives it", drivers_table(reliability).grid()),
            ("Random numbers", laws.grid()),
        ],
        remarks=[*remarks(reliability), solved(reliability)],
        plots=[(image, plot.caption) for plot, image in plots],
    )
    path.write_text(text, encoding="utf-8", newline="\n")
