"""Contact forces with Coulomb friction at sliders and pins.

Friction opposes sliding with mu times the magnitude of each contact force n, and changes the
contact forces in turn: n = n0 - B |n|, with n0 the forces without friction and B their reduction
per newton of |n|. Every combination of signs of n gives a linear system; a combination is a
solution if the forces that follow from it have these signs. With weak friction there is always
exactly one solution. If there is no solution, no forces are consistent with the motion; if there
are two, rigid-body mechanics cannot decide between them (Painleve's paradox). Either way the slider
jams.

Friction of a pin is a couple: the force on the body is tangent to the friction circle, of radius
r mu / sqrt(1 + mu^2). Since the direction of that force is free, there are no signs to try:
Newton's method follows the solution while friction grows from zero.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from loads.linkage.linkage import LinkageError
from pinbase.arrays import Complex, Floats, Ints

MAX_ENUMERATED_CONTACTS = 8  # 256 combinations of signs
FRICTION_STEPS = 4  # number of steps in which the friction of pins grows from zero
MAX_NEWTON_STEPS = 60
# Relative to the largest contact force: a smaller force counts as zero, and two solutions that
# differ by less count as one.
CONTACT_FORCE_TOLERANCE = 1e-9
# Relative to CONTACT_FORCE_TOLERANCE: Newton's method ends when the magnitudes change by less.
FORCE_SIZE_TOLERANCE = 1e-5


class JammingError(LinkageError):
    """The friction problem has no solution, or several solutions.

    instants: indices of the instants at which friction jams.
    none: whether there is no solution at the first of these instants, rather than several.
    grip: contact force that friction adds at the first of these instants per newton of contact
    force; a mechanism can jam if it is 1 or more.
    when: time of the jam, for the message.
    sliders: names of the sliders or pins that rub, for the message.
    """

    def __init__(
        self, instants: Ints, none: bool, grip: float, when: str = "", sliders: str = ""
    ) -> None:
        self.instants, self.none, self.grip = instants, none, grip
        self.sliders = sliders
        what = (
            "no friction force is consistent with the motion"
            if none
            else "two friction forces are consistent with the motion, and rigid-body mechanics "
            "cannot decide between them"
        )
        where = f"friction jams {sliders or 'a slider'}{' at ' + when if when else ''}"
        super().__init__(
            f"{where}: {what} (friction raises contact forces by {grip:.3g} of themselves; it "
            "slides below 1); reduce the friction, lengthen the bearing, drive from the other end, "
            "or avoid this part of the motion",
            "friction-jams",
        )


def contact_sizes(free: Complex, response: Complex) -> Floats:
    """Magnitudes n of contact forces with friction, (T, K) N: n = |free + response n|.

    free: (T, K) N, contact forces without friction; complex for pins, which press in any direction.
    response: (T, K, K), change of contact force i per newton of the magnitude of contact force j.

    Raises: JammingError where there is no solution. Several solutions also raise it, but are
    detected only for real forces at up to MAX_ENUMERATED_CONTACTS contacts.
    """
    if not response.any():
        return np.abs(free)
    # Forces along fixed lines: try all signs, which also shows whether the solution is unique.
    if free.shape[1] <= MAX_ENUMERATED_CONTACTS and not free.imag.any() and not response.imag.any():
        return np.abs(contact_forces(free.real, -response.real))
    # Forces in the plane: increase friction in steps, each started from the previous solution.
    sizes = np.abs(free)
    for fraction in np.linspace(0.0, 1.0, FRICTION_STEPS + 1)[1:]:
        sizes = _newton(free, fraction * response, sizes)
    return sizes


def _newton(free: Complex, response: Complex, sizes: Floats) -> Floats:
    """Magnitudes of contact forces, (T, K) N, by Newton's method from a nearby start.

    free, response: as for `contact_sizes`.
    sizes: (T, K) N, magnitudes from which the iteration starts.

    Raises: JammingError where the solution is lost. While friction grows from zero, the solution is
    lost when the determinant of the tangent vanishes: more friction is not consistent with the
    motion.
    """
    identity = np.eye(free.shape[1])
    tolerance = CONTACT_FORCE_TOLERANCE * (np.abs(free).max(axis=1) + 1e-300)
    for _ in range(MAX_NEWTON_STEPS):
        force = free + (response @ sizes[..., None])[..., 0]
        size = np.abs(force)
        # d|force| / d sizes: the response projected on the direction of the force.
        direction = force / np.where(size > 0.0, size, 1.0)
        slope = np.real(np.conj(direction)[..., None] * response)
        lost = np.linalg.det(identity - slope) <= CONTACT_FORCE_TOLERANCE
        residual = size - sizes
        if lost.any():
            break
        if np.all(np.abs(residual).max(axis=1) <= FORCE_SIZE_TOLERANCE * tolerance):
            return size
        sizes = sizes + np.linalg.solve(identity - slope, residual[..., None])[..., 0]
    else:
        lost = np.abs(residual).max(axis=1) > tolerance
        if not lost.any():
            return size
    instants = np.flatnonzero(lost)
    grip = float(np.abs(np.linalg.eigvals(np.abs(slope[instants[0]]))).max())
    raise JammingError(instants, True, grip)


def contact_forces(free: Floats, feedback: Floats) -> Floats:
    """Contact forces n, (T, K) N, with n = free - feedback |n|, by trying all signs of n.

    free: (T, K) N, contact forces without friction.
    feedback: (T, K, K), reduction of contact force i per newton of |n_j|.

    Raises: JammingError where no solution exists, or several.
    """
    count = free.shape[1]
    solution = np.zeros_like(free)
    solutions = np.zeros(len(free), dtype=int)  # number of different solutions at each instant
    size = np.abs(free).max(axis=1, initial=0.0) + 1e-300
    for signs in product((1.0, -1.0), repeat=count):
        # With |n| = s n the equations are linear: (I + B s) n = n0.
        s = np.array(signs)
        matrix = np.eye(count) + feedback * s
        regular = np.abs(np.linalg.det(matrix)) > CONTACT_FORCE_TOLERANCE
        n = np.linalg.solve(
            np.where(regular[:, None, None], matrix, np.eye(count)), free[..., None]
        )[..., 0]
        # It is a solution if n has the assumed signs. A zero force fits two combinations of signs;
        # their common solution is counted once.
        slack = CONTACT_FORCE_TOLERANCE * np.maximum(size, np.abs(n).max(axis=1))
        consistent = regular & np.all(n * s >= -slack[:, None], axis=1)
        known = (solutions > 0) & np.all(np.abs(n - solution) <= slack[:, None], axis=1)
        new = consistent & ~known
        solution[new & (solutions == 0)] = n[new & (solutions == 0)]
        solutions += new
    jammed = np.flatnonzero(solutions != 1)
    if len(jammed):
        grip = float(np.abs(np.linalg.eigvals(np.abs(feedback[jammed[0]]))).max())
        raise JammingError(jammed, bool(solutions[jammed[0]] == 0), grip)
    return solution
