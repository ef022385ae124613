"""The `chart` command, which solves all meshes, writes the output folder and prints the table."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from pinbase.platform import portable
from pinstress.cli.output_folder import replacing, require_replaceable
from pinstress.cli.plots import draw_into, report_missing
from pinstress.cli.run import console, progress_bar
from pinstress.cli.shared import say
from pinstress.cli.streams import unneeded
from pinstress.explore.chart.chart import ChartPlan, chart, plan_chart
from pinstress.explore.chart.measured_process import MeasureLimits, measure
from pinstress.study.reading.choices import require_positive
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study
from reports.data.chart import CHART_NAME, Chart
from reports.format.file_names import plot_name
from reports.format.numbers import percent
from reports.plots.chart import chart_plot
from reports.tables.chart import chart_table
from reports.text.chart_summary import print_chart

CHART_CSV = f"{CHART_NAME}.csv"
CALCULIX_TAKES_LONG = (
    "CalculiX solves contact in three dimensions on three meshes, which takes minutes; one that "
    "takes longer than --time-limit fails."
)


def chart_and_write(
    study: Study,
    pin: str,
    case: str,
    out: Path | None,
    tolerance: float | None,
    meshes: int | None,
    runs: int,
    limits: MeasureLimits,
    calculix: bool = False,
    quiet: bool = False,
) -> int:
    """Chart a pin into a folder and return the exit status.

    calculix: whether CalculiX also solves the pin. quiet: without progress and notes.

    Raises: InputError, ArithmeticError.
    """
    if portable():
        raise InputError(
            "chart measures the memory of processes, which works on Linux only", code="linux-only"
        )
    directory = out or Path("out") / plot_name(f"{study.name}-{CHART_NAME}", pin, case)
    require_replaceable(directory, CHART_CSV)
    require_positive("time_limit", limits.seconds, endless=True)
    require_positive("memory_limit", limits.memory, endless=True)
    with replacing(directory, CHART_CSV) as staging:
        plan = plan_chart(study, pin, case, tolerance)
        if calculix:
            _require_contact(plan)
            if not quiet:
                say(CALCULIX_TAKES_LONG)
        with progress_bar(quiet=quiet) as progress:
            result = chart(plan, partial(measure, limits=limits), meshes, runs, progress, calculix)
        chart_table(result).write(staging)
        failed = draw_into(staging, chart_plot(result))
    with unneeded(directory):
        print_chart(result, console())
    if not quiet:
        name = CHART_CSV if failed else f"{CHART_NAME}.svg"
        say(f"Chart: {directory / name}")
    return max(report_missing(failed), _report_missed(result))


def _require_contact(plan: ChartPlan) -> None:
    """Raise InputError for a pin that is not in contact."""
    if plan.chosen is None:
        raise InputError(
            "--second-opinion ccx: charts include CalculiX only for pins in contact with their "
            "lugs; for others use pinstress run --second-opinion ccx",
            code="no-contact",
        )


def _report_missed(result: Chart) -> int:
    tolerance, reference = percent(result.tolerance), result.reference.error
    if reference > result.tolerance:
        say(
            f"Not decided: the reference itself has an error of {percent(reference)}, which "
            f"exceeds the tolerance of {tolerance}."
        )
        return 1
    errors = [p.error for p in result.points if p.error is not None]
    if not any(error <= result.tolerance for error in errors):
        say(f"Not converged: no mesh is within the tolerance of {tolerance}.")
        return 1
    return 0
