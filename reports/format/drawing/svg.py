"""Lines and text of SVG drawings made by hand; all text is escaped."""

from __future__ import annotations

from html import escape

INK_COLOUR = "#222222"
MEAN_LETTER_WIDTH = 6.1  # mean width of a letter of the text


def line(
    x1: float, y1: float, x2: float, y2: float, attributes: str = "", ink: str = INK_COLOUR
) -> str:
    return (
        f'<line x1="{x1:.2f}" y1="{y1:.2f}" x2="{x2:.2f}" y2="{y2:.2f}" stroke="{ink}" '
        f'stroke-width="0.8" {attributes}/>'
    )


def text(x: float, y: float, words: str, halo: bool = False, anchor: str = "middle") -> str:
    """Return an SVG text at x: centred, or what else `anchor` is.

    halo: whether it has a white rim, so that it is legible over lines.
    """
    behind = ' stroke="#fff" stroke-width="3" paint-order="stroke"' if halo else ""
    return (
        f'<text x="{x:.2f}" y="{y:.2f}" text-anchor="{anchor}" fill="{INK_COLOUR}"{behind}>'
        f"{escape(words)}</text>"
    )


def wide(words: str) -> float:
    """Return the approximate width of a text, with some margin."""
    return MEAN_LETTER_WIDTH * len(words) + 8.0
