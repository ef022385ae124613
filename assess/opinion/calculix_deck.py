"""An input deck for CalculiX with the quadratic tetrahedra, supports and forces of our model."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from fea.core.material import Material
from pinbase.arrays import Floats, Ints

# C3D10 has the corners, then the edges 01, 12, 02, 03, 13, 23. This is the order of VTK and of
# scikit-fem, not of gmsh (03, 23, 13). Exchanging corners 1 and 2 corrects a mirrored element.
MIRRORED_NODE_ORDER = [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]


def c3d10(nodes: Floats, elements: Ints) -> Ints:
    """Return elements (M, 10) in the node order of C3D10 and with positive volume.

    nodes: (N, 3), m. elements: node numbers: corners, then edges 01, 12, 02, 03, 13, 23.
    """
    x = nodes[elements[:, :4]]
    negative = np.linalg.det(x[:, 1:] - x[:, :1]) < 0.0
    return np.where(negative[:, None], elements[:, MIRRORED_NODE_ORDER], elements)


def write_deck(
    path: Path, nodes: Floats, elements: Ints, material: Material, fixed: Ints, forces: Floats
) -> None:
    """Write a deck that requests displacements (.dat) and averaged stresses (.frd) at the nodes.

    nodes: (N, 3), m. elements: (M, 10), as for `c3d10`. fixed: displacement components that are
    zero, 3 n + c for component c of node n. forces: (N, 3) on the nodes, N.
    """
    with path.open("w", encoding="ascii", newline="\n") as file:
        for line in deck_lines(nodes, elements, material, fixed, forces):
            file.write(line + "\n")


def mesh_lines(kind: str, nodes: Floats, elements: Ints, material: Material) -> Iterator[str]:
    """Yield the lines of a deck with the mesh and its material.

    kind: the element type, C3D10 or CAX6.
    nodes: (N, 3), m, in the set ALL.
    elements: node numbers, counted from 0; CalculiX counts nodes and elements from 1.
    """
    yield "*NODE, NSET=ALL"
    for number, (x, y, z) in enumerate(nodes, 1):
        yield f"{number}, {real(x)}, {real(y)}, {real(z)}"
    yield f"*ELEMENT, TYPE={kind}, ELSET=PIN"
    for number, element in enumerate(elements + 1, 1):
        yield f"{number}, " + ", ".join(map(str, element))
    yield "*MATERIAL, NAME=ONE"
    yield "*ELASTIC"
    yield f"{real(material.youngs_modulus)}, {real(material.poisson_ratio)}"
    yield "*SOLID SECTION, ELSET=PIN, MATERIAL=ONE"


def deck_lines(
    nodes: Floats, elements: Ints, material: Material, fixed: Ints, forces: Floats
) -> Iterator[str]:
    """Yield the lines of a deck; arguments as `write_deck`, in any consistent units."""
    yield from mesh_lines("C3D10", nodes, c3d10(nodes, elements), material)
    yield "*BOUNDARY"
    for node, axis in zip(*divmod(fixed, 3), strict=True):
        yield f"{node + 1}, {axis + 1}"
    yield "*STEP"
    yield "*STATIC"
    yield "*CLOAD"
    for node, axis in np.argwhere(forces):
        yield f"{node + 1}, {axis + 1}, {real(forces[node, axis])}"
    yield "*NODE PRINT, NSET=ALL"
    yield "U"
    yield "*EL FILE"
    yield "S"
    yield "*END STEP"


def real(x: float) -> str:
    """Return a number as CalculiX can read it.

    CalculiX cuts the exponent off a number of more than 20 characters, and then reports a
    "nonpositive jacobian".
    """
    return f"{x:.11g}"
