"""An input deck for CalculiX: quadratic tetrahedra, held nodes and nodal forces as we have them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fea.material import Material

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

# C3D10 has the corners, then edges 01, 12, 02, 03, 13, 23, which is VTK's order and scikit-fem's
# (not gmsh's: 03, 23, 13). A mirrored element is turned by exchanging its corners 1 and 2.
MIRRORED = [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]


def c3d10(nodes: Floats, elements: Ints) -> Ints:
    """Elements (M, 10) in the node order of C3D10 and with positive volume.

    nodes: (N, 3), m. elements: node numbers: corners, then edges 01, 12, 02, 03, 13, 23.
    """
    x = nodes[elements[:, :4]]
    negative = np.linalg.det(x[:, 1:] - x[:, :1]) < 0.0
    return np.where(negative[:, None], elements[:, MIRRORED], elements)


def write_deck(
    path: Path, nodes: Floats, elements: Ints, material: Material, held: Ints, forces: Floats
) -> None:
    """Write a deck that asks for displacements (.dat) and averaged stresses (.frd) at the nodes.

    nodes: (N, 3), m. elements: (M, 10), as for `c3d10`. held: nodes that do not move. forces:
    (N, 3) on the nodes, N. CalculiX numbers nodes and elements from 1.
    """
    with path.open("w") as file:
        for line in _lines(nodes, elements, material, held, forces):
            file.write(line + "\n")


def _lines(
    nodes: Floats, elements: Ints, material: Material, held: Ints, forces: Floats
) -> Iterator[str]:
    yield "*NODE, NSET=ALL"
    for number, (x, y, z) in enumerate(nodes, 1):
        yield f"{number}, {_real(x)}, {_real(y)}, {_real(z)}"
    yield "*ELEMENT, TYPE=C3D10, ELSET=PIN"
    for number, element in enumerate(c3d10(nodes, elements) + 1, 1):
        yield f"{number}, " + ", ".join(map(str, element))
    yield "*NSET, NSET=HELD"
    yield from (f"{number}," for number in held + 1)
    yield "*MATERIAL, NAME=ONE"
    yield "*ELASTIC"
    yield f"{_real(material.youngs_modulus)}, {_real(material.poisson_ratio)}"
    yield "*SOLID SECTION, ELSET=PIN, MATERIAL=ONE"
    yield "*BOUNDARY"
    yield "HELD, 1, 3"
    yield "*STEP"
    yield "*STATIC"
    yield "*CLOAD"
    for node, axis in np.argwhere(forces):
        yield f"{node + 1}, {axis + 1}, {_real(forces[node, axis])}"
    yield "*NODE PRINT, NSET=ALL"
    yield "U"
    yield "*EL FILE"
    yield "S"
    yield "*END STEP"


def _real(x: float) -> str:
    # CalculiX reads 20 characters of a number: the exponent of a longer one is cut off, and it says
    # "nonpositive jacobian"
    return f"{x:.11g}"
