"""Places without a maximum: a sharp corner, the edge of a clamp, and that of a uniform load; and
the edge of a bearing pressure, where the maximum is at no node.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.failures.asked import command, error_of, off, row, task, told
from benchmarks.failures.draw import INK, decades, line_style, note, ratio_line, ticks
from benchmarks.failures.entry import Entry
from benchmarks.failures.fields import MPA, Mesh, even, finest, graded, revolved, towards
from fea.core.peak import SingularZone
from fea.core.pin_loads import Floats
from fea.harmonic.fields import MeridianFields
from fea.singular.williams import plane_exponent
from reports.data.row import PinResult
from reports.format.numbers import engineering

ACROSS = (5.0, 10.0, 20.0, 40.0)
CLOSEST = 1e-4  # size of the element at the corner over the diameter
NU = 0.3
WILLIAMS = "M. L. Williams, J. Appl. Mech. 19 (1952) 526"


@dataclass(frozen=True)
class Growth:
    """The growth of stress at a singular place.

    meshes: each of one element size.
    distance, stress: (J,) m and (J,) Pa, towards the place on a graded mesh.
    theory: exponent.
    zone: the zone that pinstress found there, in the row `found`.
    """

    meshes: tuple[Mesh, ...]
    distance: Floats
    stress: Floats
    theory: float
    zone: SingularZone
    found: PinResult

    @property
    def growth(self) -> float:
        """The ratio of the peaks before and after the last halving of the elements."""
        return self.meshes[-1].maximum / self.meshes[-2].maximum


@cache
def growth(name: str, kind: str, theory: float, across: tuple[float, ...] = ACROSS) -> Growth:
    """Return the peaks of a study's pin on ever finer meshes, and the stress towards the place."""
    found = row(name)
    (zone,) = (z for z in found.singular_at if z.kind == kind)
    x, y, z = zone.location
    r = float(np.hypot(x, y))
    distance, stress = towards(name, r * 1e-3, z * 1e-3, CLOSEST * 2e-3 * r)
    return Growth(tuple(even(name, n)[0] for n in across), distance, stress, theory, zone, found)


def sharp_corner() -> Growth:
    """Return the growth at an inner corner of 270 degrees."""
    theory = plane_exponent(1.5 * np.pi, NU, "free", "free")
    return growth("sharp_corner", "a sharp corner", theory)


def clamped_edge() -> Growth:
    """Return the growth at the rim of a clamped face, 90 degrees."""
    theory = plane_exponent(0.5 * np.pi, NU, "clamped", "free")
    return growth("clamped_edge", "the edge of a clamp", theory)


def looks_converged() -> Growth:
    """Return the growth at the edge of a clamp next to a fillet, which hides it on coarse
    meshes.
    """
    theory = plane_exponent(0.5 * np.pi, NU, "clamped", "free")
    return growth("looks_converged", "the edge of a clamp", theory, (3.0, 6.0, 12.0, 24.0, 48.0))


@dataclass(frozen=True)
class LoadEdge:
    """The shear at the edge of a uniform load.

    sizes: (K,) of elements, m. shear: (K,) at the edge, Pa.
    slope: of the shear over log(1/distance) on a graded mesh, Pa. theory: the same by theory.
    found: pinstress's result.
    """

    sizes: Floats
    shear: Floats
    slope: float
    theory: float
    found: PinResult


@cache
def load_edge() -> LoadEdge:
    """Return the circumferential shear at the edge of the middle band.

    The traction q T jumps there by the difference of the bands' tractions; the antiplane half plane
    has the shear q / pi log(1/d).
    """
    name = "load_edge"
    pin, loads = revolved(name), task(name).loads[0]
    left, middle = pin.band("left"), pin.band("middle")
    edge = middle.radius, middle.z0
    forces = loads.forces[0, :, 1]

    def shear(fields: MeridianFields) -> tuple[Floats, Floats]:
        amounts = np.array([forces[loads.surfaces.index(load.surface)] for load in fields.loads])
        distance = np.hypot(*(fields.points[: fields.skin] - edge).T)
        return distance, np.abs(fields.stress[: fields.skin, 3] @ amounts)

    sizes, highest = [], []
    for across in ACROSS:
        mesh, fields = even(name, across)
        distance, stress = shear(fields)
        sizes.append(mesh.size)
        highest.append(float(stress[distance.argmin()]))
    d, stress = shear(graded(name, *edge, CLOSEST * 2.0 * middle.radius))
    near = (d > 5e-4 * middle.radius) & (d < 0.02 * middle.radius)
    slope = float(np.polyfit(-np.log(d[near]), stress[near], 1)[0])
    jump = abs(forces[0] / left.area - forces[1] / middle.area)
    return LoadEdge(np.array(sizes), np.array(highest), slope, jump / np.pi, row(name))


@dataclass(frozen=True)
class PressureEdge:
    """The largest stress at the edge of a pressure.

    meshes: each of one size.
    truth: on a much finer mesh, Pa.
    found: pinstress's result.
    """

    meshes: tuple[Mesh, ...]
    truth: float
    found: PinResult


@cache
def pressure_edge() -> PressureEdge:
    """Return the results for pressures that meet on opposite sides of a pin."""
    name = "pressure_edge"
    return PressureEdge(tuple(even(name, n)[0] for n in ACROSS), finest(name), row(name))


def entries() -> tuple[Entry, ...]:
    """Return the entries of this family."""
    return (
        _entry(
            sharp_corner(),
            "sharp_corner",
            "A sharp inner corner",
            "Where two free faces meet at an inner angle of 270°, the stress of linear elasticity "
            f"grows like distance^-s ({WILLIAMS}). A real corner has a radius.",
        ),
        _entry(
            clamped_edge(),
            "clamped_edge",
            "The rim of a clamped face",
            "A rigid clamp prevents lateral contraction of the end face; the stress at its rim is "
            "unbounded "
            f"({WILLIAMS}). A real hub is not rigid.",
        ),
        _looks(looks_converged()),
        _logarithm(load_edge()),
        _pressed(pressure_edge()),
    )


def _entry(g: Growth, name: str, title: str, physics: str) -> Entry:
    first, last = g.meshes[0], g.meshes[-1]
    outside = finest(name) / MPA
    return Entry(
        name,
        title,
        physics,
        f"The largest stress on one mesh: {engineering(first.maximum / MPA, 3)} MPa with elements "
        f"of {first.size * 1e3:g} mm, {engineering(last.maximum / MPA, 3)} MPa with "
        f"{last.size * 1e3:.2g} mm. The last halving still increases it by "
        f"{100 * (g.growth - 1):.0f} %.",
        f"No maximum exists: s = {g.theory:.3f}, an increase of {100 * (2**g.theory - 1):.0f} % "
        "with "
        f"every halving, without limit. Farther away than a tenth of the diameter the maximum is "
        f"{engineering(outside)} MPa (on a mesh with four times the unknowns).",
        f"{told(g.found)} {_outside(g.found, outside)}",
        (command(name),),
        "Left: the peak rises with every halving of the element size. Right: towards the "
        "singularity the stress follows the theoretical exponent",
        lambda figure, axes: _draw_growth(figure, axes, g),
    )


def _outside(found: PinResult, truth: float) -> str:
    """Return a sentence on the accuracy of the surface's value outside the excluded zones."""
    assert found.places is not None
    value = found.places.surface.max_von_mises
    share = 100 * abs(value / truth - 1)
    if found.places.governs == "section":
        return (
            f"The section governs; the surface's maximum outside the excluded zone, "
            f"{engineering(value)} MPa, differs by {share:.1f} % from the true one."
        )
    return (
        f"The maximum outside the excluded zone differs by {share:.1f} % from "
        f"the true one; the error estimate is {100 * error_of(found) / value:.1f} %."
    )


def _draw_growth(figure: Figure, axes: list[Axes], g: Growth) -> None:
    left, right = axes
    size = np.array([m.size for m in g.meshes]) * 1e3
    peak = np.array([m.maximum for m in g.meshes]) / MPA
    left.loglog(size, peak, "o-", color=INK, ms=4)
    ratio_line(left, size, peak[-1] * (size / size[-1]) ** -g.theory, "theoretical slope")
    left.invert_xaxis()
    left.set(xlabel="element size [mm]", ylabel="largest von Mises stress [MPa]")
    note(
        left,
        size[-1],
        peak[-1],
        f"+{100 * (g.growth - 1):.0f} % in\nthis halving",
        (-10, 0),
        INK,
        "right",
    )
    _draw_towards(right, g)
    decades(right)
    ticks(left, size, (400.0, 500.0, 600.0, 800.0, 1000.0, 1200.0))
    ticks(right, None, (500.0, 1000.0, 2000.0))


def _draw_towards(axes: Axes, g: Growth) -> None:
    d, stress = g.distance * 1e3, g.stress / MPA
    axes.loglog(d, stress, color=INK)
    k = d < 0.02 * d[-1]
    at = d[k]
    line = stress[0] * (at / d[0]) ** -g.theory
    axes.loglog(at, 1.12 * line, **line_style(1))
    measured = g.zone.exponent or 0.0
    note(
        axes, at[-1], 1.12 * line[-1],
        f"theory: s = {g.theory:.3f}\nmeasured: {measured:.3f}", (8, 14), line_style(1)["color"],
    )  # fmt: skip
    axes.axvline(g.zone.excluded, color="#8a8a8a", linewidth=0.8)
    note(
        axes,
        g.zone.excluded,
        stress.max(),
        "not evaluated\nleft of here",
        (-4, -14),
        "#666666",
        "right",
    )
    axes.set(xlabel="distance from the singularity [mm]", ylabel="von Mises stress [MPa]")


def _looks(g: Growth) -> Entry:
    first, second, *_, last = g.meshes
    apart = 100 * abs(second.maximum / first.maximum - 1)
    return Entry(
        "looks_converged",
        "A clamp that looks converged",
        "The singularity of a clamp is weak: on coarse meshes the stress at a fillet exceeds it, "
        "and "
        "the agreement of two meshes does not reveal it.",
        f"Two meshes, of {first.unknowns} and {second.unknowns} unknowns, agree to {apart:.2f} %: "
        f"{engineering(second.maximum / MPA, 3)} MPa at the fillet, apparently converged.",
        f"The next meshes give {', '.join(engineering(m.maximum / MPA, 3) for m in g.meshes[2:])} "
        f"MPa, at the rim of the clamp, without limit (s = {g.theory:.3f}); at the fillet it is "
        f"{engineering(finest('looks_converged') / MPA)} MPa.",
        f"{told(g.found)} {_outside(g.found, finest('looks_converged') / MPA)} "
        "Pinstress locates singularities from the geometry, requires at least three meshes, and "
        "grades them towards singularities.",
        (command("looks_converged"),),
        "The peak is constant on two meshes and then rises without limit",
        lambda figure, axes: _draw_looks(axes[0], g, last),
        panels=1,
    )


def _draw_looks(axes: Axes, g: Growth, last: Mesh) -> None:
    unknowns = np.array([m.unknowns for m in g.meshes])
    peak = np.array([m.maximum for m in g.meshes]) / MPA
    axes.semilogx(unknowns, peak, "o-", color=INK, ms=4)
    note(axes, unknowns[1], peak[1], "two meshes agree", (0, -14), INK, "center")
    note(
        axes,
        unknowns[-1],
        peak[-1],
        "the rim of the clamp,\nwithout limit",
        (-10, -4),
        INK,
        "right",
    )
    own = [(s.dofs, s.max_von_mises) for s in g.found.history]
    axes.semilogx(*zip(*own, strict=True), "s", color=line_style(1)["color"], ms=4)
    x, y = own[-1]
    note(
        axes, x, y, "pinstress: outside the excluded zone,\nsingularity reported", (10, -4),
        line_style(1)["color"],
    )  # fmt: skip
    axes.set(xlabel="unknowns", ylabel="largest von Mises stress [MPa]")
    axes.set_ylim(0.9 * peak.min(), 1.06 * peak.max())
    decades(axes, which="x")


def _logarithm(e: LoadEdge) -> Entry:
    first, last = e.shear[0] / MPA, e.shear[-1] / MPA
    outside = finest("load_edge") / MPA
    return Entry(
        "load_edge",
        "The edge of a uniform load",
        "A traction of constant direction on a band has a circumferential component, which jumps "
        "at "
        "the band's edge. The shear stress near a jump q grows like (q/π) log(1/distance) "
        "(antiplane "
        "half-space; Timoshenko & Goodier give the plane case). A bearing pressure has no such "
        "jump.",
        f"The shear at the edge of the middle band: {engineering(first, 3)} MPa on the coarsest "
        f"mesh, {engineering(last, 3)} MPa on the finest. It grows so slowly that any two meshes "
        "seem "
        "to agree.",
        f"Every halving adds {engineering(e.theory * np.log(2) / MPA, 3)} MPa in theory "
        f"({engineering(e.slope * np.log(2) / MPA, 3)} measured): a logarithm without limit. "
        f"Farther away than a hundredth of the diameter the maximum is {engineering(outside)} MPa.",
        f'{told(e.found)} {_outside(e.found, outside)} The remedy is `distribution = "cosine"`.',
        (command("load_edge"),),
        "The shear at the band's edge grows by the same amount with every halving of the element "
        "size",
        lambda figure, axes: _draw_logarithm(axes[0], e),
        panels=1,
    )


def _draw_logarithm(axes: Axes, e: LoadEdge) -> None:
    size = e.sizes * 1e3
    axes.semilogx(size, e.shear / MPA, "o-", color=INK, ms=4)
    line = (e.shear[-1] + e.theory * np.log(e.sizes[-1] / e.sizes)) / MPA - 3.0
    axes.semilogx(size, line, **line_style(1))
    note(axes, size[1], line[1], "theory: (q/π) log(1/size)", (0, -14), line_style(1)["color"])
    note(axes, size[2], e.shear[2] / MPA, "at the edge of the band", (-8, 6), INK, "right")
    axes.invert_xaxis()
    axes.set(xlabel="element size [mm]", ylabel="circumferential shear [MPa]")
    ticks(axes, size)


def _pressed(e: PressureEdge) -> Entry:
    lows = [100.0 * (1.0 - m.maximum / e.truth) for m in e.meshes]
    return Entry(
        "pressure_edge",
        "The edge of a bearing pressure",
        "Where a pressure p ends, the stress is bounded but depends on the direction from which "
        "the "
        "edge is approached: it is that of a half-plane with p on one half, at any distance "
        "(Johnson, *Contact Mechanics*, 2.5). The largest stress is directly below the edge.",
        "No node is exactly at the edge. The largest nodal stress is "
        + ", ".join(f"{low:.0f}" for low in lows[:-1])
        + f" and {lows[-1]:.1f} % low with {e.meshes[0].unknowns:,} to "
        f"{e.meshes[-1].unknowns:,} unknowns, at a different node on every mesh.",
        f"{engineering(e.truth / MPA)} MPa, on a mesh with four times the unknowns of pinstress's "
        "last.",
        f"{told(e.found)} Elements at the edge are not evaluated. The half-plane "
        "stress, known from the pressure, is subtracted farther away and added back for every "
        "direction, so "
        f"that the first mesh, with {e.found.history[0].dofs:,} unknowns, is "
        f"{abs(off(e.found.history[0].max_von_mises, e.truth / MPA)):.1f} % off.",
        (command("pressure_edge"),),
        "The largest nodal stress rises slowly with the number of unknowns; pinstress's is right "
        "on "
        "the first mesh",
        lambda figure, axes: _draw_pressed(axes[0], e),
        panels=1,
    )


def _draw_pressed(axes: Axes, e: PressureEdge) -> None:
    unknowns = [m.unknowns for m in e.meshes]
    peak = [m.maximum / MPA for m in e.meshes]
    axes.semilogx(unknowns, peak, "o-", color=INK, ms=4)
    note(axes, unknowns[1], peak[1], "nodal values, uniform meshes", (8, -12), INK)
    axes.axhline(e.truth / MPA, color=INK, lw=0.8, ls=":")
    own = line_style(1)
    axes.semilogx(*zip(*((s.dofs, s.max_von_mises) for s in e.found.history), strict=True), **own)
    last = e.found.history[-1]
    note(axes, last.dofs, last.max_von_mises, "pinstress", (8, -10), own["color"])
    axes.set(xlabel="unknowns", ylabel="largest von Mises stress [MPa]")
    decades(axes, which="x")
