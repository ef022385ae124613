"""Supports of a pin: none, rigid clamps or soft lugs; and the reactions of a support."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from matplotlib.axes import Axes
from scipy.sparse.linalg import splu

from benchmarks.failures.asked import (
    command,
    error_of,
    material_of,
    row,
    surface_contains,
    task,
    told,
)
from benchmarks.failures.draw import INK, decades, line_style, note
from benchmarks.failures.entry import Entry
from benchmarks.failures.fields import MPA, finest, revolved
from fea.core.pin_loads import Floats, PinLoads, UnitLoad
from fea.core.tractions import traction
from fea.harmonic.assembly import Section
from fea.harmonic.boundary import Outline
from fea.harmonic.fields import MeridianFields
from fea.harmonic.stress_recovery import reading
from fea.harmonic.superposition import Circumference
from fea.solid.boundary import Patch, resultants
from fea.solid.model import SolidModel
from geometry.mesh.section_mesh import SectionSize, meridian_mesh
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from reports.data.row import PinResult
from reports.format.numbers import engineering, ten_to

ACROSS = (3.0, 4.0, 5.0, 6.0, 8.0)
FORCE = 1e4  # N
MESHES = (2.0, 3.0, 4.0, 6.0)  # elements over the diameter of the solid


@dataclass(frozen=True)
class Free:
    """The results for an unconstrained pin, as an LU factorisation gives them without an error.

    across: (K,) elements over the diameter.
    stress: (K,) Pa. motion: (K,) displacement, m.
    push: the resultant of the loads, N.
    found: pinstress's result.
    """

    across: Floats
    stress: Floats
    motion: Floats
    push: float
    found: PinResult


@cache
def free_pin() -> Free:
    """Return the results for the loads of the study on the singular matrix of harmonic 1."""
    stress, motion = zip(*(_unheld(n) for n in ACROSS), strict=True)
    push = float(np.abs(task("free_pin").loads[0].forces[0].sum(axis=0)).max())
    return Free(np.array(ACROSS), np.array(stress), np.array(motion), push, row("free_pin"))


def _unheld(across: float) -> tuple[float, float]:
    """Return the largest von Mises stress, Pa, and the largest displacement, m."""
    pin, loads, steel = revolved("free_pin"), task("free_pin").loads[0], material_of("free_pin")
    space = Section(meridian_mesh(pin, SectionSize(across)))
    outline = Outline(space)
    free = np.setdiff1d(np.arange(space.unknowns), _axis(space))
    forces, parts = _summed(outline, loads)
    K = space.stiffness(steel, 1)[free][:, free].tocsc()
    unknowns = np.zeros(space.unknowns)
    unknowns[free] = splu(K, permc_spec="MMD_AT_PLUS_A").solve(forces[free])
    p, m, w = unknowns.reshape(-1, 3).T
    u = np.stack([p + m, p - m, w], axis=1)[..., None]
    read = reading(space, outline, steel)
    moved, found = read.of(1, u, parts[..., None])
    unit = (UnitLoad("left", "force", 1),)
    fields = MeridianFields(read.points, unit, found, moved, read.skin, space.unknowns)
    one = PinLoads("one", ("left",), np.array([[[0.0, 1.0, 0.0]]]))
    return Circumference(fields, one).top(np.ones(len(read.points), bool)).value, float(
        np.abs(moved).max()
    )


def _axis(space: Section) -> Floats:
    return np.concatenate([3 * space.section.axis, 3 * space.section.axis + 2])


def _summed(outline: Outline, loads: PinLoads) -> tuple[Floats, Floats]:
    """Return the forces on the unknowns (n,) and the tractions (E, 3, 3) of the whole case.

    The loads along y are applied along x.
    """
    pin, y = revolved("free_pin"), loads.forces[0, :, 1]
    parts = [(traction(pin, UnitLoad(name, "force", 1)),) for name in loads.surfaces]
    R, T, Z = sum(f * outline.forces(part, 1) for f, part in zip(y, parts, strict=True)).T
    spread = sum(f * outline.traction(part) for f, part in zip(y, parts, strict=True))
    return np.stack([R + T, R - T, Z], axis=1).ravel(), np.asarray(spread)


@dataclass(frozen=True)
class Support:
    """The errors of the force of a clamp.

    across: (K,) elements over the diameter. unknowns: (K,).
    surface, residual: (K,) relative errors by the stresses on its face, and by the residual of the
    system.
    """

    across: Floats
    unknowns: Floats
    surface: Floats
    residual: Floats


@cache
def reactions() -> Support:
    """Return the errors for the clamp of the study clamped_edge, on solid meshes."""
    name = "clamped_edge"
    pin, steel = revolved(name), material_of(name)
    unknowns, surface, residual = [], [], []
    for across in MESHES:
        mesh = solid_mesh(pin, MeshSize(across=across, corner=1.0))
        fields = SolidModel(pin, mesh, steel, ("start",)).solve(
            ((UnitLoad("link", "force", 1), 1),)
        )
        patch = Patch(fields.space, fields.surface, "start")
        at = fields.surface.corners[patch.rows]
        tension = _pull(fields.stress[at, :, 0], fields.surface.normals[patch.rows])
        read = resultants(fields.space.nodes, patch.nodal_forces(tension[..., None]))[:, 0]
        unknowns.append(fields.space.unknowns)
        surface.append(abs(float(read[1]) + 1.0))
        residual.append(abs(float(fields.support[1, 0]) + 1.0))
    return Support(
        np.array(MESHES), np.array(unknowns, dtype=float), np.array(surface), np.array(residual)
    )


def _pull(stress: Floats, normals: Floats) -> Floats:
    """Return the traction (P, 6, 3) of stress (P, 6, 6), components xx, yy, zz, yz, xz, xy."""
    tensor = stress[..., [[0, 5, 4], [5, 1, 3], [4, 3, 2]]]
    return np.asarray(np.einsum("pqab,pqb->pqa", tensor, normals))


def entries() -> tuple[Entry, ...]:
    """Return the entries of this family."""
    return (_free(free_pin()), _supports(), _reactions(reactions()))


def _free(f: Free) -> Entry:
    stresses = ", ".join(engineering(s / MPA, 3) for s in f.stress)
    return Entry(
        "free_pin",
        "An unconstrained pin",
        "Without supports the stiffness matrix is singular. Round-off makes its last pivots small "
        "numbers instead of zeros, so that a factorisation succeeds.",
        f"SuperLU gives {stresses} MPa on five meshes, all plausible stresses, and displacements "
        "of "
        f"{engineering(f.motion.min() / 1e3, 2)} km and more, which nobody prints.",
        f"The loads have a resultant of {engineering(f.push, 3)} N that nothing reacts: the pin "
        "flies off.",
        f"{told(f.found)} No matrix is factorised.",
        (command("free_pin"),),
        "Stresses on five meshes scatter randomly; displacements are hundreds of thousands of "
        "kilometres",
        lambda figure, axes: _draw_free(axes[0], axes[1], f),
    )


def _draw_free(left: Axes, right: Axes, f: Free) -> None:
    left.plot(f.across, f.stress / MPA, "o-", color=INK, ms=4)
    left.set(
        xlabel="elements over the diameter", ylabel="largest von Mises stress [MPa]", ylim=(0, None)
    )
    right.plot(f.across, f.motion / 1e6, "o-", color=INK, ms=4)
    right.set(xlabel="elements over the diameter", ylabel="displacement [1000 km]", ylim=(0, None))
    note(left, f.across[1], f.stress[1] / MPA, "a plausible stress", (10, 0))
    note(right, f.across[1], f.motion[1] / 1e6, "of a pin 80 mm long", (10, 0))


def _supports() -> Entry:
    stiff, soft = row("supports", "stiff"), row("supports", "soft")
    values = [engineering(r.max_von_mises, 3) for r in (stiff, soft)]
    truths = [finest("supports", pin) / MPA for pin in ("stiff", "soft")]
    held = all(surface_contains(r, t) for r, t in zip((stiff, soft), truths, strict=True))
    return Entry(
        "supports",
        "Stiff and soft supports",
        "A pin between two lugs bends like a beam with built-in ends if the lugs are rigid, and "
        "like a "
        "simply supported one if they are soft (textbook bending moments F l/8 and F l/4).",
        "One of the two, chosen by habit.",
        "Between the two: it depends on the stiffness of the lugs, which are not part of the "
        "study.",
        "Without [lugs](lugs.md), whose contact it computes, pinstress gives both ends of the "
        "range. Clamped: "
        f"{told(stiff)} With the lug forces applied and no clamp: {told(soft)} With real lugs the "
        f"maximum is between {values[0]} and {values[1]} MPa. Both are the sections', which exceed "
        "the surface: meshes with four times the unknowns have "
        f"{' and '.join(engineering(t) for t in truths)} MPa there, "
        + ("within both errors." if held else "not within both errors."),
        (command("supports"),),
        "The maximum stress with soft lugs is more than twice that with rigid clamps",
        lambda figure, axes: _draw_supports(axes[0], stiff, soft),
        panels=1,
    )


def _draw_supports(axes: Axes, stiff: PinResult, soft: PinResult) -> None:
    for y, (found, text) in enumerate(((stiff, "rigid clamps"), (soft, "lug forces only"))):
        value, error = found.max_von_mises or 0.0, error_of(found)
        axes.errorbar(value, y, xerr=error, fmt="s", color=line_style(1)["color"], capsize=3)
        note(
            axes,
            value,
            y,
            f"{text}:\n{engineering(value, 3)} MPa, {found.verdict}",
            (0, 22),
            INK,
            "center",
        )
    low, high = (r.max_von_mises or 0.0 for r in (stiff, soft))
    axes.plot([low, high], [0, 1], color="#8a8a8a", linestyle=(0, (1.2, 1.4)))
    note(axes, (low + high) / 2, 0.5, "lugs of finite stiffness", (10, -6), "#555555")
    axes.set(
        xlabel="largest von Mises stress [MPa]", xlim=(0, 1.3 * high), ylim=(-0.6, 1.9), yticks=[]
    )


def _reactions(s: Support) -> Entry:
    read = ", ".join(f"{100 * e:.0f} %" for e in s.surface)
    return Entry(
        "reactions",
        "Reactions from the stress on the support",
        "At the rim of a clamp the stress is unbounded, and its finite-element approximation has a "
        "first-order error. The residual of the system of equations is in equilibrium with the "
        "loads on any mesh (Galerkin orthogonality with the rigid-body motions).",
        "Integrating the stresses over the clamped face gives a transverse force with errors of "
        f"{read} "
        "on successively finer meshes.",
        f"{engineering(FORCE, 3)} N, by equilibrium.",
        "Clamp forces are taken from the residual (`fea/solid/model.py`), here accurate to "
        f"{_power(float(s.residual.max()))} on all meshes; a solution whose clamp forces do not "
        "balance its loads to 10⁻⁶ is rejected.",
        (command("clamped_edge", "run", "--model solid"),),
        "The error of the integrated stresses stays at about 10 %, that of the residual at "
        "round-off",
        lambda figure, axes: _draw_reactions(axes[0], s),
        panels=1,
    )


def _power(error: float) -> str:
    return ten_to(int(np.ceil(np.log10(error))))


def _draw_reactions(axes: Axes, s: Support) -> None:
    color = line_style(1)["color"]
    axes.loglog(s.unknowns, s.surface, "o-", color=INK, ms=4)
    axes.loglog(s.unknowns, s.residual, "s--", color=color, ms=4)
    note(axes, s.unknowns[1], s.surface[1], "integrated stresses", (0, -12), INK)
    note(axes, s.unknowns[1], s.residual[1], "residual of the system", (0, 14), color)
    axes.set(xlabel="unknowns", ylabel="error of the clamp's force", ylim=(1e-15, 3.0))
    decades(axes, which="x")
    axes.yaxis.set_major_formatter(lambda value, _: ten_to(round(np.log10(value))))
