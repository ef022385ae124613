"""The equations of linkages in space: their derivatives by differences, for every kind of joint."""

import numpy as np

from loads.space.equations import SpaceEquations
from loads.space.kinds import KINDS, Kind
from loads.space.linkage import (
    BodyAngle,
    JointAngle,
    JointTravel,
    PointDistance,
    Ratio,
    RigidBody,
    SpaceJoint,
    SpaceLinkage,
    Vector,
)
from loads.space.pose import BODY_COORDINATES
from tests.support.each import each

STEP = 1e-6


def axes_for(kind: Kind) -> tuple[Vector | None, Vector | None]:
    """As many axes as a kind needs, at a right angle."""
    axes = KINDS[kind].axes
    return (0.2, 0.1, 1.0) if axes else None, (1.0, -0.2, -0.18) if axes > 1 else None


def linkage_of(kind: Kind) -> SpaceLinkage:
    """Two bodies askew, with a joint of the kind to the ground and one between them."""
    joints = (
        SpaceJoint("J1", kind, "ground", "one", (0.1, 0.2, 0.0), *axes_for(kind)),
        SpaceJoint("J2", kind, "one", "two", (0.7, 0.2, 0.1), *axes_for(kind)),
        SpaceJoint("H", "cylindrical", "one", "two", (0.2, 0.5, 0.4), axis=(1.0, 2.0, 3.0)),
    )
    measured = (
        JointAngle("turn", "H"),
        JointTravel("slide", "H"),
        PointDistance("span", ("ground", "two"), ((0.5, 0.0, 0.0), (1.0, 2.0, 3.0))),
        BodyAngle("lean", "ground", "two", (0.1, 1.0, 0.3)),
    )
    return SpaceLinkage(
        bodies=(
            RigidBody("one", 1.0, (0.3, 0.1, 0.0)),
            RigidBody("two", 2.0, (1.0, 0.4, 0.2)),
        ),
        joints=joints,
        measured=measured,
        driven=("turn",),
        ratios=(Ratio("gear", ("turn", "slide"), (0.1, 1.0)),),
    )


def somewhere(equations: SpaceEquations) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates away from the drawing, and rates, both (1, n), with Euler parameters of length 1
    and at a right angle to their rates.
    """
    random = np.random.default_rng(1)
    q, v = 0.2 * random.standard_normal((2, 1, equations.columns))
    for body in range(equations.bodies):
        k = slice(BODY_COORDINATES * body + 3, BODY_COORDINATES * (body + 1))
        p = q[0, k] + (1.0, 0.0, 0.0, 0.0)
        p /= np.linalg.norm(p)
        q[0, k] = p - (1.0, 0.0, 0.0, 0.0)
        v[0, k] -= p * (p @ v[0, k])
    return q, v


@each("kind", KINDS)
def test_jacobian_is_the_derivative_of_the_residual(kind: Kind) -> None:
    equations = SpaceEquations(linkage_of(kind))
    q, _ = somewhere(equations)
    drives = np.zeros((1, 1))

    def residual(q: np.ndarray) -> np.ndarray:
        return np.asarray(equations.residual(q, equations.pose(q), drives)[0])

    steps = STEP * np.eye(equations.columns)
    columns = [(residual(q + h) - residual(q - h)) / (2.0 * STEP) for h in steps]
    expected = np.stack(columns, axis=1) / equations.scale
    np.testing.assert_allclose(equations.jacobian(equations.pose(q))[0], expected, atol=1e-8)


@each("kind", KINDS)
def test_quadratic_accelerations_are_the_second_derivative(kind: Kind) -> None:
    equations = SpaceEquations(linkage_of(kind))
    q, v = somewhere(equations)
    a = np.zeros_like(v)
    for body in range(equations.bodies):  # keeps the length of the Euler parameters
        k = slice(BODY_COORDINATES * body + 3, BODY_COORDINATES * (body + 1))
        a[0, k] = -(q[0, k] + (1.0, 0.0, 0.0, 0.0)) * (v[0, k] @ v[0, k])
    drives, h = np.zeros((1, 1)), 1e-4
    points = [q + s * v + 0.5 * s * s * a for s in (-h, 0.0, h)]
    before, at, after = (equations.residual(p, equations.pose(p), drives)[0] for p in points)
    pose = equations.pose(q)
    linear = equations.jacobian(pose)[0] @ (a[0] * equations.scale)
    second = (after - 2.0 * at + before) / h**2
    np.testing.assert_allclose(second, linear - equations.bend_side(pose, v)[0], atol=2e-6)


def test_number_of_conditions_is_what_each_kind_prevents() -> None:
    freedoms = {
        "revolute": 1, "spherical": 3, "universal": 2, "cylindrical": 2, "prismatic": 1,
        "planar": 3, "fixed": 0, "point-on-line": 4,
    }  # fmt: skip
    for kind, conditions in KINDS.items():
        assert conditions.count == 6 - freedoms[kind], kind
        # Nothing that a joint allows is prevented, and all the rest is: by rank, at the drawing.
        joint = SpaceJoint("J", kind, "ground", "body", (0.1, 0.2, 0.0), *axes_for(kind))
        linkage = SpaceLinkage((RigidBody("body", 1.0, (0.3, 0.1, 0.0)),), (joint,))
        equations = SpaceEquations(linkage)
        J = equations.jacobian(equations.pose(np.zeros((1, equations.columns))))[0]
        rank = np.linalg.matrix_rank(J)
        assert equations.columns - rank == freedoms[kind] == equations.kutzbach, kind
