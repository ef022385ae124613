"""Mobility by the rank of the loop equations: unconstrained bodies and redundant connections."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from loads.linkage.linkage import GROUND, Linkage, LinkageError
from loads.motion.as_drawn import moves_nearby, rank, singular_as_drawn
from loads.motion.joint_forces import connection_members
from loads.motion.loop_equations import Loops, Pose
from pinbase.arrays import Floats

MIN_PARTICIPATION = 1e-6  # of the largest component of a null vector


@dataclass(frozen=True)
class Mobility:
    """Degrees of freedom and redundancy in the drawn position.

    kutzbach: degrees of freedom by counting links and joints.
    degrees: degrees of freedom by rank, without drives.
    free: degrees of freedom that remain with the drives locked; 0: the position is determined.
    loose: bodies that can move then.
    redundant: number of redundant equations.
    shared: connections whose force rigid-body statics does not determine.
    """

    kutzbach: int
    degrees: int
    free: int
    loose: tuple[str, ...]
    redundant: int
    shared: tuple[str, ...]


def mobility(linkage: Linkage) -> Mobility:
    """Mobility and redundancy as drawn.

    Raises: LinkageError for bodies that are not joined to the ground.
    """
    loops = Loops(linkage)
    pose = loops.pose(np.zeros((1, loops.columns)))
    J = loops.jacobian(pose)[0]
    left, singular, right = np.linalg.svd(J)
    equations = rank(singular)
    guided = J[: loops.guides]
    free = right[equations:]
    return Mobility(
        kutzbach=kutzbach(linkage),
        degrees=loops.columns - rank(np.linalg.svd(guided, compute_uv=False)),
        free=len(free),
        loose=moving_bodies(loops, pose, free / loops.scale),
        redundant=len(J) - equations,
        shared=stressed_connections(loops, pose, left[:, equations:]),
    )


def kutzbach(linkage: Linkage) -> int:
    """Degrees of freedom by Kutzbach: 3 (links - 1) - 2 (pins and sliders) - pairs of teeth.

    A pin at which k links meet counts k - 1 times; particles do not count. Welded bodies are one
    link.
    """
    names = [b.name for b in linkage.bodies if not is_particle(linkage, b.name)] + [GROUND]
    link = {name: linkage.rigid[name][0] for name in names}
    pins = 0
    for joint in linkage.joints:
        meeting = (*(c.body for c in joint.connections), joint.fixed_in or "")
        pins += max(len({link[name] for name in meeting if name in link}) - 1, 0)
    links = len({*link.values()})
    return 3 * (links - 1) - 2 * (pins + len(linkage.sliders)) - len(linkage.teeth)


def is_particle(linkage: Linkage, name: str) -> bool:
    """Whether a body is a particle at its connection."""
    body = next(b for b in linkage.bodies if b.name == name)
    slides = any(name in (s.base, s.moving) for s in linkage.sliders)
    return body.inertia is None and not slides


def moving_bodies(
    loops: Loops, pose: Pose, rates: Floats, least: float = MIN_PARTICIPATION
) -> tuple[str, ...]:
    """Names of the bodies that move in any of k motions.

    pose: at a single instant.
    rates: (k, n) of the coordinates.
    least: speed of a body that moves, relative to the fastest.
    """
    if not len(rates):
        return ()
    linkage, angles = loops.linkage, loops.frames - 1
    slopes = loops.partials(pose, loops.centres)[0]
    speed = np.abs(rates @ slopes)[:, : len(linkage.bodies)]
    for i, body in enumerate(linkage.bodies):
        f = loops.frame[i]
        if f and body.inertia is not None and f <= angles:
            speed[:, i] += linkage.length_scale * np.abs(rates[:, f - 1])
    largest = speed.max(axis=0)
    return tuple(
        b.name for b, v in zip(linkage.bodies, largest, strict=True) if v > least * largest.max()
    )


def stressed_connections(loops: Loops, pose: Pose, multipliers: Floats) -> tuple[str, ...]:
    """Names of the connections and teeth that carry any of k sets of self-equilibrated forces.

    pose: at a single instant.
    multipliers: (rows, k).
    """
    closing = loops.closing_forces(pose, multipliers.T)
    if not closing.size:
        return ()
    no_forces = np.zeros((len(closing), len(loops.linkage.items)), dtype=complex)
    forces = connection_members(loops).forces(no_forces, closing)
    size = np.abs(np.hstack([forces, closing[:, len(loops.closing) :]])).max(axis=0)
    names = [name for name, _ in loops.linkage.forces]
    return tuple(n for n, f in zip(names, size, strict=True) if f > MIN_PARTICIPATION * size.max())


def require_determined(linkage: Linkage) -> Mobility:
    """The mobility of a linkage whose drives determine every position.

    Raises: LinkageError where they do not, with the bodies that can still move; for too many
    drives; and for sharing rules without effect.
    """
    freedom = mobility(linkage)
    if 0 < freedom.degrees < len(linkage.driven):
        raise LinkageError(
            f"{len(linkage.driven)} drives ({', '.join(linkage.driven)}) for {freedom.degrees} "
            "degree(s) of freedom: remove one",
            "too-many-drives",
            ("drive",),
        )
    if freedom.free:
        raise _unconstrained(linkage, freedom)
    if errors := list(_idle_sharing(linkage, freedom)):
        raise LinkageError.all(errors)
    return freedom


def _unconstrained(linkage: Linkage, freedom: Mobility) -> LinkageError:
    """The error of bodies that can move with the drives locked: singular as drawn, or unguided."""
    loose = ", ".join(freedom.loose)
    if not linkage.driven:
        return _undriven_error(linkage, freedom, loose)
    match singular_as_drawn(Loops(linkage)):
        case "change point":
            return LinkageError(
                f"as drawn the linkage is at a change point, where {loose} can move in either of "
                "two ways; draw it in another position, on the intended branch",
                "change-point",
            )
        case "dead point":
            return LinkageError(
                f"as drawn the linkage is at a dead point, where {', '.join(linkage.driven)} "
                f"cannot move it and {loose} can move with the drive locked; draw it in another "
                "position, on the intended side of the dead point, or drive another body",
                "dead-point",
            )
    return LinkageError(
        f"with the drives locked the linkage still has {freedom.free} degree(s) of freedom: "
        f"{loose} can move; add the missing connection or drive",
        "underconstrained",
    )


def _undriven_error(linkage: Linkage, freedom: Mobility, loose: str) -> LinkageError:
    """The error of a linkage without drives that can move, or is at the limit of its form."""
    if not moves_nearby(Loops(linkage)):
        return LinkageError(
            f"as drawn {loose} can give way a little although nothing is missing (joints in line, "
            "or links that meet in one point), so that no finite force holds a load; draw it in "
            "another form, or add a connection",
            "unstable-form",
        )
    count = f"{freedom.free} degree{'s' * (freedom.free > 1)} of freedom ({loose} can move)"
    return LinkageError(
        f"there is no drive, but {count}; add as many [[mechanism.drive]], or the connection that "
        "makes it a structure, or name the locks that hold it in every case: hold = [...]",
        "underconstrained",
        ("drive",),
    )


def _idle_sharing(linkage: Linkage, freedom: Mobility) -> Iterator[LinkageError]:
    """The errors of sharing rules none of whose connections is statically indeterminate."""
    for share in linkage.sharing:
        if set(share.connections) & set(freedom.shared):
            continue
        shared = ", ".join(freedom.shared)
        remedy = f"name some of {shared} instead" if shared else "remove it"
        yield LinkageError(
            f"sharing over {', '.join(share.connections)} has no effect: rigid-body statics "
            f"determines the forces there; {remedy}{_undriven(linkage, share.connections)}",
            "sharing-idle",
            ("sharing",),
        )


def _undriven(linkage: Linkage, idle: tuple[str, ...]) -> str:
    """Advice for cylinders that should share the load when only one of them is driven."""
    bodies = {c.body for _, c in linkage.connections if c.name in idle}
    free = [
        s.name
        for s in linkage.sliders
        if s.name not in linkage.driven and bodies & {s.base, s.moving}
    ]
    if not free:
        return ""
    return (
        f". Slider {', '.join(free)} has no drive and so carries no axial force to share; describe "
        "how parallel cylinders share their force by parallel = [...] instead of connections"
    )
