"""A linkage's positions during a motion, or its static position."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reports.data.results import Floats, LinkageMotion, Units
from reports.format.file_names import plot_name
from reports.format.numbers import short
from reports.format.plot_labels import Label, place_texts
from reports.format.style import INK, clipped, line_style, panels, plain_numbers, save

BETWEEN = 5  # positions between the first and the last
LOWEST, HIGHEST = 3.0, 7.0  # inches, of the axes
SAME = 1e-6  # of the linkage's size: positions nearer than this are drawn once


def linkage_plot(motion: LinkageMotion, units: Units, directory: Path) -> list[Path]:
    """Positions from the start (solid) to the end (dashed) with the paths of the joints."""
    with panels(1, height=_height(motion)) as (figure, (axes,)):
        axes.set_aspect("equal", adjustable="datalim")
        axes.set(xlabel=f"x [{units.length}]", ylabel=f"y [{units.length}]")
        plain_numbers(axes)
        last = len(motion.condition) - 1
        if motion.time is not None:
            between = "intermediate"
            _paths(axes, motion)
            for k in np.linspace(0, last, BETWEEN + 2)[1:-1]:
                shade = f"{0.80 - 0.28 * k / last:.3f}"
                style: Any = {"color": shade, "linewidth": 1.1, "zorder": 2.0}
                _position(axes, motion, round(k), between, **style)
                between = ""
        texts = _emphasised(axes, motion, units)
        axes.set_title(_title(motion), pad=8)
        handles, labels = axes.get_legend_handles_labels()
        if handles:
            ncols = min(3, len(handles))
            figure.legend(handles, labels, loc="outside lower left", ncols=ncols, handlelength=3.5)
        _name(figure, axes, motion, texts)
        return save(figure, directory, plot_name("linkage", motion.case))


def _title(motion: LinkageMotion) -> str:
    if motion.time is None:
        return f"{motion.case}: the linkage's position"
    return f"{motion.case}: the linkage from start to end, and the paths of its joints"


def _height(motion: LinkageMotion) -> float:
    wide, high = np.ptp(_all_points(motion), axis=0) + 1e-12
    return float(
        np.clip(6.2 * high / wide + (0.6 if motion.time is None else 1.1), LOWEST, HIGHEST)
    )


def _all_points(motion: LinkageMotion) -> Floats:
    parts = [motion.joint_position, *motion.slides.values()]
    return np.concatenate([np.asarray(p).reshape(-1, 2) for p in parts])


def _emphasised(axes: Axes, motion: LinkageMotion, units: Units) -> list[int]:
    """Draw the first and the last position; returns the instants drawn."""
    if motion.time is None:
        _position(axes, motion, 0, **line_style(0), linewidth=2.2, zorder=4.0, fill=True)
        return [0]
    start, end = (f"t = {short(float(motion.time[k]))} {units.time}" for k in (0, -1))
    points = motion.joint_position
    moved = float(np.abs(points[-1] - points[0]).max())
    same = moved < SAME * float(np.ptp(_all_points(motion), axis=0).max())
    first = f"start, {start}, and end, {end}" if same else f"start, {start}"
    _position(axes, motion, 0, first, **line_style(0), linewidth=2.2, zorder=4.0, fill=True)
    if not same:
        dashed = {"color": "#c8501e", "linestyle": (0, (4, 1.6))}
        _position(axes, motion, -1, f"end, {end}", **dashed, linewidth=2.2, zorder=5.0, fill=True)
    return [0] if same else [0, -1]


def _position(
    axes: Axes, motion: LinkageMotion, k: int, label: str = "", fill: bool = False, **style: Any
) -> None:
    at = dict(zip(motion.joints, motion.joint_position[k], strict=True))
    for joints in motion.links:
        if len(joints) < 2:
            continue
        ring = [at[j] for j in (*joints, joints[0])] if len(joints) > 2 else [at[j] for j in joints]
        axes.plot(*np.transpose(ring), solid_capstyle="round", label=label or None, **style)
        label = ""
        if fill and len(joints) > 2:
            axes.fill(*np.transpose(ring), color=style["color"], alpha=0.10, linewidth=0.0)
    slider = "slider" if k == 0 else ""
    thin = style | {"linewidth": 0.6 * style["linewidth"]}
    for ends in motion.slides.values():
        dashed = thin | {"linestyle": (0, (8, 2, 1.5, 2))}
        axes.plot(*ends[k].T, **dashed, label=slider or None)
        slider = ""
        if fill:
            axes.plot(*ends[k, 1], "s", ms=9, mfc="none", mec=style["color"], zorder=5.5)
    if fill:
        moving = np.array([p for j, p in at.items() if j not in motion.ground]).reshape(-1, 2)
        axes.plot(*moving.T, "o", ms=5, mfc="white", mec=style["color"], mew=1.3, zorder=6.0)
        _ground(axes, motion, at, "ground joint" if k == 0 else None)


def _ground(axes: Axes, motion: LinkageMotion, at: dict[str, Floats], label: str | None) -> None:
    still = np.array([at[j] for j in motion.ground]).reshape(-1, 2)
    axes.plot(*still.T, "^", ms=13, mfc="#bbbbbb", mec=INK, mew=0.9, zorder=5.8, label=label)
    axes.plot(*still.T, "o", ms=5, mfc="white", mec=INK, mew=1.3, zorder=6.1)


def _paths(axes: Axes, motion: LinkageMotion) -> None:
    dots: Any = {"color": INK, "linestyle": (0, (1, 1.6)), "linewidth": 0.9, "zorder": 3.0}
    label: str | None = "path of a joint"
    for j, name in enumerate(motion.joints):
        if name not in motion.ground:
            axes.plot(*motion.joint_position[:, j].T, label=label, **dots)
            label = None


def _name(figure: Figure, axes: Axes, motion: LinkageMotion, instants: list[int]) -> None:
    """Names of joints at the first position drawn, of moved ones at the last, then of bodies."""
    labels = []
    least = SAME * float(np.ptp(_all_points(motion), axis=0).max())
    bold, italic = {"color": INK, "weight": "bold"}, {"color": "#555555", "style": "italic"}
    for j, name in enumerate(motion.joints):
        first, *others = motion.joint_position[instants, j]
        moved = [point for point in others if np.abs(point - first).max() > least]
        for x, y in (first, *moved):
            labels.append(Label(clipped(name), float(x), float(y), bold))
    at = dict(zip(motion.joints, motion.joint_position[0], strict=True))
    for body, joints in zip(motion.bodies, motion.links, strict=True):
        if len(joints) > 1 and sorted(body) != sorted("".join(joints)):  # EF is named after E and F
            x, y = np.mean([at[j] for j in joints], axis=0)
            labels.append(Label(clipped(body), float(x), float(y), italic))
    place_texts(figure, axes, labels)
