"""report.html: all results of a run in one file that opens offline; scripts are optional."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from fea.core.dimensions import Point
from reports.data.results import PinShape, Results
from reports.format.file_names import SVG, drive_names, plot_name
from reports.format.numbers import DASH, components, engineering, like, ratio, short
from reports.format.ranges import error_words, factor_range
from reports.format.template import environment
from reports.format.words import BEYOND, headline, verdict_words
from reports.page.factors import factor_parts
from reports.page.loads import timings
from reports.page.motion import motion_parts
from reports.page.pin_drawing import draw_pin
from reports.page.pins import pin_parts, reaction_tables
from reports.tables.hand_checks import HAND_CHECKS
from reports.tables.landing import NOTE, landing_blocks
from reports.tables.published import published_reactions
from reports.tables.singular_zones import circles, pin_zones
from reports.text.summary import summary

TYPES = {".svg": "image/svg+xml", ".png": "image/png", ".jpg": "image/jpeg"}


@dataclass(frozen=True)
class _Plots:
    """The plots that may be shown, by name."""

    files: dict[str, Path]

    def uri(self, kind: str, *names: str) -> str | None:
        path = self.files.get(plot_name(kind, *names))
        return None if path is None else data_uri(path)


def write_page(
    results: Results,
    directory: Path,
    pictures: dict[tuple[str, str], Path],
    plots: Iterable[Path] | None = None,
) -> Path:
    """Write report.html and return its path.

    pictures: of pins, by pin and case. plots: their files; None for those in directory/plots.
    """
    found = (directory / "plots").glob("*.svg") if plots is None else plots
    path = directory / "report.html"
    files = {p.name.removesuffix(SVG): p for p in found if p.suffix == SVG}
    path.write_text(render(results, pictures, files, directory), encoding="utf-8", newline="\n")
    return path


def render(
    results: Results,
    pictures: dict[tuple[str, str], Path],
    plots: dict[str, Path],
    directory: Path,
) -> str:
    """The page as text; plots by name (reports.format.file_names); directory: where it will be."""
    from markupsafe import Markup

    templates = environment()
    templates.filters.update(
        eng=engineering,
        short=_short,
        like=like,
        error=error_words,
        factor=factor_range,
        place=_place,
    )
    template = templates.get_template("report.html.j2")
    drawings: dict[str, str] = {s.pin: Markup(_drawing(s, results)) for s in results.shapes}
    parts = pin_parts(results, drawings, {k: data_uri(p) for k, p in pictures.items()})
    return template.render(
        results=results,
        units=results.units,
        headline=headline(results),
        summary=summary(results),
        timings=timings(results),
        beyond=BEYOND,
        verdict_words=verdict_words,
        hand_checks=HAND_CHECKS,
        landing_note=NOTE,
        plot=_Plots(plots).uri,
        drive_names=drive_names,
        ratio=ratio,
        motion=motion_parts(results, _Plots(plots).uri, directory),
        anchors={part.pin: part.anchor for part in parts},
        timed=any(v.time is not None for v in results.published),
        pins=parts,
        published=published_reactions(results),
        landing=landing_blocks(results),
        landed=list(dict.fromkeys(r.case for r in results.landing)),
        reactions=reaction_tables(results),
        cases=list(dict.fromkeys(pin.case for pin in results.pins)),
        **factor_parts(results),
    )


def _drawing(shape: PinShape, results: Results) -> str:
    zones = pin_zones(results, shape.pin).values()
    return draw_pin(shape, results.units, circles(zone for case in zones for zone in case))


def data_uri(path: Path) -> str:
    """A picture as a data URI."""
    return f"data:{TYPES[path.suffix]};base64,{b64encode(path.read_bytes()).decode('ascii')}"


def _place(location: Point) -> str:
    return ", ".join(components(location, max(map(abs, location))))


def _short(value: float | None) -> str:
    return DASH if value is None else short(value)
