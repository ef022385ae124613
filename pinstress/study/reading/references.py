"""References by name within a study, each of which must refer to something that exists."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import partial

from assess.fatigue.flight import flight
from assess.requirement import LEVELS_OF_CHECK
from geometry.shape.band import END_FACES
from pinbase.errors import ArgumentError
from pinbase.keys import key_part, lug_key
from pinstress.study.reading.errors import Wrong
from pinstress.study.reading.mechanism_references import of_its_cases, of_pins, of_plane
from pinstress.study.reading.names import known_name, known_names
from pinstress.study.reading.space_references import of_space
from pinstress.study.schema.cases import GivenCase, InstantCase, MotionCase, StaticCase
from pinstress.study.schema.fatigue import FatigueTable
from pinstress.study.schema.landing import DropCase, GroundCase
from pinstress.study.schema.lugs import LugTable
from pinstress.study.schema.materials import MaterialTable
from pinstress.study.schema.mechanism import MechanismTable
from pinstress.study.schema.pins import PinTable
from pinstress.study.schema.require import level_of
from pinstress.study.schema.shown import as_text, in_toml
from pinstress.study.schema.tables import StudyTable

MATERIAL_PATHS = "lug_defaults.material lug_defaults.bushing.material pin.material"
NUMBERED_SURFACE = re.compile(r"(segment|bore segment|shoulder|hole|flat|slot|passage) \d+")
CASE_PATHS = "beam_check.case motion_check.case require.cases sequence.steps.case"


def cross_references(table: StudyTable) -> Iterator[Wrong]:
    """Yield the references to things that do not exist."""
    bears: dict[str, str] = {}
    common = _materials(table.lug_defaults or LugTable())
    known = partial(known_names, table, "")
    yield from known(MATERIAL_PATHS, "material", table.material)
    yield from known("beam_check.pin require.pins", "pin", table.pin)
    yield from known(CASE_PATHS, "case", table.case)
    for name, pin in table.pin.items():
        surfaces = dict.fromkeys(connection for _, connection in pin.connections)
        surfaces |= dict.fromkeys(s.name for s in pin.profile or () if s.name)
        surfaces |= dict.fromkeys(pin.band)
        for connection, lug in pin.lug.items():
            key = lug_key(name, connection)
            yield from known_name(key, "connection or segment", connection, surfaces)
            for at, made_of in _materials(lug).items():
                if made_of not in common.values():
                    yield from known_name(f"{key}.{at}", "material", made_of, table.material)
        if pin.geometry is None:
            yield from _of_clamps(table, name, surfaces)
        for key, connection in pin.connections:
            if connection in bears:
                yield Wrong(
                    f"pin.{key_part(name)}.{key}: connection {as_text(connection)} already bears "
                    f"on pin {bears[connection]}; a connection bears on one pin only",
                    code="duplicate-connection",
                )
            bears[connection] = name
        yield from _of_ears(name, pin)
        if pin.balance is not None:
            own = [connection for _, connection in pin.connections]
            yield from known_name(
                f"pin.{key_part(name)}.balance", "connection of the pin", pin.balance, own
            )
    yield from _of_bearing(table)
    if isinstance(table.analysis.limit_load, list):
        yield from known("analysis.limit_load", "pin", table.pin)
    yield from _of_cases(table, bears)
    yield from _of_requirements(table)
    yield from _of_sequences(table)
    if table.mechanism is not None:
        yield from of_pins(table, table.mechanism, bears)
        if isinstance(table.mechanism, MechanismTable):
            yield from of_plane(table.mechanism)
        else:
            yield from of_space(table.mechanism)
        yield from of_its_cases(table, table.mechanism)
    if table.fatigue is not None:
        yield from _of_fatigue(table, table.fatigue)


def _materials(lug: LugTable) -> dict[str, str]:
    """Return the materials that a lug names, by their keys."""
    bushing = {} if lug.bushing is None else {"bushing.material": lug.bushing.material}
    return bushing if lug.material is None else {"material": lug.material, **bushing}


def _of_clamps(table: StudyTable, pin: str, surfaces: Iterable[str]) -> Iterator[Wrong]:
    """Yield the clamped surfaces of a pin that do not exist, even if the shape of the pin is
    impossible.

    Names that the program itself gives ("segment 2", "hole 1") are left out, since only the shape
    tells whether they exist.
    surfaces: the names that the study gives.
    """
    clamps = {f"pin.{key_part(pin)}.clamp": table.pin[pin].clamp}
    for case, given in table.case.items():
        clamps[f"case.{key_part(case)}.clamp.{key_part(pin)}"] = given.clamp.get(pin, [])
    known = [*END_FACES, *surfaces]
    for key, named in clamps.items():
        for i, surface in enumerate(named, 1):
            if not NUMBERED_SURFACE.fullmatch(surface):
                yield from known_name(f"{key}[{i}]", "surface", surface, known)


def _of_ears(name: str, pin: PinTable) -> Iterator[Wrong]:
    """Yield the ears of clevises whose connection does not exist, or has two ears already."""
    known, ears = [connection for _, connection in pin.connections], set[str]()
    for i, segment in enumerate(pin.profile or (), 1):
        if segment.ear_of is None:
            continue
        at = f"pin.{key_part(name)}.profile[{i}].ear_of"
        yield from known_name(at, "connection", segment.ear_of, known)
        if segment.ear_of in ears:
            yield Wrong(
                f"{at}: connection {as_text(segment.ear_of)} already has two ears; a link with "
                "more needs connections of their own",
                code="third-ear",
            )
        ears.add(segment.ear_of)


def _of_bearing(table: StudyTable) -> Iterator[Wrong]:
    """Yield errors for bearing strengths that are never compared with a pressure.

    They are of materials of which neither a pin with a connection or lug, nor a lug or bushing, is
    made.
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
                f"material.{key_part(name)}.bearing_strength: no lug bears on a pin of this "
                "material, and no lug or bushing is made of it; give "
                "pin.NAME.lug.CONNECTION.material, or remove this",
                code="bearing-strength-without-lug",
            )


def _of_cases(table: StudyTable, bears: dict[str, str]) -> Iterator[Wrong]:
    for name, case in table.case.items():
        for pin in case.clamp:
            yield from known_name(f"case.{key_part(name)}.clamp", "pin", pin, table.pin)
        if isinstance(case, GivenCase):
            for key, given in (("forces", case.forces), ("moments", case.moments)):
                for connection in given or ():
                    what, where = "pin has a connection", f"case.{key_part(name)}.{key}"
                    yield from known_name(where, what, connection, bears)
                    borne = bears.get(connection)
                    if borne is not None and connection == table.pin[borne].balance:
                        where = f"{where}.{key_part(connection)}"
                        yield Wrong(closed_message(where, borne), code="balances-the-others")
            for file in case.tables:
                for connection in file.connections:
                    what = "pin has a connection"
                    yield from known_name(f"case.{key_part(name)}.table", what, connection, bears)
        elif table.mechanism is None:
            yield Wrong(
                f"case.{key_part(name)}: kind {case.kind!r} needs a [mechanism]",
                code="no-mechanism",
            )


def closed_message(where: str, pin: str) -> str:
    """Return the message for a force that the study gives although it follows from others."""
    return (
        f"{where}: follows from the other forces on pin {pin}, by pin.{key_part(pin)}.balance; "
        "remove it"
    )


def _of_sequences(table: StudyTable) -> Iterator[Wrong]:
    for name, sequence in table.sequence.items():
        if name in table.case:
            text = f"sequence.{key_part(name)}: a case has this name too; rename one"
            yield Wrong(text, code="duplicate-case")
        for i, step in enumerate(sequence.steps, 1):
            where = f"sequence.{key_part(name)}.steps[{i}]"
            case = table.case.get(step.case)
            if isinstance(case, InstantCase):
                text = f"{where}.case: an instant of a motion does not last; name the motion"
                yield Wrong(text, code="not-in-sequences")
            elif isinstance(case, MotionCase | DropCase) and step.duration is not None:
                text = f"{where}.duration: {as_text(step.case)} has its own time; remove this"
                yield Wrong(text, code="key-not-applicable")
            elif isinstance(case, StaticCase | GroundCase) and step.duration is None:
                text = f"{where}: {as_text(step.case)} is at rest; give its duration"
                yield Wrong(text, code="missing-key")


def _of_requirements(table: StudyTable) -> Iterator[Wrong]:
    """Yield errors for levels that do not fit the check, and for several factors for one pin, case,
    check and level.
    """
    known: dict[tuple[str, str, str, str], int] = {}
    for i, require in enumerate(table.require, 1):
        where, level = f"require[{i}]", level_of(require)
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


def _of_fatigue(table: StudyTable, fatigue: FatigueTable) -> Iterator[Wrong]:
    """Yield errors for cases of the spectrum that do not exist, and for missing data of the fatigue
    method.
    """
    for case in fatigue.occurrences:
        known = {**table.case, **table.sequence}
        yield from known_name(f"fatigue.occurrences.{key_part(case)}", "case", case, known)
    try:
        flight([*fatigue.occurrences.values()])
    except ArgumentError as error:
        yield Wrong(f"fatigue.occurrences: {error}", code=error.code)
    if fatigue.method == "fkm-p-ram" and (fatigue.failure_probability or 0.0) > 0.5:
        text = 'fatigue.failure_probability: must be at most 0.5 for method "fkm-p-ram"'
        yield Wrong(text, code="out-of-range")
    needs = "fkm" if fatigue.method == "fkm-p-ram" else "fatigue"
    used = {pin.material for pin in table.pin.values()}
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
                yield Wrong(f"material.{key_part(name)}.{key} is missing", code="missing-key")


def _parameters(material: MaterialTable, fatigue: FatigueTable) -> dict[str, float | None]:
    """Return the further material parameters that a method needs, by key."""
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
