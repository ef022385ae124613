"""The command line. Data go to stdout, progress and messages to stderr.

The numeric libraries are imported inside the commands that need them: `check` answers at once.
"""

from __future__ import annotations

import signal
from pathlib import Path
from typing import Any

import click

from pinstress.cli_more import completion, init, schema, size, view
from pinstress.command import INTERRUPTS, example, names
from pinstress.errors import InputError
from pinstress.threads import hold_threads

REACHED, NOT_REACHED, BAD_INPUT, NUMERICS_FAILED, INTERRUPTED = 0, 1, 2, 3, 130


def run_command_line(arguments: list[str]) -> int:
    """Exit status of a command: 0 done, 1 something asked for was not reached, 2 bad input, 3 the
    numerics failed, 130 interrupted.
    """
    for each in INTERRUPTS:
        if signal.getsignal(each) != signal.SIG_IGN:  # nohup, or a job in the background
            signal.signal(each, _interrupt)
    try:
        status = commands.main(arguments, prog_name="pinstress", standalone_mode=False)
        return int(status or REACHED)
    except click.ClickException as error:
        error.show()
        return BAD_INPUT
    except InputError as error:
        click.echo(f"Error: {error}", err=True)
        return BAD_INPUT
    except ArithmeticError as error:  # MeshError, SolveError and what numpy raises
        click.echo(f"Error: the numerics failed: {error}", err=True)
        return NUMERICS_FAILED
    except MemoryError:
        click.echo(
            "Error: the numerics failed: out of memory; a larger --tolerance needs less", err=True
        )
        return NUMERICS_FAILED
    except (KeyboardInterrupt, click.Abort):
        click.echo("Interrupted; nothing was written.", err=True)
        return INTERRUPTED
    except BrokenPipeError:
        return REACHED


def _interrupt(*_: object) -> None:
    for each in INTERRUPTS:
        signal.signal(each, signal.SIG_IGN)  # clearing up is not interrupted once more
    raise KeyboardInterrupt


@click.group(
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="A first run: pinstress init trial && pinstress run trial/one_pin.toml",
)
@click.version_option(package_name="pinstress")
def commands() -> None:
    """Stresses and safety factors of the pins of a linkage."""
    hold_threads()


@commands.command(
    help=example("pinstress run studies/grenier2008.toml --pins B,E --out out/trial")
    + "\nThe whole pipeline: reactions, stresses, safety factors. Prints the table and writes "
    "tables, plots, VTK files and report.html.\n\n"
    "Exit status: 0 done; 1 done, but a requested accuracy was not reached or the second opinion "
    "differs; 2 bad input; "
    "3 the numerics failed; 130 interrupted."
)
@click.argument("study", type=click.Path(path_type=Path))
@click.option(
    "--out", type=click.Path(path_type=Path), help="Folder to write [out/<study's name>]."
)
@click.option("--pins", callback=names, metavar="A,B", help="These pins only.")
@click.option("--cases", callback=names, metavar="X,Y", help="These cases only.")
@click.option(
    "--model",
    type=click.Choice(["auto", "beam", "harmonic", "solid"]),
    help="Instead of the study's.",
)
@click.option(
    "--tolerance",
    type=click.FloatRange(0.0, 1.0, min_open=True, max_open=True),
    help="On the maximum stress, instead of the study's.",
)
@click.option("--no-pictures", is_flag=True, help="Neither plots nor rendered pins: faster.")
@click.option(
    "--vtk",
    type=click.Choice(["model", "surface", "solid", "motion", "none"]),
    default="model",
    show_default=True,
    help="Fields for ParaView: as the model has them (the skin of a revolved pin, all of a meshed "
    "solid), skins only, also all of revolved pins (large), also along every motion (large), none.",
)
@click.option(
    "--jobs",
    type=click.IntRange(1),
    metavar="N",
    help="So many processes at a time [as many as there are cores]; the results are the same.",
)
@click.option(
    "--memory-limit",
    type=click.FloatRange(0.0, min_open=True),
    metavar="MB",
    help="What a solid model may take [80 % of what is free]; past it no finer mesh is solved.",
)
@click.option(
    "--second-opinion",
    type=click.Choice(["ccx"]),
    help="Have CalculiX solve every row once more on the solid model's mesh, and compare.",
)
@click.option(
    "--no-cache", is_flag=True, help="Solve every pin anew, also those that were solved before."
)
@click.option("--json", "as_json", is_flag=True, help="Print results.json instead of the table.")
@click.option("--quiet", is_flag=True, help="No progress and no notes; what failed is still said.")
@click.option("--open", "opens", is_flag=True, help="Open the report in the browser at the end.")
def run(
    study: Path,
    out: Path | None,
    pins: list[str] | None,
    cases: list[str] | None,
    model: str | None,
    tolerance: float | None,
    no_pictures: bool,
    vtk: str,
    jobs: int | None,
    memory_limit: float | None,
    second_opinion: str | None,
    no_cache: bool,
    as_json: bool,
    quiet: bool,
    opens: bool,
) -> int:
    if second_opinion is not None:
        _require_calculix()
    from pinstress.study import load_study

    loaded = load_study(study)
    directory = out or Path("out") / loaded.name
    from pinstress.write import Wanted, run_and_write

    second, cached = second_opinion is not None, not no_cache
    wanted = Wanted(not no_pictures, second, vtk, as_json, quiet, opens, jobs, cached)
    chosen: dict[str, Any] = {
        "pins": pins,
        "cases": cases,
        "model": model,
        "tolerance": tolerance,
        "memory": memory_limit,
    }
    return run_and_write(loaded, directory, wanted, **chosen)


def _require_calculix() -> None:
    import shutil

    if shutil.which("ccx") is None:  # as fea.calculix, without waiting for numpy
        raise InputError(
            "--second-opinion ccx: CalculiX is not installed (no command ccx); on Debian and "
            "Ubuntu: sudo apt-get install --no-install-recommends calculix-ccx"
        )


@commands.command(
    help=example("pinstress loads studies/bowman2019.toml")
    + "\nThe mechanism alone: reactions, drives, motion, plots and an animation of every case."
)
@click.argument("study", type=click.Path(path_type=Path))
@click.option(
    "--out", type=click.Path(path_type=Path), help="Folder to write [out/<study's name>-loads]."
)
@click.option("--cases", callback=names, metavar="X,Y", help="These cases only.")
@click.option("--no-pictures", is_flag=True, help="No plots: faster.")
@click.option("--quiet", is_flag=True, help="No notes; what failed is still said.")
def loads(
    study: Path, out: Path | None, cases: list[str] | None, no_pictures: bool, quiet: bool
) -> int:
    from pinstress.study import load_study

    loaded = load_study(study)
    from pinstress.write import loads_and_write

    directory = out or Path("out") / f"{loaded.name}-loads"
    return loads_and_write(loaded, directory, plots=not no_pictures, cases=cases, quiet=quiet)


@commands.command(
    help=example("pinstress chart studies/one_pin.toml --pin B --case landing")
    + "\nHow much time and memory each model and mesh takes for how much error, on your own pin: "
    "chart.csv, chart.svg, chart.png, and a table. Every mesh is solved in its own process; about "
    "three minutes.\n\n"
    "Exit status: 0 done; 1 done, but nothing charted is within the tolerance, or the reference "
    "is not known well enough to say; 2 bad input; 3 the numerics failed; 130 interrupted."
)
@click.argument("study", type=click.Path(path_type=Path))
@click.option("--pin", required=True, metavar="NAME", help="The pin.")
@click.option("--case", required=True, metavar="NAME", help="The case; all its instants count.")
@click.option(
    "--out", type=click.Path(path_type=Path), help="Folder to write [out/<study>-chart.PIN.CASE]."
)
@click.option(
    "--tolerance",
    type=click.FloatRange(0.0, 1.0, min_open=True, max_open=True),
    help="The line to be met, instead of the study's.",
)
@click.option(
    "--meshes",
    type=click.IntRange(1, 9),
    help="Of each solid element [5, or 4 if they get large]; each takes about twice the last.",
)
@click.option(
    "--runs",
    type=click.IntRange(1),
    default=3,
    show_default=True,
    help="Of which times are the median.",
)
@click.option(
    "--time-limit",
    type=click.FloatRange(0.0, min_open=True),
    default=120.0,
    show_default=True,
    help="Of a point's process, s: what passes it is shown as failed; the reference has none.",
)
@click.option(
    "--memory-limit", type=click.FloatRange(0.0, min_open=True), default=4000.0,
    show_default=True, help="The same in MB above the bare process.",
)  # fmt: skip
def chart(
    study: Path,
    pin: str,
    case: str,
    out: Path | None,
    tolerance: float | None,
    meshes: int | None,
    runs: int,
    time_limit: float,
    memory_limit: float,
) -> int:
    from pinstress.study import load_study

    loaded = load_study(study)
    from pinstress.own_process import Limits
    from pinstress.write_chart import chart_and_write

    limits = Limits(time_limit, memory_limit)
    return chart_and_write(loaded, pin, case, out, tolerance, meshes, runs, limits)


@commands.command(
    help=example("pinstress check studies/grenier2008.toml")
    + "\nRead and validate everything without solving; say what would be run."
)
@click.argument("study", type=click.Path(path_type=Path))
def check(study: Path) -> None:
    from pinstress.check import describe
    from pinstress.study import load_study

    click.echo(describe(load_study(study)))


for _command in (init, schema, size, view, completion):
    commands.add_command(_command)
