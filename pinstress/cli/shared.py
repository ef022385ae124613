"""Helpers shared by the commands."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Container, Iterator
from contextlib import contextmanager
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from pinbase.counted import counted
from pinbase.processes import interrupts
from pinbase.processes.interrupts import Unfinished
from pinstress.study.reading.errors import InputError
from pinstress.study.schema.units import NUMBER_PATTERN

if TYPE_CHECKING:
    from pinstress.explore.sweep.cluster import Cluster
    from pinstress.explore.sweep.connection import ClusterConnection
    from pinstress.study.reading.file import Study

    _ParamType = click.ParamType[Any]
else:
    _ParamType = click.ParamType  # in older clicks it is not generic

Command = TypeVar("Command", bound=Callable[..., object])


def example(text: str) -> str:
    """Return the first line of a help text: an example that click does not wrap."""
    return f"\b\nExample: {text}\n"


def names(_: click.Context, __: click.Parameter, value: str | None) -> list[str] | None:
    """Convert the text A,B to a list of names."""
    if value is None:
        return None
    entries = [n.strip() for n in value.split(",") if n.strip()]
    if not entries:
        raise click.BadParameter("empty list; write for example A,B")
    return entries


class _InPlainDigits(_ParamType):
    """A finite number as studies write it: in the digits 0 to 9, without separators between
    them.
    """

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        text = str(value).strip()
        if not NUMBER_PATTERN.fullmatch(text) or math.isinf(float(text)):
            self.fail(f"{value!r} is not a valid {self.name}.", param, ctx)
        return super().convert(value, param, ctx)


class RealNumber(_InPlainDigits, click.FloatRange):
    name = "number"


class WholeNumber(_InPlainDigits, click.IntRange):
    name = "whole number"


QUOTED = re.compile(r"""(["']).*\1""", re.DOTALL)
PATH = click.Path(path_type=Path)
NEW_FILE = click.Path(path_type=Path, dir_okay=False)
POSITIVE = RealNumber(0.0, min_open=True)
SHARE = RealNumber(0.0, 1.0, min_open=True, max_open=True)
STUDY = click.argument("study", type=PATH)
RESULTS = click.argument("results", type=PATH)
PINS_OPTION = click.option("--pins", metavar="A,B", help="Only these pins.")
CASES_OPTION = click.option("--cases", metavar="X,Y", help="Only these cases.")
JOBS_OPTION = click.option(
    "--jobs",
    type=WholeNumber(1),
    metavar="N",
    help="Number of parallel processes [number of cores]; does not affect the results.",
)
QUIET_OPTION = click.option(
    "--quiet", is_flag=True, help="No progress bar, no notes; errors are still reported."
)


def choices(command: Command) -> Command:
    """Add the options --pins, --cases, --jobs and --quiet to a command that solves pins."""
    return PINS_OPTION(CASES_OPTION(JOBS_OPTION(QUIET_OPTION(command))))


def output_folder(default: str) -> Callable[[Command], Command]:
    """Return the option --out of a command that writes a folder, by default out/<default>."""
    return click.option("--out", type=PATH, help=f"Output folder [out/{default}].")


def cluster_choices(command: Command) -> Command:
    """Add the options for the connection to a cluster: --scheduler, --tls and --insecure."""
    scheduler = click.option(
        "--scheduler",
        metavar="ADDRESS",
        help="Solve on an existing Dask cluster, tls://HOST:8786, instead of in processes of this "
        "machine, which use no network.",
    )
    tls = click.option(
        "--tls",
        metavar="DIR",
        type=PATH,
        help="With --scheduler: the folder that `pinstress cluster-keys` wrote; scheduler and "
        "workers use the same three files.",
    )
    insecure = click.option(
        "--insecure",
        is_flag=True,
        help="With --scheduler: allow a connection beyond this machine that is not encrypted; "
        "whoever reaches it can run code on the cluster.",
    )
    return scheduler(tls(insecure(command)))


def chosen_connection(options: dict[str, Any]) -> ClusterConnection | None:
    """Return the connection to a cluster that the options of a command describe, or None.

    options: those of `cluster_choices` are removed from it.

    Raises: InputError.
    """
    from pinstress.explore.sweep.connection import connection_to

    cluster = {key: options.pop(key) for key in ("scheduler", "tls", "insecure")}
    return connection_to(jobs=options["jobs"], **cluster)


@contextmanager
def connected(connection: ClusterConnection | None) -> Iterator[Cluster | None]:
    """Connect to a cluster, if a connection is given."""
    if connection is None:
        yield None
        return
    from pinstress.explore.sweep.scheduler import cluster_at

    with cluster_at(connection, warn) as it:
        yield it


@contextmanager
def resumable(kept: Callable[[], int], noun: str, plural: str = "") -> Iterator[None]:
    """Tell the user that a command can be resumed, if an error or an interruption ends it.

    kept: returns the number of things, called `noun`, that the command has finished.
    """
    try:
        yield
    except BaseException as error:
        if not (finished := kept()):
            raise
        things = f"{counted(finished, noun, plural)} {'is' if finished == 1 else 'are'}"
        text = f"{things} kept: run the same command with --resume to continue"
        if isinstance(error, KeyboardInterrupt) or interrupts.came():
            raise Unfinished(text) from None
        if isinstance(error, InputError):
            raise InputError(f"{error}\n{text}", code=error.code) from None
        raise


def read_study(path: Path) -> Study:
    """Load a study, and warn about implausible or contradictory numbers.

    Raises: InputError.
    """
    from pinstress.study.model.balance import given_warnings
    from pinstress.study.model.landing import unsprung_warnings
    from pinstress.study.model.load import load_study
    from pinstress.study.model.weights import weight_warnings

    study = load_study(path)
    warnings = (weight_warnings(study), unsprung_warnings(study), given_warnings(study))
    warn(*study.warnings, *chain.from_iterable(warnings))
    return study


def read_chosen(path: Path, options: dict[str, Any]) -> Study:
    """Load a study as `read_study` does.

    options: those of the command; the texts of --pins and --cases are replaced by lists of names.

    Raises: InputError.
    """
    study = read_study(path)
    table = study.table
    for key, known in ("pins", table.pin), ("cases", {**table.case, **table.sequence}):
        if options.get(key) is not None:
            options[key] = names_in(options[key], known)
    return study


def names_in(text: str, known: Container[str]) -> list[str]:
    """Return the names in the text A,B.

    known: names, which may contain commas; other names with commas are in quotes.

    Raises: InputError if a text is both one name and a list of several.
    """
    parts, entries, begin = text.split(","), list[str](), 0
    while begin < len(parts):
        joined = {n: ",".join(parts[begin:n]).strip() for n in range(begin + 1, len(parts) + 1)}
        inner = {n: x[1:-1] for n, x in joined.items() if QUOTED.fullmatch(x)}
        ends = [n for n in joined if joined[n] in known or inner.get(n) in known]
        end = max(ends, default=min(inner, default=begin + 1))
        single = [part.strip() for part in parts[begin:end]]
        if joined[end] in known and len(single) > 1 and all(part in known for part in single):
            several = ",".join(f'"{part}"' for part in single)
            whole = joined[end]
            raise InputError(
                f"{whole} may be one name or {len(single)} names; write '\"{whole}\"' or "
                f"'{several}'",
                code="ambiguous-names",
            )
        entries.append(joined[end] if joined[end] in known else inner.get(end, joined[end]))
        begin = end
    return [entry for entry in entries if entry]


def say(text: str) -> None:
    """Print a line beside the results, on standard error."""
    click.echo(text, err=True)


def warn(*warnings: str) -> None:
    """Print warnings, one line each."""
    for warning in warnings:
        say(f"Warning: {warning}")


def open_page(page: Path) -> None:
    """Open a page in the browser, if there is one."""
    import webbrowser

    if not webbrowser.open(page.resolve().as_uri()):
        say(f"No browser found; open {page} yourself.")


# Commands by purpose, as the help lists them.
COMMAND_SECTIONS = {
    "Studies": ("init", "check", "import", "schema", "fits", "materials"),
    "Analysis": ("run", "loads", "chart", "export"),
    "Designs": ("size", "curve", "sweep", "reliability", "cluster-keys"),
    "Earlier runs": ("view", "compare", "plots", "pdf"),
}


class Commands(click.Group):
    """A group of commands that are listed in sections."""

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the sections, then the commands that are in none of them."""
        names = self.list_commands(ctx)
        wide = max(map(len, names))
        placed = {name for section in COMMAND_SECTIONS.values() for name in section}
        rest = tuple(name for name in names if name not in placed)
        for title, members in {**COMMAND_SECTIONS, "Other": rest}.items():
            rows = [
                (f"{n:{wide}}", self.commands[n].short_help or "") for n in members if n in names
            ]
            if rows:
                with formatter.section(title):
                    formatter.write_dl(rows)
