"""Elements that lock: linear ones in bending, and all but mixed ones near nu = 1/2."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import scipy.sparse as sp
from matplotlib.axes import Axes
from scipy.sparse.linalg import spsolve
from skfem import (
    Basis,
    BilinearForm,
    ElementTetP1,
    ElementTriP1,
    ElementTriP2,
    ElementVector,
    MeshTet1,
    MeshTri1,
)
from skfem.models.elasticity import linear_elasticity

from benchmarks.failures.asked import (
    command,
    contains,
    error_of,
    material_of,
    plan,
    row,
    task,
    told,
)
from benchmarks.failures.draw import INK, line_style, note
from benchmarks.failures.entry import Entry
from benchmarks.failures.fields import MPA, even, revolved
from fea.core.local_fit import continuation
from fea.core.material import Material
from fea.core.pin_loads import Floats, UnitLoad
from fea.core.tractions import traction
from fea.core.voigt import von_mises
from fea.harmonic.assembly import Section, elasticity
from fea.harmonic.boundary import Outline
from fea.harmonic.superposition import Circumference
from fea.solid.boundary import surface
from fea.solid.model import SolidModel
from fea.solid.nodal_loads import nodal_loads
from geometry.mesh.section_mesh import SectionSize, meridian_mesh
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from reports.data.row import PinResult
from reports.format.numbers import engineering

FORCE = 5e3  # N
ACROSS = (2.0, 3.5, 6.0)  # tetrahedra over the diameter
MIDDLE = (0.02, 0.05)  # m, between which the shaft's stress is read
FINE = 16.0  # elements over the diameter on the section mesh that gives the true values
COARSE, REFINED = SectionSize(6.0, 8.0, 0.3), SectionSize(6.0, 20.0, 0.4)


@dataclass(frozen=True)
class Bending:
    """The deflection of the tip, m, and the stress in the middle, Pa.

    across: (K,) elements over the diameter.
    linear, quadratic: (K, 2) of linear and quadratic tetrahedra on the same meshes.
    truth: (2,) of the fine mesh of the section.
    found: pinstress's result.
    """

    across: Floats
    linear: Floats
    quadratic: Floats
    truth: Floats
    found: PinResult


@cache
def bending() -> Bending:
    """Return the deflections and stresses of all meshes."""
    name = "linear_elements"
    both = [_tetrahedra(n) for n in ACROSS]
    pin = revolved(name)
    _, fields = even(name, FINE)
    r, z = fields.points.T
    tip = np.hypot(r - pin.segments[-1].diameter / 2.0, z - pin.length).argmin()
    middle = (z > MIDDLE[0]) & (z < MIDDLE[1])
    top = Circumference(fields, task(name).loads[0]).top(middle).value
    truth = np.array([FORCE * fields.displacement[tip, 0, 0], top])
    linear, quadratic = (np.array(x) for x in zip(*both, strict=True))
    return Bending(np.array(ACROSS), linear, quadratic, truth, row(name))


def _tetrahedra(across: float) -> tuple[Floats, Floats]:
    """Return deflection and stress of linear and of quadratic elements on one mesh."""
    name = "linear_elements"
    pin, steel = revolved(name), material_of(name)
    mesh = solid_mesh(pin, MeshSize(across=across, corner=1.0))
    unit = ((UnitLoad("link", "force", 1), 0),)
    model = SolidModel(pin, mesh, steel, ("start",))
    fields = model.solve(unit)
    x = fields.space.nodes
    skin = fields.surface.nodes
    tip = int(np.linalg.norm(x - [0.01, 0.0, pin.length], axis=1).argmin())
    size = von_mises(fields.stress[skin, :, 0])
    quadratic = np.array([fields.displacement[tip, 0, 0], size[_in_middle(x[skin])].max()])
    forces = nodal_loads(pin, steel, model.space, surface(model.space), unit).forces[..., 0]
    u, stress = _linear(mesh.mesh, steel, forces)
    linear = np.array([u[tip, 0], von_mises(stress)[_in_middle(x[: len(u)])].max()])
    return FORCE * linear, FORCE * quadratic


def _in_middle(x: Floats) -> Any:
    return (x[:, 2] > MIDDLE[0]) & (x[:, 2] < MIDDLE[1])


def _linear(mesh: Any, material: Material, forces: Floats) -> tuple[Floats, Floats]:
    """Return displacements (V, 3) and averaged stresses (V, 6) of linear tetrahedra.

    The elements have the corners of a quadratic mesh and are held at z = 0; the forces (N, 3) of
    mid-edge nodes are divided between the ends of their edges.
    """
    corners = MeshTet1(np.ascontiguousarray(mesh.doflocs[:, : mesh.nvertices]), mesh.t)
    f = forces[: mesh.nvertices].copy()
    for end in mesh.edges:
        np.add.at(f, end, 0.5 * forces[mesh.nvertices :])
    basis = Basis(corners, ElementVector(ElementTetP1()), intorder=1)
    K = linear_elasticity(*material.lame).assemble(basis).tocsr()
    free = np.flatnonzero(np.repeat(corners.p[2] > 1e-9, 3))
    u = np.zeros(3 * corners.nvertices)
    u[free] = spsolve(K[free][:, free].tocsc(), f.ravel()[free])
    h = np.asarray(basis.interpolate(u).grad)[..., 0]
    e = 0.5 * (h + h.swapaxes(0, 1))
    strain = np.stack([e[a, b] for a, b in ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))], -1)
    return u.reshape(-1, 3), _averaged(corners.t, material.stress(strain))


def _averaged(cells: Any, values: Floats) -> Floats:
    """Return the means (V, C) at corners of the values (M, C) of elements."""
    count = np.bincount(cells.ravel())
    total = np.zeros((len(count), values.shape[1]))
    for corner in cells:
        np.add.at(total, corner, values)
    return total / count[:, None]


@dataclass(frozen=True)
class Ratio:
    """The largest von Mises stress at one Poisson's ratio, MPa.

    naive: of linear triangles. truth: of mixed elements. found: pinstress's result.
    """

    nu: float
    naive: float
    truth: float
    found: PinResult


@cache
def incompressible() -> tuple[Ratio, ...]:
    """Return the results for a shaft pulled between thicker ends."""
    name = "incompressible"
    out = []
    for t in plan(name).tasks:
        steel = material_of(name, t.pin.name)
        rough, fine = (_pulled(name, t.pin.name, s) for s in (COARSE, REFINED))
        out.append(
            Ratio(
                steel.poisson_ratio,
                _triangles(*rough, steel) / MPA,
                _mixed(*fine, steel) / MPA,
                row(name, t.pin.name),
            )
        )
    return tuple(out)


def _pulled(name: str, pin_name: str, size: SectionSize) -> tuple[Section, Floats]:
    """Return a mesh, and the forces (N, 2) along r and z for one radian."""
    pin, loads = revolved(name, pin_name), task(name, pin_name).loads[0]
    space = Section(meridian_mesh(pin, size))
    outline, forces = Outline(space), np.zeros((len(space.nodes), 3))
    for band, f in zip(loads.surfaces, loads.forces[0, :, 2], strict=True):
        forces += f * outline.forces((traction(pin, UnitLoad(band, "force", 0)),), 0)
    return space, forces[:, [0, 2]] / (2.0 * np.pi)


def _strain(u: Any, w: Any) -> list[Any]:
    """Return the strains rr, tt, zz, rz of a displacement along r and z."""
    g = u.grad
    return [g[0, 0], u[0] / w.x[0], g[1, 1], 0.5 * (g[0, 1] + g[1, 0])]


def _deviator(lam: float, mu: float) -> BilinearForm:
    def form(u: Any, v: Any, w: Any) -> Any:
        e, d = _strain(u, w), _strain(v, w)
        pairs = sum(a * b for a, b in zip(e[:3], d[:3], strict=True)) + 2.0 * e[3] * d[3]
        return w.x[0] * (2.0 * mu * pairs + lam * sum(e[:3]) * sum(d[:3]))

    return BilinearForm(form)


def _size(strain: list[Any], mu: float) -> Floats:
    """Return the von Mises stress from strains, which does not depend on the pressure."""
    mean = sum(strain[:3]) / 3.0
    square = sum((e - mean) ** 2 for e in strain[:3]) + 2.0 * strain[3] ** 2
    return np.asarray(2.0 * mu * np.sqrt(1.5 * square))


def _triangles(space: Section, forces: Floats, material: Material) -> float:
    """Return the largest stress of linear triangles, averaged at their corners."""
    mesh, count = space.section.mesh, space.section.mesh.nvertices
    corners = MeshTri1(np.ascontiguousarray(mesh.doflocs[:, :count]), mesh.t)
    f = forces[:count].copy()
    for end in mesh.facets:
        np.add.at(f, end, 0.5 * forces[count:])
    basis = Basis(corners, ElementVector(ElementTriP1()), intorder=2)
    lam, mu = material.lame
    K = _deviator(lam, mu).assemble(basis).tocsr()
    u = _held(K, f.ravel(), corners.p[0], count)
    g = np.asarray(basis.interpolate(u).grad).mean(axis=3)  # constant within an element
    around = np.mean(u[0::2][corners.t] / np.maximum(corners.p[0][corners.t], 1e-9), axis=0)
    around = np.where(corners.p[0][corners.t].min(axis=0) < 1e-9, g[0, 0], around)
    size = _size([g[0, 0], around, g[1, 1], 0.5 * (g[0, 1] + g[1, 0])], mu)
    return float(_averaged(corners.t, size[:, None]).max())


def _mixed(space: Section, forces: Floats, material: Material) -> float:
    """Return the largest stress of Taylor-Hood elements, whose pressure (over mu) is an unknown of
    its own.
    """
    lam, mu = material.lame
    basis = Basis(space.section.mesh, ElementVector(ElementTriP2()), intorder=4)
    pressure = basis.with_element(ElementTriP1())

    def divergence(u: Any, q: Any, w: Any) -> Any:
        return -w.x[0] * mu * q * sum(_strain(u, w)[:3])

    def bulk(p: Any, q: Any, w: Any) -> Any:
        return -w.x[0] * p * q * mu**2 / lam

    A = _deviator(0.0, mu).assemble(basis)
    B = BilinearForm(divergence).assemble(basis, pressure)
    C = BilinearForm(bulk).assemble(pressure)
    K = sp.bmat([[A, B.T], [B, C]], format="csr")
    f = np.concatenate([forces.ravel(), np.zeros(pressure.N)])
    u = _held(K, f, space.nodes[:, 0], len(space.nodes))[: basis.N].reshape(-1, 2)
    three = np.stack([u[:, 0], 0.0 * u[:, 0], u[:, 1]], axis=1)[..., None]
    stress = space.sampled_stress(material, 0, three)[..., 0]
    e = stress @ np.linalg.inv(elasticity(material))  # rr, tt, zz, tz, rz, rt, shears doubled
    at_nodes = (continuation(space.samples, space.nodes) @ e.reshape(-1, 6)).T
    return float(_size([*at_nodes[:3], 0.5 * at_nodes[4]], mu).max())


def _held(K: Any, f: Floats, r: Floats, nodes: int) -> Floats:
    """Return the solution of K u = f, with no motion along r on the axis, and one point held along
    z.

    The unknowns are 2 k + c for node k and component c.
    """
    fixed = np.append(2 * np.flatnonzero(r < 1e-12), 1)
    free = np.setdiff1d(np.arange(K.shape[0]), fixed)
    u = np.zeros(K.shape[0])
    u[free] = spsolve(K[free][:, free].tocsc(), f[free])
    return u


def entries() -> tuple[Entry, ...]:
    """Return the entries of this family."""
    return (_bending(bending()), _incompressible(incompressible()))


def _listed(values: Floats, digits: int = 2) -> str:
    return ", ".join(f"{v:.{digits}f}" for v in values)


def _bending(b: Bending) -> Entry:
    tip, stress = (b.linear / b.truth).T
    own_tip, own_stress = (b.quadratic / b.truth).T
    across = ", ".join(f"{n:g}" for n in b.across)
    return Entry(
        "linear_elements",
        "Linear elements in bending",
        "A linear element has constant strain; bending needs a strain gradient, which the element "
        "replaces by spurious shear (shear locking; Hughes, *The Finite Element "
        "Method*, "
        "ch. 4).",
        f"Linear tetrahedra, {across} over the diameter: the tip deflection is {_listed(tip)} and "
        "the "
        f"bending stress {_listed(stress)} of the true value.",
        f"{b.truth[0] * 1e3:.4f} mm and {engineering(b.truth[1] / MPA)} MPa between 1 and 2.5 "
        "diameters from the clamp (a fine section mesh).",
        "There are no linear elements; those of a mesh file are converted to quadratic ones. On "
        "the "
        f"same meshes {_listed(own_tip, 3)} and {_listed(own_stress)}. The study: {told(b.found)}",
        (command("linear_elements", "run", "--model solid"),),
        "Linear elements approach one slowly from below; quadratic ones reach it on the first mesh",
        lambda figure, axes: _draw_bending(axes[0], axes[1], b),
    )


def _draw_bending(left: Axes, right: Axes, b: Bending) -> None:
    linear, own = b.linear / b.truth, b.quadratic / b.truth
    for k, (axes, what) in enumerate(((left, "deflection of the tip"), (right, "bending stress"))):
        axes.plot(b.across, own[:, k], "s--", color=line_style(1)["color"], ms=4)
        axes.plot(b.across, linear[:, k], "o-", color=INK, ms=4)
        axes.axhline(1.0, color="#8a8a8a", linewidth=0.8)
        note(axes, b.across[1], linear[1, k], "linear", (10, -6))
        note(axes, b.across[1], own[1, k], "quadratic (pinstress)", (0, 14 if k == 0 else 16),
             line_style(1)["color"], "center")  # fmt: skip
        axes.set(xlabel="tetrahedra over the diameter", ylabel=f"{what} / true value")
        axes.set_ylim(0.3, 1.15)


def _incompressible(ratios: tuple[Ratio, ...]) -> Entry:
    naive = ", ".join(f"{engineering(r.naive, 3)} at {r.nu:g}" for r in ratios)
    truth = ", ".join(f"{engineering(r.truth, 3)} at {r.nu:g}" for r in ratios)
    ours = ", ".join(
        f"{engineering(r.found.max_von_mises, 3)} ± {engineering(error_of(r.found), 2)} "
        f"(`{r.found.verdict}`) at {r.nu:g}"
        for r in ratios
    )
    held = sum(contains(r.found, r.truth) for r in ratios)
    return Entry(
        "incompressible",
        "Poisson's ratio near one half",
        "Near ν = 1/2 every element must keep its volume; linear triangles have more such "
        "constraints than unknowns and cannot deform (volumetric locking; Hughes, ch. 4). "
        "Quadratic "
        "ones have enough unknowns.",
        f"Linear triangles on one mesh: {naive} MPa.",
        f"{truth} MPa, from mixed elements with pressure unknowns (Taylor and Hood).",
        f"{ours} MPa; the true value is within the error in {held} of {len(ratios)}.",
        (command("incompressible"),),
        "Linear triangles deviate from the true value as Poisson's ratio approaches one half; "
        "pinstress's values do not",
        lambda figure, axes: _draw_incompressible(axes[0], ratios),
        panels=1,
    )


def _draw_incompressible(axes: Axes, ratios: tuple[Ratio, ...]) -> None:
    x, color = np.arange(len(ratios)), line_style(1)["color"]
    truth = np.array([r.truth for r in ratios])
    axes.plot(x, [r.naive for r in ratios] / truth, "o-", color=INK, ms=4)
    ours = np.array([r.found.max_von_mises or 0.0 for r in ratios]) / truth
    error = np.array([error_of(r.found) for r in ratios]) / truth
    axes.errorbar(x, ours, yerr=error, fmt="s", ms=4, color=color, capsize=3)
    axes.axhline(1.0, color="#8a8a8a", linewidth=0.8)
    note(axes, 1.0, ours[1], "pinstress", (12, 12), color)
    note(axes, 1.0, ratios[1].naive / truth[1], "linear triangles", (8, 8))
    axes.set(
        xlabel="Poisson's ratio", ylabel="peak / true value", xlim=(-0.4, 2.4), ylim=(0.4, 1.2)
    )
    axes.set_xticks(x, [f"{r.nu:g}" for r in ratios])
