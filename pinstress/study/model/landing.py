"""The drop of a landing leg, and the point of its mechanism that touches the ground."""

from __future__ import annotations

from loads import Law, Linkage, LinkageError, StateDrive
from loads.landing import (
    DROP_RULES,
    Drop,
    GasSpring,
    Landing,
    LandingError,
    Levered,
    LinearSpring,
    Oil,
    PowerTyre,
    Strut,
    TableTyre,
    Telescopic,
    Touchdown,
    Wheel,
    axes,
    effective_mass,
    land,
    required_velocity,
    travel,
)
from pinbase.errors import ArgumentError, NumberInSI
from pinbase.keys import key_part
from pinstress.study.model.mechanism.drives import state
from pinstress.study.model.mechanism.linkage import linkage
from pinstress.study.model.mechanism.masses import STANDARD_GRAVITY
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study
from pinstress.study.schema.landing import AtWheel, DropCase, StrutTable, TyreTable

# Relative to the mechanism's unsprung mass, which changes by about as much along a stroke
UNSPRUNG_MASS_TOLERANCE = 0.1


def place(study: Study, name: str, case: AtWheel, mechanism: Linkage) -> Touchdown:
    """Return the point on which the ground pushes, with its axes and the extended position of the
    leg.

    Raises: InputError.
    """
    try:
        assert isinstance(case.forward, str)
        up, aft = axes(mechanism, case.forward)
    except ArgumentError as error:
        raise study.error(f"case.{key_part(name)}: {error}", code=error.code) from None
    strut = getattr(case, "strut", None)
    number = None if strut is None else mechanism.driven.index(strut.drive)
    extended = tuple(value for value, _, _ in state(study, name, case, mechanism))
    return Touchdown(case.body, case.joint, up, aft, number, extended)


def drop(study: Study, name: str, case: DropCase, mechanism: Linkage) -> tuple[Drop, Touchdown]:
    """Return a leg ready to drop, and the point on which the ground pushes.

    Raises: InputError, LinkageError.
    """
    where = place(study, name, case, mechanism)
    key = f"case.{key_part(name)}.strut"
    try:
        strut = None if case.strut is None else _strut(case.strut)
        rises: Telescopic | Levered = Telescopic()
        if case.strut is not None:
            rises = travel(mechanism, where, case.strut.stroke)
        key = f"case.{key_part(name)}.tyre"
        tyre = _tyre(case.tyre)
        key = f"case.{key_part(name)}"
        unsprung = case.unsprung or _unsprung(case, mechanism, where)
        return _drop(case, mechanism, strut, rises, tyre, unsprung), where
    except ArgumentError as error:
        raise study.error(f"{key}: {error.told(study.system.told)}", code=error.code) from None


def _unsprung(case: DropCase, mechanism: Linkage, where: Touchdown) -> float:
    """Return the unsprung mass of the mechanism, kg.

    Raises: ArgumentError if it has none.
    """
    if case.strut is None:
        raise ArgumentError(
            "give unsprung: without a strut nothing in the mechanism moves with the axle",
            "no-unsprung",
        )
    mass = effective_mass(mechanism, where, case.strut.stroke)
    if mass <= 0.0:
        raise ArgumentError(
            "give unsprung, or masses of the bodies that move with the axle: the mechanism has "
            "none",
            "no-unsprung",
        )
    return mass


def unsprung_warnings(study: Study) -> list[str]:
    """Return a warning for every drop whose stated unsprung mass differs from that of its
    mechanism.
    """
    drops = {n: c for n, c in study.table.case.items() if isinstance(c, DropCase)}
    warnings = []

    def told(mass: float) -> str:
        return study.system.told(NumberInSI(mass, "mass"))

    for name, case in drops.items():
        if case.unsprung is None or case.strut is None:
            continue
        try:
            mechanism = linkage(study)
            mass = effective_mass(mechanism, place(study, name, case, mechanism), case.strut.stroke)
        except (InputError, LinkageError, ArgumentError):
            continue  # the error is reported where the case is computed
        if abs(case.unsprung - mass) > UNSPRUNG_MASS_TOLERANCE * mass:
            text = (
                f"case.{key_part(name)}.unsprung: {told(case.unsprung)} is stated, but the "
                f"mechanism's bodies move with the axle like {told(mass)}; the stated mass is "
                "used for the fall, the bodies' for the forces in the leg. Remove it to use that "
                "of the mechanism, or correct the masses"
            )
            warnings.append(str(study.error(text)))
    return warnings


def _drop(
    case: DropCase,
    mechanism: Linkage,
    strut: Strut | None,
    rises: Telescopic | Levered,
    tyre: PowerTyre | TableTyre,
    unsprung: float,
) -> Drop:
    g = (mechanism.gravity[0] ** 2 + mechanism.gravity[1] ** 2) ** 0.5
    mass = case.mass if case.mass is not None else (case.weight or 0.0) / STANDARD_GRAVITY
    if unsprung >= mass:
        raise ArgumentError(
            [
                "unsprung, ",
                NumberInSI(unsprung, "mass"),
                ", is part of the mass on the leg, ",
                NumberInSI(mass, "mass"),
                ", and must be smaller",
            ],
            "unsprung-too-large",
        )
    rule = None if case.rule is None else DROP_RULES[case.rule]
    velocity = case.velocity
    if velocity is None:
        assert case.rule is not None
        velocity = required_velocity(case.rule, case.wing_loading)
    lift = case.lift if case.lift is not None else (0.0 if rule is None else rule.lift)
    return Drop(
        sprung=mass - unsprung,
        unsprung=unsprung,
        velocity=velocity,
        tyre=tyre,
        strut=strut,
        wheel=_wheel(case, unsprung),
        lift=lift,
        gravity=g,
        duration=case.duration,
        travel=rises,
    )


def _strut(table: StrutTable) -> Strut:
    spring: GasSpring | LinearSpring
    if table.gas is not None:
        spring = GasSpring(**dict(table.gas))
    else:
        assert table.spring is not None
        spring = LinearSpring(**dict(table.spring))
    oil = None if table.oil is None else Oil(**dict(table.oil))
    return Strut(spring, table.stroke, oil, table.friction)


def _tyre(table: TyreTable) -> PowerTyre | TableTyre:
    if table.at is not None:
        deflection, force = table.at
        return PowerTyre(force / deflection**table.exponent, table.exponent, table.damping)
    return TableTyre(tuple(table.deflection or ()), tuple(table.force or ()), table.damping)


def _wheel(case: DropCase, unsprung: float) -> Wheel | None:
    w = case.wheel
    if w is None:
        return None
    mass = unsprung if w.mass is None else w.mass
    return Wheel(w.inertia, w.radius, w.speed, w.friction, w.stiffness, mass, w.damping)


def fallen(study: Study, name: str, leg: Drop) -> Landing:
    """Return the course of the drop.

    Raises: InputError if the strut bottoms, the tyre is deflected too far, or the drop cannot be
    computed.
    """
    try:
        return land(leg)
    except LandingError as error:
        told = error.told(study.system.told)
        raise study.error(f"case.{key_part(name)}: {told}", code=error.code) from None


def drop_note(study: Study, case: DropCase, leg: Drop) -> str:
    """Return the clause of a drop, and its unsprung mass if that follows from the mechanism."""
    clause = "" if case.rule is None else f"{DROP_RULES[case.rule].clause}."
    if case.unsprung is not None:
        return clause
    unsprung = study.system.told(NumberInSI(leg.unsprung, "mass"))
    return f"{clause} Unsprung mass {unsprung}, of the mechanism's bodies.".strip()


def still(where: Touchdown) -> list[Law]:
    """Return laws that keep all drives in the position with the strut extended."""
    return [StateDrive(value) for value in where.extended]
