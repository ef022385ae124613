"""Records in JSON, in other units by the dimensions of their fields, and in bytes and back."""

from __future__ import annotations

import dataclasses
import json
import types
from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

import numpy as np
import pytest

from fea.core.mesh_result import SingularIntensity
from fea.core.peak import Maximum, Refinement, SingularZone
from pinbase.records import in_units, pack, plain, unpack
from pinstress.analysis.stored import Entry, PinOutcome
from pinstress.study.schema.units import UNIT_SYSTEMS
from reports.data import mechanics, motion, row, sensitivities
from reports.data import results as data
from reports.data.fields import Field
from reports.data.mechanics import DriveEffort, DriveTable, ReactionTable
from reports.data.motion import BodyMotion
from reports.data.row import GoverningLoad, PinResult
from tests.support.each import each
from tests.support.results.made_up_run import make_results

INCHES, MILLIMETRES = UNIT_SYSTEMS["in-lbf-s"], UNIT_SYSTEMS["mm-N-s"]

WITHOUT_DIMENSION = {
    "Judgement.safety_factor",
    "PinSensitivities.factor",
    "PinResult.exponent",
    "StatedRequirement.factor",
    "Sensitivity.factor_with_step",
    "PinResult.published_max_von_mises",  # as published, in the study's units
    "PinResult.published_safety_factor",
    "ReactionTable.turn",  # rad
    "PowerLedger.violation",  # ratios
    "WheelLoad.factor",
    "CutShape.angle",
    "CutShape.tilt",  # degrees
    "LinkageMotion.angle",  # degrees, and rad
    "LinkageMotion.angular_velocity",
    "LinkageMotion.angular_acceleration",
    "LinkageMotion.condition",
    "LinkageMotion.transmission",
    "Posture.transmission",
    "SpacePosture.transmission",
    "SpacePosture.condition",
    "SpacePosture.violation",
    "Skeleton.axes",  # unit vectors
    "LandingRange.safety_factor",
    "LandingRange.error",
    "LandingRange.largest_load",
    "SharingRange.largest_load",
    "Dependence.factor",
    "Judgement.required",
    "PointFatigue.damage",  # per unit of the spectrum, in which lives are counted
    "PointFatigue.largest_damage",
    "PointFatigue.life",
    "PointFatigue.utilisation",
    "PointFatigue.counts",
    "Fatigue.probability",
    "Fatigue.life",
    "DropRecord.imbalance",
    "DropRecord.lift",
    "DropRecord.load_factor",
    "Margin.factor",
    "Margin.over_joint",
    "Remedy.required",
    "Remedy.load_factor",
    "Remedy.diameter_factor",
    "LimitLoad.lower",
    "LimitLoad.upper",
    "LimitLoad.permanent_at",
    "LimitLoad.seconds",
    "PublishedValue.time",
    "PublishedValue.published",
    "Refinement.seconds",
    "Opinion.displacement",  # relative differences
    "Opinion.stress",
    "SingularZone.exponent",
    "SingularZone.exponent_theory",
    "Results.required_safety_factor",
    "Results.tolerance",
}


def numbers(value: Any) -> list[float]:
    """All numbers of results, in order, but seconds of computing."""
    if dataclasses.is_dataclass(value):
        names = [f.name for f in dataclasses.fields(value)]
        return [x for name in names for x in numbers(getattr(value, name))]
    if isinstance(value, np.ndarray):
        return [float(x) for x in value.ravel() if x == x]
    if isinstance(value, dict):
        return [x for v in value.values() for x in numbers(v)]
    if isinstance(value, tuple | list):
        return [x for v in value for x in numbers(v)]
    return [value] if isinstance(value, float) else []


def test_there_and_back_is_the_same() -> None:
    """Nothing is converted one way only: SI values of the inverse units undo it."""
    results = make_results()
    there = in_units(results, MILLIMETRES.factor)
    back = in_units(there, lambda dimension: 1.0 / MILLIMETRES.factor(dimension))
    assert numbers(back) == pytest.approx(numbers(results), rel=1e-12)
    assert numbers(there) != numbers(results)


def test_every_array_has_a_dimension_or_is_known_to_need_none() -> None:
    """A new field that holds numbers cannot be left in SI by oversight."""
    plain = {
        f"{name}.{f.name}"
        for module in (data, row, mechanics, motion, sensitivities)
        for name, kind in vars(module).items()
        if dataclasses.is_dataclass(kind)
        for f in dataclasses.fields(kind)
        if str(f.type).split(" | ")[0] in ("Floats", "float", "dict[str, Floats]")
    }
    assert plain == WITHOUT_DIMENSION


def test_a_singularity_has_the_units_of_its_exponent() -> None:
    zone = SingularZone(
        (0.0254, 0.0, 0.0), "a sharp corner", ("a", "b"), 0.44, 0.4555, 0.0508, True, 6894.757293,
        "a fillet", SingularIntensity(6894.757293 * 0.0254**0.4555, 0.4555, None),
    )  # fmt: skip
    found = in_units(zone, INCHES.factor)
    assert found.location == pytest.approx((1.0, 0.0, 0.0))
    assert (found.excluded, found.max_von_mises) == pytest.approx((2.0, 1.0))
    assert found.strength is not None
    assert found.strength.along == pytest.approx(1.0)
    assert found.strength.notch is None
    assert found.exponent == 0.44


@each(("kind", "length", "force"), [("slider", 1e3, 1.0), ("rotary", 1.0, 1e3)])
def test_a_drive_has_a_force_or_a_torque(kind: str, length: float, force: float) -> None:
    one = np.ones(2)
    drive = DriveTable("m", one, one, one, one, one, one, one, one, one, "d", kind)
    found = in_units(replace(drive, effort=DriveEffort(*[1.0] * 7)), MILLIMETRES.factor)
    assert found.position == pytest.approx(length)
    assert found.velocity == pytest.approx(length)
    assert found.force == pytest.approx(force)
    assert found.power == pytest.approx(1e3)  # N mm/s
    assert found.effort is not None
    assert (found.effort.largest, found.effort.time) == pytest.approx((force, 1.0))


def test_positions_are_lengths_or_degrees() -> None:
    zero = np.zeros((2, 1, 3))
    table = ReactionTable("m", np.ones(2), np.ones(2), ("A",), ("b",), ("p",), zero, zero)
    assert in_units(table, MILLIMETRES.factor).position == pytest.approx(1e3)
    turning = replace(table, position_unit="deg")
    assert in_units(turning, MILLIMETRES.factor).position == pytest.approx(1.0)


def test_a_product_of_units() -> None:
    one = np.ones((1, 3))
    body = BodyMotion("c", "b", None, *(one,) * 10, np.ones(1))
    assert in_units(body, MILLIMETRES.factor).angular_momentum == pytest.approx(1e3)
    assert in_units(body, INCHES.factor).spin == pytest.approx(1.0)


def test_packing_keeps_every_bit() -> None:
    numbers = np.array([[0.1, -0.0, np.nan], [np.inf, 5e-324, 1 / 3]], order="F")
    field = Field("P ü", "c", numbers, np.arange(8).reshape(2, 4), numbers, numbers, numbers[0],
                  numbers[1], "quad", None, (0.1 + 0.2, (1.0, -0.0, 1e300)))  # fmt: skip
    row = PinResult(Maximum("P", "c", "beam", "rigid", "why"))
    entry = Entry(PinOutcome((row,)), (field,))
    data = pack(entry)
    back = unpack(Entry, data)
    assert pack(back) == data
    assert back.solved == entry.solved
    assert back.fields[0].points.tobytes("A") == numbers.tobytes("A")
    assert repr(back.fields[0].outside) == repr(field.outside)


def example(hint: Any) -> Any:
    """A value of a type, with everything in it that may be there."""
    if get_origin(hint) in (Union, types.UnionType):
        (hint,) = (arm for arm in get_args(hint) if arm is not types.NoneType)
    origin, inner = get_origin(hint), get_args(hint)
    if origin is Annotated:
        return example(inner[0])
    if origin is Literal:
        return inner[-1]
    if origin is np.ndarray:
        return np.ones((2, 3), get_args(inner[1])[0])
    if origin is tuple:
        kinds = inner[:1] * 2 if inner[1:] == (...,) else inner
        return tuple(example(kind) for kind in kinds)
    if origin in (dict, Mapping):
        return {"key": example(inner[1])}
    if dataclasses.is_dataclass(hint) or hasattr(hint, "_fields"):
        names = getattr(hint, "_fields", None) or [f.name for f in dataclasses.fields(hint)]
        hints = get_type_hints(hint, include_extras=True)
        values = {name: example(hints[name]) for name in names}
        return hint(**values)
    return {float: 0.1, int: 3, bool: True, str: "text"}[hint]


def test_all_that_an_entry_can_hold_is_read_back() -> None:
    """What cannot be read back is solved anew in every run, and nobody is told."""
    entry = example(Entry)
    data = pack(entry)
    assert pack(unpack(Entry, data)) == data


@each(
    "wrong",
    [
        Maximum("P", "c", "beam", "perhaps", ""),  # type: ignore[arg-type]
        Maximum("P", "c", "beam", "rigid", "", max_von_mises="1"),  # type: ignore[arg-type]
        Maximum("P", "c", "beam", "rigid", "", location=(1.0, 2.0)),  # type: ignore[arg-type]
        Maximum("P", "c", "beam", "rigid", 1),  # type: ignore[arg-type]
        Refinement(1, 1.0, 1.0),
        ("P",),
        None,
    ],
)
def test_unpacking_checks_types(wrong: object) -> None:
    with pytest.raises(ValueError, match=r"expected|argument"):
        unpack(Maximum, pack(wrong))


def test_a_record_is_not_read_as_another_with_the_same_fields() -> None:
    """Nor do both have the same key in the cache."""

    @dataclasses.dataclass(frozen=True)
    class One:
        value: float

    @dataclasses.dataclass(frozen=True)
    class Other:
        value: float

    assert pack(One(1.0)) != pack(Other(1.0))
    with pytest.raises(ValueError, match="expected"):
        unpack(One, pack(Other(1.0)))


def test_json_has_no_numbers_that_are_none() -> None:
    load = GoverningLoad("B", "strut", np.array([1.0, np.nan, 3.0]), np.zeros(3))
    found = plain({1: load, "n": (np.int64(2), np.bool_(True), np.inf, None, "x", 0.1)})
    text = json.dumps(found, allow_nan=False)
    assert json.loads(text) == {
        "1": {
            "connection": "B",
            "body": "strut",
            "force": [1.0, None, 3.0],
            "moment": [0.0, 0.0, 0.0],
        },
        "n": [2, True, None, None, "x", 0.1],
    }
