"""Turned bodies given as a profile, as CAD, and solved as solids: times of whole commands, one by
one.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.timing import table
from geometry import Pin, Segment, meridian
from geometry.mesh.gmsh_session import gmsh_model
from geometry.mesh.revolve import revolve
from reports.format.numbers import engineering

SHAPES = {
    "shoulder, radius 2 mm": (Segment(15.0, 30.0, fillet=2.0),),
    "shoulder, sharp": (Segment(15.0, 30.0),),
    "cone of 45 degrees, radius 4 mm": (
        Segment(10.0, 30.0),
        Segment(5.0, 30.0, end_diameter=20.0, fillet=4.0),
    ),
}
STUDY = """title = "Shapes"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "500 MPa"
[pin.P]
material = "steel"
{shape}
[case.bent]
kind = "given"
distribution = "cosine"
forces = {{ A = [0, -5000], B = [0, 5000], C = [0, 7500], D = [0, -7500] }}
"""
BANDS = {"A": (0, 10), "B": (15, 25), "C": (50, 55), "D": (60, 65)}
RUNS = 3


def shapes() -> str:
    """Return the table."""
    rows = []
    for name, middle in SHAPES.items():
        pin = Pin("P", (Segment(25.0, 30.0), *middle, Segment(30.0, 20.0)))
        with tempfile.TemporaryDirectory() as made:
            folder = Path(made)
            _draw(pin, folder)
            _study(folder / "profile.toml", f"meridian = {_corners(pin)}")
            _study(folder / "cad.toml", 'geometry = "pin.step"')
            rows += [
                row(name, "`meridian`", folder / "profile.toml", RUNS),
                row(name, "CAD file", folder / "cad.toml", RUNS),
                row(name, "solid (`--model solid`)", folder / "cad.toml", 1, "--model", "solid"),
            ]
    head = ("shape", "given as", "command, s", "model", "largest stress, MPa", "±, MPa", "verdict")
    return (
        "A pin of 30 and 20 mm, bent by two couples at its ends, pictures left out. The "
        "least of three runs, of one for solids:\n\n" + table(head, rows)
    )


def _corners(pin: Pin) -> list[list[float]]:
    out = [[0.0, pin.segments[0].diameter / 2]]
    for i, z in enumerate(pin.stations[1:-1]):
        ends = dict.fromkeys((pin.segments[i].diameters[1], pin.segments[i + 1].diameter))
        out += [[z, d / 2, pin.fillet_at(i) if d == min(ends) else 0.0] for d in ends]
    return [*out, [pin.length, pin.segments[-1].diameter / 2]]


def _draw(pin: Pin, folder: Path) -> None:
    with gmsh_model(pin.name) as gmsh:
        revolve(gmsh, meridian(pin))
        gmsh.write(str(folder / "pin.step"))


def _study(path: Path, shape: str) -> None:
    bands = "\n".join(f"band.{name} = {{ z = [{a}, {b}] }}" for name, (a, b) in BANDS.items())
    path.write_text(STUDY.format(shape=f"{shape}\n{bands}"))


def row(shape: str, given: str, study: Path, runs: int, *more: str) -> tuple[str, ...]:
    out, spent = study.with_suffix(""), []
    for _ in range(runs):
        start = time.perf_counter()
        command = [sys.executable, "-m", "pinstress", "run", str(study)]
        subprocess.run(
            [*command, "--out", str(out), "--quiet", *more], check=False, capture_output=True
        )
        spent.append(time.perf_counter() - start)
    (found,) = json.loads((out / "results.json").read_text())["pins"]
    error = found["error_estimate"]
    return (
        shape,
        given,
        engineering(min(spent), 3),
        found["model"],
        engineering(found["max_von_mises"], 4),
        "-" if error is None else engineering(error, 2),
        found["verdict"],
    )
