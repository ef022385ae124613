"""Measured tables as files that the documentation includes, so that no number is typed by hand."""

from __future__ import annotations

import datetime
import os
import platform
from pathlib import Path

from benchmarks import ROOT

FOLDER = ROOT / "docs" / "measured"


def record(name: str, text: str, command: str = "") -> Path:
    """Write a benchmark's text with its command, day and machine; return the file."""
    FOLDER.mkdir(exist_ok=True)
    path = FOLDER / f"{name}.md"
    day = datetime.date.today().isoformat()
    told = f"`{command or f'python -m benchmarks {name}'}`, {day}, {machine()}:"
    if not any(line.startswith(("|", "## ")) for line in text.splitlines()):
        text = f"```text\n{text}\n```"  # plain text: Markdown would join its lines
    path.write_text(f"{told}\n\n{text}\n", encoding="utf-8")
    return path


def machine() -> str:
    """Return the processor, the number of cores, and their load, since other work increases wall
    times.
    """
    lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    models = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    model = models[0] if models else platform.machine()
    cores, load = len(os.sched_getaffinity(0)), os.getloadavg()[1]
    return f"{cores} cores of {model}, load {load:.1f}"
