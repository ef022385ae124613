"""Contact of pins with their lugs: compared with contact in three dimensions, its convergence with
cells, and its times.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from itertools import product
from statistics import median
from typing import TypeVar

import numpy as np

from benchmarks.timing import table
from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.core.requirement import Requirement
from fea.harmonic.field import HarmonicField
from fea.harmonic.superposition import Circumference
from fea.solve.solve import solve_pin
from fea.support.contact.joint_contact import JointContact
from fea.support.contact.resolution import Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Lug
from geometry import Pin, Segment
from geometry.shape.lug_outline import LugOutline

S = TypeVar("S")
T = TypeVar("T")

E, NU, D, EYE, HELD, FORCE = 210e9, 0.3, 0.02, 0.05, 0.05, 50e3
STEEL = Material("steel", E, NU)
NAMES = "L", "M", "R"
SHARE = np.array([-0.5, 1.0, -0.5])
# Inner and outer lug, gap, diametral clearance, mm; bending moment over F/2 (t_o/2 + g + t_i/4) and
# von Mises stress of the tension fibre at mid-span, MPa, by frictionless contact in three
# dimensions with two programs (eyes of 50 mm with a shank 50 mm wide that is clamped 50 mm away).
TRUTH = (
    (20, 10, 1, 0.0, 0.8418, 306.3),
    (20, 10, 1, 0.02, 0.8433, 303.8),
    (20, 10, 1, 0.05, 0.8476, 304.8),
    (20, 10, 1, 0.1, 0.8574, 308.6),
    (10, 5, 0.5, 0.0, 0.9483, 196.2),
    (10, 5, 0.5, 0.05, 0.9500, 196.3),
    (40, 20, 2, 0.0, 0.3845, 279.3),
    (40, 20, 2, 0.05, 0.4197, 304.0),
)
INSTANTS = 201
COARSE, USUAL, FINE = Resolution(4, 24, 8), Resolution(), Resolution(12, 48, 16)
RADII = (0.0, 0.01, 0.025, 0.05)  # of the lugs' edges, over the diameter


def joint() -> str:
    """Return the three tables."""
    return f"{_accuracy()}\n\n{_convergence()}\n\n{_times()}"


def model(
    inner: float, outer: float, gap: float, of_all: Lug, cells: Resolution = USUAL
) -> ContactModel:
    """Return a clevis, lengths in mm, whose lugs are `of_all` except for the tilt of the outer
    ones.
    """
    over, apart = Segment(0.002, D), Segment(gap / 1e3, D)
    left, middle, right = (
        Segment(t / 1e3, D, connection=name)
        for t, name in zip((outer, inner, outer), NAMES, strict=True)
    )
    pin = Pin("P", (over, left, apart, middle, apart, right, over))
    shank = shank_tilt(outer / 1e3)
    tilt = dict(zip(NAMES, (shank, math.inf, shank), strict=True))
    lugs = [replace(of_all, connection=name, tilt=k) for name, k in tilt.items()]
    return ContactModel(pin, STEEL, lugs, cells)


def shank_tilt(thick: float) -> float:
    """Return the stiffness of the shank of an eye in bending, N m/rad. thick: m."""
    outline = LugOutline("round", D, EYE, EYE, HELD, EYE / 2.0)
    return E * thick**3 / (12.0 * outline.bending)


def pull(angle: Floats) -> PinLoads:
    """Return loads with one instant for each angle, rad, of the force."""
    along = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    return PinLoads("pull", NAMES, FORCE * SHARE[None, :, None] * along[:, None, :])


def _growing(count: int) -> PinLoads:
    """Return instants that all differ in contact: with clearance, contact depends on the size of
    the load.
    """
    loads = pull(np.linspace(0.0, np.pi, count))
    return replace(loads, forces=loads.forces * np.linspace(1.0, 0.2, count)[:, None, None])


def _accuracy() -> str:
    rows = []
    for inner, outer, gap, clearance, moment, stress in TRUTH:
        lug = Lug("all", EYE, STEEL, clearance / 1e3)
        found = model(inner, outer, gap, lug).solve(pull(np.zeros(1)))
        bending, ours = at_mid_span(found, inner, outer, gap)
        rows.append(
            (
                f"{inner:g} / {outer:g}+{outer:g}, gap {gap:g}",
                f"{clearance:g}",
                f"{bending:.4f}",
                f"{moment:.4f}",
                f"{ours:.1f}",
                f"{stress:.1f}",
                f"{100.0 * (ours / stress - 1.0):+.1f}",
            )
        )
    head = ("lugs [mm]", "clearance [mm]", "M / M0", "3D", "mid-span [MPa]", "3D", "off [%]")
    return table(head, rows)


def at_mid_span(found: JointContact, inner: float, outer: float, gap: float) -> tuple[float, float]:
    """Return the bending moment over the nominal one, and the von Mises stress of the tension
    fibre, MPa.
    """
    middle = (2.0 + outer + gap + inner / 2.0) / 1e3
    bending = abs(found.bending_moment(np.array([middle]))[0, 0, 0])
    nominal = FORCE / 2.0 * (outer / 2.0 + gap + inner / 4.0) / 1e3
    (solution,) = solve_pin(
        found.pin, STEEL, (), (found.loads,), Requirement(model="harmonic", meshes=2)
    )
    assert isinstance(solution.answer, HarmonicField)
    fields = solution.answer.fields
    near = np.hypot(fields.points[:, 0] - D / 2.0, fields.points[:, 1] - middle)
    stress = Circumference(fields, found.loads).envelope(np.array([near.argmin()]), np.zeros(1))
    return float(bending / nominal), float(stress[0, 0]) / 1e6


def _convergence() -> str:
    """Return the table of the first clevis and the longest, by the radius of the lugs' edges."""
    rows = []
    for case, radius, cells in product((TRUTH[2], TRUTH[7]), RADII, (COARSE, USUAL, FINE)):
        inner, outer, gap, clearance = case[:4]
        lug = Lug("all", EYE, STEEL, clearance / 1e3, edge_radius=radius * D)
        solved = model(inner, outer, gap, lug, cells)
        found = solved.solve(pull(np.zeros(1)))
        bending, stress = at_mid_span(found, inner, outer, gap)
        about = f"{cells.rings}, {cells.sectors}, {cells.highest}"
        clevis = f"{inner:g} / {outer:g}+{outer:g}"
        numbers = f"{bending:.5f}", f"{stress:.1f}"
        rows.append((clevis, f"{radius:g}", about, str(len(solved.rings)), *numbers))
    head = ("lugs [mm]", "edge radius / d", "rings, sectors, n", "all rings", "M / M0")
    return table((*head, "mid-span [MPa]"), rows)


def _times() -> str:
    """Return the table of times, s, of the first clevis, medians of three runs with a new model
    each.
    """
    head = ("cells of each band", "flexibilities [s]", "one instant [s]", "each further [ms]")
    rows = [_times_on(cells) for cells in (USUAL, FINE)]
    return table((*head, f"{INSTANTS} instants [s]", "steps of the active set"), rows)


def _times_on(cells: Resolution) -> tuple[str, ...]:
    new = partial(model, 20, 10, 1, Lug("all", EYE, STEEL, 5e-5), cells)
    first, _ = _timed(lambda _: new(), str)
    one, _ = _timed(lambda model: model.solve(_growing(1)), new)
    many, found = _timed(lambda model: model.solve(_growing(INSTANTS)), new)
    steps = np.mean([c.steps for c in found.contact])
    each = 1e3 * (many - one) / (INSTANTS - 1)
    about = f"{cells.rings} rings, {cells.sectors} sectors, n to {cells.highest}"
    return (about, f"{first:.2f}", f"{one:.2f}", f"{each:.1f}", f"{many:.2f}", f"{steps:.1f}")


def _timed(work: Callable[[S], T], with_this: Callable[[], S]) -> tuple[float, T]:
    """Return the median time of `work`, s, and its result. with_this: makes its argument, which is
    not timed.
    """
    spent = []
    for _ in range(3):
        made = with_this()
        start = time.perf_counter()
        found = work(made)
        spent.append(time.perf_counter() - start)
    return median(spent), found
