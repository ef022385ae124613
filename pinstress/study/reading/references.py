"""References by name within a study: each must exist."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import partial

from assess.fatigue.flight import flight
from assess.requirement import LEVELS_OF_CHECK
from pinbase.errors import ArgumentError
from pinstress.study.reading.errors import Wrong
from pinstress.study.reading.materials import library
from pinstress.study.schema.cases import (
    ApplyTable,
    GivenCase,
    InstantCase,
    LegCase,
    MotionCase,
    StaticCase,
)
from pinstress.study.schema.fatigue import FatigueTable
from pinstress.study.schema.landing import AtWheel, DropCase, GroundCase
from pinstress.study.schema.lugs import LugTable
from pinstress.study.schema.mechanism import (
    MechanismTable,
    RotaryDrive,
    SliderDrive,
    drive_name,
)
from pinstress.study.schema.pins import MaterialTable
from pinstress.study.schema.require import level_of
from pinstress.study.schema.shown import as_text, in_toml, near
from pinstress.study.schema.tables import StudyTable


def cross_references(table: StudyTable) -> Iterator[Wrong]:
    """Yield the references to things that do not exist."""
    bears: dict[str, str] = {}
    common = _materials(table.lug_defaults or LugTable())
    for at, made_of in common.items():
        yield from _known(f"lug_defaults.{at}", "material", made_of, table.material)
    for name, pin in table.pin.items():
        yield from _known(f"pin.{name}.material", "material", pin.material, table.material)
        surfaces = dict.fromkeys(connection for _, connection in pin.connections)
        surfaces |= dict.fromkeys(s.name for s in pin.profile or () if s.name)
        surfaces |= dict.fromkeys(pin.band)
        for connection, lug in pin.lug.items():
            key = f"pin.{name}.lug.{connection}"
            yield from _known(key, "connection or segment", connection, surfaces)
            for at, made_of in _materials(lug).items():
                if made_of not in common.values():
                    yield from _known(f"{key}.{at}", "material", made_of, table.material)
        for key, connection in pin.connections:
            if connection in bears:
                yield Wrong(
                    f"pin.{name}.{key}: connection {as_text(connection)} already bears on pin "
                    f"{bears[connection]}; a connection bears on one pin only",
                    code="duplicate-connection",
                )
            bears[connection] = name
        if pin.balance is not None:
            own = [connection for _, connection in pin.connections]
            yield from _known(f"pin.{name}.balance", "connection of the pin", pin.balance, own)
    yield from _of_bearing(table)
    limited = table.analysis.limit_load
    for pin_name in limited if isinstance(limited, list) else ():
        yield from _known("analysis.limit_load", "pin", pin_name, table.pin)
    yield from _of_cases(table, bears)
    yield from _of_requirements(table)
    yield from _of_sequences(table)
    if table.mechanism is not None:
        yield from _of_pins(table, table.mechanism, bears)
        yield from _of_mechanism(table.mechanism)
        yield from _of_its_cases(table, table.mechanism)
    if table.fatigue is not None:
        yield from _of_fatigue(table, table.fatigue)
    for key, check, pools in (
        ("beam_check", table.beam_check, (("pin", table.pin), ("case", table.case))),
        ("motion_check", table.motion_check, (("case", table.case),)),
    ):
        for field, pool in pools:
            if check is not None:
                yield from _known(f"{key}.{field}", field, getattr(check, field), pool)


def _materials(lug: LugTable) -> dict[str, str]:
    """Return the materials that a lug names, by their keys."""
    bushing = {} if lug.bushing is None else {"bushing.material": lug.bushing.material}
    return bushing if lug.material is None else {"material": lug.material, **bushing}


def _of_bearing(table: StudyTable) -> Iterator[Wrong]:
    """Yield errors for bearing strengths with which no pressure is compared.

    They belong to materials of no pin on which a link bears, and of no lug or bushing.
    """
    bears: set[str] = set()
    for pin in table.pin.values():
        lugs = pin.lug.values()
        bears |= {made_of for lug in lugs for made_of in _materials(lug).values()}
        if pin.connections or lugs:
            bears.add(pin.material)
    for name, material in table.material.items():
        if material.bearing_strength is not None and name not in bears:
            yield Wrong(
                f"material.{name}.bearing_strength: no lug bears on a pin of this material, and no "
                "lug or bushing is made of it; give pin.NAME.lug.CONNECTION.material, or remove "
                "this",
                code="bearing-strength-without-lug",
            )


def _known(where: str, what: str, name: str, names: Collection[str]) -> Iterator[Wrong]:
    if name not in names:
        if what == "material":
            names = [*names, *library()]
        code = f"unknown-{what.split()[-1]}"
        hint = partial(near, name, names)
        yield Wrong(f"{where}: no {what} {as_text(name)}; ", hint, code=code, name=name)


def _of_cases(table: StudyTable, bears: dict[str, str]) -> Iterator[Wrong]:
    for name, case in table.case.items():
        for pin in case.clamp:
            yield from _known(f"case.{name}.clamp", "pin", pin, table.pin)
        if isinstance(case, GivenCase):
            for key, given in (("forces", case.forces), ("moments", case.moments)):
                for connection in given or ():
                    what = "pin has a connection"
                    yield from _known(f"case.{name}.{key}", what, connection, bears)
                    borne = bears.get(connection)
                    if borne is not None and connection == table.pin[borne].balance:
                        yield Wrong(closed_message(f"case.{name}.{key}.{connection}", borne),
                                    code="balances-the-others")  # fmt: skip
            for file in case.tables:
                for connection in file.connections:
                    what = "pin has a connection"
                    yield from _known(f"case.{name}.table", what, connection, bears)
        elif isinstance(case, LegCase):
            if table.spatial_leg is None:
                yield Wrong(f"case.{name}: kind 'spatial_leg' needs a [spatial_leg]", code="no-leg")
        elif table.mechanism is None:
            yield Wrong(f"case.{name}: kind {case.kind!r} needs a [mechanism]", code="no-mechanism")


def closed_message(where: str, pin: str) -> str:
    """Return the message for a force that the study gives although it follows from others."""
    return f"{where}: follows from the other forces on pin {pin}, by pin.{pin}.balance; remove it"


def _of_sequences(table: StudyTable) -> Iterator[Wrong]:
    for name, sequence in table.sequence.items():
        if name in table.case:
            text = f"sequence.{name}: a case has this name too; rename one"
            yield Wrong(text, code="duplicate-case")
        for i, step in enumerate(sequence.steps, 1):
            where = f"sequence.{name}.steps[{i}]"
            yield from _known(f"{where}.case", "case", step.case, table.case)
            case = table.case.get(step.case)
            if isinstance(case, InstantCase):
                text = f"{where}.case: an instant of a motion does not last; name the motion"
                yield Wrong(text, code="not-in-sequences")
            elif isinstance(case, MotionCase | DropCase | LegCase) and step.duration is not None:
                text = f"{where}.duration: {as_text(step.case)} has its own time; remove this"
                yield Wrong(text, code="key-not-applicable")
            elif isinstance(case, StaticCase | GroundCase) and step.duration is None:
                text = f"{where}: {as_text(step.case)} is at rest; give its duration"
                yield Wrong(text, code="missing-key")


def _of_requirements(table: StudyTable) -> Iterator[Wrong]:
    """Yield errors unless pins and cases exist, the level fits the check, and there is one factor
    for each pin, case, check and level.
    """
    known: dict[tuple[str, str, str, str], int] = {}
    for i, require in enumerate(table.require, 1):
        where, level = f"require[{i}]", level_of(require)
        for what, names, pool in (
            ("pin", require.pins, table.pin),
            ("case", require.cases, table.case),
        ):
            for name in names or ():
                yield from _known(f"{where}.{what}s", what, name, pool)
        if level not in LEVELS_OF_CHECK[require.check]:
            fitting = " or ".join(map(in_toml, LEVELS_OF_CHECK[require.check]))
            text = f"{where}.level: {require.check} is not required at {level} load; use {fitting}"
            yield Wrong(text, code="level-without-check")
        cases: Iterable[str] = require.cases or table.case
        if require.check == "fatigue":
            cases = ("",)
            if require.cases:
                text = "fatigue is over all cases of the spectrum; remove this"
                yield Wrong(f"{where}.cases: {text}", code="key-not-applicable")
        keys = [(p, c, require.check, level) for p in require.pins or table.pin for c in cases]
        again = next((key for key in keys if known.get(key, i) != i), None)
        if again is not None:
            pin, case, check, _ = again
            yield Wrong(
                f"{where}: {check} of pin {pin}{f' in case {case}' if case else ''} is required at "
                f"{level} load by require[{known[again]}], too; name other pins or cases in one of "
                "them",
                code="duplicate-requirement",
            )
        known |= {key: i for key in keys if key not in known}


MATERIAL_TABLE_OF_METHOD = {
    "signed-von-mises": "fatigue",
    "critical-plane": "fatigue",
    "fkm-p-ram": "fkm",
}


def _of_fatigue(table: StudyTable, fatigue: FatigueTable) -> Iterator[Wrong]:
    """Yield errors unless the spectrum's cases exist and a pin's material has data for its
    method.
    """
    for case in fatigue.occurrences:
        known = {**table.case, **table.sequence}
        yield from _known(f"fatigue.occurrences.{case}", "case", case, known)
    try:
        flight([*fatigue.occurrences.values()])
    except ArgumentError as error:
        yield Wrong(f"fatigue.occurrences: {error}", code=error.code)
    if fatigue.method == "fkm-p-ram" and (fatigue.failure_probability or 0.0) > 0.5:
        text = 'fatigue.failure_probability: must be at most 0.5 for method "fkm-p-ram"'
        yield Wrong(text, code="out-of-range")
    needs, used = (
        MATERIAL_TABLE_OF_METHOD[fatigue.method],
        {pin.material for pin in table.pin.values()},
    )
    given = [name for name in used & table.material.keys() if getattr(table.material[name], needs)]
    if not given:
        yield Wrong(
            f"fatigue.method: {fatigue.method!r} needs material.NAME.{needs} of the material of a "
            "pin",
            code="no-fatigue-data",
        )
    for name in sorted(given):
        for key, value in _parameters(table.material[name], fatigue).items():
            if value is None:
                yield Wrong(f"material.{name}.{key} is missing", code="missing-key")


def _parameters(material: MaterialTable, fatigue: FatigueTable) -> dict[str, float | None]:
    """Return the further parameters of a method, by key."""
    ultimate = {"ultimate_strength": material.ultimate_strength}
    sn = material.fatigue
    if fatigue.method == "fkm-p-ram" or sn is None:
        return ultimate
    probability = fatigue.failure_probability
    scattered = probability not in (None, sn.failure_probability)
    scatter = {"fatigue.scatter": sn.scatter} if scattered else {}
    sensitivity = {"fatigue.mean_stress_sensitivity": sn.mean_stress_sensitivity}
    if fatigue.method == "critical-plane":
        return sensitivity | scatter
    walker = {"fatigue.walker_exponent": sn.walker_exponent}
    rules = {"fkm": sensitivity, "goodman": ultimate, "walker": walker}
    return rules.get(sn.mean_stress, {}) | scatter


def _of_pins(
    table: StudyTable, mechanism: MechanismTable, bears: dict[str, str]
) -> Iterator[Wrong]:
    have = dict.fromkeys(c for joint in mechanism.joint.values() for c in joint.connections)
    if all(isinstance(case, GivenCase | LegCase) for case in table.case.values()):
        return
    for connection, pin in bears.items():
        if connection not in have:
            text = f"pin.{pin}: connection {as_text(connection)} is not in the mechanism; "
            hint = partial(near, connection, have)
            yield Wrong(text, hint, code="unknown-connection", name=connection)


def named_joints(mechanism: MechanismTable) -> Iterator[tuple[str, str]]:
    """Yield every key below [mechanism] that names a joint, with the name."""
    for name, slider in mechanism.slider.items():
        for joint in slider.joints:
            if isinstance(joint, str):
                yield f"slider.{name}.joints", joint
    for name, body in mechanism.body.items():
        for joint in body.bar.joints if body.bar is not None else ():
            yield f"body.{name}.bar.joints", joint
    for i, drive in enumerate(mechanism.drive, 1):
        for joint in () if isinstance(drive, SliderDrive) else _lines(drive):
            yield f"drive[{i}].line" if len(mechanism.drive) > 1 else "drive.line", joint
    for name, point in mechanism.point.items():
        if isinstance(point.at, str):
            yield f"point.{name}.at", point.at
    for name, spring in mechanism.spring.items():
        for end in spring.joints or ():
            if isinstance(end, str):
                yield f"spring.{name}.joints", end
    for name, gear in mechanism.gear.items():
        for joint in gear.joints:
            yield f"gear.{name}.joints", joint
    for name, rack in mechanism.rack.items():
        yield f"rack.{name}.joint", rack.joint


def _lines(drive: RotaryDrive) -> tuple[str, ...]:
    return (drive.line or ()) + (drive.against_line or ())


def _of_mechanism(mechanism: MechanismTable) -> Iterator[Wrong]:
    bodies = dict.fromkeys(["ground", *mechanism.body])
    for name, joint in mechanism.joint.items():
        where = f"mechanism.joint.{name}"
        for origin in joint.origins:
            yield from _known(f"{where}.at", "joint", origin, mechanism.joint)
        if joint.fixed_in is not None:
            yield from _known(f"{where}.fixed_in", "body", joint.fixed_in, bodies)
        for connection, body in joint.connections.items():
            yield from _known(f"{where}.connections.{connection}", "body", body, bodies)
    for name, part in mechanism.body.items():
        where = f"mechanism.body.{name}.welded_to"
        yield from _known(where, "body", part.welded_to or "ground", bodies)
    for place, named in named_joints(mechanism):
        yield from _known(f"mechanism.{place}", "joint", named, mechanism.joint)
    for i, drive in enumerate(mechanism.drive, 1):
        where = "mechanism.drive" + (f"[{i}]" if len(mechanism.drive) > 1 else "")
        if isinstance(drive, SliderDrive):
            yield from _known(f"{where}.slider", "slider", drive.slider, mechanism.slider)
            continue
        yield from _known(f"{where}.body", "body", drive.body, bodies)
        yield from _known(f"{where}.against", "body", drive.against, bodies)
    for name, spring in mechanism.spring.items():
        where = f"mechanism.spring.{name}"
        if spring.slider is not None:
            yield from _known(f"{where}.slider", "slider", spring.slider, mechanism.slider)
        yield from _two_bodies(where, spring.bodies, bodies)
    for name, point in mechanism.point.items():
        yield from _known(f"mechanism.point.{name}.body", "body", point.body, mechanism.body)
    for name, stop in mechanism.stop.items():
        yield from _two_bodies(f"mechanism.stop.{name}", stop.bodies, bodies)
    for name, gear in mechanism.gear.items():
        yield from _two_bodies(f"mechanism.gear.{name}", gear.bodies, bodies)
    for name, rack in mechanism.rack.items():
        where = f"mechanism.rack.{name}"
        yield from _known(f"{where}.pinion", "body", rack.pinion, bodies)
        yield from _known(f"{where}.slider", "slider", rack.slider, mechanism.slider)
    for name, torsion in mechanism.torsion_spring.items():
        yield from _two_bodies(f"mechanism.torsion_spring.{name}", torsion.bodies, bodies)


def _two_bodies(
    where: str, pair: tuple[str, str] | None, bodies: Mapping[str, object]
) -> Iterator[Wrong]:
    for body in pair or ():
        yield from _known(f"{where}.bodies", "body", body, bodies)
    if pair is not None and pair[0] == pair[1]:
        text = f"{where}.bodies: {as_text(pair[0])} twice; name two different bodies"
        yield Wrong(text, code="same-body")


def _of_its_cases(table: StudyTable, mechanism: MechanismTable) -> Iterator[Wrong]:
    moves = all(d.moves for d in mechanism.drive)
    holders = dict.fromkeys([*map(drive_name, mechanism.drive), *mechanism.slider, *mechanism.stop])
    for name, case in table.case.items():
        for hold_name in (case.hold or ()) if isinstance(case, StaticCase) else ():
            what = "drive, slider or stop"
            yield from _known(f"case.{name}.hold", what, hold_name, holders)
        if isinstance(case, MotionCase) and not moves:
            yield Wrong(
                f"case.{name}: a motion needs start, end and duration in [mechanism.drive]",
                code="drive-without-motion",
            )
        for i, load in enumerate(getattr(case, "apply", ()), 1):
            where = f"case.{name}.apply[{i}]"
            yield from _known(f"{where}.body", "body", load.body, mechanism.body)
            if isinstance(load.at, str):
                yield from _known(f"{where}.at", "joint", load.at, mechanism.joint)
            yield from _of_laws(where, load, mechanism, isinstance(case, MotionCase))
        if isinstance(case, AtWheel):
            yield from _of_wheel(f"case.{name}", case, table, mechanism)
    if (check := table.motion_check) is not None:
        for field in ("joint", "pivot"):
            where = f"motion_check.{field}"
            yield from _known(where, "joint", getattr(check, field), mechanism.joint)


def _of_laws(
    where: str, load: ApplyTable, mechanism: MechanismTable, moves: bool
) -> Iterator[Wrong]:
    """Yield errors for arguments of the tables of a load, and for its switches."""
    positions = {**mechanism.slider, **dict.fromkeys(map(drive_name, mechanism.drive))}
    timed = [key for key in ("begin", "end") if getattr(load, key) is not None]
    for key in ("force_law", "couple_law"):
        law = getattr(load, key)
        if law is None:
            continue
        here = f"{where}.{key}"
        if law.position_of is not None:
            what = "drive or slider"
            yield from _known(f"{here}.position_of", what, law.position_of, positions)
        for joint in law.length_between or ():
            yield from _known(f"{here}.length_between", "joint", joint, mechanism.joint)
        if law.position_of is None and law.length_between is None:
            timed.append(key)
    if timed and not moves:
        yield Wrong(
            f'{where}.{timed[0]}: depends on time, which only a case of kind "motion" has; for a '
            "table of another argument give position_of or length_between",
            code="needs-motion",
        )


def _of_wheel(
    key: str, case: AtWheel, table: StudyTable, mechanism: MechanismTable
) -> Iterator[Wrong]:
    yield from _known(f"{key}.body", "body", case.body, mechanism.body)
    yield from _known(f"{key}.at", "joint", case.at, mechanism.joint)
    if isinstance(case, DropCase) and case.strut is not None:
        slides = {d.slider: d for d in mechanism.drive if isinstance(d, SliderDrive)}
        yield from _known(f"{key}.strut.drive", "slider drive", case.strut.drive, slides)
    if isinstance(case, GroundCase) and case.drop is not None:
        drops = {name: c for name, c in table.case.items() if isinstance(c, DropCase)}
        yield from _known(f"{key}.drop", "drop case", case.drop, drops)
