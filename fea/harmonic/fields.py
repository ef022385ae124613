"""Unit fields of stress and displacement on the meridian section."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
import scipy.sparse as sp

from fea.core.pin_loads import UnitLoad
from fea.core.strain_energy import StrainEnergy
from fea.core.zone import Zone
from fea.singular.singularities import outside
from geometry.mesh.section_mesh import MeridianMesh
from pinbase.arrays import Floats, Ints, Mask

Made = TypeVar("Made")


@dataclass(frozen=True)
class MeridianFields:
    """The amplitudes of stress and displacement on a section for each of K unit loads.

    points: (S, 2) r, z in m.
    stress: (S, 6, K) Pa, components rr, tt, zz, tz, rz, rt. Under a load of harmonic n and phase p
    the first three and rz vary as cos psi, the others as sin psi, psi = n theta - p pi / 2.
    displacement: (D, 3, K) m, of the first D points: r and z vary as cos psi, theta as sin psi.
    skin: number of the first points that follow the outline counter-clockwise.
    unknowns: number of unknowns of the system that was solved.
    triangles: (M, 3) points of triangles that fill the section; empty for a model without them.
    unread: points whose stress is too rough to search for a maximum (fea.harmonic.pressure_edge).
    forces: (3 D, K) N, nodal forces along r, theta and z at the first D points, integrated around
    the axis; the work of the loads follows from them.
    mesh: of the section; None for a model without one.
    """

    points: Floats
    loads: tuple[UnitLoad, ...]
    stress: Floats
    displacement: Floats
    skin: int
    unknowns: int
    triangles: Ints = field(default_factory=lambda: np.zeros((0, 3), dtype=np.int64))
    unread: Ints = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    forces: sp.csc_matrix | None = None
    mesh: MeridianMesh | None = None

    def joined(self, other: MeridianFields) -> MeridianFields:
        """These fields and those of other loads on the same points."""
        stress, displacement = (
            np.concatenate([getattr(x, name) for x in (self, other)], axis=2)
            for name in ("stress", "displacement")
        )
        loads = self.loads + other.loads
        both = self.forces, other.forces
        forces = sp.hstack(both, format="csc") if both[0] is not None else None  # type: ignore
        return replace(self, loads=loads, stress=stress, displacement=displacement, forces=forces)

    @cached_property
    def energy(self) -> StrainEnergy | None:
        """The strain energy of the pin under these loads; None where their nodal forces are not
        known.
        """
        if self.forces is None:
            return None
        n, work = np.array([load.n for load in self.loads]), np.zeros((len(self.loads),) * 2)
        moved = self.displacement.reshape(self.forces.shape)
        for one in np.unique(n):
            here = np.flatnonzero(n == one)
            work[np.ix_(here, here)] = self.forces[:, here].T @ moved[:, here]
        return StrainEnergy.of_both_phases(self.loads, work)

    def once(self, key: tuple[object, ...], make: Callable[[], Made]) -> Made:
        """A quantity derived from these fields, by its key; made when it is first requested."""
        if key not in self.derived:
            self.derived[key] = make()
        made: Made = self.derived[key]
        return made

    @cached_property
    def derived(self) -> dict[tuple[object, ...], Any]:
        """A store of derived quantities by key.

        It holds the five numbers of some of the loads (fea.harmonic.five_numbers) and readings of
        the surface (fea.harmonic.free_surface), among others.
        """
        return {}

    def outside(self, singularities: Iterable[Zone]) -> Mask:
        """A mask (S,) of the points that may have the maximum: they are read, and in no singular
        zone.
        """
        out = outside(singularities, *self.points.T)
        out[self.unread] = False
        return out
