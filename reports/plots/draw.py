"""Drawing of plots into files, without a browser."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from pathlib import Path

from reports.format.file_names import PNG_SUFFIX, SVG_SUFFIX
from reports.plots.self_contained import require_no_address, require_self_contained
from reports.plots.spec import Plot, Spec, still
from reports.plots.theme import on_paper

VEGA_LITE_VERSION = "6.4"
CLIP_ID_PATTERN = re.compile(r'(?<=id="clip)\d+(?=")|(?<=url\(#clip)\d+(?=\))')
TWO_UNIT_CHARACTER_PATTERN = re.compile("[\U00010000-\U0010ffff]")
PIXELS_PER_UNIT = 2.0  # pixels of a PNG per unit


def draw(plots: Iterable[Plot], directory: Path) -> list[Path]:
    """Write every plot as SVG and as PNG into `directory`; return the files."""
    directory.mkdir(parents=True, exist_ok=True)
    return [path for plot in plots for path in draw_plot(plot, directory)]


def draw_plot(plot: Plot, directory: Path) -> list[Path]:
    """Write one plot as SVG and as PNG; return the files.

    Raises: ValueError where Vega-Lite fails, Damaged for an address in the plot.
    """
    import vl_convert

    drawn = svg({**plot.spec, "config": on_paper()})
    paths = [directory / f"{plot.name}{end}" for end in (SVG_SUFFIX, PNG_SUFFIX)]
    paths[0].write_text(drawn, encoding="utf-8", newline="\n")
    paths[1].write_bytes(vl_convert.svg_to_png(drawn, scale=PIXELS_PER_UNIT))
    return paths


def svg(spec: Spec) -> str:
    """Return the drawing of a specification with its configuration; no address is opened.

    Vega cuts long texts within characters that take two UTF-16 units, such as emoji, and fails;
    these characters are then written as U+1F600.

    Raises: ValueError where Vega-Lite fails, Damaged for an address in the specification.
    """
    require_no_address(spec, "the plot")
    text = json.dumps(still(spec), ensure_ascii=False)
    named = TWO_UNIT_CHARACTER_PATTERN.sub(lambda match: f"U+{ord(match[0]):X}", text)
    try:
        drawing = _drawn(text)
    except ValueError:
        if named == text:
            raise
        drawing = _drawn(named)
    require_self_contained(drawing, "the plot")
    return _numbered(drawing)


def _drawn(text: str) -> str:
    import vl_convert

    return vl_convert.vegalite_to_svg(text, vl_version=VEGA_LITE_VERSION, allowed_base_urls=[])


def _numbered(svg: str) -> str:
    """Return the SVG with clips numbered from one; Vega continues the numbers from plot to plot."""
    number = {
        name: str(k) for k, name in enumerate(dict.fromkeys(CLIP_ID_PATTERN.findall(svg)), start=1)
    }
    return CLIP_ID_PATTERN.sub(lambda match: number[match[0]], svg)
