"""Contact of a pin with its lugs as long as the same cells touch: what everything adds to a sum of
their pressures.

Forces f on the cells in contact and rigid motions m solve

    gap + C f + G m = 0    G^T f = asked

which is symmetric. With the adjoints l and k of a stress S(f), C l + G k = dS/df and G^T l = 0,

    dS = S' - l^T (gap' + C' f + G' m) + k^T (asked' - G'^T f)

so that shape, material and loads need no further solution of contact. All of it but the elasticity
of the bodies (assess.derivatives.ring_work) follows from formulas, and is taken by differences.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from assess.derivatives.ring_work import Pair
from fea.core.pin_loads import PinLoads
from fea.support.contact.contact import Mask, rotation
from fea.support.contact.pressure_loads import waves_of_sectors
from fea.support.contact.solve_joint import ContactModel
from pinbase.arrays import Floats

AMPLITUDE_TOLERANCE = 1e-13  # of the largest amplitude
SWITCHING_TOLERANCE = (
    1e-6  # of the largest pressure or gap: a cell that is about to open or to close
)


class FixedContact:
    """At the only instant of loads of links. gradient: of the stress by the amplitudes of pressures
    on the rings, (N + 1, R, 2). changing: how many cells are about to open or to close.

    Raises: SolveError.
    """

    def __init__(self, model: ContactModel, links: PinLoads, gradient: Floats) -> None:
        self._model, self._links, self._contact = model, links, model.contact
        (pressed,) = model.pressed(links)
        self._turn = rotation(pressed.angle)
        waves = waves_of_sectors(model.cells.sectors, model.cells.highest, pressed.angle)
        self._wanted = np.einsum("nrc,njc->rj", gradient, waves).ravel()
        asked = self._asked(model, links)
        self._at = self._contact.adjoint(pressed.active, self._wanted / self._contact.area, asked)
        self.changing = _close(pressed.pressure, pressed.active)
        self.changing += _close(pressed.gap, ~pressed.active)
        shape = pressed.pressure.shape
        both = self._at.by_gap.reshape(shape), self._at.force.reshape(shape)
        self._l, self._f = (np.fft.fft(x, axis=1) for x in both)  # harmonics, (R, M)
        count = len(model.flexibility)
        self._factors = self._contact.factors(np.arange(count))
        tail = self._contact.tail_weights(count)
        self._tail = np.real(np.conj(self._l) * self._f) @ tail
        self._wavy = {
            model.likeness(lug, ends): model.wavy[:, :, own, own].sum(axis=0)
            for own, lug, ends in model.by_lug()
        }

    def _asked(self, model: ContactModel, links: PinLoads) -> Floats:
        """Of the rigid motions, in the directions of the cells."""
        forces, couples = model.forces(links)[0], model.couples(links)[0]
        x, y = (couples @ self._turn).tolist()
        return self._contact.asked(forces @ self._turn, (x, y))

    def held(self, model: ContactModel) -> float:
        """The sum, Pa, on another shape (JointModel.reshaped), but for the elasticity of its
        bodies; to first order in what is different.
        """
        at, bands, sectors = self._at, model.bands, self._contact.sectors
        area = self._contact.cells_area(bands)
        tilt = [lug.tilt for lug in model.lugs]
        motions, tilts = self._contact.rigid(bands, tilt)
        opened = np.repeat(bands.gap, sectors) + motions @ at.motion + tilts @ (tilts.T @ at.force)
        asked = self._asked(model, self._links)
        total = (self._wanted / area) @ at.force - at.by_gap @ opened
        total += at.by_asked @ (asked - motions.T @ at.force)
        of_ring = area[::sectors]
        total -= self._tail @ (model.tail / of_ring)
        high = model.high
        for own, lug, ends in model.by_lug():
            known = self._wavy.get(model.likeness(lug, ends))
            wavy = model.wavy_of(lug, ends).sum(axis=0) if known is None else known
            lost, pressed = (x[own][:, high % sectors] for x in (self._l, self._f))
            pressed = pressed / of_ring[own, None]
            works = np.einsum("rn,nrs,sn->n", np.conj(lost), wavy, pressed)
            total -= float(self._factors[high] @ works.real)
        return float(total)

    def pairs(self, own: slice = slice(None)) -> Iterator[Pair]:
        """Of some rings, the pressures whose works are what their elasticity takes of the sum."""
        bands, area = self._model.bands, self._contact.area[:: self._contact.sectors]
        of_ring = bands.length * bands.radius
        for n in range(self._model.cells.highest + 1):
            p, l = self._f[:, n] / area, self._l[:, n] / of_ring  # noqa: E741
            for part in (np.real, np.imag):
                if all(
                    np.abs(part(x[own])).max() > AMPLITUDE_TOLERANCE * np.abs(x).max(initial=0.0)
                    for x in (p, l)
                ):
                    yield Pair(n, float(self._factors[n]), part(p[own]), part(l[own]))

    def by_loads(self, links: PinLoads) -> float:
        """What loads of links add to the sum through the pressures, Pa per one of these loads."""
        return float(self._at.by_asked @ self._asked(self._model, links))


def _close(values: Floats, some: Mask) -> int:
    """How many of some of the values are almost none."""
    found = values[some]
    return int((found < SWITCHING_TOLERANCE * found.max(initial=0.0)).sum())
