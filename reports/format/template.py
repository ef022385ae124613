"""Templates of pages; everything that does not come from here is escaped."""

from __future__ import annotations

import sys
from contextlib import suppress
from functools import cache
from importlib.util import cache_from_source
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from jinja2 import BytecodeCache, Environment

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
        bytecode_cache=_compiled(),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def rendered(template: str, **values: object) -> str:
    """Return a page as text: a template by its name, with the values that it names."""
    return environment().get_template(template).render(values)


def _compiled() -> BytecodeCache:
    """Return where compiled templates are kept for other runs: where Python keeps our modules, if
    it may; compiling them takes a tenth of a short run.
    """
    from jinja2 import FileSystemBytecodeCache
    from jinja2.bccache import Bucket

    class BesideModules(FileSystemBytecodeCache):
        def dump_bytecode(self, bucket: Bucket) -> None:
            if not sys.dont_write_bytecode:
                with suppress(OSError):  # a folder that can only be read, a full disk
                    Path(self.directory).mkdir(parents=True, exist_ok=True)
                    super().dump_bytecode(bucket)

    return BesideModules(str(Path(cache_from_source(str(TEMPLATE_FOLDER / "_.py"))).parent))
