"""File names of the plots, known before any plot is drawn."""

from __future__ import annotations

from urllib.parse import quote

from reports.data.mechanics import DriveTable

SVG_SUFFIX, PNG_SUFFIX = ".svg", ".png"


def plot_name(kind: str, *names: str) -> str:
    """Return a file name without extension, such as "reactions.retract.B"; different names stay
    different.
    """
    return ".".join((kind, *(_safe(name) for name in names)))


def drive_names(drive: DriveTable) -> list[str]:
    """Return the names of a drive for plot_name: its case and, if the drive has one, its
    own name.
    """
    return [drive.case, drive.name] if drive.name else [drive.case]


def animation_name(case: str) -> str:
    """Return the file name of the animation of a case."""
    return f"animation_{_safe(case)}.html"


def _safe(name: str) -> str:
    # Dots separate the names, so a dot within a name is encoded.
    return quote(name, safe="").replace(".", "%2E")
