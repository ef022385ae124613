"""Storage of the solved designs of a sweep, each batch in its own file.

A sweep that is interrupted in any way loses only the unfinished batches.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pinstress.explore.sweep.table import read_table, write_table
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study
from pinstress.study.reading.inputs import inputs
from reports.folder.inside import write_inside

if TYPE_CHECKING:
    import pyarrow as pa

PARTS_FOLDER = "parts"
IDENTITY_FILE = "sweep.json"  # the identity of the sweep, in the folder of parts
SWEEP_SCHEMA = "pinstress-sweep/1"
PART_SUFFIX = ".parquet"
DESIGNS_FILE = "designs.parquet"
CONTINUABLE_SAMPLES = "sobol", "random"  # a larger sample begins with the designs of a smaller one


@dataclass(frozen=True)
class Identity:
    """The identity of a sweep.

    sweep: a hash of all data on which the numbers depend.
    but_count: a hash of the same data without the number of designs.
    count: the number of designs.
    sample: the kind of sample.
    """

    sweep: str
    but_count: str
    count: int
    sample: str


class BatchFolder:
    """The files of one sweep in the folder `parts` of an output folder.

    sweep: the hash that identifies the sweep.
    """

    def __init__(self, directory: Path, identity: Identity) -> None:
        self.folder, self.identity = directory / PARTS_FOLDER, identity
        self.sweep = identity.sweep

    def begin(self) -> None:
        """Create the folder with only the identity of the sweep in it.

        Old batches are removed first: a sweep that was killed while it removed its batches may have
        left some with other numbers.
        """
        self.folder.mkdir(parents=True, exist_ok=True)
        self._clear()
        self._state()

    def _state(self) -> None:
        """Write the identity of the sweep; from then on the sweep has begun."""
        identity = self.identity
        stated = {"sweep": identity.sweep, "but_count": identity.but_count, "count": identity.count}
        text = json.dumps({"schema": SWEEP_SCHEMA, **stated}, indent=1) + "\n"
        write_inside(self.folder, IDENTITY_FILE, text.encode())

    def there(self) -> bool:
        """Whether a sweep has begun in this folder."""
        return stated(self.folder) is not None

    @property
    def finished(self) -> bool:
        """Whether the output folder has the complete table of this sweep."""
        return not self.there() and stated(self.folder.parent) == self.sweep

    def require_same(self) -> None:
        """Check that the parts are those of this sweep.

        Raises: InputError if there are none, or if they belong to another sweep that this one
        cannot continue.
        """
        known, ours, before = self._stated, self.identity, self.count_before
        if not known:
            raise InputError(
                f"--resume: {self.folder.parent} has no sweep to resume; leave out --resume",
                code="nothing-to-resume",
            )
        if before is not None and ours.sample not in CONTINUABLE_SAMPLES:
            raise InputError(
                f"--resume: the sweep in {self.folder.parent} has count = {before}, the study "
                f"{ours.count}: a {ours.sample} sample of another count has other designs, so that "
                f"only {' and '.join(CONTINUABLE_SAMPLES)} ones can be continued; choose another "
                f"folder",
                code="other-count",
            )
        if before is not None and before > ours.count:
            raise InputError(
                f"--resume: the sweep in {self.folder.parent} has count = {before}, more than the "
                f"study's {ours.count}: it can only be continued, to more designs; choose another "
                "folder",
                code="fewer-designs",
            )
        if known.get("sweep") != self.sweep and before is None:
            raise InputError(
                f"--resume: the sweep in {self.folder.parent} is of another study, other [vary], "
                "pins or cases, other tables, or of another version of pinstress; resume with "
                "those, or choose another folder",
                code="other-sweep",
            )

    @property
    def _stated(self) -> dict[str, Any]:
        """The stated identity of the sweep in the folder; empty if there is none."""
        return _read(self.folder) or _read(self.folder.parent)

    @property
    def count_before(self) -> int | None:
        """The number of designs of the sweep in the folder, if it differs from this one only in
        this number; else None.
        """
        known, identity = self._stated, self.identity
        other = (
            known.get("sweep") != identity.sweep and known.get("but_count") == identity.but_count
        )
        return int(known["count"]) if other else None

    def continue_with(self, schema: pa.Schema) -> None:
        """Take over the designs of a sweep with fewer designs: its batches, or its complete table.

        If this is interrupted, it can be repeated.
        """
        if self.there():
            tables = [table for _, table in self._tables() if table is not None]
        else:
            tables = [read_table(self.folder.parent / DESIGNS_FILE)]
        self.folder.mkdir(exist_ok=True)
        for table in tables:
            if table.schema.equals(schema):
                self.write(table.replace_schema_metadata(schema.metadata))
        self._state()

    def write(self, table: pa.Table) -> None:
        """Keep a batch, named by its first design; its file is complete or absent."""
        number = min(table["design"].to_pylist())
        write_table(table, self.folder / f"{number:08d}{PART_SUFFIX}")

    def read(self, schema: pa.Schema) -> list[pa.Table]:
        """Return all batches. A file that is damaged or has other columns is removed; its designs
        are solved again.
        """
        tables = []
        for path, table in self._tables():
            if table is not None and table.schema.equals(schema, check_metadata=True):
                tables.append(table)
            else:
                path.unlink(missing_ok=True)
        return tables

    def _tables(self) -> Iterator[tuple[Path, pa.Table | None]]:
        """Yield the files of batches with their tables; None for a file that is damaged."""
        from pyarrow import ArrowException, parquet

        for path in sorted(self.folder.glob(f"*{PART_SUFFIX}")):
            try:
                table = parquet.read_table(path)
            except (ArrowException, OSError):
                table = None
            yield path, table

    @property
    def count(self) -> int:
        """The number of batches."""
        return len(list(self.folder.glob(f"*{PART_SUFFIX}")))

    def finish(self) -> None:
        """Remove the parts after the complete table is written; the identity stays beside it."""
        (self.folder / IDENTITY_FILE).replace(self.folder.parent / IDENTITY_FILE)
        self.remove()

    def remove(self) -> None:
        """Remove the files and the folder."""
        self._clear()
        for path in self.folder.glob(f"{IDENTITY_FILE}*"):
            path.unlink(missing_ok=True)
        self.folder.rmdir()

    def _clear(self) -> None:
        """Remove all batches, finished or not."""
        for path in self.folder.glob(f"*{PART_SUFFIX}*"):
            path.unlink(missing_ok=True)


def is_ours(name: str) -> bool:
    """Whether an entry of an output folder belongs to its parts."""
    if name == f"{PARTS_FOLDER}/":
        return True
    folder, _, file = name.partition("/")
    bare = file.removesuffix(".partial")
    return folder == PARTS_FOLDER and (
        bare == IDENTITY_FILE
        or (bare.endswith(PART_SUFFIX) and bare.removesuffix(PART_SUFFIX).isdecimal())
    )


def identity(study: Study, *chosen: object) -> Identity:
    """Return the identity of the sweep of a study; its hashes cover all data on which the numbers
    depend.

    chosen: the chosen pins and cases.
    """
    import tomlkit

    from pinstress.analysis.cache import program

    vary = study.table.vary  # a study without [vary] is refused when its parameters are read
    document = tomlkit.parse(study.text)
    document.get("vary", {}).pop("count", None)
    values, version = inputs(study), program()
    others = {key: value for key, value in values.items() if key != "vary.count"}
    study_inputs = study.text, values, chosen, version
    but_count = tomlkit.dumps(document), others, chosen, version
    whole, but = (hashlib.sha256(repr(x).encode()).hexdigest() for x in (study_inputs, but_count))
    return Identity(whole, but, *((vary.count, vary.sample) if vary else (0, "")))


def stated(folder: Path) -> str | None:
    """Return the hash that identifies the sweep whose identity file is in a folder; None without
    one.
    """
    sweep: str | None = _read(folder).get("sweep")
    return sweep


def _read(folder: Path) -> dict[str, Any]:
    """Return a folder's statement of its sweep; empty if there is none."""
    try:
        content: Any = json.loads((folder / IDENTITY_FILE).read_text(encoding="utf-8"))
        ours = content["schema"] == SWEEP_SCHEMA and isinstance(content["sweep"], str)
        return dict(content) if ours else {}
    except (OSError, ValueError, KeyError, TypeError):
        return {}
