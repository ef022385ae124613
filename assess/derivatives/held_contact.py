"""Derivatives of the contact between a pin and its lugs, with the same cells in contact.

Forces f on the cells in contact and rigid motions m solve

    gap + C f + G m = 0    G^T f = q

a symmetric system; q are the resultants of the links' loads. With the adjoints l and k of a stress
S(f), C l + G k = dS/df and G^T l = 0,

    dS = S' - l^T (gap' + C' f + G' m) + k^T (q' - G'^T f)

so that derivatives by shape, material and loads need no further contact solution. The elasticity of
the bodies is left to assess.derivatives.ring_work; all other terms have closed formulae and are
differentiated by finite differences.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from assess.derivatives.ring_work import Pair
from fea.core.pin_loads import PinLoads
from fea.support.contact.pressure_loads import waves_of_sectors
from fea.support.contact.sectors import sector_factors, tail_weights
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.links import tilting_bands
from pinbase.arrays import Floats, Mask

AMPLITUDE_TOLERANCE = 1e-13  # relative to the largest amplitude: smaller ones are round-off
# Relative to the largest pressure or gap: a cell with less is about to open or to close.
SWITCHING_TOLERANCE = 1e-6


class FixedContact:
    """The contact problem with a fixed set of contact cells, and its adjoint solution. The links'
    loads have a single instant.

    gradient: (N + 1, R, 2) derivative of the stress by the pressure amplitudes on the rings.
    changing: number of cells that are about to open or to close.

    Raises: SolveError.
    """

    def __init__(self, model: ContactModel, links: PinLoads, gradient: Floats) -> None:
        self._model, self._links, self._contact = model, links, model.freed(links)
        (pressed,) = model.pressed(links)
        self._angle = pressed.angle
        waves = waves_of_sectors(model.cells.sectors, model.cells.highest, pressed.angle)
        self._wanted = np.einsum("nrc,njc->rj", gradient, waves).ravel()
        right_hand_side = self._right_hand_side(model, links)
        self._at = self._contact.adjoint(
            pressed.active, self._wanted / self._contact.area, right_hand_side
        )
        self.changing = _nearly_zero(pressed.pressure, pressed.active)
        self.changing += _nearly_zero(pressed.gap, ~pressed.active)
        shape = pressed.pressure.shape
        both = self._at.by_gap.reshape(shape), self._at.force.reshape(shape)
        self._l, self._f = (np.fft.fft(x, axis=1) for x in both)  # harmonics, (R, M)
        count = len(model.flexibility)
        self._factors = sector_factors(self._contact.sectors, np.arange(count))
        tail = tail_weights(self._contact.sectors, count)
        self._tail = np.real(np.conj(self._l) * self._f) @ tail
        self._wavy = {
            model.flexibility_key(lug, ends): model.wavy[:, :, rings, rings].sum(axis=0)
            for rings, lug, ends in model.by_lug()
        }

    def _right_hand_side(self, model: ContactModel, links: PinLoads) -> Floats:
        """Return the right-hand side of the equilibrium, in the axes of the cells."""
        acting = model.acting(links).turned([self._angle])
        x, y = acting.couples[0].tolist()
        return self._contact.required_resultants(acting.forces[0], (x, y), acting.moments[0])

    def with_fixed_cells(self, model: ContactModel) -> float:
        """Return the stress, Pa, of another shape (ContactModel.reshaped) with the same cells in
        contact, to first order in the changes and without the elasticity of the bodies.
        """
        at, bands, sectors = self._at, model.bands, self._contact.sectors
        area = self._contact.cells_area(bands)
        free = tilting_bands(model.whole, self._links)
        tilt = [0.0 if f else lug.tilt for f, lug in zip(free, model.lugs, strict=True)]
        motions, tilts = self._contact.rigid(bands, tilt)
        opened = np.repeat(bands.gap, sectors) + motions @ at.motion + tilts @ (tilts.T @ at.force)
        right_hand_side = self._right_hand_side(model, self._links)
        # The stress due to the cell forces, less the adjoint work of the gaps.
        total = (self._wanted / area) @ at.force - at.by_gap @ opened
        # Equilibrium of the links' loads.
        total += at.by_required @ (right_hand_side - motions.T @ at.force)
        # Short pressure waves, whose flexibility is not covered by `ring_work`.
        of_ring = area[::sectors]
        total -= self._tail @ (model.tail / of_ring)
        high = model.high
        for rings, lug, ends in model.by_lug():
            known_wavy = self._wavy.get(model.flexibility_key(lug, ends))
            wavy = model.wavy_of(lug, ends).sum(axis=0) if known_wavy is None else known_wavy
            lost, pressed = (x[rings][:, high % sectors] for x in (self._l, self._f))
            pressed = pressed / of_ring[rings, None]
            works = np.einsum("rn,nrs,sn->n", np.conj(lost), wavy, pressed)
            total -= float(self._factors[high] @ works.real)
        return float(total)

    def pairs(self, rings: slice = slice(None)) -> Iterator[Pair]:
        """Yield pairs of pressures on some rings; their work is the elastic part of the stress."""
        bands, area = self._model.bands, self._contact.area[:: self._contact.sectors]
        of_ring = bands.length * bands.radius
        for n in range(self._model.cells.highest + 1):
            p, l = self._f[:, n] / area, self._l[:, n] / of_ring  # noqa: E741
            for part in (np.real, np.imag):
                if all(
                    np.abs(part(x[rings])).max() > AMPLITUDE_TOLERANCE * np.abs(x).max(initial=0.0)
                    for x in (p, l)
                ):
                    yield Pair(n, float(self._factors[n]), part(p[rings]), part(l[rings]))

    def by_loads(self, links: PinLoads) -> float:
        """Return the stress, Pa, that loads of the links add through the contact pressures."""
        return float(self._at.by_required @ self._right_hand_side(self._model, links))


def _nearly_zero(values: Floats, some: Mask) -> int:
    """Return how many of the selected values are nearly zero, relative to the largest of them."""
    chosen = values[some]
    return int((chosen < SWITCHING_TOLERANCE * chosen.max(initial=0.0)).sum())
