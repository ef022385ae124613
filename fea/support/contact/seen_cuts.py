"""The cuts of a pin as its contact with lugs sees them.

A cell that a cut removes almost completely carries no pressure. On the other cells the cuts add
compliance, which is computed under pressures on single rings, harmonic by harmonic
(fea.cut.compliance): the pin bends more, ovalises over a hole, and gives way beside a mouth. A cell
that is removed in part counts as a whole cell, with the force on its remainder.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from fea.core.material import Material
from fea.core.pin_loads import UnitLoad
from fea.cut.compliance import AddedCompliance, added_compliance
from fea.cut.region import loaded_bands, pieces
from fea.support.bands import Bands
from fea.support.contact.pressure_loads import waves_of_sectors
from geometry import CutPin, Pin
from pinbase.arrays import Floats, Mask
from pinbase.memo import Memo
from pinbase.records import digest

CELL_POINTS = 8  # points along each side of a cell, which are tested for being inside a cut
# Fraction of a cell's area that must remain for the cell to carry pressure; chosen by judgement.
MIN_CELL_LEFT = 0.15


@dataclass(frozen=True)
class SeenCuts:
    """The cuts of a pin, and the compliance that they add under pressures on its rings.

    compliance: added compliance under K unit pressures.
    of: harmonic, ring and phase of each unit pressure, (K, 3).
    known: added displacements of cells that are kept, since many variations of a joint have the
    same cells.
    """

    cut: CutPin
    compliance: AddedCompliance
    of: Floats
    known: Memo = field(default_factory=Memo, compare=False, repr=False)

    @cached_property
    def angle(self) -> float:
        """The angle of the middle of the first cell, rad, which is that of the first cut.

        The cells are then symmetric about this cut. They do not turn with the loads, as they do on
        a pin with rotational symmetry.
        """
        return next(iter(self.cut.cuts.values())).angle

    def removed(self, bands: Bands, sectors: int) -> Mask:
        """A mask (U,) of the cells that cuts remove."""
        part = (np.arange(CELL_POINTS) + 0.5) / CELL_POINTS - 0.5
        turns = (np.arange(sectors)[:, None] + part).ravel() * 2.0 * np.pi / sectors + self.angle
        out = []
        for z, length, radius in zip(bands.z, bands.length, bands.radius, strict=True):
            along, around = np.meshgrid(z + part * length, turns)
            x = np.stack([radius * np.cos(around), radius * np.sin(around), along], axis=-1)
            taken = np.zeros(x.size // 3, dtype=bool)
            for cut in self.cut.cuts.values():
                low, high = cut.opens
                if low < z + 0.5 * length and high > z - 0.5 * length:
                    taken |= cut.takes(x.reshape(-1, 3), float(radius))
            out.append(taken.reshape(sectors, -1).mean(axis=1) > 1.0 - MIN_CELL_LEFT)
        return np.concatenate(out)

    def added(self, bands: Bands, sectors: int, groups: Floats) -> Floats:
        """The displacements of cells under forces on cells that the cuts add, (U, U) m/N.

        groups: (R, C), 1 where a ring of the pin belongs to a ring of the cells.
        """
        key = digest((bands.z, bands.length, bands.radius, sectors, groups))
        return self.known.get(key, lambda: self._added(bands, sectors, groups))

    def _added(self, bands: Bands, sectors: int, groups: Floats) -> Floats:
        waves = waves_of_sectors(sectors, int(self.of[:, 0].max()), self.angle)
        n, ring, phase = self.of.T
        on_cells = groups[ring][:, :, None] * waves[n, :, phase][:, None, :]
        area = bands.length * bands.radius * 2.0 * np.pi / sectors
        amounts = (on_cells / area[:, None]).reshape(len(self.of), -1)
        here = ~self.removed(bands, sectors)
        # The forces of all cells together are in balance. Single unit loads are not, and tractions
        # on all bands close their balance. The unbalanced part is therefore projected out, which
        # removes at most a rigid motion of the pin.
        turns = 2.0 * np.pi * np.arange(sectors) / sectors
        e_r = np.tile(np.stack([np.cos(turns), np.sin(turns)], axis=1), (len(bands.z), 1))
        z = np.repeat(bands.z - bands.z.mean(), sectors)[:, None] / np.ptp(bands.z)
        motions = np.hstack([e_r, z * e_r]) * here[:, None]
        amounts *= here
        share = np.linalg.solve(motions.T @ motions, motions.T)
        balanced = amounts - (amounts @ motions) @ share
        return self.compliance.work(balanced)


def seen_cuts(
    cut: CutPin, ringed: Pin, rings: Sequence[str], material: Material, highest: int
) -> SeenCuts:
    """The cuts of a pin in contact with its lugs.

    cut: the pin with cuts and with the bands of the lugs.
    ringed: the pin without cuts, its bands cut into rings.
    rings: names of the rings.
    highest: highest harmonic of the pressures.

    Raises: MeshError, SolveError.
    """
    bands = loaded_bands(cut, cut.connections)
    number = {name: k for k, name in enumerate(rings)}
    loads = [
        tuple(UnitLoad("", "pressure", n, ((name, 1.0),)) for name in rings)
        for n in range(highest + 1)
    ]
    added = added_compliance(ringed, material, pieces(cut, (), bands=bands), bands, loads)
    of = np.array([(load.n, number[load.parts[0][0]], phase) for load, phase in added.units])
    return SeenCuts(cut, added, of)
