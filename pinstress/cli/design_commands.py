"""The options of the commands `sweep` and `reliability`."""

from __future__ import annotations

from pathlib import Path

import click

from pinstress.cli.shared import choices, example, read_study


@click.command(
    short_help="Solve many designs: the numbers of a study that vary.",
    help=example("pinstress sweep study.toml --out out/designs --jobs 4")
    + "\nSolve the designs that the study's [vary] describes: a grid, a Sobol sequence, a Latin "
    "hypercube or a random sample of any of its numbers. Writes designs.parquet, a row for each "
    "design, pin and case, and a page to explore them; a design that fails is a row with its "
    "reason.\n\n"
    "A sweep that was interrupted or killed goes on with --resume; one of a Sobol sequence or a "
    "random sample also to a larger count.\n\n"
    "Exit status: 0 done; 1 done, but every design failed; 2 bad input; 130 interrupted.",
)
@click.argument("study", type=click.Path(path_type=Path))
@click.option("--out", type=click.Path(path_type=Path), help="Output folder [out/<study>-sweep].")
@choices
@click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="Solve on an existing Dask cluster, tcp://host:8786, instead of in processes of this "
    "machine, which use no network. Unless dask is configured with TLS, whoever reaches a "
    "scheduler or a worker can run code there: start them with --host 127.0.0.1, or on a network "
    "that you trust.",
)
@click.option("--resume", is_flag=True, help="Resume a sweep, or extend it to a larger count.")
@click.option("--open", "opens", is_flag=True, help="Open the page in the browser when done.")
def sweep(
    study: Path,
    out: Path | None,
    pins: list[str] | None,
    cases: list[str] | None,
    jobs: int | None,
    scheduler: str | None,
    resume: bool,
    opens: bool,
    quiet: bool,
) -> int:
    loaded = read_study(study)
    from pinstress.cli.sweep import Way, sweep_and_write

    directory = out or Path("out") / f"{loaded.name}-sweep"
    way = Way(jobs, scheduler, resume, opens, quiet)
    return sweep_and_write(loaded, directory, pins, cases, way)


@click.command(
    short_help="Find the probability that pins fail, and what drives it.",
    help=example("pinstress reliability study.toml --out out/risk")
    + "\nFind the factor of safety as a distribution where numbers of the study are random, as "
    "[vary.parameters] says: its value at a stated probability, the probability of failure with "
    "its confidence interval by sampling, FORM and importance sampling, and what drives it. Keys "
    "in [reliability]. Writes reliability.csv, drivers.csv, reliability.json, reliability.html.\n\n"
    "Exit status: 0 done; 1 done, but it could not be determined whether a probability of failure "
    "is within the allowed one; 2 bad input; 3 the solution failed; 130 interrupted.",
)
@click.argument("study", type=click.Path(path_type=Path))
@click.option(
    "--out", type=click.Path(path_type=Path), help="Output folder [out/<study name>-reliability]."
)
@choices
def reliability(
    study: Path,
    out: Path | None,
    pins: list[str] | None,
    cases: list[str] | None,
    jobs: int | None,
    quiet: bool,
) -> int:
    loaded = read_study(study)
    from pinstress.cli.reliability import reliability_and_write

    directory = out or Path("out") / f"{loaded.name}-reliability"
    return reliability_and_write(loaded, directory, pins, cases, jobs, quiet)
