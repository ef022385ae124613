"""What someone with pyvista and results.json finds on the surface of pins never exceeds their row
and its error (benchmarks/joints/vtu_reader.py). The pins are drawn at random, as in
test_random_pins.py, and run by the command, from a file.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import pyvista

from benchmarks.joints.random_pins import PinTrial, pin_trials
from benchmarks.joints.trial_study import tapered, write_study
from benchmarks.joints.vtu_reader import SurfaceRead, read_folder, shut, von_mises
from tests.support.programs.command_line import run_here

TRIALS = pin_trials(20, 7)
NAMED = {"tapered": tapered(0.0), "tapered tube": tapered(0.3)}
# Fillets 0.02 to 0.2 d from lugs, tubes, grooves, touching lugs, motions.
SOME = 0, 2, 4, 6, 7, 8, 13, 17, 19


def run(trial: PinTrial, folder: Path, *options: str) -> list[SurfaceRead]:
    """At each growth of what is pressed: none, and a cell."""
    study, out = write_study(trial, folder), folder / "out"
    done = run_here("run", str(study), "--out", str(out), "--quiet", *options, cwd=folder)
    assert done.returncode in (0, 1), done.stderr
    return [x for grown in (0.0, 0.5, 1.0) for x in read_folder(out, grown)]


def require(found: list[SurfaceRead], files: int) -> None:
    assert len(found) == 3 * files
    for x in found:
        assert not x.violates, str(x)
        assert x.read > 0.6 * x.row  # it reads something


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize("k", SOME)
def test_nothing_on_the_surface_exceeds_the_row(k: int, tmp_path: Path) -> None:
    """On the surface's own file and on the outside of the solid's."""
    require(run(TRIALS[k], tmp_path, "--vtk", "solid"), 2)


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize("name", NAMED)
def test_nothing_on_cones_exceeds_the_row(name: str, tmp_path: Path) -> None:
    require(run(NAMED[name], tmp_path, "--vtk", "solid"), 2)


@pytest.mark.slow
def test_nothing_exceeds_a_row_that_is_only_decided(tmp_path: Path) -> None:
    """A row of a wide error."""
    require(run(TRIALS[16], tmp_path, "--tolerance", "0.2"), 1)


def written(folder: Path, stress: float, contact: bool = True) -> Path:
    """A folder of a cylinder of radius 1 with a bore of 0.5, from z = 0 to 4, with a tension of
    100 along z, and more at one node on the outer surface, at z = 2 and 90 degrees; it is pressed
    from z = 1 to 2 about 0 degrees, and has 100 in its row.
    """
    z, angle = np.meshgrid(np.linspace(0.0, 4.0, 9), np.radians(np.arange(0.0, 360.0, 15.0)))
    points = np.concatenate([
        np.stack([r * np.cos(angle).ravel(), r * np.sin(angle).ravel(), z.ravel()], axis=1)
        for r in (1.0, 0.5)
    ])  # fmt: skip
    n, m = 24, 9
    i, j = np.meshgrid(np.arange(n), np.arange(m - 1), indexing="ij")
    a, b = i * m + j, (i + 1) % n * m + j
    quads = np.stack([np.full_like(a, 4), a, a + 1, b + 1, b], axis=-1).reshape(-1, 5)
    other = quads + np.array([0, *4 * [n * m]])
    body = pyvista.PolyData(points, np.concatenate([quads, other]).ravel())
    tensor = np.zeros((len(points), 6))
    tensor[:, 2] = 100.0
    tensor[np.linalg.norm(points - [0.0, 1.0, 2.0], axis=1) < 1e-9, 2] = stress
    tensor[np.linalg.norm(points - [1.0, 0.0, 2.0], axis=1) < 1e-9, 2] = 1e6  # pressed
    body.point_data["stress [MPa]"] = tensor
    (folder / "vtk").mkdir(parents=True)
    body.cast_to_unstructured_grid().save(folder / "vtk" / "P_pull.vtu")
    row = {"pin": "P", "case": "pull", "max_von_mises": 100.0, "error_estimate": 1.0}
    row |= {"max_von_mises_interval": None, "governs": "surface"}
    cells = [[1.0, 2.0, -20.0, 20.0], [1.0, 2.0, 20.0, 60.0]]
    row["contact"] = {"bands": [{"pressed": cells}]} if contact else None
    results = {"units": {"stress": "MPa"}, "pins": [row]}
    (folder / "results.json").write_text(json.dumps(results), encoding="utf-8")
    return folder


def test_it_finds_what_is_more_and_where(tmp_path: Path) -> None:
    """102 for 100 +- 1, and nothing on a pressed cell; a growth of one cell shuts it out."""
    folder = written(tmp_path / "a", 102.0)
    (found,) = read_folder(folder)
    assert (found.read, found.z, found.angle) == pytest.approx((102.0, 2.0, 90.0))
    assert found.violates
    assert not replace(found, upper=102.0).violates
    assert "102 at z 2, 90.0 degrees" in str(found)
    (grown,) = read_folder(folder, 1.0)
    assert grown.read == pytest.approx(100.0)
    with pytest.raises(ValueError, match="one cell at most"):
        read_folder(folder, 1.5)
    assert read_folder(written(tmp_path / "b", 102.0, contact=False)) == []


def test_a_bore_is_never_pressed() -> None:
    points = np.array([[1.0, 0.0, 1.5], [0.5, 0.0, 1.5], [1.0, 0.0, 2.0], [1.0, 0.0, 2.2]])
    cells = np.array([[1.0, 2.0, -20.0, 20.0]])
    assert shut(points, cells, 0.0).tolist() == [True, False, True, False]
    assert shut(points, cells, 0.5).tolist() == [True, False, True, True]


def test_von_mises_of_a_tensor_in_the_order_of_vtk() -> None:
    """Tension, and shear by sqrt(3)."""
    tensors = np.array([[0.0, 0, 5, 0, 0, 0], [0, 0, 0, 0, 2, 0], [7, 7, 7, 0, 0, 0]])
    assert von_mises(tensors) == pytest.approx([5.0, 2.0 * 3.0**0.5, 0.0])
