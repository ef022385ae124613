"""The bounds of plane bodies in plane strain contain limit loads in closed form, and close in."""

import math

import numpy as np
import pytest

from assess.plastic.lug.bounds import lower_program, upper_program
from assess.plastic.lug.cone_program import solve_cone_program
from assess.plastic.lug.mesh import PlaneMesh, plane_mesh
from pinbase.arrays import Floats


def _bounds(mesh: PlaneMesh, motion: Floats) -> tuple[float, float]:
    lower = solve_cone_program(lower_program(mesh, motion)).lower
    return lower, solve_cone_program(upper_program(mesh, motion)).upper


def _grid(x: Floats, y: Floats) -> tuple[Floats, np.ndarray]:
    """Nodes and triangles of a grid, each cell cut by both diagonals."""
    nodes = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    i, j = (a.ravel() for a in np.meshgrid(*(np.arange(len(v) - 1) for v in (x, y)), indexing="ij"))
    corner = i * len(y) + j
    square = np.stack([corner, corner + len(y), corner + len(y) + 1, corner + 1], axis=1)
    middle = len(nodes) + np.arange(len(square))
    nodes = np.concatenate([nodes, nodes[square].mean(axis=1)])
    parts = [np.stack([square[:, a], square[:, (a + 1) % 4], middle], axis=1) for a in range(4)]
    return nodes, np.concatenate(parts)


def _boundary(triangles: np.ndarray) -> np.ndarray:
    sides = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    key, count = np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)
    return np.asarray(key[count == 1])


def _punch(fine: int) -> PlaneMesh:
    """Half of a block below a punch of half width 1 that moves along x, fine at its edge."""
    near = np.linspace(0.0, 1.0, fine + 1) ** 2
    y = np.concatenate([1.0 - near[::-1], 1.0 + near[1:], 2.0 + (near * 2.5)[1:]])
    x = np.linspace(0.0, 1.0, 2 * fine + 1) ** 1.5 * 3.0
    nodes, triangles = _grid(x, y)
    edges = _boundary(triangles)
    middle = nodes[edges].mean(axis=1)
    under = (middle[:, 0] < 1e-9) & (middle[:, 1] < 1.0)
    axis = middle[:, 1] < 1e-9
    above = (middle[:, 0] < 1e-9) & ~under
    names = {"bore": under, "axis": axis, "free": above, "held": ~(under | axis | above)}
    return plane_mesh(nodes, triangles, {name: edges[which] for name, which in names.items()})


def _cylinder(fine: int) -> PlaneMesh:
    """A quarter of a thick cylinder of radii 1 and 2."""
    r, angle = np.linspace(1.0, 2.0, fine + 1), np.linspace(0.0, math.pi / 2.0, 2 * fine + 1)
    flat, triangles = _grid(r, angle)
    nodes = flat[:, :1] * np.stack([np.cos(flat[:, 1]), np.sin(flat[:, 1])], axis=1)
    edges = _boundary(triangles)
    radius = flat[edges, 0].mean(axis=1)
    inner, outer = radius < 1.0 + 1e-9, radius > 2.0 - 1e-9
    names = {"bore": inner, "free": outer, "axis": ~(inner | outer)}
    return plane_mesh(nodes, triangles, {name: edges[which] for name, which in names.items()})


@pytest.mark.parametrize(("fine", "width"), [(4, 0.13), (8, 0.07)])
def test_prandtls_punch(fine: int, width: float) -> None:
    """(2 + pi) k: the hardest closed form for elements that lock, because flow is everywhere."""
    lower, upper = _bounds(_punch(fine), np.array([1.0, 0.0]))
    exact = 2.0 + math.pi
    assert lower < exact < upper
    assert upper - lower < width * exact


@pytest.mark.parametrize(("fine", "width"), [(3, 0.06), (6, 0.02)])
def test_thick_cylinder(fine: int, width: float) -> None:
    """2 k ln(b / a); the polygon of the bore, not the arc, is what is pressed."""
    mesh = _cylinder(fine)
    ends = mesh.nodes[mesh.edges["bore"]]
    along = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(along, axis=1)
    outwards = np.stack([-along[:, 1], along[:, 0]], axis=1) / length[:, None]
    lower, upper = _bounds(mesh, outwards)
    exact = 2.0 * math.log(2.0) * math.pi / 2.0
    assert (1.0 - width) * exact < lower < 1.001 * exact
    assert 0.999 * exact < upper < (1.0 + width) * exact
