"""The cost of local solids about cuts of every kind, each measured alone in a process of
its own.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import time

import numpy as np

from benchmarks.random_pins import STEEL
from benchmarks.timing import table
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.solve.solve import solve_pin
from geometry import Bottom, Cut, CutPin, Flat, Hole, Passage, Pin, Segment, Slot

D, MIDDLE, TOLERANCE, FURTHER = 0.02, 0.08, 0.01, 200
BANDS = ("A", "B", "C", "E")
SHAFT = Pin(
    "shaft",
    (
        *(Segment(0.01, D, connection="A"), Segment(0.01, D), Segment(0.01, D, connection="B")),
        Segment(0.1, D, name="middle"),
        *(Segment(0.01, D, connection="C"), Segment(0.01, D), Segment(0.01, D, connection="E")),
    ),
)
ROUNDED = 6e-4
KINDS: dict[str, Cut] = {
    "hole": Hole(MIDDLE, 0.004),
    "blind hole": Hole(MIDDLE, 0.004, 0.0, 0.008, Bottom(radius=ROUNDED)),
    "countersunk hole": Hole(MIDDLE, 0.004, chamfer=ROUNDED),
    "hole with rounded mouths": Hole(MIDDLE, 0.004, mouth_radius=ROUNDED),
    "flat": Flat(0.07, 0.09, 0.0085, 0.0, 0.001),
    "keyway": Slot(0.07, 0.09, 0.006, 0.0035, 0.0, ROUNDED),
    "slot through": Slot(0.077, 0.083, 0.004, None, 0.0),
    "passage through": Passage(0.0, 0.16, 0.004, 0.005),
    "blind passage": Passage(0.0, MIDDLE, 0.004, 0.005, 0.0, "start", Bottom(radius=ROUNDED)),
}


def four_point(count: int = 1) -> PinLoads:
    """Return four-point bending of 30 N m at the middle of the shaft, by forces along x."""
    size = 1500.0 * np.cos(np.arange(count))[:, None, None]
    forces = np.array([[1.0, 0, 0], [-1.0, 0, 0], [-1.0, 0, 0], [1.0, 0, 0]])
    return PinLoads("bending", BANDS, size * forces)


def cut_cost() -> str:
    """Return the table of all kinds, each at the extreme fibre in four-point bending, in its own
    process.
    """
    rows = []
    for kind in KINDS:
        command = [sys.executable, "-m", "benchmarks.cuts.cut_cost", kind]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
        rows.append(tuple(json.loads(done.stdout.splitlines()[-1])))
    head = (
        "cut", "unknowns", "meshes", "max von Mises, MPa", "±", "verdict", "processor s", "MB",
        f"{FURTHER} further instants, ms",
    )  # fmt: skip
    return table(head, rows)


def measured(kind: str) -> list[str | int]:
    """Return the row of a kind; the memory is that of this whole process."""
    pin, loads, start = CutPin(SHAFT, (KINDS[kind],)), four_point(), time.process_time()
    found = solve_pin(pin, STEEL, (), (loads,), Requirement(TOLERANCE))[0]
    spent, peak = time.process_time() - start, found.peak
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    assert found.answer is not None
    assert peak.max_von_mises is not None
    assert peak.error_estimate is not None
    again = time.process_time()
    found.answer.maxima(four_point(FURTHER))
    further = 1e3 * (time.process_time() - again)
    value, error = (f"{x / 1e6:.2f}" for x in (peak.max_von_mises, peak.error_estimate))
    return [
        kind, peak.dofs, len(peak.history), value, error, peak.verdict, f"{spent:.1f}",
        f"{memory:.0f}", f"{further:.0f}",
    ]  # fmt: skip


if __name__ == "__main__":
    print(json.dumps(measured(sys.argv[1])))
