"""report.html: all results of a run in one file that opens offline; scripts are optional."""

from __future__ import annotations

from pathlib import Path

from reports.animation.player_data import script_json
from reports.data.envelope import in_detail
from reports.data.results import PinShape, Results
from reports.format.file_names import drive_names, plot_name
from reports.format.numbers import DASH, engineering, like, ratio, short
from reports.format.packed import deflated
from reports.format.ranges import error_words, factor_range
from reports.format.template import VENDOR, environment
from reports.format.words import BEYOND, headline, verdict_words
from reports.page.factors import factor_parts
from reports.page.loads import timings
from reports.page.motion import motion_parts
from reports.page.paper import document
from reports.page.pin_drawing import WIDTH, draw_pin
from reports.page.pins import pin_parts, reaction_tables
from reports.plots.all import all_plots
from reports.plots.loads.reactions import WITHOUT
from reports.plots.spec import Plot
from reports.plots.theme import on_page, style_sheet
from reports.tables.loads.drop import drop_words, impulse_grid, peak_grid
from reports.tables.published import published_reactions
from reports.tables.strength.envelope import READING, cell_text, heat, matrix
from reports.tables.strength.fatigue import fatigue_grid, fatigue_sentence, worst_points
from reports.tables.strength.hand_checks import HAND_CHECKS
from reports.tables.strength.landing import NOTE, landing_blocks
from reports.tables.strength.margins import (
    READING_ARMS,
    READING_MARGINS,
    arms_grid,
    governing_grid,
    not_made_words,
)
from reports.tables.stress.singular_zones import circles, pin_zones
from reports.text.method import METHOD
from reports.text.summary import summary

ON_PAPER = 420.0  # width of a pin's drawing, of half a page
LIBRARIES = ("vega.min.js", "vega-lite.min.js", "vega-interpreter.js")


def write_page(results: Results, directory: Path) -> Path:
    """Write report.html and return its path."""
    path = directory / "report.html"
    path.write_text(render(results, directory), encoding="utf-8", newline="\n")
    return path


def render(results: Results, directory: Path) -> str:
    """The page as text; directory: where it will be, with the animations."""
    from markupsafe import Markup

    templates = environment()
    templates.filters.update(
        eng=engineering,
        short=_short,
        like=like,
        error=error_words,
        factor=factor_range,
    )
    template = templates.get_template("report.html.j2")
    everything, results = results, in_detail(results)
    drawings: dict[str, str] = {s.pin: Markup(_drawing(s, results)) for s in results.shapes}
    printed = {s.pin: _drawing(s, results, ON_PAPER) for s in results.shapes}
    parts = pin_parts(results, drawings)
    plots = all_plots(results)

    def plot(kind: str, *names: str) -> Plot | None:
        return plots.get(plot_name(kind, *names))

    return template.render(
        results=results,
        units=results.units,
        headline=headline(everything),
        summary=summary(everything),
        timings=timings(everything),
        program=f"pinstress {results.versions.get('pinstress', '')}",
        beyond=BEYOND,
        verdict_words=verdict_words,
        hand_checks=HAND_CHECKS,
        landing_note=NOTE,
        method=METHOD,
        paper=deflated(script_json(document(everything, printed)).encode()),
        plot=plot,
        without=WITHOUT,
        embedded=lambda shown: script_json(shown.spec),
        libraries=deflated(b"\n".join((VENDOR / name).read_bytes() for name in LIBRARIES)),
        theme=script_json(on_page()),
        shades=style_sheet(),
        drive_names=drive_names,
        drop_words=drop_words,
        peak_grid=peak_grid,
        impulse_grid=impulse_grid,
        ratio=ratio,
        motion=motion_parts(results, plot, directory),
        anchors={part.pin: part.anchor for part in parts},
        timed=any(v.time is not None for v in results.published),
        pins=parts,
        published=published_reactions(results),
        landing=landing_blocks(results),
        landed=list(dict.fromkeys(r.case for r in results.landing)),
        reactions=reaction_tables(results),
        fatigue=fatigue_grid(results),
        fatigue_points=worst_points(results.fatigue) if results.fatigue else [],
        fatigue_sentence=fatigue_sentence(results.fatigue) if results.fatigue else "",
        cases=list(dict.fromkeys(pin.case for pin in results.pins)),
        margins=governing_grid(results),
        margins_not_made=not_made_words(results),
        margins_reading=READING_MARGINS,
        arms=arms_grid(results),
        arms_reading=READING_ARMS,
        envelope=matrix(everything),
        envelope_reading=READING,
        heat=heat,
        cell_text=cell_text,
        **factor_parts(results),
    )


def _drawing(shape: PinShape, results: Results, width: float = WIDTH) -> str:
    zones = pin_zones(results, shape.pin).values()
    return draw_pin(shape, results.units, circles(zone for case in zones for zone in case), width)


def _short(value: float | None) -> str:
    return DASH if value is None else short(value)
