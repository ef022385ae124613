"""The shank of a lug, which contact of the pin models as a spring against tilting: compared with a
lug in three dimensions; and the effect of its stiffness in the plane, which contact leaves out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import gmsh
import numpy as np
from skfem import (
    Basis,
    BilinearForm,
    ElementHex2,
    ElementVector,
    FacetBasis,
    Functional,
    LinearForm,
    MeshHex,
    MeshQuad,
)
from skfem.helpers import ddot, dot, sym_grad, trace

from benchmarks.joints import joint
from benchmarks.timing import table
from fea.core.linear_solver import ConstrainedSystem
from fea.core.pin_loads import Floats
from fea.lug.plane_fields import HARMONICS, Elasticity, plane_fields
from fea.support.bands import Bands
from fea.support.contact.contact import ContactProblem
from fea.support.contact.pressure_loads import waves_of_sectors
from fea.support.lugs.lug import Lug
from geometry.shape.lug_outline import LugOutline
from pinbase.arrays import Mask

NU, BORE = 0.3, 20.0  # lengths in mm, stresses over Young's modulus
# Head, width of the shank, its length to the held end, thickness, mm
LUGS = (
    (50.0, 50.0, 50.0, 5.0),
    (50.0, 50.0, 50.0, 10.0),
    (50.0, 50.0, 50.0, 20.0),
    (50.0, 30.0, 50.0, 10.0),
    (50.0, 30.0, 100.0, 10.0),
    (36.0, 36.0, 50.0, 10.0),
)
USUAL = 0.8  # integral of dx / width of a lug without a shank
AT_BORE, GROWTH, LARGEST = (
    2.5,
    0.25,
    6.0,
)  # element size at the bore, mm, its growth, the largest, mm
RING_LAYERS, AROUND, LAYERS = 5, 72, 3  # elements of a ring, and through the thickness
ANGLES, NEAR = (75, 90, 105, 120), 6  # degrees from the shank at which hoop stress is read, ± NEAR
# Width and length of the shank, mm, and whether it is in compression: of the clevises of `joint`
SHANKS = ((50.0, 50.0, False), (50.0, 50.0, True), (30.0, 100.0, False), (24.0, 50.0, False))


def shanks() -> str:
    """Return the two tables."""
    return f"{_bent()}\n\n{_in_the_plane()}"


@dataclass(frozen=True)
class _Tilted:
    """The tilt of a bore under a pressure z cos, rad, and the hoop stress at its face by angle from
    the shank, each over the couple.
    """

    tilt: float
    hoop: Floats


def _bent() -> str:
    """Return the table of the stiffness against tilting, and of the hoop stress beyond that of the
    eye alone.
    """
    rows = []
    for head, width, length, thick in LUGS:
        lug, ring = _lug(head, width, length, thick), _ring(head, thick)
        usual = thick**3 / (12.0 * USUAL)
        outline = LugOutline("round", BORE, head, width, length, head / 2.0)
        nominal = 6.0 / ((outline.width_at_bore - BORE) * thick**2)
        stiff, more = list[float](), list[str]()
        for end in (True, False):
            whole, eye = _tilted(lug, end, length), _tilted(ring, end, outer=head / 2.0)
            stiff.append(1.0 / (whole.tilt - eye.tilt) / usual)
            more.append(", ".join(f"{x:.2f}" for x in (whole.hoop - eye.hoop) / nominal))
        sizes = (f"{x:g}" for x in (head, width, length, thick))
        shown = (f"{x:.3f}" for x in (*stiff, USUAL / outline.bending))
        rows.append((*sizes, *shown, *more))
    titles = ("head [mm]", "width", "length", "thickness", "pressed at its end", "at the shank")
    return table((*titles, "by its outline", "hoop stress, at its end", "at the shank"), rows)


def _lug(head: float, width: float, length: float, thick: float) -> MeshHex:
    """Return a mesh of a round head about its bore with a shank along x, with hexahedra through the
    thickness.
    """
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        occ, sizes = gmsh.model.occ, gmsh.model.mesh.field
        disc = occ.addDisk(0, 0, 0, head / 2, head / 2)
        strip = occ.addRectangle(0, -width / 2, 0, length, width)
        whole, _ = occ.fuse([(2, disc)], [(2, strip)])
        occ.cut(whole, [(2, occ.addDisk(0, 0, 0, BORE / 2, BORE / 2))])
        occ.synchronize()
        away = f"{AT_BORE} + {GROWTH} * (sqrt(x*x + y*y) - {BORE / 2})"
        for k, size in enumerate((away, str(LARGEST)), 1):
            sizes.add("MathEval", k)
            sizes.setString(k, "F", size)
        sizes.add("Min", 3)
        sizes.setNumbers(3, "FieldsList", [1, 2])
        sizes.setAsBackgroundMesh(3)
        for option, value in (("MeshSizeExtendFromBoundary", 0), ("RecombineAll", 1)):
            gmsh.option.setNumber(f"Mesh.{option}", value)
        gmsh.option.setNumber("Mesh.SubdivisionAlgorithm", 1)  # gives quadrilaterals only
        gmsh.model.mesh.generate(2)
        tags, x, _ = gmsh.model.mesh.getNodes()
        _, corners = gmsh.model.mesh.getElementsByType(3)
    finally:
        gmsh.finalize()
    used, numbers = np.unique(corners, return_inverse=True)
    rows = np.argsort(tags)[np.searchsorted(np.sort(tags), used)]
    plane = MeshQuad(x.reshape(-1, 3)[rows, :2].T, numbers.reshape(-1, 4).T)
    return _through(plane.p, plane.t, thick)


def _ring(head: float, thick: float) -> MeshHex:
    r, turn = np.linspace(BORE / 2, head / 2, RING_LAYERS + 1), np.arange(AROUND)
    angle = 2.0 * np.pi * turn / AROUND
    points = np.stack([np.outer(r, np.cos(angle)), np.outer(r, np.sin(angle))]).reshape(2, -1)
    inner = (np.arange(RING_LAYERS)[:, None] * AROUND + turn).ravel()
    after = (np.arange(RING_LAYERS)[:, None] * AROUND + (turn + 1) % AROUND).ravel()
    return _through(points, np.stack([inner, inner + AROUND, after + AROUND, after]), thick)


def _through(points: Floats, quads: np.ndarray, thick: float) -> MeshHex:
    """Return hexahedra over quadrilaterals (4, M), whose corners are counter-clockwise."""
    count, z = points.shape[1], np.linspace(-thick / 2, thick / 2, LAYERS + 1)
    nodes = np.hstack([np.vstack([points, np.full(count, at)]) for at in z])
    a, b, c, d = quads
    layers = [
        np.stack([a, a + count, d, b, d + count, b + count, c, c + count]) + k * count
        for k in range(LAYERS)
    ]
    return MeshHex(nodes, np.hstack(layers))


def _tilted(mesh: MeshHex, at_end: bool, held: float = 0.0, outer: float | None = None) -> _Tilted:
    """Return the tilt of a bore, over Young's modulus, under a pressure z cos on one half of the
    bore.

    at_end: whether the pressed half is the one away from the shank. The tilt is found from the work
    of the pressure.
    held: x of the end that is held.
    outer: radius of a ring instead. Its outer surface reacts by a traction along x that is linear
    in z, and the tilt is relative to the mean motion of this surface.
    """
    basis = Basis(mesh, ElementVector(ElementHex2()), intorder=4)
    lam, mu = NU / (1.0 + NU) / (1.0 - 2.0 * NU), 0.5 / (1.0 + NU)
    side = -1.0 if at_end else 1.0

    @BilinearForm
    def work(u, v, _):  # type: ignore[no-untyped-def]
        strain = sym_grad(u)
        return lam * trace(strain) * trace(sym_grad(v)) + 2.0 * mu * ddot(strain, sym_grad(v))

    def pressure(x: Floats) -> Floats:
        return np.asarray(x[2] * np.maximum(side * x[0] / np.hypot(x[0], x[1]), 0.0))

    @LinearForm
    def pushed(v, w):  # type: ignore[no-untyped-def]
        outwards = np.stack([w.x[0], w.x[1], 0.0 * w.x[0]]) / np.hypot(w.x[0], w.x[1])
        return pressure(w.x) * dot(outwards, v)

    @Functional
    def couple(w):  # type: ignore[no-untyped-def]
        return pressure(w.x) * w.x[2] * side * w.x[0] / np.hypot(w.x[0], w.x[1])

    bore = _facets(mesh, basis, lambda x: np.hypot(x[0], x[1]) < BORE / 2 * 1.03)
    K, force, free = work.assemble(basis).tocsr(), pushed.assemble(bore), np.ones(basis.N)
    moment = float(couple.assemble(bore))
    if outer is None:
        free[basis.get_dofs(lambda x: np.abs(x[0] - held) < 1e-9).all()] = 0.0
        moved = ConstrainedSystem(K).solve(K, free, force[:, None])[:, 0]
        return _Tilted(float(force @ moved) / moment**2, _hoop(bore, moved) / moment)
    against, rigid = _guides(mesh, basis, outer)
    force = force - against @ np.linalg.solve(rigid.T @ against, rigid.T @ force)
    for at, axes in (((outer, 0.0), (0, 1, 2)), ((-outer, 0.0), (1, 2)), ((0.0, outer), (2,))):
        corner = np.linalg.norm(mesh.p - np.array([[*at, mesh.p[2].min()]]).T, axis=0).argmin()
        free[basis.nodal_dofs[list(axes), corner]] = 0.0
    moved = ConstrainedSystem(K).solve(K, free, force[:, None])[:, 0]
    moved = moved - rigid @ np.linalg.solve(against.T @ rigid, against.T @ moved)
    return _Tilted(float(force @ moved) / moment**2, _hoop(bore, moved) / moment)


def _hoop(bore: FacetBasis, moved: Floats) -> Floats:
    """Return the hoop stress at a face near ANGLES from x, from the least-squares slope of the
    stress along z.
    """
    strain = np.asarray(sym_grad(bore.interpolate(moved)))
    x, y, z = np.asarray(bore.global_coordinates())
    r = np.hypot(x, y)
    t = np.stack([-y / r, x / r, 0.0 * r])
    lam, mu = NU / (1.0 + NU) / (1.0 - 2.0 * NU), 0.5 / (1.0 + NU)
    stress = lam * np.einsum("iiab->ab", strain) + 2.0 * mu * np.einsum(
        "iab,ijab,jab->ab", t, strain, t
    )
    turn, out = np.abs(np.degrees(np.arctan2(y, x))), list[float]()
    for angle in ANGLES:
        near = np.abs(turn - angle) < NEAR
        weight = bore.dx[near]
        out.append((stress * z)[near] @ weight / (z[near] ** 2 @ weight) * z.max())
    return np.array(out)


def _guides(mesh: MeshHex, basis: Basis, outer: float) -> tuple[Floats, Floats]:
    """Return the forces along x on the outer surface, linear in z and constant, and the rigid
    motions that they hold.
    """
    surface = _facets(mesh, basis, lambda x: np.hypot(x[0], x[1]) > 0.97 * outer)

    @LinearForm
    def linear(v, w):  # type: ignore[no-untyped-def]
        return w.x[2] * v[0]

    @LinearForm
    def even(v, _):  # type: ignore[no-untyped-def]
        return v[0]

    tilt = basis.project(lambda x: np.array([x[2], 0.0 * x[0], -x[0]]))
    shift = basis.project(lambda x: np.array([1.0 + 0.0 * x[0], 0.0 * x[0], 0.0 * x[0]]))
    against = np.stack([form.assemble(surface) for form in (linear, even)], axis=1)
    return against, np.stack([tilt, shift], axis=1)


def _facets(mesh: MeshHex, basis: Basis, where) -> FacetBasis:  # type: ignore[no-untyped-def]
    """Return the boundary facets whose middles satisfy a condition, without those of both faces."""
    facets = mesh.facets_satisfying(where, boundaries_only=True)
    z = mesh.p[2, mesh.facets[:, facets]]
    return FacetBasis(mesh, basis.elem, facets=facets[np.ptp(z, axis=0) > 1e-9], intorder=6)


def _in_the_plane() -> str:
    """Return the table of the changes of bending moment and stress at mid-span by the shank's
    stiffness in the plane.
    """
    rows = []
    for (width, length, pressed), case in (
        (shank, joint.TRUTH[k]) for shank in SHANKS for k in (0, 2, 7)
    ):
        inner, outer, gap, clearance, *_ = case
        model = joint.model(inner, outer, gap, Lug("all", joint.EYE, joint.STEEL, clearance / 1e3))
        loads = joint.pull(np.zeros(1))
        ring = joint.at_mid_span(model.solve(loads), inner, outer, gap)
        shank = LugOutline("round", joint.D, joint.EYE, width / 1e3, length / 1e3, joint.EYE / 2.0)
        turns = [0.0, math.pi, 0.0] if pressed else [math.pi, 0.0, math.pi]
        cells, plain = model.cells.sectors, model.contact
        added = _added(shank, model.bands, cells, turns)
        tilts = [lug.tilt for lug in model.lugs]
        model.__dict__["contact"] = ContactProblem(
            model.bands, model.flexibility, model.tail, tilts, cells, added
        )
        found = joint.at_mid_span(model.solve(loads), inner, outer, gap)
        model.__dict__["contact"] = plain
        clevis = f"{inner:g} / {outer:g}+{outer:g}"
        way = "pressed" if pressed else "pulled"
        change = (f"{100.0 * (a / b - 1.0):+.2f}" for a, b in zip(found, ring, strict=True))
        rows.append((clevis, f"{clearance:g}", f"{width:g}", f"{length:g}", way, *change))
    head = ("lugs [mm]", "clearance [mm]", "width of the shank", "length", "link", "moment [%]")
    return table((*head, "mid-span [%]"), rows)


def _added(shank: LugOutline, bands: Bands, sectors: int, turns: list[float]) -> Floats:
    """Return the contribution of shanks to the displacements of cells under forces on them, (U, U),
    m/N.

    It is the flexibility of the lug in its plane less that of its ring, constant through the
    thickness.
    turns: angle of the shank of each band, rad.
    """
    eye = replace(shank, shape="ring")
    elastic = Elasticity(NU)
    with_shank, alone = (plane_fields(x.in_radii(), elastic).flexibility for x in (shank, eye))
    more = (with_shank - alone) * joint.D / 2.0 / joint.E
    out = np.zeros((len(bands.z) * sectors,) * 2)
    for band, turn in enumerate(turns):
        rows: Mask = np.repeat(bands.band == band, sectors)
        both = waves_of_sectors(sectors, HARMONICS, -turn)
        pressures = np.concatenate([both[..., 0], both[1:, :, 1]])  # (2 H + 1, M)
        moved = pressures * sectors / np.where(np.arange(len(pressures)) > 0, 2.0, 1.0)[:, None]
        length = bands.length[bands.band == band].sum()
        area = 2.0 * np.pi * joint.D / 2.0 * length / sectors
        one = moved.T @ more @ pressures / area
        count = int(rows.sum()) // sectors
        out[np.ix_(rows, rows)] = np.tile(0.5 * (one + one.T), (count, count))
    return out
