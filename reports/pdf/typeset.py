"""report.pdf, typeset by typst (https://typst.app/docs), a wheel that needs no system libraries.

Typst has its own fonts, so that the PDF is the same everywhere, and is ten times faster than
WeasyPrint, which needs Pango and the fonts of the system.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from datetime import UTC, datetime
from functools import cache
from tempfile import TemporaryDirectory
from typing import Any

from pinbase.errors import Damaged
from reports.format.template import TEMPLATE_FOLDER
from reports.plots.draw import svg
from reports.plots.spec import Plot, Spec
from reports.plots.theme import on_paper

Content = dict[str, Any]  # of reports.page.paper

FIXED_DATE = datetime(2000, 1, 1, tzinfo=UTC)  # so that the same results give the same bytes
FONT_NAME = "Libertinus Serif"  # comes with typst
# Width of plots; views higher than the maximum are reduced.
PLOT_WIDTH, MAX_PLOT_HEIGHT, REDUCED_PLOT_HEIGHT = 330, 120, 95
FONT_FAMILY_PATTERN = re.compile(r'font-family="[^"]*"')


def typeset(content: Content, plots: Mapping[str, Plot]) -> bytes:
    """Return the PDF, tagged for accessibility (PDF/UA-1).

    plots: by their names. Characters without a glyph are replaced by their code points.
    Raises: Damaged for content that cannot be typeset.
    """
    import typst

    files = {"main": (TEMPLATE_FOLDER / "report.typ").read_bytes()}
    captions = {}
    for name, plot in plots.items():
        captions[name] = plot.caption
        files[f"{name}.svg"] = _drawn(plot.spec).encode()
    pins = []
    for number, pin in enumerate(content["pins"]):
        files[f"pin{number}.svg"] = FONT_FAMILY_PATTERN.sub(
            f'font-family="{FONT_NAME}"', pin["drawing"]
        ).encode()
        pins.append({**pin, "drawing": f"pin{number}.svg"})
    data = {**content, "pins": pins, "captions": captions}
    for drawing in ("linkage", "curve"):
        if (overview := content.get("overview")) and overview.get(drawing):
            files[f"{drawing}.svg"] = overview[drawing].encode()
    files["data.json"] = json.dumps(data, ensure_ascii=False).encode()
    day = content["block"]["date"]
    timestamp = datetime.fromisoformat(day).replace(tzinfo=UTC) if day else FIXED_DATE
    try:
        return _compiled(files, timestamp)
    except typst.TypstError:
        missing = _without_glyph("".join(text.decode() for text in files.values()))
    numbers = {ord(c): f"U+{ord(c):04X}" for c in missing}
    shown = {name: text.decode().translate(numbers).encode() for name, text in files.items()}
    try:
        return _compiled(shown, timestamp)
    except typst.TypstError as error:
        said = str(error).splitlines()[0]
        raise Damaged(f"report.html has content that cannot be typeset: {said}") from None


def _compiled(files: dict[str, bytes], timestamp: datetime) -> bytes:
    """Return the compiled PDF.

    Raises: TypstError, for instance for a character that no font has, which UA-1 does not allow.
    """
    import typst

    fonts = typst.Fonts(include_system_fonts=False)  # system fonts would change the bytes
    with TemporaryDirectory(
        prefix="pinstress-"
    ) as nothing:  # otherwise it reads the current folder
        compiler = typst.Compiler(files, root=nothing, font_paths=fonts)  # type: ignore[type-var]
        pdf = compiler.compile(format="pdf", pdf_standards="ua-1", timestamp=timestamp)
    assert isinstance(pdf, bytes)
    return pdf


def _without_glyph(text: str) -> list[str]:
    """Return the characters of a text that have no glyph; each is typeset separately to test it."""
    return [c for c in sorted(set(text)) if not c.isascii() and not _has_glyph(c)]


@cache
def _has_glyph(character: str) -> bool:
    import typst

    page = f'#set document(title: "x")\n#set text(font: "{FONT_NAME}", lang: "en")\n'
    try:
        _compiled({"main": f"{page}{character} *{character}*".encode()}, FIXED_DATE)
    except typst.TypstError:
        return False
    return True


def shown_plots(content: Content) -> list[str]:
    """Return the names of the plots that the PDF shows, if they exist."""
    cases = [case["plot"] for pin in content["pins"] for case in pin["cases"]]
    return [*(pin["refinement"] for pin in content["pins"]), *cases]


def _drawn(spec: Spec) -> str:
    """Return a plot half as wide as a page; its caption serves as the title."""
    config = on_paper(FONT_NAME)
    config["view"] |= {"continuousWidth": PLOT_WIDTH}
    small = _flatter({key: value for key, value in spec.items() if key != "title"})
    return svg({**small, "config": config})


def _flatter(spec: Spec) -> Spec:
    flat = (
        {**spec, "height": REDUCED_PLOT_HEIGHT} if spec.get("height", 0) > MAX_PLOT_HEIGHT else spec
    )
    if "vconcat" in spec:
        flat = {**flat, "vconcat": [_flatter(part) for part in spec["vconcat"]]}
    return flat
