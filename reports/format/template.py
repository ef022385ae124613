"""Templates of pages; all text that does not come from a template is escaped."""

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
VENDOR_FOLDER = TEMPLATE_FOLDER / "vendor"  # third-party scripts


@cache
def environment() -> Environment:
    """Return the environment of all templates, each of which is compiled once.

    The environment is made on demand, so that jinja is not imported at start-up.
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
    """Return a page as text. values: the variables that the template names."""
    return environment().get_template(template).render(values)


def _compiled() -> BytecodeCache:
    """Return the cache of compiled templates, which later runs use.

    The cache is in the folder in which Python keeps our compiled modules, if that is writable.
    Compiling the templates takes a tenth of a short run.
    """
    from jinja2 import FileSystemBytecodeCache
    from jinja2.bccache import Bucket

    class BesideModules(FileSystemBytecodeCache):
        def dump_bytecode(self, bucket: Bucket) -> None:
            if not sys.dont_write_bytecode:
                with suppress(OSError):  # a read-only folder, or a full disk
                    Path(self.directory).mkdir(parents=True, exist_ok=True)
                    super().dump_bytecode(bucket)

    return BesideModules(str(Path(cache_from_source(str(TEMPLATE_FOLDER / "_.py"))).parent))
