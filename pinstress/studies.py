"""Where the studies that ship with the project are: in the wheel, or in the checkout."""

from __future__ import annotations

from pathlib import Path


def shipped(name: str) -> Path:
    """Path of a shipped study."""
    here = Path(__file__).parent
    inside = here / "studies" / name
    return inside if inside.is_file() else here.parent / "studies" / name
