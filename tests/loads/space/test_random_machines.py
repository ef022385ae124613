"""Random machines in space: Newton's and Euler's laws of every body, and rates by differences.

Each machine is a tree of bodies on driven joints, some of whose drives are replaced by links
between two bodies, so that it has loops. The laws are stated here body by body, from the wrenches
that the program reports, and not from its equations.
"""

import numpy as np

from loads import CosineDrive
from loads.forces.acting import ForceLaw
from loads.space.acting import SpaceForce, SpaceSpring
from loads.space.dynamics import SpaceDynamics, space_reactions
from loads.space.kinds import Kind
from loads.space.linkage import (
    JointAngle,
    JointTravel,
    Measured,
    PointDistance,
    RigidBody,
    SpaceJoint,
    SpaceLinkage,
    Vector,
)
from loads.space.motion import SpaceCourse, SpaceMotion
from tests.support.each import each

KINDS_WITH_DRIVES: tuple[Kind, ...] = ("revolute", "prismatic", "cylindrical")
DURATION = 1.0
SEEDS = (1, 2, 3, 5, 6, 7, 9, 10, 11, 12)  # others are drawn near a dead point
FORCE, COUPLE = (30.0, -20.0, 10.0), (1.0, 2.0, -3.0)


def vector(random: np.random.Generator, size: float = 1.0) -> Vector:
    x, y, z = size * random.standard_normal(3)
    return float(x), float(y), float(z)


def body(random: np.random.Generator, name: str, centre: Vector) -> RigidBody:
    """A body of some points of mass, so that its inertia is possible."""
    points = 0.2 * random.standard_normal((5, 3))
    points -= points.mean(axis=0)
    tensor = sum(0.4 * (p @ p * np.eye(3) - np.outer(p, p)) for p in points)
    rows = [(float(a), float(b), float(c)) for a, b, c in np.asarray(tensor)]
    return RigidBody(name, 2.0, centre, (rows[0], rows[1], rows[2]))


def machine(seed: int) -> tuple[SpaceLinkage, list[CosineDrive]]:
    """A tree of six bodies with two links that close loops, and the laws of its drives."""
    random = np.random.default_rng(seed)
    bodies, joints, measured = list[RigidBody](), list[SpaceJoint](), list[Measured]()
    inner = dict[int, set[int]]()  # numbers of the joints between each body and the ground
    for k in range(6):
        on = int(random.integers(-1, k)) if k else -1
        inner[k] = inner.get(on, set()) | {k}
        base = "ground" if on < 0 else bodies[on].name
        bodies.append(body(random, f"b{k}", vector(random)))
        kind = KINDS_WITH_DRIVES[int(random.integers(3))]
        friction = 0.01 * (kind == "revolute")
        joints.append(
            SpaceJoint(f"J{k}", kind, base, f"b{k}", vector(random), vector(random),
                       friction=friction)
        )  # fmt: skip
        if kind != "prismatic":
            measured.append(JointAngle(f"angle {k}", f"J{k}"))
        if kind != "revolute":
            measured.append(JointTravel(f"travel {k}", f"J{k}"))
    drives = [(m.name, int(m.name.split()[1])) for m in measured]
    for n, (one, other) in enumerate(((0, 4), (2, 5))):
        loop = inner[one] ^ inner[other]
        within = [d for d in drives if d[1] in loop]
        if not within:
            continue
        drives.remove(within[int(random.integers(len(within)))])
        ends = np.array([vector(random), vector(random)])
        along = ends[1] - ends[0]
        square = np.cross(along, vector(random))
        across = np.cross(along, square)
        bodies.append(body(random, f"link {n}", tuple(ends.mean(axis=0).tolist())))
        p, q = (tuple(e.tolist()) for e in ends)
        joints.append(SpaceJoint(f"U{n}", "universal", f"b{one}", f"link {n}", p,
                                 tuple(across.tolist()), tuple(square.tolist())))  # fmt: skip
        joints.append(SpaceJoint(f"S{n}", "spherical", f"link {n}", f"b{other}", q))
    ends_of_spring = (vector(random), vector(random))
    measured.append(PointDistance("spring", ("ground", "b3"), ends_of_spring))
    gravity = (1.0, -2.0, -9.0)
    linkage = SpaceLinkage(tuple(bodies), tuple(joints), tuple(measured),
                           tuple(name for name, _ in drives), gravity)  # fmt: skip
    laws = [CosineDrive(m.drawn, m.drawn + 0.1, DURATION) for m in linkage.drives]
    return linkage, laws


def solved(seed: int) -> tuple[SpaceMotion, SpaceDynamics, SpaceMotion]:
    """A machine's motion with its forces, and the same a little later and earlier."""
    linkage, laws = machine(seed)
    times = np.linspace(0.1, 0.9, 5)
    step = 1e-4
    course = SpaceCourse(linkage, laws, 0.0, DURATION)
    loads = (
        SpaceForce("b3", (0.1, 0.2, 0.3), FORCE, COUPLE, follows=True),
        SpaceSpring("spring", "spring", ForceLaw(5.0, 40.0, 1.0, 3.0)),
    )
    motion = course.at(times)
    near = course.at(np.concatenate([times - step, times + step]))
    return motion, space_reactions("motion", motion, loads), near


def acting_on(dynamics: SpaceDynamics, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Force (T, 3) on a body and moment about its centre of mass, of all but its weight."""
    motion, linkage = dynamics.motion, dynamics.motion.linkage
    centre = next(b.centre for b in linkage.bodies if b.name == name)
    place = motion.point(name, centre)[0]
    force, moment = np.zeros((2, len(motion), 3))

    def push(at: np.ndarray, f: np.ndarray, m: np.ndarray | float = 0.0) -> None:
        nonlocal force, moment
        force = force + f
        moment = moment + np.cross(at - place, f) + m

    for k, joint in enumerate(linkage.joints):
        for end, sign in ((joint.moving, -1.0), (joint.base, 1.0)):
            if end == name:
                at = motion.point(joint.moving, joint.at)[0]
                f, m = (x[:, k] for x in (dynamics.reactions.forces, dynamics.reactions.moments))
                push(at, sign * f, sign * m)
                if joint.friction:
                    axis = motion.rotation(joint.base) @ np.array(joint.axis)
                    axis /= np.linalg.norm(axis, axis=1)[:, None]
                    push(at, 0.0 * f, -sign * dynamics.friction[:, k, None] * axis)
    for d, drive in enumerate(linkage.drives):
        assert isinstance(drive, JointAngle | JointTravel)
        joint = linkage.joint(drive.joint)
        axis = motion.rotation(joint.base) @ np.array(joint.axis)
        axis /= np.linalg.norm(axis, axis=1)[:, None]
        size = dynamics.drive[:, d, None]
        for end, sign in ((joint.moving, 1.0), (joint.base, -1.0)):
            if end == name:
                at = motion.point(joint.moving, joint.at)[0]
                turns = isinstance(drive, JointAngle)
                push(at, sign * size * axis * (not turns), sign * size * axis * turns)
    if name == "b3":
        turn = motion.rotation(name)
        push(
            motion.point(name, (0.1, 0.2, 0.3))[0], turn @ np.array(FORCE), turn @ np.array(COUPLE)
        )
        spring = next(m for m in linkage.measured if isinstance(m, PointDistance))
        at, velocity, _ = motion.point(name, spring.ends[1])
        apart = at - np.array(spring.ends[0])
        length = np.linalg.norm(apart, axis=1)
        rate = np.einsum("ti,ti->t", apart, velocity) / length
        size = 5.0 - 40.0 * (length - 1.0) - 3.0 * rate
        push(at, (size / length)[:, None] * apart)
    return force, moment


@each("seed", SEEDS)
def test_laws_of_newton_and_euler_hold_for_every_body(seed: int) -> None:
    motion, dynamics, near = solved(seed)
    linkage, half = motion.linkage, len(near) // 2
    size = np.abs(dynamics.reactions.forces).max()
    for k, b in enumerate(linkage.bodies):
        force, moment = acting_on(dynamics, b.name)
        force = force + b.mass * np.array(linkage.gravity)
        _, _, acceleration = motion.point(b.name, b.centre)
        np.testing.assert_allclose(force, b.mass * acceleration, atol=1e-9 * size)
        # The rate of the angular momentum, by differences of the momentum itself.
        momentum = np.einsum("tij,tj->ti", near.inertias[:, k], near.spin(b.name))
        step = 0.5 * (near.times[half] - near.times[0])
        rate = (momentum[half:] - momentum[:half]) / (2.0 * step)
        np.testing.assert_allclose(moment, rate, atol=1e-6 * size)
        before, after = near[:half], near[half:]
        places = [m.point(b.name, b.centre)[0] for m in (before, after)]
        velocity = motion.point(b.name, b.centre)[1]
        difference = (places[1] - places[0]) / (2.0 * step)
        np.testing.assert_allclose(velocity, difference, atol=1e-6)
        turned = after.rotation(b.name) - before.rotation(b.name)
        spin = turned / (2.0 * step) @ np.swapaxes(motion.rotation(b.name), 1, 2)
        axial = np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=1)
        np.testing.assert_allclose(motion.spin(b.name), axial, atol=1e-6)
    scale = np.abs(dynamics.power).max() + np.abs(dynamics.drive).max()
    assert np.abs(dynamics.imbalance).max() < 1e-10 * scale
