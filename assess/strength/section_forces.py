"""Shear force and bending moment along a pin at every instant, for the formulas.

Two ways for a link's force to act on its band: evenly along it, or concentrated at its middle. Away
from a band both give the same diagrams. At its middle the moment of a force F that is even over a
length L differs by F L / 8 from that of a concentrated one, and that of a couple m, which is linear
over the band, by m / 2 on both sides.

In double shear (outer lugs of thickness a, a middle one of b, gaps c) the even load is the moment
F (b + 4 c + 2 a) / 8 of EN 1993-1-8, figure 3.11, and concentrated forces are F (b + 2 c + a) / 4.

Source: R. G. Budynas & J. K. Nisbett, Shigley's Mechanical Engineering Design, problem 3-40 (both
ways); EN 1993-1-8:2005, 3.13.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from assess.strength.records import JOINT_MODEL_BASIS
from assess.strength.situation import Situation
from fea.beam.line_load import acting, shares
from fea.beam.round_section import Circle, thinnest_section
from fea.beam.stress import sample
from fea.beam.timoshenko import MOMENT, SHEAR, InternalForces, stepped_beam
from fea.support.records import JointForces
from pinbase.arrays import Floats

EVEN_LOAD_BASIS = "even load on each band"
SHARED_COUPLE_BASIS = "the couple that is left over is shared by all bands"
Cells = NDArray[np.intp]  # (S,) numbers of a beam's cells


@dataclass(frozen=True)
class SectionForces:
    """At S stations: z (S,) m, sections, shear and moment (T, S), N and N m; labels: of the
    segments. times: of the instants, s; basis: where they come from.
    """

    z: Floats
    sections: tuple[Circle, ...]
    labels: tuple[str, ...]
    shear: Floats
    moment: Floats
    times: Floats | None
    basis: str

    def of_sections(self, name: str) -> Floats:
        """A property of the sections, (S,)."""
        return np.array([getattr(section, name) for section in self.sections])


def section_forces(s: Situation) -> tuple[SectionForces, SectionForces]:
    """With even loads on the bands, and with concentrated ones. Raises: as `stepped_beam`."""
    s = replace(s, loads=s.by_formula)
    forces = stepped_beam(s.pin, s.material, acting(s.loads), s.clamps)
    c = shares(forces.loads, s.loads)
    cells, z = sample(forces)
    even = _sized(s, forces, cells, z, _values(forces, c, cells, z))
    bands = [s.pin.band(name) for name in s.loads.surfaces]
    inside = np.any([(z > b.z0) & (z < b.z1) for b in bands], axis=0)
    outside = _values(forces, c, cells[~inside], z[~inside])
    at_bands = _at_middles(s, forces, c)
    middles = np.repeat([b.middle for b in bands], 2)
    where = np.concatenate([z[~inside], middles])
    there = np.concatenate([cells[~inside], _cells(forces, middles)])
    both = np.concatenate([outside, at_bands], axis=1)
    at_middles = _sized(s, forces, there, where, both)
    middles_of = "forces at the middles of bands"
    return even, replace(at_middles, basis=even.basis.replace(EVEN_LOAD_BASIS, middles_of))


def of_joint(s: Situation, joint: JointForces) -> SectionForces:
    """By the model of the joint, on both sides of each station."""
    inner = np.array(s.pin.stations[1:-1])
    sides = [np.searchsorted(inner, joint.z, side=side) for side in ("left", "right")]
    segments, z = [int(i) for i in np.concatenate(sides)], np.tile(joint.z, 2)
    from_start = (z - np.array(s.pin.stations)[segments]).tolist()
    return SectionForces(
        z,
        tuple(
            thinnest_section(s.pin.segments[i], x, x)
            for i, x in zip(segments, from_start, strict=True)
        ),
        tuple(s.pin.labels[i] for i in segments),
        np.tile(joint.shear, 2),
        np.tile(joint.moment, 2),
        joint.times,
        JOINT_MODEL_BASIS,
    )


def _values(forces: InternalForces, c: Floats, cells: Cells, z: Floats) -> Floats:
    """Shear and moment in both planes, (2, S, T, 2)."""
    inside = forces.inside(cells, z)
    return np.stack([np.einsum("sk,tpk->stp", inside[:, q], c) for q in (SHEAR, MOMENT)])


def _at_middles(s: Situation, forces: InternalForces, c: Floats) -> Floats:
    """Shear and moment on both sides of concentrated loads, (2, 2 C, T, 2): the shear there is
    that beyond the band, at which the diagrams end anyway.
    """
    bands = [s.pin.band(name) for name in s.loads.surfaces]
    middles = np.array([b.middle for b in bands])
    V, M = _values(forces, c, _cells(forces, middles), middles)
    lengths = np.array([b.length for b in bands])[:, None, None]
    force = np.moveaxis(s.loads.forces[..., :2], 0, 1)
    couple = np.moveaxis(s.loads.moments, 0, 1)
    turning = np.stack([couple[..., 1], -couple[..., 0]], axis=-1)
    M = M - force * lengths / 8.0
    return np.stack(
        [
            np.repeat(np.zeros_like(V), 2, axis=0),
            np.stack([M + turning / 2.0, M - turning / 2.0], axis=1).reshape(-1, *M.shape[1:]),
        ]
    )


def _cells(forces: InternalForces, z: Floats) -> Cells:
    return np.searchsorted(forces.stations[1:-1], z, side="right")


def _sized(
    s: Situation, forces: InternalForces, cells: Cells, z: Floats, values: Floats
) -> SectionForces:
    V, M = np.linalg.norm(values, axis=-1)
    middles = 0.5 * (forces.stations[1:] + forces.stations[:-1])
    segments = np.searchsorted(s.pin.stations[1:-1], middles, side="right")
    return SectionForces(
        z,
        tuple(forces.sections[int(i)] for i in cells),
        tuple(s.pin.labels[segments[int(i)]] for i in cells),
        V.T,
        M.T,
        s.loads.times,
        EVEN_LOAD_BASIS if s.balanced else f"{EVEN_LOAD_BASIS}; {SHARED_COUPLE_BASIS}",
    )
