"""The deck for CalculiX, and what is read of its answer."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from assess.opinion.calculix import (
    JOB_NAME,
    CalculixError,
    displacements,
    installed,
    run,
    seconds_of,
    solved,
    stresses,
)
from assess.opinion.calculix_deck import c3d10, write_deck
from benchmarks.solids.calculix_ours import FORCE, PIN, Loaded
from fea.core.material import Material
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from tests.support.errors import raises

# CalculiX manual, ten-node tetrahedral element: nodes 5 to 10 lie between these, from 1
C3D10_EDGES = ((1, 2), (2, 3), (3, 1), (1, 4), (2, 4), (3, 4))
COARSE = MeshSize(across=2.0, arc=1.0)
CORNERS = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
OUR_EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
NODES = np.concatenate([CORNERS, [(CORNERS[a] + CORNERS[b]) / 2.0 for a, b in OUR_EDGES]])


@pytest.mark.parametrize("z", [1.0, -1.0])
def test_middles_lie_between_their_corners_and_volumes_are_positive(z: float) -> None:
    nodes = NODES * [1.0, 1.0, z]
    (element,) = c3d10(nodes, np.arange(10)[None, :])
    x = nodes[element]
    assert np.linalg.det(x[1:4] - x[0]) > 0.0
    for middle, (a, b) in zip(x[4:], C3D10_EDGES, strict=True):
        assert np.array_equal(middle, (x[a - 1] + x[b - 1]) / 2.0)


def test_the_order_holds_on_a_mesh_of_a_pin() -> None:
    """Curved edges are off their chord's middle by a part of its length, far less than 0.3."""
    space = Loaded(solid_mesh(PIN, COARSE).mesh).space
    x = space.nodes[c3d10(space.nodes, space.elements)]
    assert np.linalg.det(x[:, 1:4] - x[:, :1]).min() > 0.0
    for k, (a, b) in enumerate(C3D10_EDGES, 4):
        chord = x[:, b - 1] - x[:, a - 1]
        off = np.linalg.norm(x[:, k] - x[:, a - 1] - chord / 2.0, axis=1)
        assert (off / np.linalg.norm(chord, axis=1)).max() < 0.3


def test_the_deck_of_one_element(tmp_path: Path, steel: Material) -> None:
    forces = np.zeros((10, 3))
    forces[3, 1], forces[9, 0] = -100.0, 1.0 / 3.0
    fixed = np.array([0, 1, 2, 13])
    write_deck(tmp_path / "job.inp", NODES, np.arange(10)[None, :], steel, fixed, forces)
    text = (tmp_path / "job.inp").read_text()
    assert text.startswith("*NODE, NSET=ALL\n1, 0, 0, 0\n2, 1, 0, 0\n")
    assert "\n*ELEMENT, TYPE=C3D10, ELSET=PIN\n1, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10\n" in text
    assert "\n*ELASTIC\n2e+11, 0.3\n" in text
    assert "\n*BOUNDARY\n1, 1\n1, 2\n1, 3\n5, 2\n*STEP\n" in text
    assert "\n*CLOAD\n4, 2, -100\n10, 1, 0.33333333333\n*NODE PRINT" in text


def test_the_deck_of_a_pin(tmp_path: Path, steel: Material) -> None:
    """All of the force is there, to the 11 digits of each part; no number has more than the 20
    characters that CalculiX reads.
    """
    pin = Loaded(solid_mesh(PIN, COARSE).mesh)
    space, deck = pin.space, tmp_path / "job.inp"
    write_deck(deck, space.nodes, space.elements, steel, 3 * pin.held, pin.forces)
    text = deck.read_text()
    assert max(len(field) for field in re.findall(r"[-+.\w]+", text)) <= 20
    loads = text.split("*CLOAD\n")[1].split("*NODE PRINT")[0].splitlines()
    values = np.array([[float(field) for field in line.split(",")] for line in loads])
    for axis, total in ((1.0, 0.0), (2.0, FORCE), (3.0, 0.0)):
        found = values[values[:, 1] == axis, 2].sum()
        assert found == pytest.approx(total, abs=1e-9 * FORCE)


def test_displacements_are_read(tmp_path: Path) -> None:
    path = tmp_path / "job.dat"
    path.write_text(
        "\n displacements (vx,vy,vz) for set ALL and time  0.1000000E+01\n\n"
        "         1  0.000000E+00  0.000000E+00 -0.000000E+00\n"
        "         2  6.645565E-11 -4.067764E-07 -1.410222E-11\n"
    )
    assert displacements(path)[1].tolist() == [6.645565e-11, -4.067764e-07, -1.410222e-11]


def test_stresses_are_read_in_our_order(tmp_path: Path) -> None:
    path = tmp_path / "job.frd"
    path.write_text(
        " -4  STRESS      6    1\n -5  SXX         1    4    1    1\n"
        " -1         1-1.00000E+00 2.00000E+00-3.00000E+00 4.00000E+00-5.00000E+00 6.00000E+00\n"
        " -1         2 0.00000E+00 0.00000E+00 0.00000E+00 0.00000E+00 0.00000E+00 0.00000E+00\n"
        " -3\n -4  ERROR       1    1\n -1         1 9.00000E+00\n -3\n"
    )
    found = stresses(path)
    assert found.shape == (2, 6)
    assert found[0].tolist() == [-1.0, 2.0, -3.0, -5.0, 6.0, 4.0]  # xx, yy, zz, yz, xz, xy


PRINTED = "Total CalculiX Time: 0.1\n"


def test_an_error_that_calculix_only_prints_is_told(tmp_path: Path) -> None:
    """Its status is 0 then."""
    with raises(CalculixError, "failed", "*ERROR: no such element"):
        solved(tmp_path, f"reading\n *ERROR: no such element\n{PRINTED}")
    with raises(CalculixError, "failed", "reading"):
        solved(tmp_path, "reading")


def test_results_that_are_missing_or_not_finite_are_told(tmp_path: Path) -> None:
    with raises(CalculixError, "unreadable-results"):
        solved(tmp_path, PRINTED)
    (tmp_path / f"{JOB_NAME}.dat").write_text("\n displacements\n\n 1 NaN 0. 0.\n")
    (tmp_path / f"{JOB_NAME}.frd").write_text(
        " -4  STRESS      6    1\n -1         1" + 6 * " 1.00000E+00" + "\n -3\n"
    )
    with raises(CalculixError, "not-finite"):
        solved(tmp_path, PRINTED)


def test_a_calculix_that_fails_or_is_missing_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with raises(CalculixError, "not-installed", "calculix-ccx"):
        run(tmp_path)
    (tmp_path / "ccx").write_text("#!/bin/sh\necho out of luck\nexit 201\n")
    (tmp_path / "ccx").chmod(0o755)
    with raises(CalculixError, "failed", "status 201", "out of luck"):
        run(tmp_path)


def test_what_a_run_printed_and_wrote_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A program in its place, on the deck's name: its folder, its words and its files."""
    deck_read = 'test "$1 $2" = "-i job" && test -r "$2.inp"'
    dat = "\\n displacements (vx,vy,vz)\\n\\n 1 1.0E-03 -2.0E-03 3.0E-03\\n"
    frd = (
        " -4  STRESS\\n -1         1"
        + "".join(f" {n}.00000E+00" for n in range(1, 7))
        + "\\n -3\\n"
    )
    (tmp_path / "ccx").write_text(
        f"#!/bin/sh\n{deck_read} || exit 1\nprintf '{dat}' > job.dat\nprintf '{frd}' > job.frd\n"
        "echo Total CalculiX Time: 2.5\n"
    )
    (tmp_path / "ccx").chmod(0o755)
    (tmp_path / f"{JOB_NAME}.inp").touch()
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    assert installed()
    printed = run(tmp_path)
    assert seconds_of(printed) == 2.5
    found = solved(tmp_path, printed)
    assert found.displacement.tolist() == [[1e-3, -2e-3, 3e-3]]
    assert found.stress.tolist() == [[1.0, 2.0, 3.0, 5.0, 6.0, 4.0]]  # xx, yy, zz, yz, xz, xy
    monkeypatch.setenv("PATH", str(tmp_path / "nothing"))
    assert not installed()
