"""Shear force and bending moment along a pin at every instant, for the formulas.

The force of a link can act on its band in two ways: evenly along the band, or concentrated at its
middle. Away from the band both give the same diagrams. At the middle of the band, the moment of a
force F that is even over a length L differs by F L / 8 from that of a concentrated force. The
moment of a couple m, which is linear over the band, differs by m / 2 on both sides.

In double shear (outer lugs of thickness a, a middle lug of thickness b, gaps c) even loads give the
moment F (b + 4 c + 2 a) / 8 of EN 1993-1-8, figure 3.11, and concentrated forces give
F (b + 2 c + a) / 4.

Source: R. G. Budynas & J. K. Nisbett, Shigley's Mechanical Engineering Design, problem 3-40 (both
ways); EN 1993-1-8:2005, 3.13.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from assess.margin import JOINT_MODEL_BASIS
from assess.situation import NominalStress, Resists, SectionForces, Situation
from fea.beam.line_load import acting, shares
from fea.beam.round_section import thinnest_section
from fea.beam.timoshenko import AXIAL, MOMENT, SHEAR, TORQUE, InternalForces, stepped_beam
from fea.support.records import JointForces
from pinbase.arrays import ROUND_OFF, Floats, first_largest

EVEN_LOAD_BASIS = "even load on each band"
SHARED_COUPLE_BASIS = "the couple that is left over is shared by all bands"
Cells = NDArray[np.intp]  # (S,) numbers of a beam's cells


def with_section_forces(s: Situation) -> Iterator[Situation]:
    """Yield the situation with each kind of section forces; the kind that the study chooses comes
    first.

    If the joint was solved, its section forces govern and even loads are for comparison. If the
    study chooses even loads, those govern; the section forces of the joint are then for comparison,
    unless the even loads leave an unbalanced couple. In that case the joint governs as well: the
    lugs carry the couple, and only the joint model knows which. Concentrated forces are for
    comparison if the joint was solved. If it was not, all kinds govern.

    Raises: as `section_forces`.
    """
    even, concentrated = section_forces(s)
    if s.joint is None:
        ways = [(even, True), (concentrated, True)]
    elif s.even_governs:
        ways = [(even, True), (of_joint(s, s.joint), s.joint_governs), (concentrated, False)]
    else:
        ways = [(of_joint(s, s.joint), True), (even, False), (concentrated, False)]
    for number, (forces, governs) in enumerate(ways):
        yield replace(s, section_forces=forces, chosen=number == 0, governs=governs)


def section_forces(s: Situation) -> tuple[SectionForces, SectionForces]:
    """Return the section forces with even loads on the bands, and with concentrated loads.

    Raises: as `stepped_beam`.
    """
    s = replace(s, loads=s.by_formula)
    forces = stepped_beam(s.pin, s.material, acting(s.loads), s.clamps)
    c = shares(forces.loads, s.loads)
    cells, z = forces.samples
    even = _sized(s, forces, cells, z, _values(forces, c, cells, z))
    even = replace(even, exact=partial(_largest, s, forces, c))
    bands = [s.pin.band(name) for name in s.loads.surfaces]
    inside = np.any([(z > b.z0) & (z < b.z1) for b in bands], axis=0)
    outside = _values(forces, c, cells[~inside], z[~inside])
    at_bands = _at_middles(s, forces, c)
    middles = np.repeat([b.middle for b in bands], 2)
    where = np.concatenate([z[~inside], middles])
    station_cells = np.concatenate([cells[~inside], _cells(forces, middles)])
    both = np.concatenate([outside, at_bands], axis=1)
    at_middles = _sized(s, forces, station_cells, where, both)
    middles_of = "forces at the middles of bands"
    basis = even.basis.replace(EVEN_LOAD_BASIS, middles_of)
    return even, replace(at_middles, basis=basis, kind="concentrated")


def of_joint(s: Situation, joint: JointForces) -> SectionForces:
    """Return the section forces by the joint model, on both sides of each station."""
    inner = np.array(s.pin.stations[1:-1])
    sides = [np.searchsorted(inner, joint.z, side=side) for side in ("left", "right")]
    segments, z = [int(i) for i in np.concatenate(sides)], np.tile(joint.z, 2)
    from_start = (z - np.array(s.pin.stations)[segments]).tolist()
    moment = np.tile(joint.moment, 2)
    along = [
        np.zeros_like(moment) if x is None else np.tile(x, 2) for x in (joint.axial, joint.torque)
    ]
    return SectionForces(
        z,
        tuple(
            thinnest_section(s.pin.segments[i], x, x)
            for i, x in zip(segments, from_start, strict=True)
        ),
        tuple(s.pin.labels[i] for i in segments),
        np.tile(joint.shear, 2),
        moment,
        along[0],
        along[1],
        joint.times,
        JOINT_MODEL_BASIS,
        "joint",
    )


def _values(forces: InternalForces, c: Floats, cells: Cells, z: Floats) -> Floats:
    """Return shear, moment, axial force and torque by phase, (4, S, T, 2)."""
    inside = forces.inside(cells, z)
    parts = (SHEAR, MOMENT, AXIAL, TORQUE)
    return np.stack([np.einsum("sk,tpk->stp", inside[:, q], c) for q in parts])


def _at_middles(s: Situation, forces: InternalForces, c: Floats) -> Floats:
    """Return the values of `_values` on both sides of concentrated loads, (4, 2 C, T, 2).

    The shear is set to zero here, because its value is that beyond the band, where the diagrams
    have it anyway.
    """
    bands = [s.pin.band(name) for name in s.loads.surfaces]
    middles = np.array([b.middle for b in bands])
    _, M, *others = _values(forces, c, _cells(forces, middles), middles)
    lengths = np.array([b.length for b in bands])[:, None, None]
    force = np.moveaxis(s.loads.forces[..., :2], 0, 1)
    couple = np.moveaxis(s.loads.moments, 0, 1)
    turning = np.stack([couple[..., 1], -couple[..., 0]], axis=-1)
    M = M - force * lengths / 8.0
    return np.stack(
        [
            np.repeat(np.zeros_like(M), 2, axis=0),
            np.stack([M + turning / 2.0, M - turning / 2.0], axis=1).reshape(-1, *M.shape[1:]),
            *(np.repeat(x, 2, axis=0) for x in others),
        ]
    )


def _cells(forces: InternalForces, z: Floats) -> Cells:
    return np.searchsorted(forces.stations[1:-1], z, side="right")


def _sized(
    s: Situation, forces: InternalForces, cells: Cells, z: Floats, values: Floats
) -> SectionForces:
    # The same as a norm over the last axis, of two numbers, in an eighth of the time.
    V, M, N, T = np.sqrt(values[..., 0] ** 2 + values[..., 1] ** 2)
    middles = 0.5 * (forces.stations[1:] + forces.stations[:-1])
    segments = np.searchsorted(s.pin.stations[1:-1], middles, side="right")
    return SectionForces(
        z,
        tuple(forces.sections[int(i)] for i in cells),
        tuple(s.pin.labels[segments[int(i)]] for i in cells),
        V.T,
        M.T,
        N.T,
        T.T,
        s.loads.times,
        EVEN_LOAD_BASIS if s.balanced else f"{EVEN_LOAD_BASIS}; {SHARED_COUPLE_BASIS}",
    )


def _largest(s: Situation, forces: InternalForces, c: Floats, resists: Resists) -> NominalStress:
    """Return the largest nominal stress, in whichever plane it acts.

    c: (T, 2, K) amounts of the unit loads. resists: the section property that divides V or M.
    The instant is found from samples. The place is then found exactly, since the square of V or M
    is a polynomial between two stations.
    """
    component = MOMENT if resists == "modulus" else SHEAR
    cells, z = forces.samples
    values = np.einsum("sk,tpk->spt", forces.inside(cells, z)[:, component], c)
    per = np.array([1.0 / getattr(x, resists) for x in forces.sections])  # Pa per N, or per N m
    size = np.hypot(values[:, 0], values[:, 1]) * per[cells, None]
    k, t = first_largest(size)
    best = int(cells[k]), float(z[k]), float(size[k, t])
    for cell in forces.free:
        a, b = forces.stations[cell : cell + 2]
        x, y = (Polynomial(forces.coefficients[cell, :, component] @ c[t, p]) for p in (0, 1))
        square = x * x + y * y
        for root in square.deriv().trim().roots():
            here = float(root.real)
            if 0.0 < here < b - a:
                value = math.sqrt(max(float(square(here)), 0.0)) * per[cell]
                if value > best[2] * (1.0 + ROUND_OFF):
                    best = cell, float(a) + here, float(value)
    cell, at, stress = best
    middle = 0.5 * (forces.stations[cell] + forces.stations[cell + 1])
    label = s.pin.labels[int(np.searchsorted(s.pin.stations[1:-1], middle, side="right"))]
    return NominalStress(stress, label, at, s.loads.time(t), forces.sections[cell])
