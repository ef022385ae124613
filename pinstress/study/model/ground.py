"""Loads of the ground on a wheel as multiples of a reference load, by 14 CFR or by the user."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from loads import Applied, Law, Linkage
from loads.landing import (
    GROUND_RULES,
    GroundedWheel,
    Landing,
    WheelForce,
    at_deflection,
    spin_up_drag,
)
from loads.landing.requirements import MAX_TYRE_FRICTION, GroundRule
from loads.space.acting import SpaceForce
from loads.space.linkage import SpaceLinkage, Vector
from loads.space.out_of_plane import SideLoad
from pinbase.errors import NumberInSI
from pinbase.keys import key_part
from pinstress.study.model.landing import drop, fallen, place, still
from pinstress.study.model.mechanism.sideways import axle_height
from pinstress.study.model.mechanism.space import place as place_in_space
from pinstress.study.model.mechanism.space import space_mechanism
from pinstress.study.model.space_forces import vector
from pinstress.study.reading.file import Study
from pinstress.study.schema.landing import DropCase, FactorTable, GroundCase, Side, SpinUpTable

MIN_LEVEL = 1e-6  # the least horizontal part of a direction of travel, relative to its length
AS_STATED = (
    "The leg is as drawn, or as its position says: without a drop the deflection of strut and "
    "tyres is not known."
)


@dataclass(frozen=True)
class Grounded:
    """The forces of the ground in a case.

    clause: the rule that demands them.
    forces: their components; empty if the reference is a drop that was not computed.
    notes: the origin of the spin-up drag, and what is not known.
    drives: the laws that hold the leg at rest.
    """

    clause: str
    forces: tuple[WheelForce, ...]
    notes: tuple[str, ...]
    drives: tuple[Law, ...]

    def loads(self, study: Study, case: GroundCase, mechanism: Linkage) -> tuple[SideLoad, ...]:
        """Return the forces on the axle, with their moments about it."""
        at = mechanism.joint(case.joint).at
        z = axle_height(study, case.body, case.joint)
        return tuple(
            SideLoad(
                Applied(case.body, at, force.force[:2], force.couple[2]),
                z,
                force.force[2],
                force.couple[:2],
            )
            for force in self.forces
        )

    def loads_in_space(self, study: Study, case: GroundCase) -> tuple[SpaceForce, ...]:
        """Return the forces on the axle of a linkage in space, with their moments about it."""
        at = place_in_space(space_mechanism(study), case.at)
        return tuple(SpaceForce(case.body, at, force.force, force.couple) for force in self.forces)

    def note(self, study: Study) -> str:
        """Return the clause and the product behind every component."""
        if not self.forces:
            return ""
        unit, factor = study.system.force, study.system.factor("force")
        sums = [
            f"{f.component} {f.factor:.4g} × {_digits(f.reference / factor)} = "
            f"{_digits(f.factor * f.reference / factor)} {unit} {f.towards}, at the {f.place}"
            for f in self.forces
        ]
        parts = f"{self.clause}: {'; '.join(sums)}.", *self.notes
        return " ".join(filter(None, parts))


def _digits(value: float) -> str:
    """Return a number with at least four digits and without an exponent: "33,750"."""
    return f"{value:,.0f}" if abs(value) >= 1000.0 else f"{value:.4g}"


def grounded(
    study: Study, name: str, case: GroundCase, mechanism: Linkage, extremes: bool
) -> Grounded:
    """Return the forces of the ground in a case.

    extremes: whether to compute a drop that is the reference; otherwise such a case has no forces.

    Raises: InputError, LinkageError.
    """
    where, rule = place(study, name, case, mechanism), _rule(case)
    drives: tuple[Law, ...] = tuple(still(where))
    row = case.factors[0] if case.factors else None
    reference, spin_up = _own_reference(case, row), case.spin_up
    by_drop = reference is None
    if reference is None:
        assert case.drop is not None
        if not extremes:
            return Grounded(rule.clause, (), (), drives)
        of = study.table.case[case.drop]
        assert isinstance(of, DropCase)
        leg, touchdown = drop(study, case.drop, of, mechanism)
        landing = fallen(study, case.drop, leg)
        peak = landing.peaks["vertical"]
        reference, spin_up = peak.value, spin_up or _spin_up(landing)
        drives = at_deflection(landing, touchdown, peak.time, rule.deflection)
    up, aft = (*where.up, 0.0), (*where.aft, 0.0)
    forces, notes = _forces(study, case, rule, (reference, spin_up, by_drop), (up, aft))
    return Grounded(rule.clause, forces, notes, drives)


def grounded_in_space(
    study: Study, name: str, case: GroundCase, mechanism: SpaceLinkage
) -> Grounded:
    """Return the forces of the ground in a case of a linkage in space.

    Raises: InputError if the directions of up and forward are unknown.
    """
    rule, row = _rule(case), case.factors[0] if case.factors else None
    reference, up = _own_reference(case, row), -np.array(mechanism.gravity)
    assert reference is not None
    ahead = np.array(case.forward, dtype=float)
    if not (size := float(np.linalg.norm(up))):
        text = "gravity says where up is: give mechanism.gravity"
        raise study.error(f"case.{key_part(name)}: {text}", code="no-gravity")
    up /= size
    level = ahead - (ahead @ up) * up
    if np.linalg.norm(level) <= MIN_LEVEL * np.linalg.norm(ahead):
        text = "is vertical, along gravity; give the direction of travel"
        raise study.error(f"case.{key_part(name)}.forward: {text}", code="no-direction")
    axes = vector(up.tolist()), vector((-level / np.linalg.norm(level)).tolist())
    forces, notes = _forces(study, case, rule, (reference, case.spin_up, False), axes)
    return Grounded(rule.clause, forces, notes, ())


def _forces(
    study: Study,
    case: GroundCase,
    rule: GroundRule,
    known: tuple[float, SpinUpTable | None, bool],
    axes: tuple[Vector, Vector],
) -> tuple[tuple[WheelForce, ...], tuple[str, ...]]:
    """Return the forces of a rule, and notes.

    known: the reference, N, the data of the wheel's spin-up, and whether both are from a drop.
    axes: up and aft.
    """
    (reference, spin_up, by_drop), row = known, case.factors[0] if case.factors else None
    rule, spin = _with_spin(study, rule, spin_up, reference)
    notes = (spin,) if rule.deflection == 1.0 or by_drop else (spin, AS_STATED)
    braked = row is not None and row.braked
    wheel = GroundedWheel(*axes, case.stands, case.radius, braked)
    return wheel.forces(rule, reference, _side(case, row)), notes


def _rule(case: GroundCase) -> GroundRule:
    if case.rule is not None:
        return GROUND_RULES[case.rule]
    (row,) = case.factors
    base = "reference load"
    return GroundRule(row.clause, row.vertical, row.drag, row.side, base, row.deflection)


def _own_reference(case: GroundCase, row: FactorTable | None) -> float | None:
    stated = None if row is None else row.reference
    return stated if stated is not None else case.reference


def _side(case: GroundCase, row: FactorTable | None) -> Side:
    stated = None if row is None else row.toward
    return stated or case.toward or ("left" if case.stands == "nose" else "inboard")


def _spin_up(landing: Landing) -> SpinUpTable | None:
    wheel, peak = landing.drop.wheel, landing.peaks["vertical"]
    if wheel is None:
        return None
    return SpinUpTable.model_construct(
        inertia=wheel.inertia, radius=wheel.radius, speed=wheel.speed, time=peak.time
    )


def _with_spin(
    study: Study, rule: GroundRule, wheel: SpinUpTable | None, reference: float
) -> tuple[GroundRule, str]:
    """Return a rule with the spin-up drag of its wheel, and a sentence on its origin."""
    if not rule.spins:
        return rule, ""
    most = f"the most that is required, {MAX_TYRE_FRICTION:g} of the vertical reaction"
    if wheel is None:
        return rule, f"The drag is {most}, as no wheel is given (spin_up, or wheel of the drop)."
    drag = spin_up_drag(wheel.inertia, wheel.radius, wheel.speed, reference, wheel.time)
    if drag >= MAX_TYRE_FRICTION * reference:
        return rule, f"The spin-up drag sqrt(2 I v n F / t) / r is more: it is {most}."
    inertia, speed, radius = (
        study.system.told(NumberInSI(getattr(wheel, key), dimension))
        for key, dimension in (("inertia", "inertia"), ("speed", "velocity"), ("radius", "length"))
    )
    shown = f"I = {inertia}, v = {speed}, n = {MAX_TYRE_FRICTION:g}"
    shown += f", t = {wheel.time:.4g} s, r = {radius}"
    sign = 1.0 if rule.drag > 0.0 else -1.0
    part = sign * drag / reference
    return replace(rule, drag=part), f"Spin-up drag sqrt(2 I v n F / t) / r with {shown}."
