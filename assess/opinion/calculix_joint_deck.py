"""An input deck for CalculiX: a pin and its lugs in frictionless contact, surface to surface.

Each ring of the pin is a slave surface, so that CalculiX prints the force on every ring; the bore
of a lug is the master. A lug is supported as in fea.support.contact: its outer surface carries a
traction of constant direction that is linear along z. An *EQUATION between the mean motion of that
surface and an auxiliary node turns a force or a spring on this node into such a traction.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from assess.opinion.calculix_deck import real
from assess.opinion.calculix_joint_mesh import INNER_FACE, OUTER_FACE, Hexahedra
from fea.core.material import Material

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

Dialect = Literal["calculix", "abaqus"]

GAUSS_POINTS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(3)
FACE_CORNERS = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
LAST_INCREMENT_ONLY = "FREQUENCY=1000000"  # results are written for the last increment only
# Stiffness of the springs that hold bodies without contact, over Young's modulus times pin length
WEAK_SPRING_STIFFNESS = 1e-7
STICK_STIFFNESS_RATIO = 0.1  # stiffness against sliding over the stiffness of the contact
FRICTION_INCREMENTS = "0.5, 1, 0.02, 0.5"  # of a step with friction: first, total, min, max


@dataclass(frozen=True)
class Part:
    """A body of the deck: its name, mesh and material.

    lining: outer radius, m, and material of the inner part, if that has another material.
    """

    name: str
    mesh: Hexahedra
    material: Material
    lining: tuple[float, Material] | None = None

    @property
    def materials(self) -> Iterator[tuple[str, Material, Ints]]:
        """The name in the deck, the material, and the element numbers within this body, for each
        material.
        """
        if self.lining is None:
            yield self.name, self.material, np.arange(len(self.mesh.elements))
            return
        radius, other = self.lining
        inside = self.mesh.outer < radius * (1.0 + 1e-9)
        yield self.name, self.material, np.flatnonzero(~inside)
        yield f"{self.name}LINING", other, np.flatnonzero(inside)


@dataclass(frozen=True)
class Eye:
    """A lug with its load and support.

    force: (2,) force of the link on the lug, N.
    tilt: tilting stiffness, N m/rad; inf and 0 as in fea.support.lugs.lug: Lug.
    rings: the elements of the pin on each of the lug's rings.
    couple: (2,) couple of the link on the lug, N m, for tilts along x and along y towards z.
    held: whether the lug belongs to a structure and is fixed.
    """

    part: Part
    force: Floats
    tilt: float
    rings: tuple[Ints, ...]
    couple: tuple[float, float] = (0.0, 0.0)
    held: bool = False


@dataclass(frozen=True)
class JointDeck:
    """The deck of a pin in its lugs.

    The axes are those of the pin or, if only the half in y > 0 is modelled, those of the plane of
    the loads.
    stiffness: of the contact, Pa/m.
    half: whether y = 0 is a plane of symmetry; forces and stiffnesses of lugs are then those of the
    half.
    dialect: the program that reads the deck; Abaqus has no total force CF in *CONTACT PRINT, and
    takes elements, not nodes, in *EL FILE.
    friction: Coulomb's friction coefficient.
    history: the fractions of the forces at the ends of the load steps; with friction each step
    takes several increments.
    """

    pin: Part
    eyes: tuple[Eye, ...]
    stiffness: float
    half: bool
    dialect: Dialect = "calculix"
    friction: float = 0.0
    history: tuple[float, ...] = (1.0,)

    def lines(self) -> Iterator[str]:
        """Yield the lines of the deck."""
        first = self._first()
        for part, (node, element) in zip(self._parts, first, strict=True):
            yield from _body(part, node, element)
        yield from self._surfaces(first)
        yield from self._contact()
        yield from self._holding(first)
        for fraction in self.history:
            yield from self._step(fraction)

    def write(self, path: Path) -> None:
        """Write the deck."""
        with path.open("w", encoding="ascii", newline="\n") as file:
            for line in self.lines():
                file.write(line + "\n")

    @property
    def unknowns(self) -> int:
        """The number of displacement components of all nodes."""
        return 3 * sum(len(part.mesh.nodes) for part in self._parts)

    @property
    def axes(self) -> tuple[int, ...]:
        """The transverse axes along which a lug may move: 1 and 2, or 1 for a half."""
        return (1,) if self.half else (1, 2)

    @property
    def _fixed_eyes(self) -> set[int]:
        """The numbers of the lugs that cannot shift: those of a structure, else the first lug,
        which reacts the imbalance.
        """
        return {b for b, eye in enumerate(self.eyes) if eye.held} or {0}

    @property
    def _parts(self) -> tuple[Part, ...]:
        return (self.pin, *(eye.part for eye in self.eyes))

    def _first(self) -> list[tuple[int, int]]:
        """Return the numbers of the first node and the first element of each part."""
        out = [(1, 1)]
        for part in self._parts:
            node, element = out[-1]
            out.append((node + len(part.mesh.nodes), element + len(part.mesh.elements)))
        return out[:-1]

    @property
    def _nodes(self) -> int:
        return sum(len(part.mesh.nodes) for part in self._parts)

    def _surfaces(self, first: list[tuple[int, int]]) -> Iterator[str]:
        for eye, (_, start) in zip(self.eyes, first[1:], strict=True):
            bore = np.flatnonzero(eye.part.mesh.inner == eye.part.mesh.inner.min())
            yield from _surface(f"BORE{eye.part.name}", start + bore, INNER_FACE)
            for k, elements in enumerate(eye.rings):
                yield from _surface(slave(eye.part.name, k), 1 + elements, OUTER_FACE)

    def _contact(self) -> Iterator[str]:
        yield "*SURFACE INTERACTION, NAME=DRY"
        yield "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR"
        yield real(self.stiffness)
        if self.friction:
            yield "*FRICTION"
            yield f"{real(self.friction)}, {real(STICK_STIFFNESS_RATIO * self.stiffness)}"
        for eye in self.eyes:
            for k in range(len(eye.rings)):
                yield "*CONTACT PAIR, INTERACTION=DRY, TYPE=SURFACE TO SURFACE"
                yield f"{slave(eye.part.name, k)}, BORE{eye.part.name}"

    def _auxiliary(self, b: int) -> tuple[int, int]:
        """Return the nodes whose displacements are the mean shift of lug b and its tilt, rad."""
        return self._nodes + 1 + 2 * b, self._nodes + 2 + 2 * b

    def _holding(self, first: list[tuple[int, int]]) -> Iterator[str]:
        for b, (eye, (node, _)) in enumerate(zip(self.eyes, first[1:], strict=True)):
            shift, tilt = self._auxiliary(b)
            yield "*NODE"
            yield from (f"{n}, 0, 0, 0" for n in (shift, tilt))
            for axis in self.axes:
                yield from _equations(eye.part.mesh, node, axis, shift, tilt)
        yield from self._axial(first)
        yield from self._springs()
        yield "*BOUNDARY"
        yield from self._fixed(first)

    def _springs(self) -> Iterator[str]:
        number = sum(len(part.mesh.elements) for part in self._parts) + 1
        mesh, E = self.pin.mesh, self.pin.material.youngs_modulus
        length = float(np.ptp(mesh.nodes[:, 2]))
        weak = WEAK_SPRING_STIFFNESS * E * length
        constrained = [(1 + n, axis, weak) for n in _ends(mesh) for axis in self.axes]
        for b, eye in enumerate(self.eyes):
            shift, tilt = self._auxiliary(b)
            constrained += [(shift, axis, weak) for axis in self.axes if b not in self._fixed_eyes]
            if np.isfinite(eye.tilt):
                stiff = max(eye.tilt, weak * length**2)
                constrained += [(tilt, axis, stiff) for axis in self.axes]
        for k, (node, axis, stiffness) in enumerate(constrained):
            yield f"*ELEMENT, TYPE=SPRING1, ELSET=SPRING{k}"
            yield f"{number + k}, {node}"
            yield f"*SPRING, ELSET=SPRING{k}"
            yield f"{axis}"
            yield f"{stiffness:.10e}"  # without a point it would be read as another axis

    def _fixed(self, first: list[tuple[int, int]]) -> Iterator[str]:
        """Yield the fixed components: the shifts of `_fixed_eyes`, the tilts of guided lugs, and
        the normal displacements on the plane of symmetry.
        """
        for b, eye in enumerate(self.eyes):
            shift, tilt = self._auxiliary(b)
            if b in self._fixed_eyes:
                yield from (f"{shift}, {axis}" for axis in self.axes)
            others = [axis for axis in (1, 2, 3) if axis not in self.axes]
            yield from (f"{node}, {axis}" for node in (shift, tilt) for axis in others)
            if np.isinf(eye.tilt):
                yield from (f"{tilt}, {axis}" for axis in self.axes)
        for part, (start, _) in zip(self._parts, first, strict=True):
            x = part.mesh.nodes
            if self.half:
                flat = np.flatnonzero(np.abs(x[:, 1]) < 1e-9 * np.abs(x).max())
                yield from (f"{start + n}, 2" for n in flat)

    def _axial(self, first: list[tuple[int, int]]) -> Iterator[str]:
        """Yield the constraints that prevent axial motion and rotation about the axis of each body.

        Each constrains two opposite nodes, so that a tilt does not shift the body; a shift would
        move the edges of its contact.
        """
        for part, (start, _) in zip(self._parts, first, strict=True):
            one, other = _opposite(part.mesh)
            yield from ("*EQUATION", "2", f"{start + one}, 3, 1., {start + other}, 3, 1.")
            if not self.half:
                yield from ("*EQUATION", "2", f"{start + one}, 2, 1., {start + other}, 2, -1.")

    def _step(self, fraction: float) -> Iterator[str]:
        yield "*STEP"
        yield "*STATIC"
        yield FRICTION_INCREMENTS if self.friction else "1, 1"
        yield "*CLOAD"
        for b, eye in enumerate(self.eyes):
            shift, tilt = self._auxiliary(b)
            for axis in self.axes:
                if b not in self._fixed_eyes:
                    yield f"{shift}, {axis}, {real(fraction * float(eye.force[axis - 1]))}"
                if any(eye.couple):
                    yield f"{tilt}, {axis}, {real(fraction * eye.couple[axis - 1])}"
        for eye in self.eyes if self.dialect == "calculix" else ():
            for k in range(len(eye.rings)):
                pair = f"SLAVE={slave(eye.part.name, k)}, MASTER=BORE{eye.part.name}"
                yield f"*CONTACT PRINT, {pair}, {LAST_INCREMENT_ONLY}"
                yield "CF"
        yield f"*NODE FILE, NSET={self.pin.name}, {LAST_INCREMENT_ONLY}"
        yield "U"
        kind = "NSET" if self.dialect == "calculix" else "ELSET"
        yield f"*EL FILE, {kind}={self.pin.name}, {LAST_INCREMENT_ONLY}"
        yield "S"
        yield "*END STEP"


def slave(lug: str, ring: int) -> str:
    """Return the name of the slave surface of a ring of the pin."""
    return f"PIN{lug}R{ring + 1}"


def _body(part: Part, node: int, element: int) -> Iterator[str]:
    yield f"*NODE, NSET={part.name}"
    for number, (x, y, z) in enumerate(part.mesh.nodes, node):
        yield f"{number}, {real(x)}, {real(y)}, {real(z)}"
    for name, material, elements in part.materials:
        yield f"*ELEMENT, TYPE=C3D20R, ELSET={name}"
        for number, row in zip(
            elements + element, part.mesh.elements[elements] + node, strict=True
        ):
            text = [str(n) for n in row]
            yield f"{number}, " + ", ".join(text[:10]) + ","
            yield ", ".join(text[10:])
        yield f"*MATERIAL, NAME=OF{name}"
        yield "*ELASTIC"
        yield f"{real(material.youngs_modulus)}, {real(material.poisson_ratio)}"
        yield f"*SOLID SECTION, ELSET={name}, MATERIAL=OF{name}"


def _surface(name: str, elements: Ints, face: int) -> Iterator[str]:
    yield f"*SURFACE, NAME={name}"
    yield from (f"{number}, S{face}" for number in elements)


def _ends(mesh: Hexahedra) -> tuple[int, int]:
    """Return one node at each end of the pin, in the plane of symmetry."""
    x = mesh.nodes
    order = 1e-6 * np.abs(x[:, 1]) - 1e-7 * x[:, 0]
    return int(np.argmin(x[:, 2] + order)), int(np.argmin(order - x[:, 2]))


def _opposite(mesh: Hexahedra) -> tuple[int, int]:
    """Return two nodes inside the wall at half the length, on opposite sides of the axis in x."""
    z, wall = mesh.nodes[:, 2], mesh.outer[mesh.outer > 0.0]
    # The small offset avoids a tie between two nodes.
    middle = 0.5 * (z.min() + z.max()) + 1e-4 * np.ptp(z)
    r = 0.5 * (mesh.inner[mesh.outer > 0.0].min() + wall.max())
    near = [np.linalg.norm(mesh.nodes - [x, 0.0, middle], axis=1).argmin() for x in (r, -r)]
    return int(near[0]), int(near[1])


def _equations(mesh: Hexahedra, first: int, axis: int, shift: int, tilt: int) -> Iterator[str]:
    """Yield the equations that set the displacements of the auxiliary nodes along an axis to the
    mean displacement of the outer surface (shift) and to its mean slope along z (tilt).
    """
    nodes, weight = surface_weights(mesh)
    rows = weight / weight[:, 0].sum(), weight
    z = mesh.nodes[nodes, 2]
    middle = 0.5 * (z.min() + z.max())
    arm = weight[:, 1] - middle * weight[:, 0]
    second = float((arm * (z - middle)).sum())
    means = np.stack([rows[0][:, 0], arm / second])  # (2, K)
    dependent = [
        int(np.argmax(weight[:, 0] * (z < middle))),
        int(np.argmax(weight[:, 0] * (z > middle))),
    ]
    inverse = np.linalg.inv(means[:, dependent])
    solved = inverse @ means
    others = np.delete(np.arange(len(nodes)), dependent)
    for k in range(2):
        terms = [(first + int(nodes[dependent[k]]), axis, 1.0)]
        terms += [(first + int(nodes[i]), axis, float(solved[k, i])) for i in others]
        terms += [(n, axis, -float(inverse[k, j])) for j, n in enumerate((shift, tilt))]
        yield "*EQUATION"
        yield str(len(terms))
        for i in range(0, len(terms), 4):
            yield ", ".join(f"{n}, {a}, {real(c)}" for n, a, c in terms[i : i + 4])


def surface_weights(mesh: Hexahedra) -> tuple[Ints, Floats]:
    """Return the nodes (K,) of the outer surface, and the integrals (K, 2) of their shape
    functions, m^2, and of their shape functions times z, m^3.
    """
    faces = mesh.face(np.flatnonzero(mesh.outer == mesh.outer.max()), OUTER_FACE)
    nodes, number = np.unique(faces, return_inverse=True)
    x = mesh.nodes[faces]  # (F, 8, 3)
    out = np.zeros((len(nodes), 2))
    for s, w in zip(GAUSS_POINTS, GAUSS_WEIGHTS, strict=True):
        for t, v in zip(GAUSS_POINTS, GAUSS_WEIGHTS, strict=True):
            shape, slope = _serendipity(float(s), float(t))
            along = np.einsum("fnc,nd->fdc", x, slope)
            area = w * v * np.linalg.norm(np.cross(along[:, 0], along[:, 1]), axis=1)
            z = x[:, :, 2] @ shape
            for j, value in enumerate((area, area * z)):
                np.add.at(out[:, j], number.reshape(faces.shape), value[:, None] * shape)
    return nodes, out


def _serendipity(s: float, t: float) -> tuple[Floats, Floats]:
    """Return the shape functions (8,) of an eight-node quadrilateral, and their slopes (8, 2)."""
    a, b = FACE_CORNERS.T
    p, q = 1.0 + a * s, 1.0 + b * t
    corner = 0.25 * p * q * (a * s + b * t - 1.0)
    ds = 0.25 * a * q * (2.0 * a * s + b * t)
    dt = 0.25 * b * p * (a * s + 2.0 * b * t)
    middle = 0.5 * np.array(
        [(1 - s * s) * (1 - t), (1 + s) * (1 - t * t), (1 - s * s) * (1 + t), (1 - s) * (1 - t * t)]
    )
    ms = np.array([-s * (1 - t), 0.5 * (1 - t * t), -s * (1 + t), -0.5 * (1 - t * t)])
    mt = np.array([-0.5 * (1 - s * s), -t * (1 + s), 0.5 * (1 - s * s), -t * (1 - s)])
    slopes = np.stack([np.concatenate([ds, ms]), np.concatenate([dt, mt])], axis=1)
    return np.concatenate([corner, middle]), slopes
