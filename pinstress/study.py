"""Reading a study file: TOML, validated, in SI, every cross-reference checked."""

from __future__ import annotations

import difflib
import hashlib
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from pinstress.errors import InputError
from pinstress.file_names import same_files
from pinstress.quantities import KINDS
from pinstress.schema import StudyTable
from pinstress.schema_cases import GivenCase, LegCase, MotionCase
from pinstress.schema_mechanism import MechanismTable, RotaryDrive, SliderDrive
from pinstress.units import SYSTEMS, UnitSystem


@dataclass(frozen=True)
class Sourced:
    """Where a number of the study comes from."""

    key: str
    kind: str
    note: str


@dataclass(frozen=True)
class Study:
    """A valid study. table: its content in SI. system: the units it speaks."""

    path: Path
    text: str
    table: StudyTable
    provenance: tuple[Sourced, ...]

    @property
    def system(self) -> UnitSystem:
        """The study's unit system."""
        return SYSTEMS[self.table.units]

    @property
    def name(self) -> str:
        """The file's name without its ending."""
        return self.path.stem

    @property
    def sha256(self) -> str:
        """Hash of the study file."""
        return hashlib.sha256(self.text.encode()).hexdigest()

    def beside(self, name: str) -> Path:
        """A file that the study names."""
        return self.path.parent / name

    def clamps(self, pin: str, case: str) -> tuple[str, ...]:
        """What holds a pin in a case, in the study's words."""
        return tuple(self.table.case[case].clamp.get(pin, self.table.pin[pin].clamp))

    def connections(self, pin: str) -> tuple[str, ...]:
        """Connections that bear on a pin."""
        return tuple(name for _, name in self.table.pin[pin].connections)


def load_study(path: str | Path) -> Study:
    """Read and validate a study file.

    Raises: InputError naming the file, the keys and what would be right.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
        raw = tomllib.loads(text)
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read ({error})") from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: not valid TOML: {error}") from None
    provenance: list[Sourced] = []
    raw = _unwrap(raw, "", provenance)
    wrong = [
        f"{s.key}: provenance must be given, derived, fitted or assumed, not {s.kind!r}"
        for s in provenance
        if s.kind not in KINDS
    ]
    system = SYSTEMS.get(str(raw.get("units")), SYSTEMS["m-N-s"])
    try:
        table = StudyTable.model_validate(raw, context={"system": system})
    except ValidationError as error:
        raise InputError(_listed(path, wrong + _explain(error))) from None
    wrong += _cross_references(table)
    wrong += same_files(table.pin, table.case)
    if wrong:
        raise InputError(_listed(path, wrong))
    return Study(path, text, table, tuple(provenance))


def _unwrap(node: Any, key: str, found: list[Sourced]) -> Any:
    """The same tree without provenance and notes, which go to `found`; of { value, provenance,
    note } the value remains.
    """
    if isinstance(node, list):
        return [_unwrap(v, f"{key}[{i}]", found) for i, v in enumerate(node, 1)]
    if not isinstance(node, dict):
        return node
    if isinstance(node.get("provenance"), str):
        found.append(Sourced(key, node["provenance"], str(node.get("note", ""))))
        node = {k: v for k, v in node.items() if k not in ("provenance", "note")}
        if set(node) == {"value"}:
            return node["value"]
    return {k: _unwrap(v, f"{key}.{k}" if key else k, found) for k, v in node.items()}


def _listed(path: Path, wrong: list[str]) -> str:
    if len(wrong) == 1:
        return f"{path}: {wrong[0]}"
    return f"{path}: {len(wrong)} errors\n" + "\n".join(f"  {w}" for w in wrong)


def _explain(error: ValidationError) -> list[str]:
    wrong = []
    for item in error.errors():
        key = ""
        for i, part in enumerate(item["loc"]):
            if str(part).startswith("<") or (i == 2 and item["loc"][0] == "case"):
                continue  # a union's tag, not a key of the file
            key += f"[{part + 1}]" if isinstance(part, int) else f"{'.' if key else ''}{part}"
        message = item["msg"].removeprefix("Value error, ")
        value = item.get("input")
        if item["type"] == "missing":
            message = "is missing"
        elif item["type"] == "union_tag_invalid":
            kinds = item["ctx"]["expected_tags"]
            message = f"{item['ctx']['tag']!r} is not a kind; there are {kinds}"
        elif item["type"] not in ("value_error", "union_tag_invalid", "union_tag_not_found"):
            message = f"{message[0].lower()}{message[1:]}"
            if isinstance(value, int | float | str):
                message += f", not {value!r}"
        wrong.append(f"{key}: {message}" if key else message)
    return wrong


def _near(name: str, known: Iterable[str]) -> str:
    known = list(known)
    near = difflib.get_close_matches(name, known, n=1)
    return f"did you mean {near[0]!r}?" if near else f"there are {', '.join(known) or 'none'}"


def _cross_references(table: StudyTable) -> Iterable[str]:
    """What names something that is not there."""
    bears: dict[str, str] = {}
    for name, pin in table.pin.items():
        if pin.material not in table.material:
            yield f"pin.{name}.material: no material {pin.material!r}; " + _near(
                pin.material, table.material
            )
        for key, connection in pin.connections:
            if connection in bears:
                yield (f"pin.{name}.{key}: {connection!r} bears on pin {bears[connection]} already")
            bears[connection] = name
    for name, case in table.case.items():
        for pin_name in case.clamp:
            if pin_name not in table.pin:
                yield f"case.{name}.clamp: no pin {pin_name!r}; " + _near(pin_name, table.pin)
        if isinstance(case, GivenCase):
            for key, given in (("forces", case.forces), ("moments", case.moments)):
                for connection in given or ():
                    if connection not in bears:
                        yield (
                            f"case.{name}.{key}: no pin has a connection {connection!r}; "
                            + _near(connection, bears)
                        )
        elif isinstance(case, LegCase):
            if table.spatial_leg is None:
                yield f"case.{name}: kind 'spatial_leg' needs a [spatial_leg]"
        elif table.mechanism is None:
            yield f"case.{name}: kind {case.kind!r} needs a [mechanism]"
    yield from _mechanism_references(table, bears)
    for key, check, pools in (
        ("beam_check", table.beam_check, (("pin", table.pin), ("case", table.case))),
        ("motion_check", table.motion_check, (("case", table.case),)),
    ):
        for field, pool in pools:
            if check is not None and getattr(check, field) not in pool:
                name = getattr(check, field)
                yield f"{key}.{field}: no {field} {name!r}; " + _near(name, pool)


def named_joints(mechanism: MechanismTable) -> Iterable[tuple[str, str]]:
    """Every place below [mechanism] that names a joint, with the name."""
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


def _lines(drive: RotaryDrive) -> tuple[str, ...]:
    return drive.line + (drive.against_line or ())


def _mechanism_references(table: StudyTable, bears: dict[str, str]) -> Iterable[str]:
    mechanism = table.mechanism
    if mechanism is None:
        return
    have = {c for joint in mechanism.joint.values() for c in joint.connections}
    driven = any(not isinstance(case, GivenCase | LegCase) for case in table.case.values())
    for connection, pin in bears.items():
        if driven and connection not in have:
            yield (
                f"pin.{pin}: connection {connection!r} is not in the mechanism; "
                + _near(connection, have)
            )
    bodies = ["ground", *mechanism.body]
    for name, joint in mechanism.joint.items():
        if joint.fixed_in is not None and joint.fixed_in not in bodies:
            yield f"mechanism.joint.{name}.fixed_in: no body {joint.fixed_in!r}; " + _near(
                joint.fixed_in, bodies
            )
        for connection, body in joint.connections.items():
            if body not in bodies:
                yield (
                    f"mechanism.joint.{name}.connections.{connection}: no body {body!r}; "
                    + _near(body, bodies)
                )
    for where, named in named_joints(mechanism):
        if named not in mechanism.joint:
            yield f"mechanism.{where}: no joint {named!r}; " + _near(named, mechanism.joint)
    for i, drive in enumerate(mechanism.drive, 1):
        where = "mechanism.drive" + (f"[{i}]" if len(mechanism.drive) > 1 else "")
        if isinstance(drive, SliderDrive):
            if drive.slider not in mechanism.slider:
                yield f"{where}.slider: no slider {drive.slider!r}; " + _near(
                    drive.slider, mechanism.slider
                )
            continue
        for key, body in (("body", drive.body), ("against", drive.against)):
            if body not in bodies:
                yield f"{where}.{key}: no body {body!r}; " + _near(body, bodies)
    for name, case in table.case.items():
        if isinstance(case, MotionCase) and not all(d.moves for d in mechanism.drive):
            yield f"case.{name}: a motion needs start, end and duration in [mechanism.drive]"
        for i, load in enumerate(getattr(case, "apply", ()), 1):
            where = f"case.{name}.apply[{i}]"
            if load.body not in mechanism.body:
                yield f"{where}.body: no body {load.body!r}; " + _near(load.body, mechanism.body)
            if isinstance(load.at, str) and load.at not in mechanism.joint:
                yield f"{where}.at: no joint {load.at!r}; " + _near(load.at, mechanism.joint)
    if (check := table.motion_check) is not None:
        for field in ("joint", "pivot"):
            if getattr(check, field) not in mechanism.joint:
                yield f"motion_check.{field}: no joint {getattr(check, field)!r}; " + _near(
                    getattr(check, field), mechanism.joint
                )
