"""The command line. Data go to stdout; progress and messages go to stderr.

Numeric libraries are imported inside the commands that need them, so that `check` starts fast.
"""

from __future__ import annotations

import logging
import os
from pathlib import Path
from typing import Any

import click

from pinbase.processes import interrupts
from pinbase.processes.interrupts import EXIT_INTERRUPTED, Unfinished
from pinbase.processes.threads import hold_threads
from pinstress.cli.design_commands import cluster_keys, reliability, sweep
from pinstress.cli.export import export
from pinstress.cli.more_commands import (
    compare_runs,
    completion,
    curve,
    fits,
    import_,
    init,
    materials,
    pdf_of,
    plots,
    schema,
    size,
    view,
)
from pinstress.cli.shared import (
    CASES_OPTION,
    PATH,
    POSITIVE,
    QUIET_OPTION,
    SHARE,
    STUDY,
    Commands,
    WholeNumber,
    choices,
    example,
    open_page,
    output_folder,
    read_chosen,
    read_study,
    say,
    warn,
)
from pinstress.study.reading.choices import ChoiceError, Selection
from pinstress.study.reading.errors import InputError, cannot_write, clipped

PLOTS_HELP = "Also draw plots and pictures as SVG and PNG, as `pinstress plots` does (slower)."
MAX_TIMESTAMP = 253_402_300_799  # the end of the year 9999, the last that Python supports
EPOCH_VARIABLE = "SOURCE_DATE_EPOCH"
EXIT_REACHED, EXIT_NOT_REACHED, EXIT_BAD_INPUT, EXIT_NUMERICS_FAILED = 0, 1, 2, 3


def run_command_line(arguments: list[str]) -> int:
    """Run the command line and return its exit status.

    The status is 0 when done, 1 when done but a requested result was not reached, 2 for bad input,
    3 when the solution failed, 130 when interrupted.
    """
    interrupts.listen()
    try:
        status = commands.main(arguments, prog_name="pinstress", standalone_mode=False)
        return int(status or EXIT_REACHED)
    except BaseException as error:
        ended = EXIT_INTERRUPTED if interrupts.came() else _status(error)
        if ended is None:
            raise
        if ended == EXIT_INTERRUPTED:
            why = error.__cause__ or error  # click wraps the error in its own
            left = str(why) if isinstance(why, Unfinished) else interrupts.left()
            say(f"Interrupted; {left}.")
        return ended
    finally:
        interrupts.forget()


def _status(error: BaseException) -> int | None:
    """Report the error that ended a command. Return its exit status, or None for a programming
    error.
    """
    match error:
        case click.exceptions.NoArgsIsHelpError():
            error.show()  # the help itself, whole
            return EXIT_BAD_INPUT
        case click.ClickException():
            short = clipped(message := error.format_message())
            (error if message == short else click.ClickException(short)).show()
            return EXIT_BAD_INPUT
        case InputError():
            about = error.of_option if isinstance(error, ChoiceError) else error
            say(f"Error: {about}")
            return EXIT_BAD_INPUT
        case ArithmeticError():  # MeshError, SolveError and what numpy raises
            say(f"Error: the solution failed: {error}")
            return EXIT_NUMERICS_FAILED
        case MemoryError():
            say("Error: the solution failed: out of memory; a larger --tolerance needs less")
            return EXIT_NUMERICS_FAILED
        case KeyboardInterrupt() | click.Abort():
            return EXIT_INTERRUPTED
    return None


@click.group(
    cls=Commands,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="A first run: pinstress init trial && pinstress run trial/pin_in_lugs.toml",
)
@click.version_option(package_name="pinstress")
def commands() -> None:
    """Stresses and safety factors of the pins of a linkage."""
    _settle_environment()


def _settle_environment() -> None:
    """Set environment variables so that the user's environment does not change how libraries run.

    Numeric libraries get one thread each, and plots no windows. Pydantic gets no plugins, for which
    it would search all installed packages. An invalid SOURCE_DATE_EPOCH is removed, because
    libraries fail on it at import (our files contain no time). A COLUMNS of zero, which terminals
    of unknown size set, is removed, because rich prints no table in that width. Matplotlib is
    imported for its colours only, so its warning that it has no folder for fonts is suppressed.
    """
    hold_threads()
    if not os.environ.get("COLUMNS", "").strip("0"):
        os.environ.pop("COLUMNS", None)
    os.environ["MPLBACKEND"] = "agg"
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    os.environ["PYDANTIC_DISABLE_PLUGINS"] = "__all__"
    stated = os.environ.get(EPOCH_VARIABLE)
    if stated is not None and not (stated.isdecimal() and int(stated[:20]) <= MAX_TIMESTAMP):
        del os.environ[EPOCH_VARIABLE]
        warn(f"{EPOCH_VARIABLE} is not a time in seconds and is ignored.")


@commands.command(
    short_help="Compute forces, stresses and safety factors; write the report.",
    help=example("pinstress run studies/grenier2008.toml --pins B,E --out out/trial")
    + "\nCompute reactions, stresses and safety factors. Prints the safety factor table; writes "
    "tables, VTK files and report.html with its plots.\n\n"
    "Exit status: 0 done; 1 done, but a requested accuracy was not reached, a stated requirement "
    "was not checked, or CalculiX disagrees; 2 bad input; 3 the solution failed; 4 with "
    "--fail-on-miss, where a pin misses its requirements; 130 interrupted.",
)
@STUDY
@output_folder("<study name>")
@choices
@click.option(
    "--model",
    type=click.Choice(["auto", "beam", "harmonic", "solid"]),
    help="Override the study's model.",
)
@click.option(
    "--tolerance", type=SHARE, help="Override the study's tolerance on the maximum stress."
)
@click.option("--plots/--no-pictures", default=False, help=PLOTS_HELP)
@click.option("--pdf", is_flag=True, help="Also write report.pdf, as `pinstress pdf` does.")
@click.option(
    "--vtk",
    type=click.Choice(["model", "surface", "solid", "motion", "none"]),
    default="model",
    show_default=True,
    help="Fields for ParaView. model: the surface of a revolved pin, all of a solid model; "
    "surface: surfaces only; solid: also the interior (large); motion: also a "
    "time series of every motion (large).",
)
@click.option(
    "--memory-limit",
    "memory",
    type=POSITIVE,
    metavar="MB",
    help="Memory limit of one mesh, estimated from its unknowns and loads [80 % of free memory]; "
    "finer ones are not solved. Contact of lugs, checks, pictures and the program itself, 0.2 to "
    "4 GB a process, are not counted.",
)
@click.option(
    "--second-opinion",
    type=click.Choice(["ccx"]),
    help="Solve every row again with CalculiX and compare: on the solid model's mesh; a pin in its "
    "lugs by contact in three dimensions, which takes minutes.",
)
@click.option(
    "--limit-load",
    is_flag=True,
    help="Limit load of every row that yields, however long it takes; without it, each has 20 s of "
    "processor time unless the study asks for it.",
)
@click.option(
    "--sensitivities",
    "sensitive",
    is_flag=True,
    help="Sensitivities of every pin in all cases, not only in its worst one, and in contact too.",
)
@click.option(
    "--fail-on-miss",
    "strict",
    is_flag=True,
    help="Exit with status 4 where a pin fails, or its result depends on a range, a requirement is "
    "missed, or a margin is negative.",
)
@click.option(
    "--junit",
    metavar="FILE",
    type=PATH,
    help="Also write the requirements as JUnit XML, a test case each, for continuous integration.",
)
@click.option(
    "--show-work",
    "work",
    is_flag=True,
    help="Also print the work of every check: formula, numbers, what would pass, what is missing.",
)
@click.option("--no-cache", is_flag=True, help="Solve all pins again; do not reuse cached results.")
@click.option("--json", "as_json", is_flag=True, help="Print results.json instead of the table.")
@click.option("--open", "opens", is_flag=True, help="Open the report in the browser when done.")
def run(
    study: Path, out: Path | None, second_opinion: str | None, no_cache: bool, **options: Any
) -> int:
    if second_opinion is not None:
        _require_calculix()
    loaded = read_chosen(study, options)
    from pinstress.cli.run import OutputOptions, run_and_write

    chosen = {key: options.pop(key) for key in Selection.__annotations__}
    wanted = OutputOptions(second=second_opinion is not None, cached=not no_cache, **options)
    return run_and_write(loaded, out or Path("out") / loaded.name, wanted, **chosen)


def _require_calculix() -> None:
    from assess.opinion.calculix import installed

    if not installed():
        raise InputError(
            "--second-opinion ccx: CalculiX is not installed (no command ccx); on Debian and "
            "Ubuntu: sudo apt-get install --no-install-recommends calculix-ccx",
            code="no-calculix",
        )


@commands.command(
    short_help="Compute the mechanism's forces only, without stresses.",
    help=example("pinstress loads studies/bowman2019.toml")
    + "\nCompute the mechanism only: reactions, drives and motion, with an animation of every case "
    "and report.html.",
)
@STUDY
@output_folder("<study name>-loads")
@CASES_OPTION
@click.option("--plots/--no-pictures", default=False, help=PLOTS_HELP)
@click.option("--quiet", is_flag=True, help="No notes; errors are still reported.")
def loads(study: Path, out: Path | None, **options: Any) -> int:
    loaded = read_chosen(study, options)
    from pinstress.cli.run import loads_and_write

    directory = out or Path("out") / f"{loaded.name}-loads"
    return loads_and_write(loaded, directory, **options)


@commands.command(
    short_help="Chart error against time and memory for all models of a pin.",
    help=example("pinstress chart studies/one_pin.toml --pin B --case landing")
    + "\nChart the error of the maximum stress against time and memory for every model and mesh on "
    "one of your pins. Prints a table; writes chart.csv, chart.svg and chart.png. Each mesh is "
    "solved in its own process; takes about three minutes.\n\n"
    "Exit status: 0 done; 1 done, but no result is within the tolerance, or the reference is not "
    "accurate enough to tell; 2 bad input; 3 the solution failed; 130 interrupted.",
)
@STUDY
@click.option("--pin", required=True, metavar="NAME", help="The pin.")
@click.option("--case", required=True, metavar="NAME", help="The case (all its instants).")
@output_folder("<study>-chart.PIN.CASE")
@click.option("--tolerance", type=SHARE, help="Override the study's tolerance.")
@click.option(
    "--meshes",
    type=WholeNumber(1, 9),
    help="Number of meshes per solid element type [5, or 4 if they get large]; each takes about "
    "twice as long as the previous one.",
)
@click.option(
    "--runs",
    type=WholeNumber(1),
    default=3,
    show_default=True,
    help="Number of runs per mesh; the median time is reported.",
)
@click.option(
    "--time-limit",
    type=POSITIVE,
    default=120.0,
    show_default=True,
    help="Time limit per mesh, s; slower ones are marked as failed. The reference has no limit.",
)
@click.option(
    "--memory-limit", type=POSITIVE, default=4000.0,
    show_default=True, help="Memory limit per mesh, MB above the bare process.",
)  # fmt: skip
@click.option(
    "--second-opinion",
    type=click.Choice(["ccx"]),
    help="For a pin in its lugs: also CalculiX with contact in three dimensions, which takes "
    "minutes.",
)
@QUIET_OPTION
def chart(
    study: Path, time_limit: float, memory_limit: float, second_opinion: str | None, **options: Any
) -> int:
    if second_opinion is not None:
        _require_calculix()
    loaded = read_study(study)
    from pinstress.cli.chart import chart_and_write
    from pinstress.explore.chart.measured_process import MeasureLimits

    limits = MeasureLimits(time_limit, memory_limit)
    calculix = second_opinion is not None
    return chart_and_write(loaded, limits=limits, calculix=calculix, **options)


@commands.command(
    short_help="Validate a study without solving it.",
    help=example("pinstress check studies/grenier2008.toml")
    + "\nRead and validate a study and all its files without solving; print what would be run. "
    "With --open a page draws the linkage with its loads and every pin in its lugs.\n\n"
    "Exit status: 0 done; 1 done, but a pin is unconstrained, or its loads are not in equilibrium; "
    "2 bad input.",
)
@STUDY
@click.option("--open", "opens", is_flag=True, help="Draw a page and open it in the browser.")
@click.option(
    "--out",
    type=PATH,
    help="File of the page, which is then drawn; default with --open out/<study>_check.html.",
)
@click.option("--no-browser", is_flag=True, help="With --open, do not open the page.")
def check(study: Path, opens: bool, out: Path | None, no_browser: bool) -> int:
    from pinstress.cli.check import examine

    loaded = read_study(study)
    x = examine(loaded)
    click.echo("\n".join(x.lines))
    warn(*x.warnings)
    for line in x.unheld:
        say(f"Not decided: {line}.")
    if opens or out is not None:
        from pinstress.cli.check_page import require_page, write_check_page

        page = out or Path("out") / f"{loaded.name}_check.html"
        require_page(page)
        try:
            page.parent.mkdir(parents=True, exist_ok=True)
            write_check_page(loaded, x, page)
        except OSError as error:
            raise cannot_write(page, error) from None
        say(f"Page: {page}")
        if opens and not no_browser:
            open_page(page)
    return EXIT_NOT_REACHED if x.unheld else EXIT_REACHED


for _command in (
    cluster_keys, compare_runs, curve, export, fits, import_, init, materials, pdf_of, plots,
    reliability, schema, size, sweep, view, completion,
):  # fmt: skip
    commands.add_command(_command)
