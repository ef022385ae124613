"""The largest stress of a pin, of its surface or of its sections, under given lug pressures.

The classes give the derivatives of this stress by the pressures, and by changes of the joint at
fixed pressures.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from assess.derivatives.derivatives import Adjoint
from assess.derivatives.governing import rotated
from assess.derivatives.in_section import GoverningSection
from assess.derivatives.reading_point import Continued
from assess.derivatives.records import SolvedCase
from assess.derivatives.ties import competing_places, competing_times
from fea.core.pin_loads import PinLoads, UnitLoad
from fea.support.contact.pressure_loads import others_along, resultants
from fea.support.contact.solve_joint import ContactModel
from geometry import Pin
from geometry.mesh.outline_motion import NodeMotion, rate_of
from pinbase.arrays import Floats


@dataclass(frozen=True)
class JointStep:
    """The joint at the difference steps of a parameter.

    key: of the parameter.
    models: the joint at DIFFERENCE_STEPS times `step` (m, or the unit of the parameter).
    flexible: the motion of the outline on the mesh for the pin's flexibility; None where the pin
    does not change.
    """

    key: str
    models: tuple[ContactModel, ...]
    step: float
    flexible: NodeMotion | None

    @property
    def pins(self) -> tuple[Pin, ...]:
        """The pins with their rings, one for each model."""
        return tuple(one.pin for one in self.models)

    def rate(self, of: Callable[[ContactModel], Floats | float]) -> Floats:
        """Return the derivative by the parameter of a quantity `of` the joint."""
        return rate_of([np.asarray(of(one)) for one in self.models], self.step)


class PressedStress(Protocol):
    """The interface of a stress, Pa, under lug pressures at one instant."""

    @property
    def maximum(self) -> float: ...

    @property
    def tied_places(self) -> tuple[tuple[float, float], ...]: ...

    @property
    def tied_times(self) -> tuple[float, ...]: ...

    def by_pressures(self) -> Floats:
        """Return the derivative (N + 1, R, 2) by the pressure amplitudes of the harmonics 0 to N on
        the R rings, by phase.
        """

    def require(self, change: JointStep) -> None:
        """Check that a change keeps the topology of the pin or its beam.

        Raises: OtherShapeError.
        """

    def at_fixed_pressures(self, changes: Sequence[JointStep]) -> dict[str, float]:
        """Return the derivative by each change at fixed pressures, by the key of the change."""

    def of_amounts(self, amounts: Mapping[UnitLoad, Floats]) -> float:
        """Return the stress, Pa, that amounts of axial unit loads and torques add.

        amounts: (2,) by phase.
        """


class OfSurface:
    """The largest stress over the surface of a pin (assess.derivatives.derivatives)."""

    def __init__(self, solved: SolvedCase, model: ContactModel, links: PinLoads) -> None:
        self._solved, self._model, self._links = solved, model, links
        self._adjoint = Adjoint(solved)
        self._motions: dict[str, NodeMotion] = {}

    @property
    def maximum(self) -> float:
        return self._adjoint.top.value

    @property
    def tied_places(self) -> tuple[tuple[float, float], ...]:
        adjoint, solved = self._adjoint, self._solved
        return competing_places(adjoint.around, solved.zones, adjoint.top, solved.error)

    @property
    def tied_times(self) -> tuple[float, ...]:
        return competing_times(self._solved, self.maximum)

    def by_pressures(self) -> Floats:
        model, adjoint = self._model, self._adjoint
        out = np.zeros((model.cells.highest + 1, len(model.rings), 2))
        for k, wave in enumerate(adjoint.waves):
            if wave.n < len(out):
                loads = [UnitLoad("", "pressure", wave.n, ((name, 1.0),)) for name in model.rings]
                parts = rotated(wave.n, np.eye(2), adjoint.top.angle)[wave.part]
                out[wave.n] += adjoint.of_loads(k, loads)[:, None] * parts
        return out

    def require(self, change: JointStep) -> None:
        if change.flexible is not None:
            nodes = self._adjoint.outline_nodes
            self._motions[change.key] = nodes.among(change.key, change.pins, change.step)

    def at_fixed_pressures(self, changes: Sequence[JointStep]) -> dict[str, float]:
        moved = [self._motions[x.key] for x in changes if x.flexible is not None]
        out = self._adjoint.by_motions(moved)
        for x in changes:
            out[x.key] = out.get(x.key, 0.0) + self._by_material(x) + self._by_shares(x)
        return out

    def _by_material(self, change: JointStep) -> float:
        """Return the part due to the pin's material and the pressure exponent at a lug's edge."""
        adjoint, point, total = self._adjoint, self._adjoint.point, 0.0
        if isinstance(point, Continued):
            exponent = change.rate(lambda one: one.on_shaft.exponent[point.cusp.ring])
            if exponent:
                total += float(exponent) * adjoint.by_exponent()
        if poisson := float(change.rate(lambda one: one.material.poisson_ratio)):
            total += poisson * adjoint.by_poisson()
        if density := float(change.rate(lambda one: one.material.density or 0.0)):
            total += density * adjoint.by_density()
        return total

    def _by_shares(self, change: JointStep) -> float:
        """Return the part due to axial forces and moments, which rings share by their lengths."""
        links = self._links
        along = links.forces[..., 2].any() or links.moments[..., 2].any()
        if change.flexible is None or not along:
            return 0.0
        amounts = [others_along(x.pin, x.rings, links).coefficients() for x in change.models]
        rates = {load: rate_of([x[load][0] for x in amounts], change.step) for load in amounts[0]}
        return self.of_amounts(rates)

    def of_amounts(self, amounts: Mapping[UnitLoad, Floats]) -> float:
        total, adjoint = 0.0, self._adjoint
        for load, both in amounts.items():
            parts = rotated(load.n, both, adjoint.top.angle)
            for k, wave in enumerate(adjoint.waves):
                if wave.n == load.n and parts[wave.part]:
                    total += float(parts[wave.part] * adjoint.of_loads(k, [load])[0])
        return total


class OfSections:
    """The largest stress over the sections of a pin (assess.derivatives.in_section).

    Sections carry only the resultants of the pressures.
    """

    def __init__(self, solved: SolvedCase, model: ContactModel, links: PinLoads) -> None:
        self._model, self._links = model, links
        self._section = GoverningSection(solved, solved.loads.on_rings)
        self._waves = model.waves(model.pressed(links))
        self.tied_places = self._section.tied_places
        self.tied_times = self._section.tied_times

    @property
    def maximum(self) -> float:
        return self._section.maximum

    def by_pressures(self) -> Floats:
        model = self._model
        out = np.zeros((model.cells.highest + 1, len(model.rings), 2))
        area = np.array([model.pin.band(name).area for name in model.rings])
        for c, name in enumerate(model.rings):
            load = UnitLoad(name, "force", 1)
            parts = [self._section.of_amounts({load: one}) for one in np.eye(2)]
            out[1, c] = -0.5 * area[c] * np.array(parts)
        return out

    def require(self, change: JointStep) -> None:
        self._value(change.models[0])

    def at_fixed_pressures(self, changes: Sequence[JointStep]) -> dict[str, float]:
        return {x.key: float(x.rate(self._value)) for x in changes}

    def _value(self, model: ContactModel) -> float:
        """Return the stress, Pa, of another joint under the same pressures.

        Raises: OtherShapeError.
        """
        on_rings = resultants(model.pin, model.rings, self._waves, self._links)
        return self._section.value(model.pin, model.material, on_rings)

    def of_amounts(self, amounts: Mapping[UnitLoad, Floats]) -> float:
        return self._section.of_amounts(dict(amounts))
