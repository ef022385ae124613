"""The limit load by CalculiX on the same hexahedra (C3D20R), with the same supports and forces.

The forces increase until CalculiX finds no equilibrium; the load factor that it reached is a lower
bound for this mesh.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from assess.opinion.calculix import CALCULIX_COMMAND, JOB_NAME, CalculixError, attempt, end
from assess.opinion.calculix_deck import mesh_lines, real
from assess.plastic.body import Ties
from assess.plastic.pin_body import PinBody
from fea.core.material import Material
from geometry.mesh.hexahedra import twenty
from pinbase.arrays import Floats

MIN_INCREMENT = 1e-3  # increment of the loads over the largest loads
MAX_INCREMENT = 0.04


def factor_reached(pin: PinBody, most: float, folder: Path) -> float:
    """Return the load factor that CalculiX reaches on its way to `most`, accurate to a thousandth
    of `most`.

    Raises: CalculixError if no increment converges.
    """
    _write(pin, most, folder / f"{JOB_NAME}.inp")
    done, status = attempt(folder), folder / f"{JOB_NAME}.sta"
    lines = status.read_text("ascii").splitlines() if status.exists() else []
    reached = [
        float(line.split()[-2]) for line in lines if line.split()[:1] == ["1"] and "U" not in line
    ]
    if not reached:
        raise CalculixError(
            f"{CALCULIX_COMMAND} failed: {end(done.stdout + done.stderr)}", "failed"
        )
    return most * reached[-1]


def _write(pin: PinBody, most: float, path: Path) -> None:
    material, ties = pin.body.rule.material, pin.body.ties
    lines = [
        *_mesh(pin, material),
        "*PLASTIC",
        *(f"{real(s)}, {real(e)}" for e, s in zip(*pin.body.rule.curve, strict=True)),
        "*SOLID SECTION, ELSET=PIN, MATERIAL=ONE",
        *_supports(ties),
        "*STEP, INC=1000",
        "*STATIC",
        f"{MAX_INCREMENT}, 1., {MIN_INCREMENT}, {MAX_INCREMENT}",
        "*CLOAD",
        *_forces(ties, most * pin.forces),
        "*END STEP",
    ]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def _mesh(pin: PinBody, material: Material) -> Iterator[str]:
    """Yield the lines of the mesh without the section; lines with more than 16 numbers
    are divided.
    """
    for line in mesh_lines("C3D20R", pin.mesh.nodes, pin.mesh.elements[:, twenty()], material):
        if line.startswith("*SOLID SECTION"):
            continue
        numbers = line.split(", ")
        if len(numbers) > 16 and not line.startswith("*"):
            yield ", ".join(numbers[:12]) + ",\n" + ", ".join(numbers[12:])
        else:
            yield line


def _supports(ties: Ties) -> Iterator[str]:
    """Yield the zero components, and the equations between components that are equal or
    opposite.
    """
    yield "*BOUNDARY"
    for node, axis in zip(*divmod(np.flatnonzero(ties.unknown < 0), 3), strict=True):
        yield f"{node + 1}, {axis + 1}"
    for one, other in _pairs(ties):
        sign = -ties.sign[one] * ties.sign[other]
        (n, a), (m, b) = divmod(one, 3), divmod(other, 3)
        yield f"*EQUATION\n2\n{n + 1}, {a + 1}, 1., {m + 1}, {b + 1}, {sign:.0f}."


def _pairs(ties: Ties) -> Iterator[tuple[int, int]]:
    """Yield each component that is tied to another, with the other one."""
    first = ties.first
    for component in np.flatnonzero(ties.unknown >= 0).tolist():
        if (other := int(first[ties.unknown[component]])) != component:
            yield component, other


def _forces(ties: Ties, forces: Floats) -> Iterator[str]:
    first = ties.first
    for component, force in zip(first.tolist(), (forces * ties.sign[first]).tolist(), strict=True):
        node, axis = divmod(component, 3)
        yield f"{node + 1}, {axis + 1}, {real(force)}"
