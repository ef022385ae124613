"""The `reliability` command, which samples the designs, writes the output folder and prints the
table.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from assess.judgement import DEPENDS, NOT_DECIDED
from pinbase.processes.apart import Failed
from pinbase.processes.pool import preload, processes
from pinstress.analysis.plan import prepare
from pinstress.analysis.results import run
from pinstress.cli.output_folder import replacing, require_replaceable
from pinstress.cli.plots import images, report_missing
from pinstress.cli.run import RUN_LIBRARIES, RUN_MODELS, console, progress_bar
from pinstress.cli.shared import connected, say
from pinstress.cli.streams import unneeded
from pinstress.explore.reliability.assess import assess
from pinstress.explore.reliability.designs import for_values, random_numbers
from pinstress.study.model.hardened import require_strengths
from pinstress.study.reading.file import Study
from reports.data.reliability import Reliability
from reports.page.reliability import distribution_plots, write_reliability_page
from reports.tables.reliability import write_reliability
from reports.text.reliability import name, print_reliability

if TYPE_CHECKING:
    from pinstress.explore.sweep.connection import ClusterConnection

RELIABILITY_JSON = "reliability.json"
RELIABILITY_PAGE = "reliability.html"


def reliability_and_write(
    study: Study,
    directory: Path,
    pins: list[str] | None,
    cases: list[str] | None,
    jobs: int | None,
    connection: ClusterConnection | None,
    quiet: bool,
) -> int:
    """Assess a study into a folder and return the exit status.

    The status is 1 if, for any row, it could not be determined whether the probability of failure
    is within the allowed one, or if it is only without the stress beneath contact, what the study
    leaves open, or a pin that comes loose.

    jobs: number of processes on this machine.
    connection: to a cluster that solves the samples instead; the study as it is, and the steps of
    FORM, are solved here.

    Raises: InputError.
    """
    require_replaceable(directory, RELIABILITY_JSON)
    most = processes(jobs)
    study = for_values(study)
    random_numbers(study)  # report mistakes there, and of a cluster, before any stress is solved
    with replacing(directory, RELIABILITY_JSON) as staging:
        todo = prepare(study, pins=pins, cases=cases).tasks
        require_strengths(study, (task.pin.name for task in todo))
        if connection is not None:
            from pinstress.explore.sweep.scheduler import require_cluster

            require_cluster(connection)
        with progress_bar(alone=most == 1, quiet=quiet) as progress:
            preload(*RUN_LIBRARIES, *RUN_MODELS)
            progress("the study as it is", 0.0)
            nominal = run(study, pins=pins, cases=cases, jobs=most)
            with connected(connection) as cluster:
                assessment = assess(study, nominal, most, progress, pins, cases, cluster)
        write_reliability(assessment, staging)
        failed: dict[str, Failed] = {}
        shown = images(distribution_plots(assessment), failed)
        write_reliability_page(assessment, shown, staging / RELIABILITY_PAGE)
    with unneeded(directory):
        print_reliability(assessment, console())
    if not quiet:
        say(f"Report: {directory / RELIABILITY_PAGE}")
    return max(report_missing(failed), _status(assessment))


def _status(assessment: Reliability) -> int:
    open_ones = [r for r in assessment.risks if r.result(assessment.probability) == NOT_DECIDED]
    for risk in open_ones:
        say(f"Not decided: {name(risk)}.")
    deep = [r for r in assessment.risks if r.result(assessment.probability) == DEPENDS]
    for risk in deep:
        what = " and ".join(risk.depends_on(assessment.probability))
        say(f"Depends on {what}: {name(risk)}.")
    return int(bool(open_ones or deep))
