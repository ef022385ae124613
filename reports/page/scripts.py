"""Data for the page's scripts: libraries, plots, the content of the PDF, and colours."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from datetime import datetime
from typing import Annotated, Any

from pydantic import AfterValidator, RootModel

from loads import MB
from pinbase.errors import Damaged
from reports.folder.damaged import JsonPart, inflated, strict_json, validated
from reports.format.packed import deflated
from reports.format.script_json import script_json
from reports.format.template import VENDOR_FOLDER
from reports.plots.self_contained import require_no_address, require_self_contained
from reports.plots.spec import Plot
from reports.plots.theme import on_page

SCRIPT_FILES = ("vega.min.js", "vega-lite.min.js", "vega-interpreter.js")
REPORT_PAGE = "report.html"
MAX_UNPACKED_SIZE = 512 * MB  # of a compressed part of a page
# Names made by reports.format.file_names
PLOT_NAME_PATTERN = re.compile(r"[A-Za-z][A-Za-z0-9_.~%-]*")
MAX_PLOT_NAME_LENGTH = 2000
PACKED_SCRIPT_PATTERN = r'<script type="text/plain" id="{}">([\w+/=]+)</script>'


def script_part(plots: Mapping[str, Plot], document: Mapping[str, Any]) -> dict[str, str]:
    """Return the compressed parts of the page, and the configuration of the plots as JSON.

    document: the content of the PDF.
    """
    return {
        "libraries": deflated(
            b"\n".join((VENDOR_FOLDER / name).read_bytes() for name in SCRIPT_FILES)
        ),
        "plots": _packed({name: [plot.caption, plot.spec] for name, plot in plots.items()}),
        "paper": _packed(document),
        "theme": script_json(on_page()),
    }


def plots_of(page: str) -> list[Plot]:
    """Return the plots of a page.

    Raises: Damaged, also for a plot with an address, or with a name that leads out of the folder.
    """
    content = _read(page, "plots")
    if content is None:
        return []
    parts = validated(_Plots, content, f"{REPORT_PAGE}, plots").root
    plots = [Plot(name, caption, spec) for name, (caption, spec) in parts.items()]
    for plot in plots:
        if len(plot.name) > MAX_PLOT_NAME_LENGTH or not PLOT_NAME_PATTERN.fullmatch(plot.name):
            raise Damaged(f"{REPORT_PAGE} is damaged: {plot.name[:80]!r} is no name of a plot")
        require_no_address(plot.spec, f"{REPORT_PAGE} is damaged: its plot {plot.name}")
    return plots


def document_of(page: str) -> dict[str, Any] | None:
    """Return the content of a page's PDF; None for a page without one.

    Raises: Damaged, also for a drawing that refers to something outside itself.
    """
    content: dict[str, Any] | None = _read(page, "paper")
    if content is None:
        return None
    checked = validated(_Paper, content, f"{REPORT_PAGE}, paper")
    if checked.overview and checked.overview.linkage:
        require_self_contained(
            checked.overview.linkage, f"{REPORT_PAGE} is damaged: its drawing of the linkage"
        )
    for k, pin in enumerate(checked.pins):
        require_self_contained(pin.drawing, f"{REPORT_PAGE} is damaged: its drawing of pin {k + 1}")
    return content


def _packed(content: Mapping[str, Any]) -> str:
    return deflated(json.dumps(content, allow_nan=False, separators=(",", ":")).encode())


def _read(page: str, name: str) -> Any:
    match = re.search(PACKED_SCRIPT_PATTERN.format(name), page)
    if match is None:
        return None
    where = f"{REPORT_PAGE}, {name}"
    return strict_json(inflated(match[1], MAX_UNPACKED_SIZE, where), where)


def _day(text: str) -> str:
    if text:
        datetime.fromisoformat(text)
    return text


def _caption_and_spec(pair: list[Any]) -> list[Any]:
    if len(pair) != 2 or not isinstance(pair[0], str) or not isinstance(pair[1], dict):
        raise ValueError("a plot is a caption and a specification")
    return pair


class _Plots(RootModel[dict[str, Annotated[list[Any], AfterValidator(_caption_and_spec)]]]):
    """The plots of a page: by name, a caption and a specification."""


class _Block(JsonPart):
    date: Annotated[str, AfterValidator(_day)]


class _Case(JsonPart):
    plot: str


class _Pin(JsonPart):
    drawing: str
    refinement: str
    cases: list[_Case]


class _Overview(JsonPart):
    """The part of the first screen that typst reads as a picture."""

    linkage: str | None = None


class _Paper(JsonPart):
    """The part of the PDF's content that is checked before typst reads all of it."""

    block: _Block
    pins: list[_Pin]
    overview: _Overview | None = None
