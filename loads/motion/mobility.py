"""Mobility by the rank of the loop equations, with loose bodies and redundant connections."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from loads.linkage.linkage import Linkage, LinkageError
from loads.linkage.parts import Sharing
from loads.motion.as_drawn import moves_nearby, rank, singular_as_drawn
from loads.motion.equations import Equations
from loads.motion.planar_equations import PlanarEquations


@dataclass(frozen=True)
class Mobility:
    """Degrees of freedom and redundancy in the drawn position.

    kutzbach: degrees of freedom by counting links and joints.
    degrees: degrees of freedom by rank, without drives.
    free: degrees of freedom that remain with the drives locked; with 0 the position is determined.
    loose: names of the bodies that can still move with the drives locked.
    advice: advice on how to stop these bodies, or "".
    redundant: number of redundant equations.
    shared: connections whose force rigid-body statics does not determine.
    """

    kutzbach: int
    degrees: int
    free: int
    loose: tuple[str, ...]
    advice: str
    redundant: int
    shared: tuple[str, ...]


def mobility(linkage: Linkage) -> Mobility:
    """Mobility and redundancy as drawn.

    Raises: LinkageError for bodies that are not joined to the ground.
    """
    return freedom_of(PlanarEquations(linkage))


def freedom_of(equations: Equations) -> Mobility:
    """Mobility and redundancy, as drawn, of a linkage in the plane or in space."""
    pose = equations.pose(np.zeros((1, equations.columns)))
    J = equations.jacobian(pose)[0]
    left, singular, right = np.linalg.svd(J)
    independent = rank(singular)
    guided = J[: equations.guides]
    free = right[independent:]
    return Mobility(
        kutzbach=equations.kutzbach,
        degrees=equations.columns - rank(np.linalg.svd(guided, compute_uv=False)),
        free=len(free),
        loose=equations.moving(pose, free / equations.scale),
        advice=equations.advice(pose, free / equations.scale),
        redundant=len(J) - independent,
        shared=equations.stressed(pose, left[:, independent:]),
    )


def require_determined(linkage: Linkage) -> Mobility:
    """The mobility of a planar linkage whose drives determine every position.

    Raises: LinkageError where the drives do not determine the position, with the bodies that can
    still move; for too many drives; and for sharing rules without effect.
    """
    freedom = require_driven(PlanarEquations(linkage))
    undriven = partial(_undriven, linkage)
    if errors := list(idle_sharing(linkage.sharing, freedom, undriven)):
        raise LinkageError.all(errors)
    return freedom


def require_driven(equations: Equations) -> Mobility:
    """The mobility of a linkage, in the plane or in space, whose drives determine every position.

    Raises: LinkageError where the drives do not determine the position, or are too many.
    """
    freedom, driven = freedom_of(equations), equations.linkage.driven
    if 0 < freedom.degrees < len(driven):
        raise LinkageError(
            f"{len(driven)} drives ({', '.join(driven)}) for {freedom.degrees} "
            "degree(s) of freedom: remove one",
            "too-many-drives",
            ("drive",),
        )
    if freedom.free:
        raise _unconstrained(equations, freedom)
    return freedom


def _unconstrained(equations: Equations, freedom: Mobility) -> LinkageError:
    """The error for bodies that can move with locked drives: a singular drawing, or no guidance."""
    loose, driven = ", ".join(freedom.loose), equations.linkage.driven
    if not driven:
        return _undriven_error(equations, freedom, loose)
    match singular_as_drawn(equations):
        case "change point":
            return LinkageError(
                f"as drawn the linkage is at a change point, where {loose} can move in either of "
                "two ways; draw it in another position, on the intended branch",
                "change-point",
            )
        case "dead point":
            return LinkageError(
                f"as drawn the linkage is at a dead point, where {', '.join(driven)} "
                f"cannot move it and {loose} can move with the drive locked; draw it in another "
                "position, on the intended side of the dead point, or drive another body",
                "dead-point",
            )
    return LinkageError(
        f"with the drives locked the linkage still has {freedom.free} degree(s) of freedom: "
        f"{freedom.advice or f'{loose} can move; add the missing connection or drive'}",
        "underconstrained",
    )


def _undriven_error(equations: Equations, freedom: Mobility, loose: str) -> LinkageError:
    """The error for a linkage without drives that can move, by a finite or infinitesimal motion."""
    if not moves_nearby(equations):
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


def idle_sharing(
    rules: Sequence[Sharing],
    freedom: Mobility,
    advice: Callable[[tuple[str, ...]], str] = lambda idle: "",
) -> Iterator[LinkageError]:
    """The errors of sharing rules of which no connection is statically indeterminate.

    advice: function that returns advice for the connections of such a rule.
    """
    for share in rules:
        if set(share.connections) & set(freedom.shared):
            continue
        shared = ", ".join(freedom.shared)
        remedy = f"name some of {shared} instead" if shared else "remove it"
        yield LinkageError(
            f"sharing over {', '.join(share.connections)} has no effect: rigid-body statics "
            f"determines the forces there; {remedy}{advice(share.connections)}",
            "sharing-idle",
            ("sharing",),
        )


def _undriven(linkage: Linkage, idle: tuple[str, ...]) -> str:
    """Advice for parallel cylinders that should share the load although only one is driven."""
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
