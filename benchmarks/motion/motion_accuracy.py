"""Speed and accuracy of the motion: by samples, in closed form, by Newton, and by integration,
which drifts.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from benchmarks import ROOT
from benchmarks.timing import seconds, table
from loads import Course, Lever, Linkage, Slider, motion_reactions, move
from loads.forces.over_time import Exerted, ForceHistory
from loads.forces.reactions import Reactions
from loads.motion.equations import drive_side
from loads.motion.planar_equations import PlanarEquations
from pinstress import load_study
from pinstress.study.model.mechanism.drives import laws, span
from pinstress.study.model.mechanism.linkage import linkage

Floats = NDArray[np.float64]

STUDY = ROOT / "studies" / "grenier2008.toml"
CHART = ROOT / "docs" / "images" / "motion_accuracy"
SAMPLES = (6, 11, 21, 51, 101, 201, 501, 1001, 2001)
STEPS = (20, 40, 80, 160, 320)


def motion_accuracy() -> str:
    """Return the tables of peak reactions by number of samples, and of point F by three methods;
    draw the chart in docs/images.
    """
    study = load_study(STUDY)
    mechanism, courses, end = linkage(study), laws(study), span(study)

    course = Course(mechanism, courses, 0.0, end)

    def at(times: Floats) -> Reactions:
        return motion_reactions("retract", course.at(times)).reactions

    peaks = _peaks(at, end)
    ways = _ways(mechanism, courses[0], end)
    _chart(peaks, ways)
    return "\n\n".join(
        (
            table(("samples", "error, samples", "s", "error, refined", "s "), peaks),
            table(("point F by", "steps", "error", "loop gap, m", "s"), ways),
        )
    )


def _peaks(at: Callable[[Floats], Reactions], span: float) -> list[tuple[float, ...]]:
    """Return the largest relative error of the peaks of all connections: from samples alone, and
    refined.
    """

    def exerted(times: Floats) -> Exerted:
        return Exerted(times, at(times), *np.zeros((2, len(times), 0)))

    def resolved(times: Floats) -> Floats:
        first, none = exerted(times), np.empty(0)
        peaks = ForceHistory.of([first], exerted, none, (1.0, 0.0), moments=True).peaks()
        return np.array([p.value for p in peaks.force.values()])

    exact = resolved(np.linspace(0.0, span, 4001))
    rows: list[tuple[float, ...]] = []
    for n in SAMPLES:
        times = np.linspace(0.0, span, n)
        sampled = at(times)
        refined = resolved(times)
        rows.append(
            (
                n,
                float(np.abs(sampled.magnitudes.max(axis=0) / exact - 1.0).max()),
                seconds(lambda t=times: at(t)),  # type: ignore[misc]
                float(np.abs(refined / exact - 1.0).max()),
                seconds(lambda t=times: resolved(t)),  # type: ignore[misc]
            )
        )
    return rows


def _ways(linkage: Linkage, law: object, span: float) -> list[tuple[object, ...]]:
    """Return the rows for the speed of joint F at 201 instants: closed form, Newton, integration of
    the accelerations.
    """
    times = np.linspace(0.0, span, 201)
    slider = linkage.drives[0]
    assert isinstance(slider, Slider)
    pivot, f = (np.array(linkage.joint(j).at) for j in "DF")
    lever = Lever(
        float(np.linalg.norm(pivot - slider.start)), float(np.linalg.norm(pivot - slider.end))
    )
    radius = float(np.linalg.norm(f - pivot))

    def closed() -> Floats:
        speed, _ = lever.point(radius, *law(times))  # type: ignore[operator]
        return speed

    exact = closed()
    rows: list[tuple[object, ...]] = [("closed form", "-", 0.0, 0.0, seconds(closed))]
    motion = move(linkage, [law], times)  # type: ignore[list-item]
    speed = np.linalg.norm(motion.joint("F")[1], axis=1)
    rows.append(
        (
            "Newton",
            "-",
            _error(speed, exact),
            _gap(motion.loops, motion.q),
            seconds(lambda: move(linkage, [law], times)),  # type: ignore[list-item]
        )
    )
    loops = motion.loops
    start = move(linkage, [law], np.zeros(1))  # type: ignore[list-item]
    for steps in STEPS:

        def integrate(n: int = steps) -> tuple[Floats, Floats]:
            return _integrate(loops, law, start.q[0], span, n)

        q, v = integrate()
        points = loops.points(np.array([linkage.index["FDG"]]), np.array([complex(*f)]))
        slopes = loops.partials(loops.pose(q), points)
        found = np.abs((v[:, None, :] @ slopes)[:, 0, 0])
        here, _ = lever.point(radius, *law(np.linspace(0.0, span, steps + 1)))  # type: ignore[operator]
        rows.append(
            ("integration, RK4", steps, _error(found, here), _gap(loops, q), seconds(integrate, 1))
        )
    tight = solve_ivp(
        lambda t, y: _rate(loops, law, t, y),
        (0.0, span),
        np.concatenate([start.q[0], np.zeros(loops.columns)]),
        method="DOP853",
        rtol=1e-10,
        atol=1e-12,
    )
    q = tight.y[: loops.columns].T
    rows.append(("integration, DOP853 to 1e-10", tight.nfev, "-", _gap(loops, q), "-"))
    return rows


def _error(found: Floats, exact: Floats) -> float:
    return float(np.abs(found - exact).max() / np.abs(exact).max())


def _gap(loops: PlanarEquations, q: Floats) -> float:
    """Return the largest gap of a closed loop, m."""
    return float(np.abs(loops.place(loops.pose(q), loops.closures)).max())


def _rate(loops: PlanarEquations, law: object, t: float, y: Floats) -> Floats:
    """Return the rates of coordinates and speeds, by the index-reduced equations, with which loops
    drift open.
    """
    q, v = y[None, : loops.columns], y[None, loops.columns :]
    pose = loops.pose(q)
    second = law(np.array([t]))[2][None]  # type: ignore[operator]
    side = drive_side(loops, second) + loops.bend_side(pose, v)
    a = loops.factors(pose).solve(side) / loops.scale
    return np.concatenate([v[0], a[0]])


def _integrate(
    loops: PlanarEquations, law: object, q: Floats, span: float, steps: int
) -> tuple[Floats, Floats]:
    h = span / steps
    y = np.concatenate([q, np.zeros(loops.columns)])
    out = [y]
    for i in range(steps):
        t = i * h
        k1 = _rate(loops, law, t, y)
        k2 = _rate(loops, law, t + h / 2, y + h / 2 * k1)
        k3 = _rate(loops, law, t + h / 2, y + h / 2 * k2)
        k4 = _rate(loops, law, t + h, y + h * k3)
        y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        out.append(y)
    states = np.stack(out)
    return states[:, : loops.columns], states[:, loops.columns :]


def _chart(peaks: list[tuple[float, ...]], ways: list[tuple[object, ...]]) -> None:
    from matplotlib.ticker import NullFormatter

    from benchmarks.style import line_style, panels, save

    with panels(1, 2, height=3.4) as (figure, (left, right)):
        n = [row[0] for row in peaks]
        for order, (column, name) in enumerate(((1, "samples alone"), (3, "refined"))):
            errors = [max(row[column], 1e-16) for row in peaks]
            left.loglog(n, errors, marker="o", ms=4, label=name, **line_style(order))
        left.axhline(1e-10, color="#8a8a8a", linewidth=0.8)
        left.set(xlabel="instants of the motion", ylabel="largest error of a peak reaction")
        left.annotate("1e-10", (n[-1], 1.6e-10), ha="right", fontsize=8, color="#8a8a8a")
        steps = [row for row in ways if isinstance(row[1], int) and isinstance(row[2], float)]
        right.loglog(
            [float(row[4]) for row in steps],  # type: ignore[arg-type]
            [float(row[2]) for row in steps],  # type: ignore[arg-type]
            marker="s",
            ms=4,
            label="integration (RK4)",
            **line_style(0),
        )
        for order, row in enumerate(ways[:2], 1):
            right.loglog(
                float(row[4]),  # type: ignore[arg-type]
                max(float(row[2]), 1e-16),  # type: ignore[arg-type]
                marker="D",
                ms=5,
                linestyle="none",
                label=str(row[0]),
                color=line_style(order)["color"],
            )
        right.set(xlabel="time [s]", ylabel="error of the speed of F")
        right.set_xlim(2e-5, 1.0)
        right.set_ylim(1e-17, 1e-2)
        for axes in (left, right):
            axes.legend(loc="center left", bbox_to_anchor=(0.02, 0.42))
            for axis in (axes.xaxis, axes.yaxis):
                axis.set_major_formatter(lambda v, _: f"1e{round(np.log10(v))}")
                axis.set_minor_formatter(NullFormatter())
        figure.suptitle("Landing gear, retract: speed against accuracy", x=0.01, ha="left")
        save(figure, CHART.parent, CHART.name)
