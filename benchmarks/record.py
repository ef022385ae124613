"""Measured tables as files that the documentation includes, so that no figure is typed by hand."""

from __future__ import annotations

import datetime
import os
import platform
from pathlib import Path

from benchmarks import ROOT

FOLDER = ROOT / "docs" / "measured"


def record(name: str, text: str, command: str = "") -> Path:
    """Write a benchmark's text with its command, day and machine; returns the file."""
    FOLDER.mkdir(exist_ok=True)
    path = FOLDER / f"{name}.md"
    day = datetime.date.today().isoformat()
    told = f"`{command or f'python -m benchmarks {name}'}`, {day}, {machine()}:"
    if not any(line.startswith(("|", "## ")) for line in text.splitlines()):
        text = f"```text\n{text}\n```"  # not Markdown: its lines would run together
    path.write_text(f"{told}\n\n{text}\n", encoding="utf-8")
    return path


def machine() -> str:
    """Processor, cores, and how busy they were: other work stretches wall times."""
    lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    models = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    model = models[0] if models else platform.machine()
    cores, load = len(os.sched_getaffinity(0)), os.getloadavg()[1]
    return f"{cores} cores of {model}, load {load:.1f}"
