"""Templates of pages; everything that does not come from here is escaped."""

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
    """Return the environment of all templates, each of which is compiled once.

    It is made on demand, so that jinja is not imported at start-up.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    return Environment(
        loader=FileSystemLoader(TEMPLATE_FOLDER),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
