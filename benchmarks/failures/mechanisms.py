"""Linkages without a unique answer: dead points, change points, redundant links, jammed guides."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from matplotlib.axes import Axes

from benchmarks.failures.asked import command, study
from benchmarks.failures.draw import GREY, INK, decades, line_style, note
from benchmarks.failures.entry import Entry
from fea.core.pin_loads import Floats
from loads import Applied, JammingError, StateDrive, at_rest, motion_reactions, move
from pinstress.study.model.cases import case_loads
from pinstress.study.model.mechanism.linkage import linkage
from pinstress.study.reading.errors import InputError
from reports.format.numbers import engineering, ten_to

COUPLE = 100.0  # N m on the rocker
LENGTHS = (1.0, 0.9, 0.5, 0.6)  # ground, crank, coupler and rocker of the toggle, m
PUSH = 100.0  # N on the block
STEPS = (11, 15)  # odd, so that no step ends at the change point itself
Angles = tuple[float, float]


@cache
def refusal(name: str) -> str:
    """Return the message with which pinstress rejects a study.

    Raises: AssertionError if it does not.
    """
    try:
        (case,) = study(name).table.case
        case_loads(study(name), case, linkage(study(name)))
    except InputError as error:
        return str(error).partition(": ")[2]
    raise AssertionError(f"{name} was not refused")


@dataclass(frozen=True)
class Toggle:
    """The forces of a linkage near its dead point.

    short: (K,) angles before the dead point, rad.
    force: (K,) in the rocker's joint, N. exact: (K,) by the transmission angle, N.
    condition: (K,) of the loop equations.
    at: crank angles, degrees, with ever more digits of the dead point, each with the force by the
    formula, N.
    dead, told: the dead point by the law of cosines and by pinstress, degrees.
    """

    short: Floats
    force: Floats
    exact: Floats
    condition: Floats
    at: list[tuple[float, float]]
    dead: float
    told: float


def _transmission(crank: float) -> float:
    """Return the force between coupler and rocker under the couple, N, by the angle between the
    two.
    """
    ground, a, b, c = LENGTHS
    far = a * a + ground * ground - 2.0 * a * ground * np.cos(crank)
    cosine = (b * b + c * c - far) / (2.0 * b * c)
    return float(COUPLE / (c * np.sqrt(1.0 - cosine * cosine)))


@cache
def toggle() -> Toggle:
    """Return the forces towards the dead point, at rest."""
    ground, a, b, c = LENGTHS
    dead = float(np.arccos((a * a + ground * ground - (b + c) ** 2) / (2.0 * a * ground)))
    mechanism = linkage(study("toggle"))
    load = Applied("rocker", mechanism.joint("O4").at, couple=COUPLE)
    short = np.geomspace(0.3, 1e-8, 16)
    force, condition = [], []
    for gap in short:
        motion = at_rest(mechanism, [dead - gap])
        held = motion_reactions("held", at_rest(mechanism, [dead - gap]), [load], False).reactions
        force.append(float(held.magnitudes[0, held.connections.index("B")]))
        condition.append(float(motion.condition[0]))
    exact = np.array([_transmission(dead - gap) for gap in short])
    found = re.search(r"dead point at crank = ([\d.]+) deg", refusal("toggle"))
    assert found is not None
    told = float(found[1])
    typed = [np.floor(10.0**digits * np.degrees(dead)) / 10.0**digits for digits in (2, 3, 4)]
    at = [(float(angle), _transmission(np.radians(angle))) for angle in typed]
    return Toggle(
        short, np.array(force), exact, np.array(condition), at, float(np.degrees(dead)), told
    )


@dataclass(frozen=True)
class Change:
    """The rocker angles by crank angle, degrees, that a plain Newton method finds, by number of
    steps.
    """

    crank: dict[int, Floats]
    rocker: dict[int, Floats]

    @property
    def ends(self) -> dict[int, float]:
        """The rocker angle at the end of each run, degrees."""
        return {steps: float(angle[-1]) for steps, angle in self.rocker.items()}


def _newton(crank: float, guess: Angles) -> Angles:
    """Return the angles of coupler and rocker of the parallelogram, from a guess, by a plain Newton
    method.
    """
    r, x = 0.5, np.array(guess)
    for _ in range(50):
        gap = r * np.exp(1j * crank) + np.exp(1j * x[0]) - 1.0 - r * np.exp(1j * x[1])
        slope = np.array([1j * np.exp(1j * x[0]), -1j * r * np.exp(1j * x[1])])
        step = np.linalg.lstsq(np.array([slope.real, slope.imag]), [gap.real, gap.imag])[0]
        x = x - step
        if np.abs(step).max() < 1e-13:
            break
    return float(x[0]), float(x[1])


@cache
def change_point(counts: tuple[int, ...] = STEPS) -> Change:
    """Return the runs through the position in which all links are collinear, in steps of equal
    size.

    counts: the numbers of steps.
    """
    crank, rocker = {}, {}
    for steps in counts:
        angles = np.radians(np.linspace(60.0, -60.0, steps + 1))
        found = [(0.0, float(angles[0]))]
        for angle in angles[1:]:
            found.append(_newton(angle, found[-1]))
        crank[steps] = np.degrees(angles)
        turned = np.degrees(np.array(found)[:, 1])
        rocker[steps] = (turned + 180.0) % 360.0 - 180.0
    return Change(crank, rocker)


@dataclass(frozen=True)
class Shares:
    """The forces on two parallel links, N.

    total: their sum.
    smallest: by least squares. ruled: by the study's rule, with the stiffnesses.
    """

    total: float
    smallest: tuple[float, float]
    ruled: tuple[float, float]
    stiffness: tuple[float, float]


@cache
def shares() -> Shares:
    """Return the forces of a lever on two links: F1 + F2 = P L / l, one equation with two
    unknowns.
    """
    arm, reach, load = 0.5, 1.0, 900.0
    least = np.linalg.lstsq(np.array([[arm, arm]]), np.array([load * reach]))[0]
    shared = study("redundant_shared")
    found = case_loads(shared, "held", linkage(shared)).reactions
    size = dict(zip(found.connections, found.magnitudes[0], strict=True))
    first, second = linkage(shared).sharing[0].stiffness
    return Shares(
        load * reach / arm,
        (float(least[0]), float(least[1])),
        (float(size["Q1"]), float(size["Q2"])),
        (first, second),
    )


@dataclass(frozen=True)
class Jamming:
    """The force in the rod of a guide that jams, N.

    friction: (K,) coefficients.
    force: (K,) by the formula. ours: (K,) by pinstress, NaN where it refuses.
    limit: the coefficient from which there is no solution.
    """

    friction: Floats
    force: Floats
    ours: Floats
    limit: float


@cache
def jamming() -> Jamming:
    """Return the forces by the balance of the block, F (cos phi - mu sin phi) = P, with the rod at
    angle phi.
    """
    mechanism = linkage(study("jamming"))
    a, c = (complex(*mechanism.joint(j).at) for j in "AC")
    phi = float(np.angle(a - c))
    phi = np.pi - phi
    drive = mechanism.drives[0].drawn
    motion = move(mechanism, [StateDrive(drive, 1.0)], np.zeros(1))
    load = Applied("block", mechanism.joint("C").at, (PUSH, 0.0))
    friction = np.linspace(0.0, 2.0, 41)
    ours = []
    for mu in friction:
        (guide,) = mechanism.sliders
        rubbed = replace(mechanism, sliders=(replace(guide, friction=float(mu)),))
        motion = move(rubbed, [StateDrive(drive, 1.0)], np.zeros(1))
        try:
            found = motion_reactions("push", motion, [load]).reactions
            ours.append(float(found.magnitudes[0, found.connections.index("C")]))
        except JammingError:
            ours.append(np.nan)
    force = PUSH / (np.cos(phi) - friction * np.sin(phi))
    return Jamming(friction, force, np.array(ours), float(1.0 / np.tan(phi)))


def entries() -> tuple[Entry, ...]:
    """Return the entries of this family."""
    return (
        _toggle(toggle()),
        _change(change_point()),
        _redundant(shares()),
        _jammed(jamming()),
    )


def _within(error: float) -> str:
    """Return the power of ten above an error, which does not change with round-off."""
    return ten_to(int(np.ceil(np.log10(max(error, 1e-15)))))


def _toggle(t: Toggle) -> Entry:
    typed = ", ".join(f"{engineering(force, 3)} N at {angle:g}°" for angle, force in t.at)
    worst = float(np.abs(t.force / t.exact - 1.0).max())
    return Entry(
        "toggle",
        "A linkage near its dead point",
        "Where coupler and rocker are collinear the loop equations lose rank: no finite force can "
        "carry a couple on the rocker (the transmission angle is zero).",
        f"The formula M / (c sin μ) with an angle read from a drawing: {typed}. Every "
        "additional digit gives a different, plausible force.",
        f"The force is unbounded at {t.dead:.4f}° (law of cosines); close to it, it grows with the "
        "inverse square root of the distance.",
        f"Rejected: {refusal('toggle')}. Before it, pinstress's forces agree with the formula to "
        f"{_within(worst)} up to {ten_to(-8)} rad from it, and `linkage.csv` has the condition "
        "number.",
        (command("toggle", "loads"),),
        "On logarithmic axes the force grows linearly towards the dead point, and so does the "
        "condition number",
        lambda figure, axes: _draw_toggle(axes[0], axes[1], t),
    )


def _draw_toggle(left: Axes, right: Axes, t: Toggle) -> None:
    left.loglog(t.short, t.exact, color=INK)
    left.loglog(t.short, t.force, "s", color=line_style(1)["color"], ms=4)
    note(left, t.short[-1], t.force[-1], "pinstress", (-8, -2), line_style(1)["color"], "right")
    note(left, t.short[6], t.exact[6], "M / (c sin μ)", (-8, 8), INK, "right")
    left.set(xlabel="short of the dead point [rad]", ylabel="force at B [N]")
    right.loglog(t.short, t.condition, "o-", color=INK, ms=4)
    right.set(xlabel="short of the dead point [rad]", ylabel="condition number")
    for axes in (left, right):
        axes.invert_xaxis()
    decades(left, right)


def _change(c: Change) -> Entry:
    ends = {steps: "jumps" if end > 0.0 else "stays" for steps, end in c.ends.items()}
    told = ", ".join(f"with {steps} steps it {end}" for steps, end in ends.items())
    return Entry(
        "change_point",
        "A change point",
        "If shortest and longest link together are as long as the other two (L + S = P + Q, "
        "Grashof's "
        "limit), all links can become collinear, where two motions cross: parallelogram and "
        "antiparallelogram.",
        f"Newton's method from each position to the next: {told} to the other motion, by chance.",
        "Both motions are possible; rigid-body mechanics does not determine which one occurs.",
        f"Rejected: {refusal('change_point')}.",
        (command("change_point", "loads"),),
        "Two motions cross at a crank angle of zero; runs with different numbers of steps leave it "
        "on different branches",
        lambda figure, axes: _draw_change(axes[0], c),
        panels=1,
    )


def _draw_change(axes: Axes, c: Change) -> None:
    crank = np.radians(np.linspace(-60.0, 60.0, 241))
    tip = 0.5 * np.exp(1j * crank)
    crossed = 2.0 * np.degrees(np.angle(1.0 - tip)) - np.degrees(crank)
    axes.plot(np.degrees(crank), np.degrees(crank), color=GREY, lw=4, alpha=0.5)
    axes.plot(np.degrees(crank), crossed, color=GREY, lw=4, alpha=0.5)
    for k, (steps, mark) in enumerate(zip(c.crank, ("o", "s"), strict=True)):
        color = line_style(k)["color"]
        axes.plot(c.crank[steps], c.rocker[steps], mark, color=color, ms=5)
        note(axes, -60.0, c.ends[steps], f"{steps} steps", (8, 0), color)
    note(axes, 40.0, 40.0, "parallelogram", (0, 12), "#555555")
    note(axes, 40.0, float(crossed[200]), "antiparallelogram", (0, -12), "#555555")
    axes.invert_xaxis()
    axes.set(xlabel="crank angle [deg], from left to right", ylabel="rocker angle [deg]")


def _redundant(s: Shares) -> Entry:
    first, second = (engineering(x) for x in s.ruled)
    return Entry(
        "redundant",
        "Redundant links",
        "Two parallel links connect the same two pins. Opposite forces in them are "
        "self-equilibrated "
        "(a null vector of the transposed Jacobian), so rigid-body statics does not determine "
        "them.",
        f"Least squares, as any library computes without a warning: {engineering(s.smallest[0])} N "
        "each.",
        f"Any two forces with the sum {engineering(s.total)} N; stiffness and fit determine them.",
        f"Rejected: {refusal('redundant')}. With a rule in the study, stiffnesses "
        f"{s.stiffness[0]:g} : {s.stiffness[1]:g}, it finds {first} N and {second} N, which are "
        "only "
        "as good as that rule.",
        (command("redundant", "loads"), command("redundant_shared", "loads")),
        "A line of possible pairs of forces, on which least squares and the rule of the study each "
        "select a point",
        lambda figure, axes: _draw_redundant(axes[0], s),
        panels=1,
    )


def _draw_redundant(axes: Axes, s: Shares) -> None:
    x = np.array([-0.25, 1.25]) * s.total
    axes.plot(x, s.total - x, color=INK)
    axes.plot(*s.smallest, "o", color=INK)
    axes.plot(*s.ruled, "s", color=line_style(1)["color"])
    note(axes, *s.smallest, "least squares", (8, 6))
    note(axes, *s.ruled, "the study's rule, 3 : 1", (8, 6), line_style(1)["color"])
    note(axes, 0.0, s.total, "every pair on this line is in balance", (8, 6))
    axes.set(xlabel="force of the first link [N]", ylabel="of the second [N]")


def _jammed(j: Jamming) -> Entry:
    mu = study("jamming").table.mechanism.slider["guide"].friction  # type: ignore[union-attr]
    wrong = float(np.interp(mu, j.friction, j.force))
    good = np.isfinite(j.ours)
    worst = float(np.abs(j.ours[good] / j.force[good] - 1.0).max())
    return Entry(
        "jamming",
        "A guide that jams",
        "The rod presses the block against its guide, and friction increases the rod force: "
        "F (cos φ - μ sin φ) = P. For μ ≥ cot φ no force is consistent with the motion (Painlevé).",
        f"The formula still gives a number: at μ = {mu:g} the rod pulls with "
        f"{engineering(-wrong, 3)} N.",
        f"For μ ≥ {j.limit:.4f} there is no solution: the linkage jams.",
        f"Rejected: {refusal('jamming')}. Below the limit its forces agree with the formula to "
        f"{_within(worst)}.",
        (command("jamming", "loads"), "pinstress loads studies/slider_crank_jammed.toml"),
        "The rod force has a pole at the limit and changes sign beyond it, where pinstress gives "
        "none",
        lambda figure, axes: _draw_jammed(axes[0], j),
        panels=1,
    )


def _draw_jammed(axes: Axes, j: Jamming) -> None:
    before, behind = j.friction < j.limit, j.friction > j.limit
    for part in (before, behind):
        axes.plot(j.friction[part], j.force[part] / 1e3, color=INK)
    axes.plot(j.friction, j.ours / 1e3, "s", color=line_style(1)["color"], ms=4)
    axes.axvline(j.limit, color=GREY, lw=0.8)
    note(axes, 0.5, 0.21, "pinstress", (0, 12), line_style(1)["color"], "center")
    note(axes, 1.75, -0.33, "the formula goes on; pinstress refuses", (0, -14), INK, "center")
    note(axes, j.limit, 2.4, "cot φ", (-6, 0), "#555555", "right")
    axes.set(xlabel="coefficient of friction μ", ylabel="force in the rod [kN]", ylim=(-3.0, 3.0))
