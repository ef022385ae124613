"""What the page's scripts read: libraries, plots, the content of the PDF, colours."""

from __future__ import annotations

import json
import re
import zlib
from base64 import b64decode
from collections.abc import Iterator, Mapping
from typing import Any

from reports.format.packed import deflated
from reports.format.script_json import script_json
from reports.format.template import VENDOR
from reports.plots.spec import Plot
from reports.plots.theme import on_page

LIBRARIES = ("vega.min.js", "vega-lite.min.js", "vega-interpreter.js")
PACKED = r'<script type="text/plain" id="{}">([\w+/=]+)</script>'


def script_part(plots: Mapping[str, Plot], document: Mapping[str, Any]) -> dict[str, str]:
    """Compressed texts, and the configuration of the plots as JSON. document: of the PDF."""
    return {
        "libraries": deflated(b"\n".join((VENDOR / name).read_bytes() for name in LIBRARIES)),
        "plots": _packed({name: [plot.caption, plot.spec] for name, plot in plots.items()}),
        "paper": _packed(document),
        "theme": script_json(on_page()),
    }


def plots_of(page: str) -> Iterator[Plot]:
    """The plots of a page. Raises: ValueError."""
    for name, (caption, spec) in (_read(page, "plots") or {}).items():
        yield Plot(name, caption, spec)


def document_of(page: str) -> dict[str, Any] | None:
    """The content of a page's PDF; None in a page that has none. Raises: ValueError."""
    return _read(page, "paper")


def _packed(content: Mapping[str, Any]) -> str:
    return deflated(json.dumps(content, allow_nan=False, separators=(",", ":")).encode())


def _read(page: str, name: str) -> dict[str, Any] | None:
    found = re.search(PACKED.format(name), page)
    if found is None:
        return None
    try:
        content: dict[str, Any] = json.loads(zlib.decompress(b64decode(found[1])))
    except zlib.error as error:
        raise ValueError(error) from None
    return content
