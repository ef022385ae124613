"""The data that a check reads: a pin with its lugs and loads in a case, and its solved results."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from assess.codes import (
    DEFAULT_CODES,
    FITTING_FACTORS,
    RECOMMENDED,
    AiscDesign,
    Code,
    PartialFactors,
)
from assess.fatigue.records import PointFatigue
from assess.lug_factors import LugFactors
from assess.margin import Level
from assess.plastic.records import LimitLoad, LugCollapse
from assess.requirement import RequiredCheck
from fea.beam.round_section import Circle
from fea.core.equilibrium import out_of_balance
from fea.core.material import Material
from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.support.lugs.lug import Lug
from fea.support.records import JointForces, LugStress
from geometry import ArgumentError, Pin
from pinbase.arrays import Floats, first_largest

if TYPE_CHECKING:
    from fea.lug.in_joint import ShankAngle  # with the elements of lugs

MAX_LEFT_COUPLE = 0.01  # unbalanced couple, relative to the largest force times the pin's length
SUPPORT_COUNT = 2  # number of structural lugs whose forces follow from equilibrium
NO_LOADS = PinLoads("", (), np.zeros((1, 0, 3)))


ForcesKind = Literal["even", "concentrated", "joint"]
# The section property that divides the moment or the shear force to give a nominal stress.
Resists = Literal["area", "axis_area", "modulus"]


@dataclass(frozen=True)
class LoadFactors:
    """Factors on the loads of a study: at limit load (against yield) and at ultimate load (against
    rupture and collapse), and the fitting factor, which multiplies both.

    fitting_stated: whether the study states the fitting factor. A stated factor replaces the one
    that a code demands.

    Source: 14 CFR 25.301 and 25.303 (limit and ultimate loads), 25.625 (fitting factor).
    """

    limit: float = 1.0
    ultimate: float = 1.5
    fitting: float = 1.0
    fitting_stated: bool = False

    def of_code(self, code: Code) -> LoadFactors:
        """Return the factors with the fitting factor of a code, unless the study states one."""
        demanded = FITTING_FACTORS.get(code)
        if demanded is None or self.fitting_stated:
            return self
        return replace(self, fitting=demanded)

    def at(self, level: Level) -> float:
        """Return the factor on demands at a level."""
        return (self.limit if level == "limit" else self.ultimate) * self.fitting


@dataclass(frozen=True)
class NominalStress:
    """The largest nominal stress along a pin, Pa: the name of the segment, z (m) and time (s, None
    without a motion) at which it occurs, and the section there.
    """

    stress: float
    at: str
    z: float
    time: float | None
    section: Circle


@dataclass(frozen=True)
class SectionForces:
    """The section forces along a pin, as found by one method.

    z: (S,) positions of the stations, m. sections, labels: the round section and the name of the
    segment at each station. shear, moment: (T, S) shear force, N, and bending moment, N m, at T
    instants. axial, torque: (T, S) magnitudes of the axial force, N, and of the torque, N m.
    times: (T,) s, None without a motion.
    basis: the method that gave the forces, in words. kind: the same method as a key. exact: a
    function that also finds the largest nominal stress between the stations, where the shear and
    moment diagrams are polynomials; None otherwise.
    """

    z: Floats
    sections: tuple[Circle, ...]
    labels: tuple[str, ...]
    shear: Floats
    moment: Floats
    axial: Floats
    torque: Floats
    times: Floats | None
    basis: str
    kind: ForcesKind = "even"
    exact: Callable[[Resists], NominalStress] | None = None

    def of_sections(self, name: str) -> Floats:
        """Return a property of the sections by its name, (S,)."""
        return np.array([getattr(section, name) for section in self.sections])

    def mean_shear(self) -> NominalStress:
        """Return the largest mean shear stress V / A."""
        return self._largest("area")

    def neutral_axis_shear(self) -> NominalStress:
        """Return the largest shear stress at the neutral axis, V Q / (I t)."""
        return self._largest("axis_area")

    def bending(self) -> NominalStress:
        """Return the largest elastic bending stress M c / I."""
        return self._largest("modulus")

    def _largest(self, resists: Resists) -> NominalStress:
        if self.exact is not None:
            return self.exact(resists)
        force = self.moment if resists == "modulus" else self.shear
        stress = force / self.of_sections(resists)
        t, k = first_largest(stress)
        time = None if self.times is None else float(self.times[t])
        at, z, section = self.labels[k], float(self.z[k]), self.sections[k]
        return NominalStress(float(stress[t, k]), at, z, time, section)


@dataclass(frozen=True)
class SolvedRow:
    """The part of a pin's solution in a load case that checks read.

    peak: the maximum von Mises stress. limit_load: None if it was not requested. required: the
    safety factor against yield that the study requires. joint_growth: the largest ratio by which
    the stress, or a transverse force on the pin, grows over the range of the joint.
    """

    peak: Maximum
    limit_load: LimitLoad | None = None
    required: float | None = None
    joint_growth: float = 1.0


@dataclass(frozen=True)
class PinFatigue:
    """The fatigue damage of a pin under the study's spectrum, over all load cases.

    points: the critical points, the worst first. life: the life that the study requires, in `unit`s
    of the spectrum; None if it requires none. method: the method of the equivalent stress. needs:
    what is missing, where the damage is not decided.
    """

    points: tuple[PointFatigue, ...]
    life: float | None
    unit: str
    method: str
    needs: str = ""


@dataclass(frozen=True)
class Situation:
    """A pin in a load case, or in all cases of a spectrum: all data that a check may read.

    profile: the pin with a band for each lug of the structure; None for a body from a file.
    material: of the pin. loads: the loads on all loaded bands, in equilibrium or reacted by
    `clamps`. complete: false where the forces of the structure's lugs are unknown; `loads` are then
    those of the links only. lugs: the lugs that the study describes. sized: those whose outer
    diameter it states. replaceable: whether the pin is meant to be replaced.

    joint: the section forces of the joint model, if the pin is supported by one. even_governs:
    whether bending and shear checks take the evenly distributed loads of the formulas even so.
    simple: the loads by the statics of the formulas, where those of the joint differ. over_joint:
    the ratio of the largest section forces over the uncertain properties of the joint to those of
    the joint as stated. lug_growth: the same ratio of the force on each lug, by connection, for
    lugs that share forces which statics does not determine.

    section_forces: the section forces with which the check is made now (assess.checks). chosen:
    whether these are the section forces that the study chooses; the others are for comparison.
    governs: whether margins with them count.

    row: the results of the pin in this load case. fatigue: the results over all load cases.

    codes: the sets of checks that the study chooses (assess.checks). required: the bearing and
    shear checks, with their levels, that the study requires of the pin under any code.
    design_factor: N_d of ASME BTH-1. partial: the partial factors of EN 1993-1-8. aisc: the design
    method of ANSI/AISC 360. bending_factor: the ratio of the modulus of rupture of the pin to its
    ultimate strength. lug_factors: the efficiency factors of lugs, by connection. lug_stresses:
    the stresses of lugs whose shank is known. lug_collapses: the collapse loads of lugs.
    shank_angles: the directions of the known shanks, by connection.
    """

    profile: Pin | None
    material: Material
    loads: PinLoads = NO_LOADS
    clamps: tuple[str, ...] = ()
    lugs: tuple[Lug, ...] = ()
    factors: LoadFactors = LoadFactors()
    replaceable: bool = False
    joint: JointForces | None = None
    even_governs: bool = False
    simple: PinLoads | None = None
    over_joint: float = 1.0
    lug_growth: Mapping[str, float] = field(default_factory=dict)
    sized: tuple[Lug, ...] = ()
    complete: bool = True
    section_forces: SectionForces | None = None
    chosen: bool = True
    governs: bool = True
    row: SolvedRow | None = None
    fatigue: PinFatigue | None = None
    codes: tuple[Code, ...] = DEFAULT_CODES
    required: frozenset[tuple[RequiredCheck, Level]] = frozenset()
    design_factor: float | None = None
    partial: PartialFactors = RECOMMENDED
    aisc: AiscDesign = "LRFD"
    bending_factor: float | None = None
    lug_factors: Mapping[str, LugFactors] = field(default_factory=dict)
    lug_stresses: tuple[LugStress, ...] = ()
    lug_collapses: tuple[LugCollapse, ...] = ()
    shank_angles: Mapping[str, ShankAngle] = field(default_factory=dict)

    def factors_of(self, connection: str) -> LugFactors:
        """Return the efficiency factors of a lug; all of them None where the study gives none."""
        return self.lug_factors.get(connection, LugFactors())

    @property
    def pin(self) -> Pin:
        """The profile of the pin.

        Raises: ArgumentError for a body from a file, which only checks that take results can check.
        """
        if self.profile is None:
            raise ArgumentError("a body from a file has no profile", "no-profile")
        return self.profile

    @property
    def forces(self) -> SectionForces:
        """The section forces. Raises: ArgumentError in a check that does not take them."""
        if self.section_forces is None:
            raise ArgumentError("the check must take section forces", "no-section-forces")
        return self.section_forces

    def most_used(self, used: Floats) -> tuple[int, ...]:
        """Return the numbers of the instant and the section with the largest utilisation.

        used: (T, S) utilisations. Among equal values, as on both sides of the face of a link, the
        section inside the link is preferred.
        """
        return first_largest(used, np.isin(self.forces.labels, self.loads.surfaces))

    @property
    def by_formula(self) -> PinLoads:
        """The loads from which the formulas compute section forces."""
        return self.loads if self.simple is None else self.simple

    @property
    def on_bands(self) -> PinLoads:
        """The loads for the checks of bearing pressure and double shear on the bands."""
        return self.by_formula if self.even_governs else self.loads

    @cached_property
    def balanced(self) -> bool:
        """Whether the loads `by_formula` leave no transverse couple for the bands to share."""
        if self.clamps:
            return True
        left = out_of_balance(self.pin, self.by_formula)
        return left.couple <= MAX_LEFT_COUPLE * left.largest * self.pin.length

    @property
    def joint_governs(self) -> bool:
        """Whether the section forces of the joint govern.

        They do even where even loads are requested, if these leave an unbalanced couple, since even
        loads omit the couples of the lugs.
        """
        return self.joint is not None and not (self.even_governs and self.balanced)

    @property
    def across(self) -> Floats:
        """The magnitude of the transverse force on each of C bands, (T, C) N."""
        return np.asarray(np.hypot(self.loads.forces[..., 0], self.loads.forces[..., 1]))

    @property
    def loaded_across(self) -> bool:
        """Whether a force, a moment or the weight of the pin acts transverse to its axis."""
        loads = self.loads
        return any(bool(x[..., :2].any()) for x in (loads.forces, loads.moments, loads.body))

    def lug(self, band: str) -> Lug | None:
        """Return the lug in which a band sits; None if the study does not describe it."""
        return next((lug for lug in self.lugs if lug.connection == band), None)


def with_supports(pin: Pin, loads: PinLoads, structure: Sequence[str]) -> PinLoads | None:
    """Return the loads with the forces of the structure's lugs added.

    The forces follow from the equilibrium of transverse forces and moments, so there must be two
    lugs; None if there is another number. The weight of the pin is not included: tractions for the
    residual imbalance carry it.

    structure: the names of the lugs' bands. If empty, the loads are returned unchanged.
    """
    if not structure:
        return loads
    if len(structure) != SUPPORT_COUNT:
        return None
    first, second = (pin.band(name).middle for name in structure)
    middles = np.array([pin.band(name).middle for name in loads.surfaces])
    force = loads.forces[:, :, :2]
    # Moment about the first support, of the forces and of the couples, for the x and y directions.
    couple = np.stack([loads.moments[..., 1], -loads.moments[..., 0]], axis=-1)
    moment = (force * (middles - first)[:, None] + couple).sum(axis=1)
    at_second = -moment / (second - first)
    at_first = -force.sum(axis=1) - at_second
    return _with_forces(loads, structure, np.stack([at_first, at_second], axis=1))


def with_solved(loads: PinLoads, structure: Sequence[str], joint: JointForces) -> PinLoads:
    """Return the loads, at the instants of the joint model, with the forces of the structure's lugs
    from the joint model added.
    """
    own = [joint.lugs.index(name) for name in structure]
    return _with_forces(loads, structure, joint.forces[:, own])


def _with_forces(loads: PinLoads, structure: Sequence[str], across: Floats) -> PinLoads:
    """Return loads with forces added on the bands of the structure's lugs.

    across: (T, S, 2) transverse forces of the structure's lugs on the pin, N.
    """
    added = np.concatenate([across, np.zeros((*across.shape[:2], 1))], axis=2)
    none = np.zeros_like(added)
    return replace(
        loads,
        surfaces=(*loads.surfaces, *structure),
        forces=np.concatenate([loads.forces, added], axis=1),
        moments=np.concatenate([loads.moments, none], axis=1),
    )
