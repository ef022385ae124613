"""Coulomb friction at sliders and pins: which signs of the contact forces are consistent.

Friction opposes sliding with mu times the size of each contact force n, and changes the contact
forces in turn: n = n0 - B |n|, with n0 the forces without friction and B their
reduction by one newton of |n|. Every pattern of signs gives a linear system; the patterns that its
solution reproduces are the answers. With weak friction there is always exactly one. When there is
none, no forces are consistent with the motion; when there are two, rigid-body mechanics cannot
decide between them (Painleve): the slider jams.

A pin rubs with a couple: its force on the body touches the friction circle, of radius
r mu / sqrt(1 + mu^2). Its direction is free, so there are no patterns: Newton's method follows the
answer while friction grows from nothing.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from loads.linkage.linkage import LinkageError
from pinbase.arrays import Complex, Floats, Ints

MAX_ENUMERATED_CONTACTS = 8  # 256 patterns of signs
FRICTION_STEPS = 4  # in which friction of pins grows from nothing
MAX_NEWTON_STEPS = 60  # of Newton's method
# Of CONTACT_FORCE_TOLERANCE: sizes are corrected until they change by no more.
FORCE_SIZE_TOLERANCE = 1e-5
# Of the largest contact force: what counts as zero and as the same answer.
CONTACT_FORCE_TOLERANCE = 1e-9


class JammingError(LinkageError):
    """The friction problem has no solution, or several.

    instants: their indices. none: whether there is no solution at the first of them. grip:
    gain of the loop from contact force to friction to contact force there (from 1 on it can jam).
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
            f"{where}: {what} (friction adds {grip:.3g} N to each newton of contact force; it "
            "slides below 1); reduce the friction, lengthen the bearing, drive from the other end, "
            "or avoid this part of the motion",
            "friction-jams",
        )


def contact_sizes(free: Complex, response: Complex) -> Floats:
    """Sizes n (T, K) = |free + response n| of contact forces; complex those of pins, which press in
    any direction, response (T, K, K).

    Raises: JammingError where none or, of real ones up to MAX_ENUMERATED_CONTACTS, several exist.
    """
    if not response.any():
        return np.abs(free)
    if free.shape[1] <= MAX_ENUMERATED_CONTACTS and not free.imag.any() and not response.imag.any():
        return np.abs(contact_forces(free.real, -response.real))
    sizes = np.abs(free)
    for part in np.linspace(0.0, 1.0, FRICTION_STEPS + 1)[1:]:
        sizes = _newton(free, part * response, sizes)
    return sizes


def _newton(free: Complex, response: Complex, sizes: Floats) -> Floats:
    """From sizes near the answer. Where friction grows from nothing, the answer is lost when the
    determinant vanishes: more friction is then not consistent with the motion.
    """
    one = np.eye(free.shape[1])
    least = CONTACT_FORCE_TOLERANCE * (np.abs(free).max(axis=1) + 1e-300)
    for _ in range(MAX_NEWTON_STEPS):
        force = free + (response @ sizes[..., None])[..., 0]
        size = np.abs(force)
        along = force / np.where(size > 0.0, size, 1.0)
        slope = np.real(np.conj(along)[..., None] * response)
        lost = np.linalg.det(one - slope) <= CONTACT_FORCE_TOLERANCE
        off = size - sizes
        if lost.any():
            break
        if np.all(np.abs(off).max(axis=1) <= FORCE_SIZE_TOLERANCE * least):
            return size
        sizes = sizes + np.linalg.solve(one - slope, off[..., None])[..., 0]
    else:
        lost = np.abs(off).max(axis=1) > least
        if not lost.any():
            return size
    which = np.flatnonzero(lost)
    grip = float(np.abs(np.linalg.eigvals(np.abs(slope[which[0]]))).max())
    raise JammingError(which, True, grip)


def contact_forces(free: Floats, feedback: Floats) -> Floats:
    """Contact forces n (T, K) with n = free - feedback |n|; feedback (T, K, K).

    Raises: JammingError where none or several exist.
    """
    count = free.shape[1]
    found = np.zeros_like(free)
    answers = np.zeros(len(free), dtype=int)
    size = np.abs(free).max(axis=1, initial=0.0) + 1e-300
    for signs in product((1.0, -1.0), repeat=count):
        s = np.array(signs)
        matrix = np.eye(count) + feedback * s
        possible = np.abs(np.linalg.det(matrix)) > CONTACT_FORCE_TOLERANCE
        n = np.linalg.solve(
            np.where(possible[:, None, None], matrix, np.eye(count)), free[..., None]
        )[..., 0]
        slack = CONTACT_FORCE_TOLERANCE * np.maximum(size, np.abs(n).max(axis=1))
        agrees = possible & np.all(n * s >= -slack[:, None], axis=1)
        known = (answers > 0) & np.all(np.abs(n - found) <= slack[:, None], axis=1)
        new = agrees & ~known
        found[new & (answers == 0)] = n[new & (answers == 0)]
        answers += new
    wrong = np.flatnonzero(answers != 1)
    if len(wrong):
        grip = float(np.abs(np.linalg.eigvals(np.abs(feedback[wrong[0]]))).max())
        raise JammingError(wrong, bool(answers[wrong[0]] == 0), grip)
    return found
