"""Captions of the documentation's tables of contents."""

from __future__ import annotations

import re
import sys
from pathlib import Path

DOCS = Path(__file__).parents[2] / "docs"
SETTINGS = """
import sys
sys.path[:0] = [{docs!r}]
from conf import html_copy_source, html_css_files, html_js_files, html_theme, html_theme_options
extensions = ["captions"]
html_static_path = [{static!r}]
html_title = "documentation"
"""


def build_docs(folder: Path, page: str) -> None:
    """Build one page, one.html, with the settings of the documentation, into `folder` / out."""
    from sphinx.application import Sphinx

    source = folder / "source"
    source.mkdir()
    settings = SETTINGS.format(docs=str(DOCS), static=str(DOCS / "static"))
    (source / "conf.py").write_text(settings, encoding="utf-8")
    contents = "Title\n=====\n\n.. toctree::\n   :caption: Start\n\n   one\n"
    (source / "index.rst").write_text(contents, encoding="utf-8")
    (source / "one.rst").write_text(page, encoding="utf-8")
    path, conf = list(sys.path), sys.modules.pop("conf", None)
    try:
        Sphinx(source, source, folder / "out", folder / "trees", "html", status=None).build()
    finally:
        sys.path[:] = path
        sys.modules.pop("conf", None)
        if conf is not None:
            sys.modules["conf"] = conf


def test_every_caption_is_a_heading_with_a_level(tmp_path: Path) -> None:
    build_docs(tmp_path, "One\n===\n")
    for page in ("index.html", "one.html"):
        text = (tmp_path / "out" / page).read_text(encoding="utf-8")
        headings = re.findall(r'<[^>]*role="heading"[^>]*>', text)
        assert headings  # of the sidebar at least
        assert all('aria-level="2"' in heading for heading in headings)
