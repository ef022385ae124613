"""The mesh of a pin's solid by tetrahedra of gmsh, with every surface named."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from skfem import MeshTet1

from geometry.mesh.cut_pin import CutPin
from geometry.mesh.cut_solid import cut_solid, grade, name_faces, named_parts
from geometry.mesh.elements import Element
from geometry.mesh.expected import require_few
from geometry.mesh.gmsh_session import MeshError, formula_size, gmsh_model, set_size
from geometry.mesh.gmsh_tetrahedra import MIN_JACOBIAN_RATIO, collect, repair
from geometry.mesh.revolve import revolve
from geometry.mesh.scale import unit_of_solid
from geometry.shape.pin import Pin
from geometry.shape.profile import Edge, meridian, sharp_corners
from pinbase.arrays import Floats

__all__ = ["MeshError", "MeshSize", "SolidMesh", "solid_mesh"]

MAX_ELEMENTS = 1e6


@dataclass(frozen=True)
class MeshSize:
    """The fineness of a solid's mesh.

    across: number of elements over the smallest diameter.
    corner: fineness at sharp corners and edges of bands, relative to `across`.
    arc: number of elements along a fillet's quarter circle.
    growth: increase of the element size per distance from such features.
    """

    across: float = 4.0
    corner: float = 4.0
    arc: float = 1.5
    growth: float = 0.5

    def finer(self, factor: float) -> MeshSize:
        """The same grading with every size divided by `factor`."""
        return MeshSize(self.across * factor, self.corner, self.arc * factor, self.growth)


@dataclass(frozen=True)
class SolidMesh:
    """A mesh of tetrahedra, and its quality.

    mesh: coordinates in m; elements are quadratic unless another kind was requested
    (geometry.mesh.elements); `boundaries` map surface names to facets.
    jacobian: smallest ratio min/max det J of all elements.
    repaired: number of elements whose edges were straightened to reach this ratio.
    """

    mesh: MeshTet1
    jacobian: float
    repaired: int

    @property
    def nodes(self) -> Floats:
        """Coordinates of all nodes, (N, 3) m."""
        points: Floats = self.mesh.doflocs.T
        return points


def solid_mesh(
    pin: Pin | CutPin,
    size: MeshSize,
    edges: tuple[float, ...] = (),
    element: Element = "curved",
    most: float = math.inf,
) -> SolidMesh:
    """The mesh of a pin.

    edges: z of further circles on the surface at which the mesh is refined, m.
    element: kind of tetrahedra.
    most: largest number of unknowns of quadratic tetrahedra that is allowed.

    Raises: MeshError when elements are still inverted or slivers after repair and on finer meshes,
    or when there would be far too many elements.
    """
    cause = "a fillet or bore that is very small compared with its neighbours"
    return sound_mesh(lambda finer: _mesh(pin, finer, edges, element, most), size, pin.name, cause)


def sound_mesh(
    make: Callable[[MeshSize], SolidMesh], size: MeshSize, pin: str, cause: str
) -> SolidMesh:
    """The first mesh without inverted or sliver elements, of this size or two finer sizes.

    make: function that generates a mesh of a given size.
    pin, cause: name of the pin and possible cause, for the message.

    Raises: MeshError if there is none.
    """
    jacobians = []
    for factor in (1.0, 1.15, 1.35):
        mesh = make(size.finer(factor))
        if mesh.jacobian > MIN_JACOBIAN_RATIO:
            return mesh
        jacobians.append(mesh.jacobian)
    raise MeshError(
        f"pin {pin}: gmsh produced inverted or sliver elements at three mesh sizes (min/max "
        f"Jacobian {', '.join(f'{j:.2g}' for j in jacobians)}; at least {MIN_JACOBIAN_RATIO} is "
        f"required), and straightening their edges did not help; look for {cause}",
        "bad-elements",
    )


def _mesh(
    pin: Pin | CutPin, size: MeshSize, edges: tuple[float, ...], element: Element, most: float
) -> SolidMesh:
    """A mesh of a pin of this size, after repair; arguments as for `solid_mesh`."""
    profile = pin.profile
    _require_reasonable(profile, size)
    unit = unit_of_solid(profile, pin.cuts.values())
    pin, profile = pin.scaled(1.0 / unit), profile.scaled(1.0 / unit)
    edges = tuple(z / unit for z in edges)
    with gmsh_model(pin.name) as gmsh:
        cut_fields: list[int] = []
        if pin.cuts:
            cut_solid(gmsh, profile, pin.cuts)
            parts = named_parts(gmsh, profile, pin.cuts)
            surfaces, far = name_faces(parts, pin.cuts), _far(profile, size)
            cut_fields = grade(gmsh, profile, pin.cuts, parts, far, size.across, size.growth)
        else:
            outline = meridian(profile)
            revolve(gmsh, outline)
            surfaces = _name_surfaces(gmsh, profile, outline)
        set_sizes(gmsh, profile, size, edges, cut_fields)
        if element != "linear":
            require_few(gmsh, pin.name, most)
        gmsh.model.mesh.generate(3)
        if element == "linear":
            return SolidMesh(collect(gmsh, surfaces).scaled(unit), 1.0, 0)
        gmsh.option.setNumber("Mesh.SecondOrderLinear", int(element == "straight"))
        gmsh.model.mesh.setOrder(2)
        jacobian, repaired = repair(gmsh)
        return SolidMesh(collect(gmsh, surfaces).scaled(unit), jacobian, repaired)


def _require_reasonable(pin: Pin, size: MeshSize) -> None:
    """Raise MeshError when even the coarse part of the mesh would be too large."""
    elements = pin.volume / (0.12 * _far(pin, size) ** 3)  # 0.12 h^3: a regular tetrahedron
    if elements > MAX_ELEMENTS:
        raise MeshError(
            f"pin {pin.name}: the mesh would need {elements:.1e} elements, of which "
            f"{MAX_ELEMENTS:,.0f} are allowed, because the thinnest part is very small compared "
            "with the whole; model the critical part on its own",
            "too-many-elements",
        )


def _far(pin: Pin, size: MeshSize) -> float:
    """Element size away from all features, m, from the thinnest shaft or wall."""
    walls = [wall / 2 for s in pin.segments if any(s.bores) for wall in s.walls]
    return min([pin.smallest_diameter / size.across, *walls])


def _name_surfaces(gmsh: Any, pin: Pin, outline: tuple[Edge, ...]) -> dict[str, list[int]]:
    """Surface tags by name, identified by the end points of the edge that was revolved."""
    named: dict[str, list[int]] = {}
    digits = round(6 - math.log10(pin.smallest_diameter))

    def key(points: list[tuple[float, float]]) -> frozenset[tuple[float, float]]:
        return frozenset((round(r, digits) + 0.0, round(z, digits) + 0.0) for r, z in points if r)

    names = {key([e.start, e.end]): e.name for e in outline if e.name}
    for _, tag in gmsh.model.getBoundary(gmsh.model.getEntities(3), oriented=False):
        ends = gmsh.model.getBoundary([(2, tag)], oriented=False, recursive=True)
        at = [gmsh.model.getValue(0, point, []) for _, point in ends]
        name = names.get(key([(math.hypot(x, y), z) for x, y, z in at]))
        if name is None:
            raise MeshError(
                f"pin {pin.name}: surface {tag} of gmsh's solid matches no surface of the profile",
                "surface-unmatched",
            )
        named.setdefault(name, []).append(tag)
    missing = set(names.values()) - set(named)
    if missing:
        raise MeshError(
            f"pin {pin.name}: gmsh's solid lacks the surfaces {', '.join(sorted(missing))}",
            "surface-unmatched",
        )
    return named


def set_sizes(
    gmsh: Any, pin: Pin, size: MeshSize, edges: tuple[float, ...], fields: list[int]
) -> None:
    """Set the element size to the minimum of gradings around all features and of `fields`.

    Features are sharp corners, circles at z = `edges` (m), roundings and bores.
    """
    far = _far(pin, size)
    near = far / size.corner
    circles = [(c.r, c.z, near, 0.0) for c in sharp_corners(pin)]
    for z in edges:
        radii = {b.radius for b in pin.bands if b.z0 - pin.tolerance <= z <= b.z1 + pin.tolerance}
        circles += [(r, z, near, 0.0) for r in radii]
    for rounding in pin.roundings:
        arc = min(far, rounding.radius * math.pi / 2 / size.arc)
        circles.append((*rounding.at, arc, 1.3 * rounding.reach))
    # Around a circle the size is h within the distance `flat`, then grows: d + |d| is zero inside.
    tags = list(fields)
    for r, z, h, flat in dict.fromkeys(circles):
        d = f"Sqrt((Sqrt(x*x+y*y)-{r!r})^2+(z-{z!r})^2)-{flat!r}"
        tags.append(formula_size(gmsh, f"{h!r}+{size.growth / 2!r}*(({d})+Fabs({d}))"))
    for i, s in enumerate(pin.segments):
        if bore := max(s.bores):
            h = math.pi * bore / (2.0 * size.across)
            z0, z1 = pin.stations[i], pin.stations[i + 1]
            d = f"(Sqrt(x*x+y*y)-{bore / 2!r})"
            out = f"(Fabs(z-{(z0 + z1) / 2!r})-{(z1 - z0) / 2!r})"
            grow = f"{size.growth / 2!r}*({d}+Fabs({d})+{out}+Fabs({out}))"
            tags.append(formula_size(gmsh, f"{h!r}+{grow}"))
    set_size(gmsh, [*tags, formula_size(gmsh, f"{far!r}")])
