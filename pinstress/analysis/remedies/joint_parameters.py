"""Parameters of a pin in contact with its lugs, by their keys in the study: dimensions and
materials of pin and lugs.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from assess.derivatives.in_lugs import Joint, JointParameter
from geometry import body_of_revolution
from geometry.shape.dimensions import Dimension
from pinbase.keys import key_part
from pinstress.analysis.remedies.dimensions import dimensions_of
from pinstress.study.model.lugs import known_lugs
from pinstress.study.model.pins import material
from pinstress.study.model.tasks import Task
from pinstress.study.reading.file import Study
from pinstress.study.schema.lugs import LugTable

# Relative to the pin's radius: the scale for steps of a clearance, which may itself be zero
CLEARANCE_SCALE = 1e-3


@dataclass(frozen=True)
class StudyParameter:
    """A parameter of a joint; kind: its dimension ("length", "stress", .., "1")."""

    kind: str
    of_joint: JointParameter


def joint_parameters(study: Study, task: Task) -> Iterator[StudyParameter]:
    """Yield the non-zero parameters of a pin in lugs, and its clearances.

    A parameter of a lug that both ears of a link share belongs to both.
    """
    pin = body_of_revolution(task.pin)
    assert pin is not None
    for d in dimensions_of(study, pin):
        changed = partial(_with_dimension, study, task, d)
        yield StudyParameter("length", JointParameter(d.key, d.value, d.value, changed))
    table = study.table.pin[pin.name]
    for lug in task.lugs:
        name = lug.connection
        if name in table.shared_lugs:
            continue
        given = table.lug.get(name)
        bushing = given and given.bushing
        for key, value, scale in (
            ("clearance", lug.clearance - lug.growth, CLEARANCE_SCALE * pin.band(name).radius),
            ("outer_diameter", given and given.outer_diameter, None),
            ("edge_radius", lug.edge_radius, None),
            ("bushing.thickness", bushing and bushing.thickness, None),
        ):
            if scale or value:
                changed = partial(_with_lug, study, task, name, key)
                number, full_key = value or 0.0, f"lug.{key_part(name)}.{key}"
                one = JointParameter(full_key, number, scale or number, changed)
                yield StudyParameter("length", one)
    made_of = [task.material, *(m for x in task.lugs for m in (x.material, x.bearing))]
    for part in dict.fromkeys(made_of):
        heavy = part == task.material and any(loads.body.any() for loads in task.loads)
        for key, kind in (
            ("youngs_modulus", "stress"),
            ("poisson_ratio", "1"),
            *((("density", "density"),) if heavy else ()),
        ):
            value = getattr(part, key)
            if value:
                changed = partial(_with_material, study, task, part.name, key)
                full_key = f"material.{key_part(part.name)}.{key}"
                yield StudyParameter(kind, JointParameter(full_key, value, value, changed))


def _with_dimension(study: Study, task: Task, dimension: Dimension, value: float) -> Joint:
    pin = dimension.changed(value)
    old = {lug.connection: lug for lug in task.lugs}
    # The clearance of a fit jumps between ranges of nominal size; the derivative is within a range.
    lugs = tuple(
        replace(lug, clearance=was.clearance - was.growth + lug.growth, range=was.range)
        for lug in known_lugs(study, pin, task.rise)
        for was in [old[lug.connection]]
    )
    return pin, task.material, lugs


def _with_lug(study: Study, task: Task, name: str, key: str, value: float) -> Joint:
    table = study.table.pin[task.pin.name]
    ears = (ear for ear, link in table.shared_lugs.items() if link == name)
    for one in (name, *ears):
        lug_path = "pin", task.pin.name, "lug", one
        if one not in table.lug:
            study = _changed(study, lug_path, LugTable())
        study = _changed(study, (*lug_path, *key.split(".")), value)
    return _made_anew(study, task)


def _with_material(study: Study, task: Task, name: str, key: str, value: float) -> Joint:
    return _made_anew(_changed(study, ("material", name, key), value), task)


def _made_anew(study: Study, task: Task) -> Joint:
    pin = body_of_revolution(task.pin)
    assert pin is not None
    made_of = material(study, study.table.pin[pin.name].material)
    return pin, made_of, known_lugs(study, pin, task.rise)


def _changed(study: Study, path: tuple[str, ...], value: Any) -> Study:
    return replace(study, table=_set(study.table, path, value))


def _set(table: Any, path: tuple[str, ...], value: Any) -> Any:
    """Return a table with another value at a path of keys."""
    first, *rest = path
    named = isinstance(table, dict)
    if rest:
        value = _set(table[first] if named else getattr(table, first), tuple(rest), value)
    return {**table, first: value} if named else table.model_copy(update={first: value})
