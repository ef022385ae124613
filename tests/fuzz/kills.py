"""Runs that are ended at a random moment: what is left in the folder, and of their processes."""

from __future__ import annotations

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from pinstress.cli import manifest
from tests.conftest import ROOT
from tests.support.programs.process_group import alive, heard

SIGNALS = (signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT)
PATIENCE = 30.0  # s for the last process to be gone, on a machine with other work
ONE_PIN = (ROOT / "studies" / "one_pin.toml").read_text()
PIN = ONE_PIN[ONE_PIN.index("[pin.B]") : ONE_PIN.index("[case.")]
TWO_PINS = ONE_PIN.replace(PIN, PIN + PIN.replace("[pin.B]", "[pin.C]").replace('"B"', '"C"'))
TWO_PINS = TWO_PINS.replace("{ B = [0.0, -988.86] }", "{ B = [0.0, -988.86], C = [100.0, 0.0] }")


@dataclass(frozen=True)
class Killed:
    """jobs, signal, after: what was done, s. found: "absent", "old" or "new", the folder
    afterwards; "half" if it is neither. ended: the run came to its own end before. status: as
    subprocess has it. left: whether a process of it was still there.
    """

    jobs: int
    signal: signal.Signals
    after: float
    found: str
    ended: bool
    status: int
    left: bool

    @property
    def wrong(self) -> str:
        """What must not be; empty when all is well."""
        if self.found == "half":
            return "a half-written folder"
        if self.left:
            return "a process is left"
        if not self.ended and self.signal != signal.SIGKILL and self.status not in (0, 130):
            return f"status {self.status}"
        return ""

    def __str__(self) -> str:
        return (
            f"--jobs {self.jobs}, {self.signal.name} after {self.after:.2f} s, folder "
            f"{self.found}: {self.wrong}"
        )


def whole_run(folder: Path, jobs: int) -> float:
    """Run the two pins to the end into `folder`/whole; how long it took, s."""
    (folder / "study.toml").write_text(TWO_PINS)
    spent = []
    for _ in range(2):  # the second with all files read before; the shorter, lest many end first
        start = time.monotonic()
        with _run(folder, "whole", jobs) as process:
            if process.wait():
                raise RuntimeError("the run to be ended does not work by itself")
        spent.append(time.monotonic() - start)
    return min(spent)


def kill(seed: int, folder: Path, jobs: int, longest: float) -> Killed:
    """End a run into `folder`/out within `longest` s; every other time over the results of an
    earlier one, `folder`/whole of `whole_run`.
    """
    rng = random.Random(seed)
    after, sent = rng.uniform(0.0, longest), rng.choice(SIGNALS)
    out = folder / f"out{seed}"
    if seed % 2:
        shutil.copytree(folder / "whole", out)
        (out / "old").touch()
        manifest.complete(out)
    process = _run(folder, out.name, jobs)
    with process:
        try:
            process.wait(after)
        except subprocess.TimeoutExpired:
            process.send_signal(sent)
        ended = process.wait() == 0
    deadline = time.monotonic() + PATIENCE
    while alive(process.pid) and time.monotonic() < deadline:
        time.sleep(0.02)
    found = _found(out, folder / "whole")
    return Killed(jobs, sent, after, found, ended, process.returncode, alive(process.pid))


def _run(folder: Path, out: str, jobs: int) -> subprocess.Popen[bytes]:
    command = "run", "study.toml", "--out", out, "--no-cache", "--jobs", str(jobs)
    with (folder / f"{out}.err").open("wb") as messages, heard():
        return subprocess.Popen(
            [sys.executable, "-X", "faulthandler", "-m", "pinstress", *command],
            cwd=folder,
            env=os.environ | {"PYTHONPATH": str(ROOT)},
            stdout=subprocess.DEVNULL,
            stderr=messages,
            process_group=0,
        )


def _found(out: Path, whole: Path) -> str:
    """What a folder is, beside the results of a whole run."""
    if not out.exists():
        return "absent"
    names, wanted = ({str(p.relative_to(f)) for p in f.rglob("*")} for f in (out, whole))
    if "old" in names:
        return "old" if names >= wanted else "half"
    ends = (out / "report.html").is_file() and "</html>" in (out / "report.html").read_text()
    try:
        pins = json.loads((out / "results.json").read_text())["pins"]
    except (OSError, ValueError):
        return "half"
    return "new" if names == wanted and ends and len(pins) == 2 else "half"
