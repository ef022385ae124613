"""Captions of tables of contents as headings with a level, by which readers can place them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from sphinx.writers.html5 import HTML5Translator

if TYPE_CHECKING:
    from docutils.nodes import Element
    from sphinx.application import Sphinx

CAPTION_LEVEL = "2"  # below the title of a page


class LevelledTranslator(HTML5Translator):
    """Sphinx's writer, whose headings by role have a level."""

    def starttag(self, node: Element, tagname: str, *args: Any, **attributes: Any) -> str:
        """Return the start of an element."""
        if attributes.get("ROLE") == "heading":
            attributes["ARIA-LEVEL"] = CAPTION_LEVEL
        return str(super().starttag(node, tagname, *args, **attributes))


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    app.set_translator("html", LevelledTranslator)
    return {"parallel_read_safe": True}
