"""Extreme shapes: discs and needles, tiny fillets, thin tubes; and different sizes and units."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import NullFormatter

from benchmarks.failures.asked import command, contains, error_of, material_of, plan, row, task
from benchmarks.failures.draw import INK, line_style, note
from benchmarks.failures.entry import Entry
from benchmarks.failures.fields import MPA, evenly, finest, revolved
from fea.core.pin_loads import Floats
from fea.core.requirement import Requirement
from fea.solve.solve import solve_pin
from geometry import Pin
from geometry.mesh.section_mesh import SectionSize, meridian_mesh
from reports.data.row import PinResult
from reports.format.numbers import engineering, ten_to

SCALES = tuple(10.0**k for k in (-6, -3, 0, 3, 6))


@dataclass(frozen=True)
class Shape:
    """One pin of a study.

    ratio: the extreme ratio of its dimensions.
    naive, truth: MPa.
    found: pinstress's result.
    """

    ratio: float
    naive: float
    truth: float
    found: PinResult

    @property
    def held(self) -> bool:
        """Whether the estimated error contains the true value."""
        return contains(self.found, self.truth)


def beam(pin: Pin, force: float) -> float:
    """Return M c / I, Pa, in the middle of a pin in double shear: M = F L / 8.

    Its bands are a quarter, a half and a quarter of its length.
    """
    s = pin.segments[0]
    return 4.0 * force * pin.length * s.diameter / (np.pi * (s.diameter**4 - s.bore**4))


@cache
def slender() -> tuple[Shape, ...]:
    """Return pins with a length over diameter of 0.1 to 100.

    The true value is the larger of the surface and the section in the middle, for which beam theory
    is exact.
    """
    out = []
    for t in plan("slender").tasks:
        pin = revolved("slender", t.pin.name)
        ratio = pin.length / pin.smallest_diameter
        naive = beam(pin, 1000.0) / MPA
        truth = max(naive, finest("slender", pin.name) / MPA)
        out.append(Shape(ratio, naive, truth, row("slender", pin.name)))
    return tuple(out)


@cache
def fillets() -> tuple[Shape, ...]:
    """Return pins with a fillet over diameter of 0.001 to 0.1; the naive value is from one mesh of
    an eighth of the diameter.
    """
    name = "tiny_fillet"
    return tuple(
        Shape(
            (pin := revolved(name, t.pin.name)).fillet / pin.smallest_diameter,
            evenly(name, pin.name, 8.0) / MPA,
            finest(name, pin.name, beyond=1) / MPA,
            row(name, pin.name),
        )
        for t in plan(name).tasks
    )


@cache
def tubes() -> tuple[Shape, ...]:
    """Return pins with bores of 0 to 99 % of the diameter; the naive value is that of the beam."""
    name = "thin_tube"
    out = []
    for t in plan(name).tasks:
        pin = revolved(name, t.pin.name)
        s = pin.segments[0]
        truth = finest(name, pin.name, beyond=1) / MPA
        out.append(Shape(s.bore / s.diameter, beam(pin, 1000.0) / MPA, truth, row(name, pin.name)))
    return tuple(out)


@dataclass(frozen=True)
class Sizes:
    """The results for one pin at several sizes.

    scales: (K,) of all lengths.
    stress: (K,) under forces that are scaled with the squares of lengths, Pa.
    taken: (K,) fraction of the nodes that np.isclose selects as the loaded surface. right: the
    correct one.
    apart: relative difference of the study's two pins.
    """

    scales: Floats
    stress: Floats
    taken: Floats
    right: float
    apart: float


@cache
def units() -> Sizes:
    """Return the results for one pin in two systems of units, and for similar pins from 20 nm to 20
    km.
    """
    name = "units"
    pin, loads = revolved(name, "metres"), task(name, "metres").loads[0]
    stress, taken, right = [], [], 0.0
    for k in SCALES:
        segments = tuple(
            replace(s, length=k * s.length, diameter=k * s.diameter) for s in pin.segments
        )
        scaled = Pin(pin.name, segments, k * pin.fillet)
        forces = replace(loads, forces=k * k * loads.forces)
        material = material_of(name, "metres")
        (found,) = solve_pin(scaled, material, ("start",), (forces,), Requirement(tolerance=0.02))
        stress.append(found.peak.max_von_mises or 0.0)
        r = meridian_mesh(scaled, SectionSize()).mesh.doflocs[0]
        taken.append(float(np.mean(np.isclose(r, scaled.band("a").radius))))
        right = float(np.mean(np.isclose(r / k, pin.band("a").radius, atol=0.0)))
    one, other = (row(name, p).max_von_mises or 0.0 for p in ("metres", "micrometres"))
    return Sizes(np.array(SCALES), np.array(stress), np.array(taken), right, abs(one / other - 1.0))


def entries() -> tuple[Entry, ...]:
    """Return the entries of this family."""
    return (
        _entry(
            "slender", "Discs and needles", slender(),
            "Beam theory's M c / I is valid for lengths of several diameters; on shorter pins "
            "shear and the pressure itself govern. Long pins are ill-conditioned: round-off grows "
            "with a power of the length.",
            "M c / I", "length over diameter",
            "The true value is the larger of the section's, which is the beam's, and the surface's "
            "on a mesh with four times the unknowns: the section governs from 10 diameters on.",
        ),
        _entry(
            "tiny_fillet", "Tiny fillets", fillets(),
            "As the fillet gets smaller the peak tends to that of a sharp corner (in the limit "
            "like $(r/d)^{-0.456}$); a mesh that does not resolve the arc misses it.",
            "one mesh of an eighth of the diameter", "fillet over diameter",
            "The true value is from a mesh with twice the unknowns of pinstress's last.",
        ),
        _entry(
            "thin_tube", "Thin tubes", tubes(),
            "The section of a beam keeps its shape. A thin tube becomes oval under bearing "
            "pressure, and the bending of its wall governs the stress.",
            "M c / I of the tube", "bore over diameter",
            "The true value is from a mesh with twice the unknowns of pinstress's last.",
        ),
        _sizes(units()),
    )  # fmt: skip


def _entry(
    name: str, title: str, shapes: tuple[Shape, ...], physics: str, naive: str, ratio: str, by: str
) -> Entry:
    def listed(what: list[str]) -> str:
        return ", ".join(f"{text} at {s.ratio:g}" for s, text in zip(shapes, what, strict=True))

    ours = [
        f"{engineering(s.found.max_von_mises)} ± {engineering(error_of(s.found), 2)} "
        f"(`{s.found.verdict}`)"
        for s in shapes
    ]
    held = sum(s.held for s in shapes)
    return Entry(
        name,
        title,
        physics,
        f"{naive[0].upper() + naive[1:]}: {listed([engineering(s.naive, 3) for s in shapes])} MPa.",
        f"{listed([engineering(s.truth) for s in shapes])} MPa. {by}",
        f"{listed(ours)} MPa; the true value is within the error in {held} of {len(shapes)}.",
        (command(name),),
        f"{naive} / true value deviates from one at one end; pinstress's values are at one",
        lambda figure, axes: _draw(axes[0], axes[1], shapes, ratio),
    )


def _draw(left: Axes, right: Axes, shapes: tuple[Shape, ...], ratio: str) -> None:
    x = np.arange(len(shapes))
    truth = np.array([s.truth for s in shapes])
    ours = np.array([s.found.max_von_mises or 0.0 for s in shapes]) / truth
    error = np.array([error_of(s.found) for s in shapes]) / truth
    left.semilogy(x, [s.naive / s.truth for s in shapes], "o-", color=INK, ms=4)
    for k, s in zip(x, shapes, strict=True):
        note(left, float(k), s.naive / s.truth, f"{s.naive / s.truth:.2g}", (7.0, -8.0))
    left.axhline(1.0, color="#8a8a8a", linewidth=0.8)
    left.set(ylabel="naive value / true value", title="naive method")
    left.yaxis.set_minor_formatter(NullFormatter())
    left.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    right.axhline(1.0, color="#8a8a8a", linewidth=0.8)
    color = line_style(1)["color"]
    right.errorbar(x, ours, yerr=error, fmt="s", ms=4, color=color, capsize=3)
    right.set(ylabel="pinstress / true value", title="pinstress, with its error")
    for axes in (left, right):
        axes.set(xlabel=ratio, xlim=(-0.5, len(shapes) - 0.5))
        axes.set_xticks(x, [f"{s.ratio:g}" for s in shapes])


def _sizes(s: Sizes) -> Entry:
    spread = float(np.ptp(s.stress) / s.stress.mean())
    return Entry(
        "units",
        "Units and sizes",
        "Linear elasticity has no length scale: a pin a million times smaller under a million "
        "million "
        "times less force has the same stress. Absolute tolerances in a program do have one.",
        "`np.isclose(r, R)`, a common way to select the nodes of a loaded surface, selects "
        f"{100 * s.taken[0]:.0f} % of all nodes of a 20 nm pin instead of "
        f"{100 * s.right:.0f} %.",
        "The same stress at every size and in all units.",
        "The study's pin in m and N and in µm and GN: "
        f"{engineering(row('units', 'metres').max_von_mises)}"
        f" Pa both, the same to {_power(max(s.apart, 1e-15))}. Pins of 20 nm to 20 km: the same to "
        f"{_power(spread)}, as round-off decides at which of two nodes the next mesh is refined.",
        (command("units"),),
        "The stress is the same over twelve orders of magnitude in size; the share of selected "
        "nodes is not",
        lambda figure, axes: _draw_sizes(axes[0], axes[1], s),
    )


def _power(error: float) -> str:
    return ten_to(int(np.ceil(np.log10(error))))


def _draw_sizes(left: Axes, right: Axes, s: Sizes) -> None:
    d = 0.02 * s.scales
    left.semilogx(d, 100.0 * s.taken, "o-", color=INK, ms=4)
    left.axhline(100.0 * s.right, color="#8a8a8a", linewidth=0.8)
    note(left, d[-1], 100.0 * s.right, "nodes on the surface", (0, 8), "#555555", "right")
    note(left, d[0], 100.0 * s.taken[0], "all nodes", (8, 0))
    left.set(xlabel="diameter [m]", ylabel="nodes selected by np.isclose [%]", ylim=(0, 110))
    right.semilogx(d, s.stress / MPA, "s", color=line_style(1)["color"], ms=4)
    top = s.stress.max() / MPA
    note(right, d[2], s.stress[2] / MPA, "pinstress", (0, 12), line_style(1)["color"], "center")
    right.set(xlabel="diameter [m]", ylabel="largest von Mises stress [MPa]", ylim=(0, 1.3 * top))
    for axes in (left, right):
        axes.set_xticks(d, [ten_to(round(np.log10(x / 2))).replace("10", "2×10", 1) for x in d])
