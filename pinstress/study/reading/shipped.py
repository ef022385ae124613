"""Location of the studies that ship with the project, in the wheel or in the checkout."""

from __future__ import annotations

from pathlib import Path


def shipped_studies() -> dict[str, Path]:
    """Return the paths of the studies that ship with the program, by name."""
    folder = shipped("one_pin.toml").parent
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def shipped(name: str) -> Path:
    """Return the path of a shipped study."""
    here = Path(__file__).parents[2]
    inside = here / "studies" / name
    return inside if inside.is_file() else here.parent / "studies" / name
