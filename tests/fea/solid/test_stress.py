"""Von Mises, recovery at the surface, and the envelope over instants."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.voigt import von_mises
from fea.solid.model import SolidModel, UnitFields
from fea.solid.superposition import envelope
from geometry import Pin, Segment
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from tests.support.pins.unit_loads import forces as forces_on


@pytest.mark.parametrize(
    ("stress", "expected"),
    [
        ([100, 0, 0, 0, 0, 0], 100.0),
        ([0, 0, 0, 0, 0, 100], 100.0 * np.sqrt(3)),
        ([70, 70, 70, 0, 0, 0], 0.0),
        ([50, -50, 0, 0, 0, 0], 50.0 * np.sqrt(3)),
    ],
)
def test_known_states(stress: list[float], expected: float) -> None:
    assert von_mises(np.array(stress, dtype=float)) == pytest.approx(expected, abs=1e-6)


@given(st.lists(st.floats(-1e3, 1e3), min_size=6, max_size=6))
def test_from_principal_stresses(s: list[float]) -> None:
    xx, yy, zz, yz, xz, xy = s
    a, b, c = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    expected = np.sqrt(((a - b) ** 2 + (b - c) ** 2 + (c - a) ** 2) / 2)
    assert von_mises(np.array(s)) == pytest.approx(expected, abs=1e-5)


@pytest.fixture(scope="module")
def bar(steel: Material) -> UnitFields:
    """A bar clamped at its start with two bands."""
    pin = Pin(
        "P", (Segment(0.04, 0.02), Segment(0.02, 0.02, connection="B"),
              Segment(0.02, 0.02, connection="C"))
    )  # fmt: skip
    mesh = solid_mesh(pin, MeshSize(across=3.0), (0.04, 0.06, 0.08))
    return SolidModel(pin, mesh, steel, ("start",)).solve(forces_on("B", "C"))


def test_clamps_answer_every_unit_load(bar: UnitFields) -> None:
    """With its force and its moment about z = 0: the bands' middles are at 0.05 and 0.07 m, on the
    mesh's surface to 1e-6 m.
    """
    expected = np.zeros((6, 4))
    for k, (load, axis) in enumerate(bar.loads):
        force, arm = -np.eye(3)[axis], {"B": 0.05, "C": 0.07}[load.surface]
        expected[:, k] = [*force, *np.cross([0.0, 0.0, arm], force)]
    assert bar.support[:3] == pytest.approx(expected[:3], abs=1e-9)
    assert bar.support[3:] == pytest.approx(expected[3:], abs=1e-6)


def test_the_free_surface_carries_no_traction(bar: UnitFields) -> None:
    """With the mean normal of a node's facets, at every node inside the unloaded part."""
    s, space = bar.surface, bar.space
    index = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])
    near = space.nodes[s.corners][..., 2]
    free = np.isin(s.facets, space.mesh.boundaries["segment 1"])
    free &= (near.min(axis=1) > 0.001) & (near.max(axis=1) < 0.039)
    assert free.sum() > 20
    sigma = bar.stress[s.corners[free]][..., index, :]
    mean = np.zeros((len(space.nodes), 3))
    np.add.at(mean, s.corners, s.normals)
    normal = mean[s.corners[free]]
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    traction = np.einsum("fnabl,fnb->fnal", sigma, normal)
    assert np.abs(traction).max() < 1e-12 * np.abs(bar.stress).max()


def test_the_envelope_is_the_largest_of_all_instants(bar: UnitFields) -> None:
    rng = np.random.default_rng(0)
    forces = rng.standard_normal((25, 2, 3))
    forces[..., 2] = 0.0
    found = envelope(bar, PinLoads("case", ("B", "C"), forces), directions=1)
    brute = np.stack(
        [
            von_mises(bar.stress[bar.surface.nodes] @ forces[t, :, :2].ravel())
            for t in range(len(forces))
        ]
    )
    assert found.maximum == pytest.approx(brute.max(), rel=1e-12)
    assert found.instant == int(brute.max(axis=1).argmax())
    assert found.field == pytest.approx(brute.max(axis=0), rel=1e-10)


def test_an_envelope_of_no_points_is_zero(bar: UnitFields) -> None:
    """Where zones of singular stress cover all of a thin ring: it was a traceback."""
    only_c = PinLoads("case", ("C",), np.array([[[1.0, 2.0, 0.0]]]))
    assert envelope(bar, only_c, np.zeros(len(bar.points), dtype=bool)).maximum == 0.0


def test_a_band_without_force_in_a_case_is_unloaded(bar: UnitFields) -> None:
    only_c = PinLoads("case", ("C",), np.array([[[1.0, 2.0, 0.0]]]))
    assert bar.coefficients(only_c).tolist() == [[0.0, 0.0, 1.0, 2.0]]


def test_the_envelope_does_not_depend_on_which_way_round_the_pin_is_loaded(bar: UnitFields) -> None:
    """Loads turned by a ninth of a turn are among the directions that are averaged: the same
    maximum to round-off. And the mean comes nearer to the instant of the largest force than one
    direction on this mesh does.
    """
    angle = np.linspace(0.0, np.pi, 19)
    size = 1.0 - 0.02 * (angle / np.pi - 0.5) ** 2  # largest in the middle, by half a per cent
    forces = np.zeros((19, 1, 3))
    forces[:, 0, 0], forces[:, 0, 1] = size * np.cos(angle), size * np.sin(angle)
    loads = PinLoads("case", ("C",), forces)
    found = envelope(bar, loads)
    turned = envelope(bar, loads.turned(2 * np.pi / 9))
    assert turned.maximum == pytest.approx(found.maximum, rel=1e-10)
    assert found.scatter > 0.0
    assert abs(found.instant - 9) < abs(envelope(bar, loads, directions=1).instant - 9)
