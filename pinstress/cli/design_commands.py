"""The options of the commands `sweep`, `reliability` and `cluster-keys`."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Any

import click

from pinstress.cli.shared import (
    PATH,
    STUDY,
    choices,
    chosen_connection,
    cluster_choices,
    example,
    output_folder,
    read_chosen,
    say,
)


@click.command(
    short_help="Solve many designs: the numbers of a study that vary.",
    help=example("pinstress sweep study.toml --out out/designs --jobs 4")
    + "\nSolve the designs that the study's [vary] describes: a grid, a Sobol sequence, a Latin "
    "hypercube or a random sample of any of its numbers. Writes designs.parquet, a row for each "
    "design, pin and case, and a page to explore them; a design that fails is a row with its "
    "reason.\n\n"
    "A sweep that was interrupted or killed is continued with --resume; one of a Sobol sequence or "
    "a random sample also to a larger count.\n\n"
    "Exit status: 0 done; 1 done, but every design failed; 2 bad input; 130 interrupted.",
)
@STUDY
@output_folder("<study>-sweep")
@choices
@cluster_choices
@click.option("--resume", is_flag=True, help="Resume a sweep, or extend it to a larger count.")
@click.option("--open", "opens", is_flag=True, help="Open the page in the browser when done.")
def sweep(study: Path, out: Path | None, **options: Any) -> int:
    connection = chosen_connection(options)
    loaded = read_chosen(study, options)
    from pinstress.cli.sweep import SweepOptions, sweep_and_write

    directory = out or Path("out") / f"{loaded.name}-sweep"
    pins, cases = options.pop("pins"), options.pop("cases")
    return sweep_and_write(
        loaded, directory, pins, cases, SweepOptions(connection=connection, **options)
    )


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
@STUDY
@output_folder("<study name>-reliability")
@choices
@cluster_choices
def reliability(study: Path, out: Path | None, **options: Any) -> int:
    connection = chosen_connection(options)
    loaded = read_chosen(study, options)
    from pinstress.cli.reliability import reliability_and_write

    directory = out or Path("out") / f"{loaded.name}-reliability"
    return reliability_and_write(loaded, directory, connection=connection, **options)


@click.command(
    "cluster-keys",
    short_help="Write the keys of an encrypted cluster.",
    help=example("pinstress cluster-keys keys")
    + "\nWrite ca.pem, cert.pem and key.pem into a folder, and print how to start a scheduler and "
    "workers of Dask with them. Whoever has the three files can use the cluster, and nobody else: "
    "copy them to its computers, and keep key.pem secret. The key that signed the certificate is "
    "not kept. Files that exist are never overwritten.\n\n"
    "Exit status: 0 done; 2 bad input.",
)
@click.argument("directory", metavar="DIR", type=PATH)
def cluster_keys(directory: Path) -> None:
    from pinstress.explore.sweep.connection import ClusterConnection
    from pinstress.explore.sweep.keys import write_keys

    keys = write_keys(directory)
    for path in (keys.authority, keys.certificate, keys.key):
        click.echo(str(path))
    address = ClusterConnection("tls://HOST:8786", "HOST", 8786, keys)
    say(
        "Start the cluster, on computers that have these files, and use it:\n"
        f"  {address.scheduler_command}\n"
        f"  {address.worker_command}\n"
        f"  pinstress sweep study.toml --scheduler {address.address} "
        f"--tls {shlex.quote(str(directory))}"
    )
