"""Captions of the documentation's tables of contents."""

from __future__ import annotations

import re
import sys
from pathlib import Path

DOCS = Path(__file__).parents[2] / "docs"


def test_every_caption_is_a_heading_with_a_level(tmp_path: Path) -> None:
    from sphinx.application import Sphinx

    source = tmp_path / "source"
    source.mkdir()
    settings = f"import sys\nsys.path[:0] = [{str(DOCS)!r}]\nextensions = ['captions']\n"
    settings += "html_theme = 'furo'\n"
    (source / "conf.py").write_text(settings, encoding="utf-8")
    contents = "Title\n=====\n\n.. toctree::\n   :caption: Start\n\n   one\n"
    (source / "index.rst").write_text(contents, encoding="utf-8")
    (source / "one.rst").write_text("One\n===\n", encoding="utf-8")
    path = list(sys.path)
    try:
        app = Sphinx(source, source, tmp_path / "out", tmp_path / "trees", "html", status=None)
        app.build()
    finally:
        sys.path[:] = path
    for page in ("index.html", "one.html"):
        text = (tmp_path / "out" / page).read_text(encoding="utf-8")
        headings = re.findall(r'<[^>]*role="heading"[^>]*>', text)
        assert headings  # of the sidebar at least
        assert all('aria-level="2"' in heading for heading in headings)
