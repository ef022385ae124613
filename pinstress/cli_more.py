"""The commands beside the pipeline: init, schema, size, view, completion."""

from __future__ import annotations

from pathlib import Path

import click

from pinstress.command import example, names
from pinstress.errors import InputError


@click.command(
    help=example("pinstress init trial")
    + "\nWrite a small commented study, one_pin.toml, that runs as it is."
)
@click.argument("directory", type=click.Path(path_type=Path, file_okay=False), default=Path("."))
@click.option("--open", "opens", is_flag=True, help="Run it at once and open the report.")
def init(directory: Path, opens: bool) -> int:
    from pinstress.studies import shipped

    target = directory / "one_pin.toml"
    if target.exists():
        raise InputError(f"{target} exists already; name another folder")
    try:
        directory.mkdir(parents=True, exist_ok=True)
        target.write_text(shipped("one_pin.toml").read_text(encoding="utf-8"), encoding="utf-8")
    except OSError as error:
        raise InputError(f"{target}: cannot be written ({error.strerror})") from None
    click.echo(str(target))
    out = Path("out") / target.stem
    if not opens:
        click.echo(f"Next: pinstress run {target}  (its report: {out / 'report.html'})", err=True)
        return 0
    from pinstress.study import load_study
    from pinstress.write import Wanted, run_and_write

    return run_and_write(load_study(target), out, Wanted(opens=True))


@click.command(
    help=example("pinstress schema > study.schema.json")
    + "\nPrint the JSON Schema of the study file, for editors."
)
def schema() -> None:
    import json

    from pinstress.schema import StudyTable

    made = StudyTable.model_json_schema()
    made["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    click.echo(json.dumps(made, indent=2))


@click.command(
    help=example("pinstress view out/grenier2008 --pin B --case landing")
    + "\nShow a pin of an earlier run in a window: its von Mises stress at the governing instant. "
    "Without --pin and --case the one with the lowest factor of safety."
)
@click.argument("results", type=click.Path(path_type=Path))
@click.option("--pin", metavar="NAME", help="The pin.")
@click.option("--case", metavar="NAME", help="The case.")
@click.option(
    "--screenshot",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="Write a picture (.png) instead of opening a window: needs no display.",
)
def view(results: Path, pin: str | None, case: str | None, screenshot: Path | None) -> None:
    from pinstress.write_view import view as show

    show(results, pin, case, screenshot)


@click.command(
    help=example("pinstress completion bash >> ~/.bashrc")
    + "\nPrint a script that has the shell complete commands, options and file names; for zsh it "
    "goes into ~/.zshrc, for fish into ~/.config/fish/completions/pinstress.fish."
)
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
@click.pass_context
def completion(context: click.Context, shell: str) -> None:
    from click.shell_completion import get_completion_class

    found, root = get_completion_class(shell), context.find_root().command
    assert found is not None
    click.echo(found(root, {}, "pinstress", "_PINSTRESS_COMPLETE").source())


@click.command(
    help=example("pinstress size studies/one_pin.toml --fos 10 --step 0.125")
    + "\nThe smallest diameters of every pin that reach a factor of safety in all cases, and a new "
    "study file with them. A pin keeps its lengths and its proportions across the axis (diameters, "
    "bores, fillets). The new study is run before it is written.\n\n"
    "Exit status: 0 done; 1 done, but a pin does not reach the factor as a value; 2 bad input; "
    "3 the numerics failed; 130 interrupted."
)
@click.argument("study", type=click.Path(path_type=Path))
@click.option(
    "--fos",
    type=click.FloatRange(0.0, min_open=True),
    help="The factor to reach, instead of the study's required_safety_factor.",
)
@click.option("--pins", callback=names, metavar="A,B", help="These pins only.")
@click.option(
    "--step",
    metavar="LENGTH",
    help='Round diameters up to multiples of this, in the study\'s unit or its own ("1 mm").',
)
@click.option(
    "--out",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="The new study [beside the study: <its name>_sized.toml].",
)
@click.option("--quiet", is_flag=True, help="No progress and no notes; what failed is still said.")
@click.option("--jobs", type=click.IntRange(1), metavar="N", help="So many pins at a time.")
def size(
    study: Path,
    fos: float | None,
    pins: list[str] | None,
    step: str | None,
    out: Path | None,
    quiet: bool,
    jobs: int | None,
) -> int:
    from pinstress.study import load_study
    from pinstress.units import to_si

    loaded = load_study(study)
    try:
        metres = None if step is None else to_si(step, "length", loaded.system)
    except ValueError as error:
        raise InputError(f"--step: {error}") from None
    if metres is not None and metres <= 0.0:
        raise InputError("--step: must be positive")
    from pinstress.write_size import size_and_write

    return size_and_write(loaded, fos, out, pins, metres, quiet, jobs)
