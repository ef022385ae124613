"""report.html: all results of a run in one file that opens offline; scripts are optional."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from reports.data.decision import worst_first
from reports.data.envelope import detailed_rows
from reports.data.results import Results
from reports.format.file_names import animation_name, drive_names, plot_name
from reports.format.numbers import DASH, engineering, ratio, short, with_decimals_of
from reports.format.packed import deflated
from reports.format.ranges import error_words, factor_range
from reports.format.template import environment
from reports.format.words import BEYOND_YIELD, VERDICT_MEANINGS, verdict_words
from reports.page.factors import (
    change_part,
    envelope_part,
    factor_part,
    fatigue_part,
    limit_part,
    margin_part,
    sensitivity_part,
)
from reports.page.loads import largest_force, load_part, timings
from reports.page.lug_across import draw_across
from reports.page.overview import overview_part
from reports.page.paper import document
from reports.page.pins import pin_parts
from reports.page.pins_reading import SIGNS_NOTE, reading_parts, signs
from reports.page.row_drawing import draw_shape
from reports.page.scripts import script_part
from reports.page.stress_along import stress_along
from reports.plots.all import all_plots
from reports.plots.spec import Plot
from reports.plots.theme import style_sheet
from reports.text.method import METHOD_NOTE

MOTION_PLOTS = "linkage", "bodies", "transmission", "shaking", "ledger"  # kinds of plots


if TYPE_CHECKING:
    from jinja2 import Template

PRINTED_DRAWING_WIDTH = 420.0  # width of a pin's drawing, half a page
SMALL_DRAWING_WIDTH = 350.0  # on the first screen
MAX_PINS_AT_ONCE = 20  # with more pins, their sections are built when they are opened


def write_page(results: Results, directory: Path) -> Path:
    """Write report.html and return its path."""
    path = directory / "report.html"
    path.write_text(render(results, directory), encoding="utf-8", newline="\n")
    return path


def render(results: Results, directory: Path) -> str:
    """Return the page as text.

    directory: the folder of the page, which has the animations.
    """
    from markupsafe import Markup

    shown = detailed_rows(results)
    drawings: dict[str, str] = {
        s.pin: Markup(draw_shape(s, shown) + draw_across(shown, s, stress_along(shown, s)))
        for s in shown.shapes
    }
    printed = {s.pin: draw_shape(s, shown, PRINTED_DRAWING_WIDTH) for s in shown.shapes}
    pins, plots = pin_parts(shown, drawings), all_plots(shown)

    anchors = {part.pin: part.anchor for part in pins}
    worst = next(iter(worst_first(results)), None)
    of_worst = [s for s in results.shapes if worst and s.pin == worst.pin]
    small = Markup(draw_shape(of_worst[0], shown, SMALL_DRAWING_WIDTH)) if of_worst else ""

    overview = overview_part(results, anchors, small) if results.pins else None

    def plot(kind: str, *names: str) -> Plot | None:
        return plots.get(plot_name(kind, *names))

    return _template().render(
        results=shown,
        units=shown.units,
        overview=overview,
        largest=largest_force(results) if results.reactions else "No pin was solved.",
        factors=factor_part(shown),
        envelope=envelope_part(results),
        margins=margin_part(shown),
        change=change_part(shown),
        sensitivities=sensitivity_part(shown),
        limits=limit_part(shown),
        fatigue=fatigue_part(shown),
        pins=pins,
        pin_reading=reading_parts(shown),
        signs=Markup(signs()),
        signs_note=SIGNS_NOTE,
        deferred=len(pins) > MAX_PINS_AT_ONCE,
        anchors=anchors,
        plot=plot,
        motion=motion_parts(shown, plots, directory),
        loads=load_part(shown, results),
        timings=timings(results),
        scripts=script_part(plots, document(results, printed, overview)),
    )


def _template() -> Template:
    """Return the template of the page, with the functions that its parts use."""
    templates = environment()
    templates.filters.update(
        eng=engineering,
        short=lambda value: DASH if value is None else short(value),
        with_decimals_of=with_decimals_of,
        ratio=ratio,
        error=error_words,
        factor=factor_range,
        verdict=verdict_words,
    )
    templates.globals.update(
        beyond=BEYOND_YIELD,
        meaning=VERDICT_MEANINGS,
        method=METHOD_NOTE,
        drive_names=drive_names,
        shades=style_sheet(),
    )
    return templates.get_template("report.html.j2")


@dataclass(frozen=True)
class MotionPart:
    """A motion: its animation as a compressed HTML page (or empty), and its plots."""

    case: str
    animation: str
    plots: tuple[Plot, ...]


def motion_parts(results: Results, plots: Mapping[str, Plot], directory: Path) -> list[MotionPart]:
    """Return the cases with plots or an animation, which is read from the folder of the page."""

    def belongs(name: str, case: str) -> bool:
        kind = name.partition(".")[0]  # of several plots of bodies: bodies-2
        return kind.partition("-")[0] in MOTION_PLOTS and name == plot_name(kind, case)

    parts = [
        MotionPart(
            case,
            _animation(case, directory),
            tuple(plot for name, plot in plots.items() if belongs(name, case)),
        )
        for case in dict.fromkeys(s.case for s in results.skeletons)
    ]
    return [part for part in parts if part.plots or part.animation]


def _animation(case: str, directory: Path) -> str:
    path = directory / animation_name(case)
    return deflated(path.read_bytes()) if path.is_file() else ""
