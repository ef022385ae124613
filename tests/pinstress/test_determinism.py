"""The same study gives the same bytes, whatever the number of processes and the order of sets."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import ROOT

# three pins: of revolution, with a hole (tetrahedra), and in double shear (held by nothing)
STUDY = """
title = "Three pins"
units = "mm-N-s"
[material.steel]
youngs_modulus = "205 GPa"
poisson_ratio = 0.3
density = "7850 kg/m^3"
yield_strength = "600 MPa"
[pin.A]
material = "steel"
clamp = ["start"]
profile = [{ length = 20, diameter = 30 }, { length = 40, diameter = 20, connection = "A" }]
fillet = 4
[pin.B]
material = "steel"
clamp = ["start"]
profile = [{ length = 10, diameter = 30 }, { length = 20, diameter = 30, connection = "B" }]
hole = [{ z = 15, diameter = 20, angle = "20 deg" }]
[pin.C]
material = "steel"
profile = [{ length = 10, diameter = 10, connection = "C1" },
           { length = 20, diameter = 10, connection = "C2" },
           { length = 10, diameter = 10, connection = "C3" }]
[case.pull]
kind = "given"
table = "pull.csv"
[case.press]
kind = "given"
distribution = "cosine"
forces = { A = [30.0, 40.0], C1 = [0.0, 50.0], C2 = [0.0, -100.0], C3 = [0.0, 50.0] }
[analysis]
tolerance = 0.1
"""
TABLE = "connection,fx,fy,time\nA,0,100,0\nA,50,90,1\nB,10,20,0\nB,30,10,1\n"


def results(folder: Path, name: str, hash_seed: str, *options: str) -> dict[str, bytes]:
    """Every file that is no page or plot, with all times left out."""
    done = subprocess.run(
        [sys.executable, "-m", "pinstress", "run", "study.toml", "--out", name,
         *options],
        cwd=folder,
        env=os.environ | {"PYTHONHASHSEED": hash_seed, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
    )  # fmt: skip
    assert done.returncode in (0, 1), done.stderr
    files = {}
    for path in sorted((folder / name).rglob("*")):
        if path.suffix in (".json", ".csv", ".md", ".vtu"):
            text = re.sub(rb'"seconds": [0-9.e+-]+', b'"seconds"', path.read_bytes())
            files[str(path.relative_to(folder / name))] = text
    return files


@pytest.mark.slow
def test_bytes_do_not_depend_on_processes_or_hashes(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(STUDY)
    (tmp_path / "pull.csv").write_text(TABLE)
    first = results(tmp_path, "first", "0", "--jobs", "1")
    assert {"results.json", "vtk/A_pull.vtu", "vtk/B_pull.vtu", "vtk/C_press.vtu"} <= set(first)
    again = results(tmp_path, "again", "12345", "--jobs", "3")
    assert list(again) == list(first)
    assert [f for f in first if first[f] != again[f]] == []
