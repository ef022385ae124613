"""The designs that are solved so far, each batch in a file of its own, so that a sweep that is
interrupted, in whatever way, loses no more than the batches in work.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pinstress.designs.table import write_table
from pinstress.study.errors import InputError
from pinstress.study.file import Study
from pinstress.study.inputs import inputs

if TYPE_CHECKING:
    import pyarrow as pa

FOLDER = "parts"
STATED = "sweep.json"  # what is swept, in the folder of parts
SCHEMA = "pinstress-sweep/1"
SUFFIX = ".parquet"


class Parts:
    """Files in a folder `parts` of an output folder, of one sweep. sweep: its identity."""

    def __init__(self, directory: Path, sweep: str) -> None:
        self.folder, self.sweep = directory / FOLDER, sweep

    def begin(self) -> None:
        """Make the folder, with nothing in it but what is swept."""
        self.folder.mkdir(parents=True, exist_ok=True)
        text = json.dumps({"schema": SCHEMA, "sweep": self.sweep}, indent=1) + "\n"
        partial = self.folder / f"{STATED}.partial"
        partial.write_text(text, encoding="utf-8")
        partial.replace(self.folder / STATED)

    def there(self) -> bool:
        """Whether a sweep was begun here."""
        return stated(self.folder) is not None

    @property
    def finished(self) -> bool:
        """Whether the folder has this sweep's whole table."""
        return not self.there() and stated(self.folder.parent) == self.sweep

    def require_same(self) -> None:
        """Raises: InputError where the parts are of another sweep."""
        found = stated(self.folder) or stated(self.folder.parent)
        if found is None:
            raise InputError(
                f"--resume: {self.folder.parent} has no sweep to go on with; leave out --resume",
                code="nothing-to-resume",
            )
        if found != self.sweep:
            raise InputError(
                f"--resume: the sweep in {self.folder.parent} is of another study, other [vary], "
                "pins or cases, other tables, or of another version of pinstress; go on with "
                "those, or choose another folder",
                code="other-sweep",
            )

    def write(self, table: pa.Table) -> None:
        """Keep a batch, named by its first design; its file is complete or absent."""
        number = min(table["design"].to_pylist())
        write_table(table, self.folder / f"{number:08d}{SUFFIX}")

    def read(self, schema: pa.Schema) -> list[pa.Table]:
        """All batches; a file that is damaged, or of other columns, is removed and solved anew."""
        from pyarrow import ArrowException, parquet

        found = []
        for path in sorted(self.folder.glob(f"*{SUFFIX}")):
            try:
                table = parquet.read_table(path)
            except (ArrowException, OSError):
                table = None
            if table is not None and table.schema.equals(schema, check_metadata=True):
                found.append(table)
            else:
                path.unlink(missing_ok=True)
        return found

    @property
    def count(self) -> int:
        """How many batches there are."""
        return len(list(self.folder.glob(f"*{SUFFIX}")))

    def finish(self) -> None:
        """When the whole table is written; what was swept stays beside that."""
        (self.folder / STATED).replace(self.folder.parent / STATED)
        self.remove()

    def remove(self) -> None:
        """Remove the files and the folder."""
        for path in (*self.folder.glob(f"*{SUFFIX}*"), *self.folder.glob(f"{STATED}*")):
            path.unlink(missing_ok=True)
        self.folder.rmdir()


def is_ours(name: str) -> bool:
    """Whether an entry of an output folder is of its parts."""
    if name == f"{FOLDER}/":
        return True
    folder, _, file = name.partition("/")
    bare = file.removesuffix(".partial")
    return folder == FOLDER and (
        bare == STATED or (bare.endswith(SUFFIX) and bare.removesuffix(SUFFIX).isdecimal())
    )


def identity(study: Study, *chosen: object) -> str:
    """Hash of all on which a sweep's numbers depend. chosen: pins, cases."""
    from pinstress.cache.store import program

    asked = study.text, inputs(study), chosen, program()
    return hashlib.sha256(repr(asked).encode()).hexdigest()


def stated(folder: Path) -> str | None:
    """The identity of the sweep whose parts a folder has."""
    try:
        found: Any = json.loads((folder / STATED).read_text(encoding="utf-8"))
        return str(found["sweep"]) if found["schema"] == SCHEMA else None
    except (OSError, ValueError, KeyError, TypeError):
        return None
