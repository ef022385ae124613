"""Limit loads of lugs: closed forms, independent mechanisms, and what shapes are refused."""

import math

import numpy as np
import pytest

from assess.plastic.body import Elements, FlowingBody, Ties, untied
from assess.plastic.flow import FlowRule
from assess.plastic.limit_load import limit_on_mesh
from assess.plastic.lug.bounds import QuadraticNodes, lower_program, upper_program
from assess.plastic.lug.cone_program import solve_cone_program
from assess.plastic.lug.limit_load import PULL, lug_limit_load
from assess.plastic.lug.mesh import PlaneMesh, half_lug_mesh
from assess.plastic.mechanism import RefinedElements
from fea.core.material import Material
from geometry import ArgumentError
from geometry.shape.lug_outline import LugOutline
from tests.support.each import each
from tests.support.lug_outlines import round_lug, square_lug

KSI = 6.894757e6
SHEAR = 60.0 * KSI / math.sqrt(3.0)


@each("width", [1.1, 1.4])
def test_a_narrow_strip_fails_in_its_net_section(width: float) -> None:
    """2 k (w - D): the ligaments carry 2 k each and can neck along slip lines at 45 degrees."""
    limit = lug_limit_load(square_lug(1.0, width, 2.0), 60.0 * KSI)
    exact = 2.0 * SHEAR * (width - 1.0)
    assert limit.lower < exact * 1.0001
    assert limit.upper > exact * 0.9999
    assert limit.half_width < 0.016


@each("ratio", [1.0, 1.5, 2.0])
def test_a_block_that_slides_out_is_an_upper_bound(ratio: float) -> None:
    """Two planes along the load, tangent to the bore: 2 k e is never less than the limit load."""
    limit = lug_limit_load(square_lug(1.0, 4.0, ratio), 60.0 * KSI, 0.1)
    assert limit.lower < 2.0 * SHEAR * ratio


def test_an_elastic_plastic_body_carries_the_pressure_of_the_lower_bound() -> None:
    """Quadratic triangles with radial return, under the pressures that the static bound found: they
    reach its load, and no more than the kinematic bound of all pressures.
    """
    mesh = half_lug_mesh(round_lug(1.0, 3.0), 0.12)
    static = solve_cone_program(lower_program(mesh, PULL))
    kinematic = solve_cone_program(upper_program(mesh, PULL))
    space = QuadraticNodes(mesh)
    body, ties = _flowing(mesh, space)
    edges = mesh.edges["bore"]
    pressure = static.loads.reshape(2, -1)
    forces = np.zeros((space.count, 3))
    along = mesh.nodes[edges[:, 1]] - mesh.nodes[edges[:, 0]]
    push = np.stack([-along[:, 1], along[:, 0]], axis=1)
    first, last, middle = space.of_edges(edges).T
    for nodes, share in (
        (first, pressure[0] / 6.0),
        (last, pressure[1] / 6.0),
        (middle, pressure.sum(axis=0) / 3.0),
    ):
        np.add.at(forces[:, :2], nodes, share[:, None] * push)
    assert forces[:, 0].sum() == pytest.approx(static.lower, rel=1e-3)
    same = RefinedElements(body.elements, np.eye(3))
    limit = limit_on_mesh(body, np.asarray(ties.matrix.T @ forces.ravel()), same)
    assert 1.0 < limit.reached < kinematic.upper / static.lower


def _flowing(mesh: PlaneMesh, space: QuadraticNodes) -> tuple[FlowingBody, Ties]:
    """The half of a lug as a body in plane strain whose yield in shear is 1."""
    nodes = np.zeros((space.count, 3))
    nodes[space.numbers[:, :3], :2] = mesh.corners()
    nodes[space.numbers[:, 3:], :2] = (mesh.corners() + np.roll(mesh.corners(), -1, axis=1)) / 2.0
    places = np.full((3, 3), 1.0 / 6.0) + np.eye(3) / 2.0
    gradients = np.zeros((len(mesh.triangles), 3, 6, 3))
    gradients[..., 0], gradients[..., 1] = space.gradients(places)
    weights = np.repeat(mesh.gradients()[1][:, None] / 3.0, 3, axis=1)
    zero = np.zeros((space.count, 3), dtype=bool)
    zero[:, 2] = True
    zero[space.of_edges(mesh.edges["axis"]), 1] = True
    zero[space.of_edges(mesh.edges["held"])] = True
    ties = untied(space.count).without(np.flatnonzero(zero.ravel()))
    rule = FlowRule(Material("rigid", 1e3, 0.3, None, math.sqrt(3.0)))
    return FlowingBody(Elements(nodes, space.numbers, gradients, weights), ties, rule), ties


def test_shapes_that_carry_more_in_order() -> None:
    """A larger body carries at least as much: a round head within a tapered and a square one, an
    eccentric bore nearer to the end.
    """
    outlines = [
        LugOutline("round", 1.0, 3.0, 3.0, 3.0, 1.2),  # eccentric
        LugOutline("round", 1.0, 3.0, 3.0, 3.0, 1.5),
        LugOutline("tapered", 1.0, 3.0, 4.0, 3.0, 1.5),
        LugOutline("square", 1.0, 0.0, 4.0, 3.0, 1.5),
    ]
    limits = [lug_limit_load(outline, 1e6, 0.1) for outline in outlines]
    assert limits[0].upper < limits[1].lower
    assert limits[1].lower < limits[2].upper
    assert limits[2].lower < limits[3].upper


def test_a_bushing_is_part_of_the_pin() -> None:
    bushed = LugOutline("round", 0.75, 3.0, 3.0, 3.0, 1.5, interface=1.0)
    limits = [lug_limit_load(outline, 1e6, 0.1) for outline in (bushed, round_lug(1.0, 3.0))]
    assert limits[0].load == pytest.approx(limits[1].load, rel=1e-9)


def test_a_ring_is_refused() -> None:
    with pytest.raises(ArgumentError, match="without a shank"):
        lug_limit_load(LugOutline("ring", 1.0, 3.0), 1e6)


def test_a_strength_that_is_none_is_refused() -> None:
    with pytest.raises(ArgumentError, match="yield strength"):
        lug_limit_load(round_lug(1.0, 3.0), 0.0)
