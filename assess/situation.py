"""What a check is made of: a pin with its lugs and loads in a case, and what was solved of it."""

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

MAX_LEFT_COUPLE = 0.01  # couple that balance leaves, of the largest force times the pin's length
SUPPORT_COUNT = 2  # lugs of a structure whose forces follow from equilibrium
NO_LOADS = PinLoads("", (), np.zeros((1, 0, 3)))


ForcesKind = Literal["even", "concentrated", "joint"]
# The property of a section by which a nominal stress is the moment, or the shear force, over it.
Resists = Literal["area", "axis_area", "modulus"]


@dataclass(frozen=True)
class LoadFactors:
    """Factors on the loads of a study: at limit load (against yield), at ultimate load (against
    rupture and collapse), and of fittings, which multiplies both. fitting_stated: whether the study
    states the last, which then replaces that of a code.

    Source: 14 CFR 25.301 and 25.303 (limit and ultimate loads), 25.625 (fitting factor).
    """

    limit: float = 1.0
    ultimate: float = 1.5
    fitting: float = 1.0
    fitting_stated: bool = False

    def of_code(self, code: Code) -> LoadFactors:
        """The factors with the fitting factor of a code where the study states none."""
        demanded = FITTING_FACTORS.get(code)
        if demanded is None or self.fitting_stated:
            return self
        return replace(self, fitting=demanded)

    def at(self, level: Level) -> float:
        """The factor on demands at a level."""
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
    """Shear force and bending moment along a pin, by one way of finding them.

    z: of S stations, (S,) m. sections, labels: the round section and the name of the segment at
    each. shear, moment: at T instants, (T, S) N and N m; axial, torque: the size of the axial force
    and of the torque, likewise. times: (T,) s, None without a motion.
    basis: where the forces come from. kind: the same for programs. exact: finds the largest nominal
    stress between the stations, too, where the diagrams are polynomials.
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
        """A property of the sections, (S,)."""
        return np.array([getattr(section, name) for section in self.sections])

    def mean_shear(self) -> NominalStress:
        """The largest mean shear stress V / A."""
        return self._largest("area")

    def neutral_axis_shear(self) -> NominalStress:
        """The largest shear stress at the neutral axis, V Q / (I t)."""
        return self._largest("axis_area")

    def bending(self) -> NominalStress:
        """The largest elastic bending stress M c / I."""
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
    """The solution of a pin in a case, as far as checks read it.

    peak: the maximum von Mises stress. limit_load: None where it was not requested. required: the
    safety factor against yield that the study asks for. joint_growth: the most by which the stress
    or a force across the pin grows over the range of the joint.
    """

    peak: Maximum
    limit_load: LimitLoad | None = None
    required: float | None = None
    joint_growth: float = 1.0


@dataclass(frozen=True)
class PinFatigue:
    """The damage of a pin under the study's spectrum, over all cases.

    points: its critical points, the worst first. life: that the study requires, in `unit`s of the
    spectrum; None where it requires none. method: of the equivalent stress. needs: what is missing
    where damage is not decided.
    """

    points: tuple[PointFatigue, ...]
    life: float | None
    unit: str
    method: str
    needs: str = ""


@dataclass(frozen=True)
class Situation:
    """A pin in a case, or in all cases of a spectrum: all that a check may read.

    profile: the pin with a band for each lug of a structure; None for a body from a file. material:
    of the pin. loads: on all bands that carry, in balance or with `clamps`; if not `complete`, only
    on those of links, as the forces of a structure's lugs are not known. lugs: those that the study
    gives; sized: those of them whose outer diameter it gives. replaceable: whether the pin is meant
    to be replaced.

    joint: section forces by the joint model, if one supports the pin. even_governs: whether checks
    of bending and shear take the even loads of the formulas all the same. simple: the loads by the
    statics of formulas, where those of the joint differ. over_joint: the largest section forces of
    the joint model over the uncertain properties of the joint, over its own. lug_growth: the same
    of the forces on lugs that share what statics does not decide.

    section_forces: with which the check is made now (assess.checks). chosen: whether these are the
    ones that the study chooses; others are beside them. governs: whether margins with them count.

    row: what was solved of the pin in this case; fatigue: over all cases.

    codes: the sets of checks that the study chooses (assess.checks). required: the checks of
    bearing and shear, with their levels, that it requires of the pin under any code.
    design_factor: N_d of ASME BTH-1. partial: factors of EN 1993-1-8. aisc: the way of design by
    ANSI/AISC 360. bending_factor: the modulus of rupture of the pin over its ultimate strength.
    lug_factors: efficiency factors of lugs, by connection. lug_stresses: of those whose shank is
    known; shank_angles: the directions of these shanks, by connection.
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
        """The efficiency factors of a lug."""
        return self.lug_factors.get(connection, LugFactors())

    @property
    def pin(self) -> Pin:
        """The profile. Raises: ArgumentError for a body from a file, of which only checks that take
        results can be made.
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
        """The instant and the section of the largest use (T, S).

        Of sections used alike, as on both sides of a face of a link, that in the link goes first.
        """
        return first_largest(used, np.isin(self.forces.labels, self.loads.surfaces))

    @property
    def by_formula(self) -> PinLoads:
        """The loads of which formulas make section forces."""
        return self.loads if self.simple is None else self.simple

    @property
    def on_bands(self) -> PinLoads:
        """The loads with which the pressure and the double shear of bands are checked."""
        return self.by_formula if self.even_governs else self.loads

    @cached_property
    def balanced(self) -> bool:
        """Whether these loads leave no couple across the pin that its bands would have to share."""
        if self.clamps:
            return True
        left = out_of_balance(self.pin, self.by_formula)
        return left.couple <= MAX_LEFT_COUPLE * left.largest * self.pin.length

    @property
    def joint_governs(self) -> bool:
        """Whether section forces of the joint govern: also beside even loads that are requested,
        where these leave out the couples of lugs.
        """
        return self.joint is not None and not (self.even_governs and self.balanced)

    @property
    def across(self) -> Floats:
        """The size of the force across the pin on each of C bands, (T, C) N."""
        return np.asarray(np.hypot(self.loads.forces[..., 0], self.loads.forces[..., 1]))

    @property
    def loaded_across(self) -> bool:
        """Whether a force, a moment or the weight of the pin acts across it."""
        loads = self.loads
        return any(bool(x[..., :2].any()) for x in (loads.forces, loads.moments, loads.body))

    def lug(self, band: str) -> Lug | None:
        """The lug in which a band sits, if it was given."""
        return next((lug for lug in self.lugs if lug.connection == band), None)


def with_supports(pin: Pin, loads: PinLoads, structure: Sequence[str]) -> PinLoads | None:
    """The loads with the forces of the lugs of a structure, by equilibrium of forces and moments
    across the pin; None unless there are two. Without the weight of the pin, which the closing
    tractions of a balance carry.
    """
    if not structure:
        return loads
    if len(structure) != SUPPORT_COUNT:
        return None
    first, second = (pin.band(name).middle for name in structure)
    middles = np.array([pin.band(name).middle for name in loads.surfaces])
    force = loads.forces[:, :, :2]
    # About the first support, of forces and of couples, along x and y.
    couple = np.stack([loads.moments[..., 1], -loads.moments[..., 0]], axis=-1)
    moment = (force * (middles - first)[:, None] + couple).sum(axis=1)
    at_second = -moment / (second - first)
    at_first = -force.sum(axis=1) - at_second
    return _with_forces(loads, structure, np.stack([at_first, at_second], axis=1))


def with_solved(loads: PinLoads, structure: Sequence[str], joint: JointForces) -> PinLoads:
    """The loads, at the joint's instants, with the forces of a structure's lugs as the joint model
    has them.
    """
    own = [joint.lugs.index(name) for name in structure]
    return _with_forces(loads, structure, joint.forces[:, own])


def _with_forces(loads: PinLoads, structure: Sequence[str], across: Floats) -> PinLoads:
    """across: of the structure's lugs on the pin, (T, S, 2) N."""
    added = np.concatenate([across, np.zeros((*across.shape[:2], 1))], axis=2)
    none = np.zeros_like(added)
    return replace(
        loads,
        surfaces=(*loads.surfaces, *structure),
        forces=np.concatenate([loads.forces, added], axis=1),
        moments=np.concatenate([loads.moments, none], axis=1),
    )
