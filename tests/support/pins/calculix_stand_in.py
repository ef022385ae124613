"""A replacement of CalculiX for machines without it: solves our deck and writes CalculiX's files.

It shares nothing with `fea` but the deck and the solver of linear equations. It uses shape
functions of the ten-node tetrahedron in barycentric coordinates, four integration points, and
stress extrapolated from these to the corners and averaged, with middle nodes interpolated. It reads
only decks that the program writes.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from fea.core.linear_solver import factorize

Floats = NDArray[np.float64]

MIDDLES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))  # CalculiX manual, C3D10
FAR, NEAR = (5.0 - 5.0**0.5) / 20.0, (5.0 + 3.0 * 5.0**0.5) / 20.0
POINTS = np.full((4, 4), FAR) + (NEAR - FAR) * np.eye(4)
VOIGT = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))  # of the .frd: xx, yy, zz, xy, yz, zx


def sections(deck: Path) -> dict[str, list[list[str]]]:
    """Return the fields of all data lines, by the keyword above them."""
    found: dict[str, list[list[str]]] = {}
    for line in deck.read_text().splitlines():
        if line.startswith("*"):
            rows = found.setdefault(line[1:].split(",")[0], [])
        else:
            rows.append([field.strip() for field in line.split(",")])
    return found


def derivatives(L: Floats) -> Floats:
    """Return the derivatives (10, 4) of the shape functions by the barycentric coordinates at L
    (4,).
    """
    out = np.zeros((10, 4))
    out[range(4), range(4)] = 4.0 * L - 1.0
    for k, (a, b) in enumerate(MIDDLES, 4):
        out[k, a], out[k, b] = 4.0 * L[b], 4.0 * L[a]
    return out


def strains(x: Floats) -> tuple[Floats, Floats]:
    """Return strains (4, M, 6, 30) per displacement at the points of elements x (M, 10, 3), with
    engineering shears, and the volumes (4, M) of the points.
    """
    all_b, volumes = [], []
    for point in POINTS:
        local = derivatives(point)[:, 1:] - derivatives(point)[:, :1]
        jacobian = np.einsum("mia,ij->maj", x, local)
        g = np.einsum("ij,mja->mia", local, np.linalg.inv(jacobian))
        b = np.zeros((len(x), 6, 10, 3))
        for row, (i, j) in enumerate(VOIGT):
            b[:, row, :, i] = g[:, :, j]
            b[:, row, :, j] = g[:, :, i]
        all_b.append(b.reshape(len(x), 6, 30))
        volumes.append(np.linalg.det(jacobian) / 24.0)
    return np.stack(all_b), np.stack(volumes)


def run(folder: Path) -> str:
    """Solve job.inp in a folder, write job.dat and job.frd, and return what CalculiX
    would print.
    """
    read = sections(folder / "job.inp")
    nodes = np.array([[float(c) for c in row[1:]] for row in read["NODE"]])
    elements = np.array([[int(n) - 1 for n in row[1:]] for row in read["ELEMENT"]])
    young, nu = (float(value) for value in read["ELASTIC"][0])
    fixed = [3 * int(n) + int(axis) - 4 for n, axis in read["BOUNDARY"]]
    f = np.zeros(nodes.size)
    for n, axis, value in read["CLOAD"]:
        f[3 * int(n) + int(axis) - 4] += float(value)

    b, volumes = strains(nodes[elements])
    assert volumes.min() > 0.0, "*ERROR nonpositive jacobian"
    law = np.diag(np.repeat([young / (1.0 + nu), young / (2.0 * (1.0 + nu))], 3))
    law[:3, :3] += young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    k = np.einsum("qmai,ab,qmbj,qm->mij", b, law, b, volumes, optimize=True)
    dofs = (3 * elements[:, :, None] + np.arange(3)).reshape(-1, 30)
    rows, columns = np.repeat(dofs, 30, axis=1).ravel(), np.tile(dofs, 30).ravel()
    matrix = sp.csr_matrix((k.ravel(), (rows, columns)), shape=(len(f), len(f)))
    free = np.setdiff1d(np.arange(len(f)), fixed)
    u = np.zeros(len(f))
    u[free] = factorize(sp.csr_matrix(matrix[free][:, free]), free // 3)(f[free])

    at_points = np.einsum("ab,qmbi,mi->mqa", law, b, u[dofs])
    corners = np.einsum("cq,mqa->mca", np.linalg.inv(POINTS), at_points)
    middles = [(corners[:, i] + corners[:, j]) / 2.0 for i, j in MIDDLES]
    every = np.concatenate([corners, np.stack(middles, axis=1)], axis=1).reshape(-1, 6)
    total, count = np.zeros((len(nodes), 6)), np.zeros((len(nodes), 1))
    np.add.at(total, elements.ravel(), every)
    np.add.at(count, elements.ravel(), 1.0)
    write(folder, u.reshape(-1, 3), total / count)
    return "Total CalculiX Time: 0.5\n"


def write(folder: Path, u: Floats, stress: Floats) -> None:
    """Write displacement (N, 3) and stress (N, 6) in CalculiX's layout and with its number of
    digits.
    """
    rows = [f"{n:10d} " + "".join(f"{v:14.6E}" for v in row) for n, row in enumerate(u, 1)]
    head = "\n displacements (vx,vy,vz) for set ALL and time  0.1000000E+01\n\n"
    (folder / "job.dat").write_text(head + "\n".join(rows) + "\n")
    rows = [f" -1{n:10d}" + "".join(f"{v:12.5E}" for v in row) for n, row in enumerate(stress, 1)]
    head = " -4  STRESS      6    1\n -5  SXX         1    4    1    1\n"
    (folder / "job.frd").write_text(head + "\n".join(rows) + "\n -3\n")
