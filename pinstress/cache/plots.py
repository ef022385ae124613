"""Plots and pictures that were drawn before, found again by what they show."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path, PurePath

import numpy as np
from numpy.typing import NDArray

from pinstress.cache.store import Cache
from reports.plots.jobs import Plot


@dataclass(frozen=True)
class File:
    """A file by its name alone, and its bytes."""

    name: str
    content: NDArray[np.uint8]


@dataclass(frozen=True)
class Files:
    """What was drawn at once."""

    files: tuple[File, ...]

    @property
    def inside(self) -> bool:
        """Whether they stay in the folder into which they are written."""
        return all(f.name not in ("", "..") and PurePath(f.name).name == f.name for f in self.files)


def plot_once(plot: Plot, cache: Cache | None) -> list[Path]:
    """The files of a plot."""
    known = _shown(plot)
    return plot() if known is None else draw_once(plot, *known, cache)


def _shown(plot: Plot) -> tuple[object, Path] | None:
    """What a plot shows, and the folder it writes into: a function of both. None if it is not."""
    if not isinstance(plot, partial) or plot.keywords:
        return None
    folders = [a for a in plot.args if isinstance(a, Path)]
    if len(folders) != 1:
        return None
    data = [a for a in plot.args if not isinstance(a, Path)]
    return (plot.func.__module__, plot.func.__qualname__, data), folders[0]


def draw_once(draw: Plot, shown: object, directory: Path, cache: Cache | None) -> list[Path]:
    """The files that `draw` writes into a directory for what is `shown` (serialise.pack)."""
    if cache is None:
        return draw()
    key = cache.key(shown)
    kept = cache.read(key, Files)
    if kept is not None and kept.inside:
        for file in kept.files:
            (directory / file.name).write_bytes(file.content.tobytes())
        return [directory / file.name for file in kept.files]
    paths = draw()
    files = (File(p.name, np.frombuffer(p.read_bytes(), np.uint8)) for p in paths)
    cache.write(key, Files(tuple(files)))
    return paths
