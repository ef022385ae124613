"""The `sweep` command, which solves designs into a folder, stores every batch there, and prints a
summary.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from pinbase.processes import interrupts
from pinbase.processes.folder_lock import Release, lock
from pinbase.processes.pool import cores
from pinstress.cli import manifest
from pinstress.cli.output_folder import require_replaceable, resolved
from pinstress.cli.run import bar_on_stderr, console
from pinstress.cli.shared import open_page, resumable, say, warn
from pinstress.cli.streams import unneeded
from pinstress.explore.sweep.connection import ClusterConnection
from pinstress.explore.sweep.design_columns import designs_of
from pinstress.explore.sweep.page import render_designs
from pinstress.explore.sweep.parts import (
    DESIGNS_FILE,
    IDENTITY_FILE,
    PARTS_FOLDER,
    BatchFolder,
    identity,
    is_ours,
)
from pinstress.explore.sweep.summary import UNSOLVED_VERDICTS, summary
from pinstress.explore.sweep.sweep import Report, planned, solved
from pinstress.explore.sweep.table import read_table, table_of, write_table
from pinstress.study.reading.errors import InputError, cannot_write_out
from pinstress.study.reading.file import Study
from reports.folder.inside import write_inside

if TYPE_CHECKING:
    import pyarrow as pa

DESIGNS_PAGE = "designs.html"
SWEEP_FILES = (
    DESIGNS_FILE,
    DESIGNS_PAGE,
    IDENTITY_FILE,
    f"{DESIGNS_FILE}.partial",
    f"{DESIGNS_PAGE}.partial",
)
# Entries of a folder whose sweep was killed before it wrote its identity
BEGINNINGS = manifest.OWN_FILES | {f"{PARTS_FOLDER}/", f"{PARTS_FOLDER}/{IDENTITY_FILE}.partial"}


@dataclass(frozen=True)
class SweepOptions:
    """Options for solving a sweep.

    jobs: number of processes on this machine, by default one for each core.
    connection: to a cluster that solves the designs instead.
    resume: whether to resume the sweep in the folder.
    opens: whether to open the page.
    """

    jobs: int | None = None
    connection: ClusterConnection | None = None
    resume: bool = False
    opens: bool = False
    quiet: bool = False


def sweep_and_write(
    study: Study,
    directory: Path,
    pins: list[str] | None,
    cases: list[str] | None,
    options: SweepOptions,
) -> int:
    """Sweep a study into a folder and return the exit status: 1 if every design failed.

    Raises: InputError.
    """
    parts = BatchFolder(directory, identity(study, pins, cases))
    _require_usable(directory, parts, options.resume)
    sweep = planned(study, pins, cases)
    if options.resume and parts.finished:
        if not options.quiet:
            say(f"The sweep in {directory} is complete: nothing to do.")
        interrupts.state_left(f"{directory} is written")
        return _report_designs(directory, read_table(directory / DESIGNS_FILE), options)
    kept = resumable(lambda: parts.count, "batch", "batches")
    with _claimed(directory, parts, options.resume), kept, _writing(directory):
        before = parts.count_before if options.resume else None
        if before is not None:
            parts.continue_with(table_of(study, sweep.parameters, []).schema)
            if not options.quiet:
                count = len(sweep.values)
                say(f"Continued from {before:,} designs to {count:,}.")
        alone = options.connection is not None or (options.jobs or cores()) == 1
        with progress(options.quiet, alone) as report:
            table = solved(sweep, parts, options.jobs, options.connection, report, warn)
        _write(directory, table)
        with interrupts.deferred():
            parts.finish()
            interrupts.state_left(f"{directory} is written")
    return _report_designs(directory, table, options)


def _report_designs(directory: Path, table: pa.Table, options: SweepOptions) -> int:
    """Print a summary of a table and return the exit status."""
    with unneeded(directory):
        summary(table, console())
    if not options.quiet:
        say(f"Table: {directory / DESIGNS_FILE}")
        say(f"Page: {directory / DESIGNS_PAGE}")
    if options.opens:
        open_page(directory / DESIGNS_PAGE)
    verdicts = set(table["verdict"].unique().to_pylist())
    return int(verdicts <= {*UNSOLVED_VERDICTS})


def _write(directory: Path, table: pa.Table) -> None:
    manifest.add(directory, list(SWEEP_FILES))
    write_table(table, directory / DESIGNS_FILE)
    write_inside(directory, DESIGNS_PAGE, render_designs(designs_of(table)).encode())


@contextmanager
def _writing(directory: Path) -> Iterator[None]:
    """Turn an error of writing, as on a full disk, into one that names the folder.

    Raises: InputError.
    """
    try:
        yield
    except OSError as error:
        if error.filename is None and error.errno is None:
            raise
        raise cannot_write_out(directory, error) from error


def _require_usable(directory: Path, parts: BatchFolder, resume: bool) -> None:
    """Check that a sweep can be written into a folder.

    Raises: InputError for a folder that contains files other than those of a sweep, an unfinished
    sweep that is not to be resumed, or no sweep to resume.
    """
    if os.path.isdir(directory) and (link := manifest.first_link(directory)):
        raise InputError(
            f"--out: {directory}: {link} is a link, a pipe or a device, which pinstress did not "
            "make; remove it or choose another folder",
            code="not-ours",
        )
    if os.path.exists(directory):
        require_replaceable(directory, _mark(directory, parts), is_ours)
    if resume:
        parts.require_same()
    elif parts.there():
        _locked(directory)()
        raise InputError(
            f"--out: {directory} has a sweep that did not end: resume it with --resume, or delete "
            f"its folder {PARTS_FOLDER} to start again",
            code="unfinished-sweep",
        )


def _mark(directory: Path, parts: BatchFolder) -> str:
    """Return the file that a folder must contain to be that of a sweep."""
    if (parts.folder / IDENTITY_FILE).is_file():
        return f"{PARTS_FOLDER}/{IDENTITY_FILE}"
    only_begun = directory.is_dir() and manifest.entries(directory) <= BEGINNINGS
    return manifest.MANIFEST_FILE if only_begun else DESIGNS_FILE


def _locked(directory: Path) -> Release:
    """Lock the folder of a sweep and return the function that releases it.

    Raises: InputError while another sweep is writing it.
    """
    try:
        return lock(directory.resolve())
    except BlockingIOError:
        raise InputError(
            f"--out: another sweep is writing {directory}; wait for it or choose another folder",
            code="locked",
        ) from None


@contextmanager
def _claimed(directory: Path, parts: BatchFolder, resume: bool) -> Iterator[None]:
    """Create the folder, write its manifest, and lock it inside the block.

    If no batch was solved, everything that a new sweep wrote is removed.
    """
    release: Release | None = None
    existed = os.path.exists(directory)
    try:
        with _writing(directory):
            resolved(directory).mkdir(parents=True, exist_ok=True)
            release = _locked(directory)
            if manifest.entries(directory) <= BEGINNINGS:
                manifest.begin(directory)
            if not resume:
                parts.begin()
        yield
    finally:
        if release is not None:
            if not resume and parts.there() and not parts.count:
                _remove(directory, parts, existed)
            release()


def _remove(directory: Path, parts: BatchFolder, existed: bool) -> None:
    with suppress(OSError):
        parts.remove()
        if not existed and manifest.entries(directory) == {manifest.MANIFEST_FILE}:
            (directory / manifest.MANIFEST_FILE).unlink()
            directory.rmdir()


@contextmanager
def progress(quiet: bool, alone: bool = True) -> Iterator[Report]:
    """Show a progress bar on stderr if it is a terminal, otherwise a line at intervals.

    alone: whether no process is forked inside the block, so that a thread may refresh the bar;
    otherwise every call refreshes it.
    """
    from rich import progress as rich

    columns = (
        rich.TextColumn("designs"),
        rich.BarColumn(),
        rich.MofNCompleteColumn(),
        rich.TimeElapsedColumn(),
        rich.TextColumn("left"),
        rich.TimeRemainingColumn(elapsed_when_finished=False),
    )
    with bar_on_stderr(*columns, alone=alone, quiet=quiet) as bar:
        lines = _Lines(quiet or not bar.disable)
        task = bar.add_task("designs", total=None)

        def report(count: int, total: int) -> None:
            bar.update(task, completed=count, total=total, refresh=not alone)
            lines.tell(count, total)

        yield report


class _Lines:
    """Progress for an output that is not a terminal: a line every EVERY seconds."""

    EVERY = 30.0

    def __init__(self, silent: bool) -> None:
        self._silent = silent
        self._start = self._last = time.monotonic()
        self._first: int | None = None

    def tell(self, count: int, total: int) -> None:
        now = time.monotonic()
        if self._first is None:
            self._first = count
        if self._silent or now - self._last < self.EVERY or count == self._first:
            return
        self._last = now
        left = (now - self._start) / (count - self._first) * (total - count)
        say(f"{count:,} of {total:,} designs, {left:,.0f} s left")
