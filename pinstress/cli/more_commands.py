"""The commands other than run, loads, chart and check."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Any
from urllib.parse import quote

import click

from pinstress.cli.shared import (
    JOBS_OPTION,
    NEW_FILE,
    PATH,
    PINS_OPTION,
    POSITIVE,
    QUIET_OPTION,
    RESULTS,
    SHARE,
    STUDY,
    RealNumber,
    WholeNumber,
    chosen_connection,
    cluster_choices,
    example,
    names,
    output_folder,
    read_chosen,
    say,
)
from pinstress.cli.streams import unneeded
from pinstress.study.reading.errors import InputError, cannot_write

JSON_OPTION = click.option("--json", "as_json", is_flag=True, help="Print JSON instead of text.")
NEW_STUDIES = "pin_in_lugs.toml", "one_pin.toml"  # studies that init writes; the first runs first


@click.command(
    short_help="Write small example studies to start from.",
    help=example("pinstress init trial")
    + "\nWrite two small commented studies that run as they are: pin_in_lugs.toml, a clevis pin in "
    "its lugs, and one_pin.toml, a pin that is clamped.",
)
@click.argument("directory", type=click.Path(path_type=Path, file_okay=False), default=Path("."))
@click.option(
    "--open", "opens", is_flag=True, help="Run the first immediately and open the report."
)
def init(directory: Path, opens: bool) -> int:
    from pinstress.cli.new_file import require_new, write_new
    from pinstress.study.reading.shipped import shipped
    from reports.data.changes import as_argument

    target, *_ = targets = [directory / name for name in NEW_STUDIES]
    if directory.suffix == ".toml":  # the user takes the argument for the name of the study
        raise InputError(
            f"{directory}: name a folder; the studies are called {' and '.join(NEW_STUDIES)}",
            code="not-a-folder",
        )
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(target, error) from None
    remedy = "name another folder"
    for path in targets:
        require_new(path, remedy)
    for path in targets:
        write_new(path, shipped(path.name).read_bytes(), remedy)
    with unneeded(target):
        click.echo("\n".join(map(str, targets)))
    out = Path("out") / target.stem
    if not opens:
        study = as_argument(str(target))
        say(f"Next: pinstress run {study}  (writes {out / 'report.html'})")
        return 0
    from pinstress.cli.run import OutputOptions, run_and_write
    from pinstress.study.model.load import load_study

    return run_and_write(load_study(target), out, OutputOptions(opens=True))


@click.command(
    "import",
    short_help="Write the [pin.NAME] of a CAD file as a profile.",
    help=example("pinstress import shaft.step >> study.toml")
    + "\nRecognise the body in a CAD file (STEP, BREP, IGES) as a profile with cross holes and "
    "flats, and print its table for a study; the axis may have any direction.\n\n"
    "Exit status: 0 done; 2 bad input, or a body that is not a turned part; 130 interrupted.",
)
@click.argument("file", type=PATH)
@click.option("--pin", metavar="NAME", help="Name of the pin [the file's].")
@click.option(
    "--material", default="steel", metavar="NAME", show_default=True, help="Its material."
)
@click.option(
    "--unit",
    type=click.Choice(["mm", "cm", "m", "in"]),
    default="mm",
    show_default=True,
    help="Unit of length in the file; STEP files are read in mm, whatever theirs is.",
)
@click.option(
    "--out", type=NEW_FILE, metavar="FILE", help="Write this new file instead of printing."
)
def import_(file: Path, pin: str | None, material: str, unit: str, out: Path | None) -> None:
    from pinstress.cli.new_file import write_new
    from pinstress.study.model.pin_text import imported_text

    text = imported_text(file, pin, unit, material)
    if out is None:
        click.echo(text, nl=False)
    else:
        write_new(out, text.encode(), "name another file")
        say(f"Written: {out}")


@click.command(
    short_help="Print the JSON Schema of the study file.",
    help=example("pinstress schema > study.schema.json")
    + "\nPrint the JSON Schema of the study file, for completion and validation in editors.",
)
def schema() -> None:
    import json

    from pinstress.study.schema.json_schema import editor_schema

    click.echo(json.dumps(editor_schema(), indent=1))


@click.command(
    short_help="Draw the plots of an earlier run as SVG and PNG.",
    help=example("pinstress plots out/grenier2008")
    + "\nDraw the plots of a report as SVG and PNG, and pictures of the pins, into the folder "
    "`plots` of an earlier run or of `pinstress loads`.",
)
@RESULTS
def plots(results: Path) -> int:
    from pinstress.cli.plots import plots as draw

    return draw(results)


@click.command(
    "pdf",
    short_help="Write the report of an earlier run as a PDF.",
    help=example("pinstress pdf out/grenier2008")
    + "\nWrite report.pdf into the folder of an earlier run: title block, contents, safety "
    "factors, what to change, every pin with its plots, loads, and the values with their sources.",
)
@RESULTS
def pdf_of(results: Path) -> int:
    from pinstress.cli.plots import pdf

    return pdf(results)


@click.command(
    "compare",
    short_help="Show what differs between two runs.",
    help=example("pinstress compare out/before out/after --out out/comparison")
    + "\nPrint how the factors of pins changed and which requirements are newly met or lost, then "
    "which inputs of two runs differ, and which maxima, margins and forces changed: beyond their "
    "errors, or within. A and B are folders that `pinstress run` wrote, the older one first; units "
    "may differ.\n\n"
    "Exit status: 0 done; 1 done, but something could not be drawn; 2 bad input; 4 a requirement "
    "that was met no longer is, or is gone.",
)
@click.argument("first", metavar="A", type=PATH)
@click.argument("second", metavar="B", type=PATH)
@click.option(
    "--out", type=PATH, help="Also write comparison.html and comparison.md into this folder."
)
@click.option(
    "--pictures",
    is_flag=True,
    help="With --out: also draw the pins that changed most, side by side (slower).",
)
def compare_runs(first: Path, second: Path, out: Path | None, pictures: bool) -> int:
    from pinstress.cli.compare import compare

    return compare(first, second, out, pictures)


@click.command(
    short_help="Show a pin of an earlier run in a 3D window.",
    help=example("pinstress view out/grenier2008 --pin B --case landing")
    + "\nShow the von Mises stress of a pin of an earlier run at its governing instant, in a "
    "window. Default: the pin and case with the lowest safety factor.",
)
@RESULTS
@click.option("--pin", metavar="NAME", help="The pin.")
@click.option("--case", metavar="NAME", help="The case.")
@click.option(
    "--screenshot",
    type=NEW_FILE,
    metavar="FILE",
    help="Write a picture (.png) instead of opening a window; needs no display.",
)
@click.option("--force", is_flag=True, help="Overwrite FILE if it exists.")
def view(
    results: Path, pin: str | None, case: str | None, screenshot: Path | None, force: bool
) -> int:
    from pinstress.cli.view import view as show

    return show(results, pin, case, screenshot, force)


@click.command(
    short_help="Print a shell completion script.",
    help=example("pinstress completion bash >> ~/.bashrc")
    + "\nPrint a completion script for commands, options and file names. For zsh append it to "
    "~/.zshrc; for fish write it to ~/.config/fish/completions/pinstress.fish.",
)
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
@click.pass_context
def completion(context: click.Context, shell: str) -> None:
    from click.shell_completion import get_completion_class

    completion_class, root = get_completion_class(shell), context.find_root().command
    assert completion_class is not None
    click.echo(completion_class(root, {}, "pinstress", "_PINSTRESS_COMPLETE").source())


@click.command(
    short_help="Find the smallest diameters that reach a safety factor.",
    help=example("pinstress size studies/one_pin.toml --fos 10 --step 0.125")
    + example("pinstress size studies/grenier2008.toml --least-weight")
    + "\nFind the smallest diameters with which every pin reaches a safety factor in all cases; "
    "write a new study with them, each pin as soon as it is sized. Lengths and the weights of "
    "links do not change; diameters, bores and fillets are scaled together, or with --least-weight "
    "independently, so that the pin is as light as it can be. Limits and standard diameters are "
    "stated in [size] of the study. Every size is confirmed as a run solves it.\n\n"
    "A size that was interrupted is continued with --resume.\n\n"
    "Exit status: 0 done; 1 done, but a pin is not shown to reach the factor; 2 bad input; "
    "3 the solution failed; 130 interrupted.",
)
@STUDY
@click.option(
    "--fos",
    type=POSITIVE,
    help="Safety factor to reach; overrides required_safety_factor and [[require]] of the study.",
)
@PINS_OPTION
@cluster_choices
@click.option(
    "--step",
    metavar="LENGTH",
    help="Round diameters up to multiples of this, in study units or with a unit "
    '("1 mm"), instead of the series in [size].',
)
@click.option(
    "--out",
    type=NEW_FILE,
    metavar="FILE",
    help="The new study [<study name>_sized.toml, next to the study].",
)
@QUIET_OPTION
@JOBS_OPTION
@click.option("--resume", is_flag=True, help="Resume a size that did not end.")
@click.option(
    "--over-ranges",
    is_flag=True,
    help="Reach the factor over all ranges of the study, not only as described.",
)
@click.option(
    "--least-weight", is_flag=True, help="Vary every dimension independently: the lightest pins."
)
@click.option(
    "--vary",
    callback=names,
    metavar="KINDS",
    help="With --least-weight: what changes [diameters,bores,fillets].",
)
@click.option(
    "--wall",
    type=RealNumber(0.0, 0.5, min_open=True, max_open=True),
    help="With --least-weight: thinnest wall over the diameter [0.1, or as it is].",
)
@click.option(
    "--shoulder",
    type=RealNumber(1.0, 10.0, min_open=True),
    help="With --least-weight: least ratio of the diameters of a step [1.2, or as it is].",
)
@click.option(
    "--probability",
    type=SHARE,
    help="With --least-weight: of missing the factor, by the laws in [vary.parameters].",
)
def size(
    study: Path,
    fos: float | None,
    step: str | None,
    over_ranges: bool,
    least_weight: bool,
    **options: Any,
) -> int:
    from pinstress.study.schema.units import to_si

    connection = chosen_connection(options)
    loaded = read_chosen(study, options)
    try:
        metres = None if step is None else to_si(step, "length", loaded.system)
    except ValueError as error:
        raise InputError(f"--step: {error}", code="not-a-length") from None
    if metres is not None and metres <= 0.0:
        raise InputError("--step: must be positive", code="not-positive")
    from pinstress.cli.least_weight import LeastWeightOptions, lighten_and_write, weight_goal
    from pinstress.cli.size import SizeOptions, size_and_write, sizing_goal

    least_options = LeastWeightOptions(
        **{field.name: options.pop(field.name) for field in fields(LeastWeightOptions)}
    )
    if least_options.given and not least_weight:
        raise InputError(
            f"{least_options.given[0]} needs --least-weight", code="needs-least-weight"
        )
    if least_weight and connection is not None:
        raise InputError("--scheduler is not for --least-weight", code="contradiction")
    if least_weight and over_ranges:
        raise InputError("--over-ranges is not for --least-weight", code="contradiction")
    goal = sizing_goal(loaded, fos, metres, over_ranges)
    if least_weight:
        aim = weight_goal(goal, least_options, metres)
        return lighten_and_write(loaded, aim, probability=least_options.probability, **options)
    return size_and_write(loaded, goal, SizeOptions(connection=connection, **options))


@click.command(
    "curve",
    short_help="Plot factors of safety against one number of a study.",
    help=example("pinstress curve studies/one_pin.toml pin.B.profile[2].diameter")
    + "\nSolve a study at evenly spaced values of one of its numbers, KEY as in messages and "
    "[vary], and show each pin's smallest factor of safety. Says where the required factor is "
    "reached; writes curve.csv, curve.svg and curve.png.\n\n"
    "Exit status: 0 done; 1 done, but no value has a factor; 2 bad input; 130 interrupted.",
)
@STUDY
@click.argument("key")
@click.option(
    "--from", "first", metavar="VALUE", help="First value [half of that in the study]; 2 or '2 in'."
)
@click.option("--to", "last", metavar="VALUE", help="Last value [twice that in the study].")
@click.option(
    "--points",
    type=WholeNumber(2, 200),
    default=9,
    show_default=True,
    help="Number of values, evenly spaced; the one in the study is added.",
)
@click.option(
    "--pin", "--pins", "pins", metavar="A,B",
    help="Only these pins [that of the key, or all].",
)  # fmt: skip
@output_folder("<study>-curve.KEY")
@JOBS_OPTION
@QUIET_OPTION
def curve(
    study: Path, key: str, out: Path | None, first: str | None, last: str | None, **options: Any
) -> int:
    loaded = read_chosen(study, options)
    from pinstress.cli.curve import curve_and_write, number_or_text

    directory = out or Path("out") / f"{loaded.name}-curve.{quote(key, safe='.[]')}"
    ends = number_or_text(first), number_or_text(last)
    return curve_and_write(loaded, key, ends, out=directory, **options)


@click.command(
    short_help="Print the limits and the clearance of an ISO 286 fit.",
    help=example("pinstress fits 40 H7/f7")
    + "\nPrint the limits of hole and shaft and the least and largest clearance of a fit FIT by "
    "ISO 286-1, at a nominal diameter SIZE in mm, or with its unit ('1.5 in'). A lug has the same "
    'by fit = "H7/f7".',
)
@click.argument("size")
@click.argument("fit")
@JSON_OPTION
def fits(size: str, fit: str, as_json: bool) -> None:
    from pinstress.cli.look_up import fits as look_up

    look_up(size, fit, as_json)


@click.command(
    short_help="List materials with the sources of their values.",
    help=example('pinstress materials "6061-T651"')
    + "\nList the materials that a study may name without defining them, or print one of them, "
    "NAME, as a study would define it, each value with its source.",
)
@click.argument("name", required=False)
@click.option(
    "--materials",
    "file",
    type=PATH,
    metavar="FILE",
    help='Also those of this file, which a study names as materials = "FILE".',
)
@JSON_OPTION
def materials(name: str | None, file: Path | None, as_json: bool) -> None:
    from pinstress.cli.look_up import materials as look_up

    look_up(name, file, as_json)
