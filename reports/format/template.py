"""The templates of pages, with everything escaped that does not come from here."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from jinja2 import Environment

TEMPLATE_FOLDER = Path(__file__).parents[1] / "templates"
VENDOR_FOLDER = TEMPLATE_FOLDER / "vendor"  # scripts of others


@cache
def environment() -> Environment:
    """The environment of all templates, each of which is compiled once; without jinja's import at
    start-up.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    return Environment(
        loader=FileSystemLoader(TEMPLATE_FOLDER),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
