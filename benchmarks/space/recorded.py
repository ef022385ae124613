"""Forces of other codes in files, so that tests can compare with them where the codes are not
installed.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from benchmarks import ROOT
from benchmarks.space.machines import MACHINES
from benchmarks.space.peer_forces import PeerForces
from pinbase.arrays import Floats

FOLDER = ROOT / "tests" / "loads" / "space" / "peers"
INSTANTS = 6
HEAD = ("machine", "time", "name", "x", "y", "z", "fx", "fy", "fz", "mx", "my", "mz")


def instants(name: str) -> Floats:
    """Return equally spaced times of a machine, s, at which codes are compared; at the last it is
    at rest.
    """
    return np.linspace(0.0, MACHINES[name]()["duration"], INSTANTS + 1)[1:]


def write(code: str, results: dict[str, tuple[PeerForces, float]]) -> Path:
    """Write the result of a code for every machine, with its measured error, to CODE.csv; return
    the path.

    Drives have their force or torque as x.
    """
    path = FOLDER / f"{code}.csv"
    FOLDER.mkdir(exist_ok=True)
    with path.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(HEAD)
        for name, (forces, error) in results.items():
            machine = MACHINES[name]()
            rows.writerow([name, "", "error", f"{error:.2g}"])
            wrenches = np.concatenate([forces.points, forces.forces, forces.moments], axis=2)
            for t, time in enumerate(instants(name)):
                at = f"{time:.12g}"
                for joint, values in zip(machine["joints"], wrenches[t], strict=True):
                    rows.writerow([name, at, joint, *(f"{v:.14g}" for v in values)])
                for drive, value in zip(machine["drives"], forces.drives[t], strict=True):
                    rows.writerow([name, at, drive, f"{value:.14g}"])
    return path


def read(code: str, name: str) -> tuple[PeerForces, float]:
    """Return the result of a code for a machine at its `instants`, and the code's
    measured error.
    """
    machine = MACHINES[name]()
    with (FOLDER / f"{code}.csv").open(encoding="utf-8") as file:
        rows = [row for row in csv.reader(file) if row[0] == name]
    (error,) = (float(row[3]) for row in rows if row[2] == "error")

    def values(names: list[str], columns: slice) -> Floats:
        chosen = {n: [[float(x) for x in r[columns]] for r in rows if r[2] == n] for n in names}
        return np.stack([np.array(chosen[n]) for n in names], axis=1)

    wrenches = values(list(machine["joints"]), slice(3, 12))
    drives = values(list(machine["drives"]), slice(3, 4))[..., 0]
    points, forces, moments = np.split(wrenches, 3, axis=2)
    return PeerForces(points, forces, moments, drives), error
