"""A pin whose row hardly grows over a range of loads, while another place of it does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fea.core.pin_loads import PinLoads
from pinstress import Engine, run
from pinstress.analysis.landing_scales import Ranged, landing_scales
from pinstress.analysis.plan import prepare
from pinstress.study.model.tasks import Task
from pinstress.study.reading.in_python import study_from
from reports.data.dependence import depends_on
from reports.data.row import LandingRange, PinResult, SharingRange
from reports.tables.strength.landing import landing_table
from tests.pinstress.analysis.test_scaled import STUDY as CLEVIS
from tests.places.test_outcomes_beneath import only, pin

# Two arms on a pin in two lugs of a structure: one bends it by 8 kN, far from both lugs; the other,
# whose impulse has a range, shears it beside a lug.
STUDY = """
title = "Two arms on a pin of the structure"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "270 MPa"
[analysis]
required_safety_factor = 1.0
[mechanism]
joint.O = { at = [0, 0], fixed_in = "ground", connections = { O1 = "short", O2 = "long" } }
body = { short = { mass = 0 }, long = { mass = 0 } }
drive = [
  { body = "short", start = "0 deg", end = "9 deg", duration = 1 },
  { body = "long", start = "0 deg", end = "9 deg", duration = 1 },
]
[case.landing]
kind = "static"
[[case.landing.apply]]
body = "long"
at = "O"
force = [0, 8000]
[[case.landing.apply]]
body = "short"
at = "O"
[case.landing.apply.impulse]
weight = 9810
gravity = "9.81 m/s^2"
velocity_change = "1 m/s"
impulse_time = TIME
direction = [0, 1]
range = { impulse_time = [1.0, 0.05] }
[lug_defaults]
outer_diameter = 50
clearance = 0.02
edge_radius = 0.3
tilt = "guided"
range = { clearance = [0.02, 0.02], stiffness = [1, 1], tilt = ["guided", "guided"] }
[pin.O]
material = "steel"
lug = { S1 = {}, S2 = {} }
profile = [
  { length = 10, diameter = 20, name = "S1" },
  { length = 0.5, diameter = 20 },
  { length = 4, diameter = 20, connection = "O1" },
  { length = 30, diameter = 20 },
  { length = 20, diameter = 20, connection = "O2" },
  { length = 30, diameter = 20 },
  { length = 10, diameter = 20, name = "S2" },
]
"""


HARDENED = (
    'yield_strength = "270 MPa"',
    ('hardened = { surface = "500 MPa", core = "270 MPa", depth = "1 mm" }'),
)
HOLE = 'material = "steel"\nlug', 'material = "steel"\nhole = [{ z = 59, diameter = 3 }]\nlug'


def _landed(time: float, change: tuple[str, str] = ("", "")) -> tuple[PinResult, float]:
    """The pin with an impulse of 1000 N s over a time, which may be 0.05 to 1 s, and what lies
    beneath contact at 0.05 s, MPa.
    """
    (row,) = run(study_from(STUDY.replace("TIME", str(time)).replace(*change))).pins
    assert row.landing is not None
    assert row.landing.beneath is not None
    return row, float(row.landing.beneath[1])


@pytest.mark.slow
def test_what_lies_beneath_contact_is_that_under_the_impulse_at_the_end_of_its_range() -> None:
    """The row grows from 183 to 241 MPa, what lies beneath from 183 to 285, of 270 permitted. The
    pin was safe: what lies beneath was taken to grow as the row does, to 240.
    """
    (long, at_end), (short, own) = _landed(1.0), _landed(0.05)
    assert short.places is not None
    assert short.places.contact is not None
    assert [at_end, own] == pytest.approx([short.places.contact.beneath] * 2, rel=0.02)
    (one,) = long.depends_on
    assert (one.what, one.value, one.over) == ("beneath", "impulse time", "landing")


@pytest.mark.slow
@pytest.mark.parametrize("change", [HARDENED, pytest.param(HOLE, marks=pytest.mark.long)])
def test_so_it_is_of_pins_with_a_hardened_surface_and_with_holes(change: tuple[str, str]) -> None:
    """Neither a case of 1 mm, half as deep as where it is read, nor a hole far away changes it."""
    row, at_end = _landed(1.0, change)
    assert at_end == pytest.approx(285.0, rel=0.02)
    assert [(d.what, d.value) for d in row.depends_on] == [("beneath", "impulse time")]


def _over_time(stress: float, error: float, beneath: float) -> LandingRange:
    """A landing of the row's 59,000 psi over 0.15 s, and of other stresses over 0.13 s."""
    maxima = np.array([59000.0, stress])
    return LandingRange(
        "A", "x", np.array([0.15, 0.13]), np.full(2, 25.0), maxima, maxima, 118000.0 / maxima,
        (0.15, 25.0), "converged", pulses=("rectangular",) * 2, nominal_pulse="rectangular",
        error=np.array([0.005, error]), beneath=np.array([60000.0, beneath]),
    )  # fmt: skip


@pytest.mark.parametrize(("stress", "error", "beneath", "expected"), [
    (76000.0, 0.005, 78000.0, []), (76000.0, 0.04, 60000.0, ["impulse time"]),
    (60000.0, 0.005, 80000.0, ["beneath"]),
])  # fmt: skip
def test_each_place_has_its_own_stress_and_error_over_an_impulse(
    stress: float, error: float, beneath: float, expected: list[str]
) -> None:
    """78,667 psi are permitted: 76,000 with 4 % are 79,040, with 0.5 % they are 76,380."""
    made = pin(60000.0, 0.0, landing=_over_time(stress, error, beneath))
    assert [d.what for d in made.depends_on] == expected


def test_the_table_of_a_landing_counts_what_lies_beneath() -> None:
    """80,000 psi beneath contact at 0.13 s, of 78,667: it was said to meet the factor."""
    made = only(pin(60000.0, 0.0, landing=_over_time(60000.0, 0.005, 80000.0)))
    assert [x["meets_required"] for x in landing_table(made).records()] == [True, False]


@pytest.mark.parametrize(("upper_end", "beneath", "expected"), [
    (76400.0, 78000.0, []), (79000.0, 60000.0, ["AE stiffer"]), (76400.0, 79000.0, ["beneath"]),
])  # fmt: skip
def test_and_over_the_stiffness_of_links(
    upper_end: float, beneath: float, expected: list[str]
) -> None:
    over = SharingRange(
        (59000.0, 76000.0), "", "AE stiffer", upper_end=upper_end, beneath=(60000.0, beneath),
        deepest="BD stiffer",
    )  # fmt: skip
    assert [d.what for d in pin(60000.0, 0.0, sharing=over).depends_on] == expected


def test_both_together_multiply_what_each_place_has() -> None:
    """Of 78,667 psi beneath contact: 60,000 x 1.2 by the impulse, x 1.1 by the links are 79,200."""
    landing = _over_time(60000.0, 0.005, 72000.0)
    links = SharingRange(
        (59000.0, 60000.0), "", "", upper_end=60300.0, beneath=(60000.0, 66000.0), deepest="BD"
    )
    made = pin(60000.0, 0.0, landing=landing, sharing=links)
    assert [(d.what, d.over) for d in made.depends_on] == [("together", "landing and links")]
    less = replace(links, beneath=(60000.0, 65000.0))
    assert depends_on(replace(made, sharing=less)) == ()


@pytest.mark.slow
def test_a_quick_row_has_the_range_of_the_changed_study() -> None:
    """Less force on the long arm eases the row, and not the short one that governs at the end of
    the range: its stress was scaled with the row, to 250 of 274 MPa, and the pin was safe.
    """
    change = {"case.landing.apply[1].force[2]": 7000.0}
    gear = Engine(study_from(STUDY.replace("TIME", "1.0")))
    quick = gear.row(change, "O", "landing", accuracy="quick")
    full = gear.row(change, "O", "landing")
    assert quick.landing is not None
    assert quick.landing.beneath is not None
    assert full.landing is not None
    assert full.landing.beneath is not None
    contact = quick.places and quick.places.contact
    assert contact
    error = contact.beneath_error / contact.beneath
    assert quick.landing.beneath[1] * (1.0 + error) >= full.landing.beneath[1]
    assert full.outcome == "depends"
    assert quick.outcome in ("depends", "not decided")


def test_a_range_is_scaled_only_where_its_loads_tell_nothing_new() -> None:
    """Loads of two links, of an impulse on one and a constant force on the other."""
    (task,) = prepare(study_from(CLEVIS)).tasks
    force = np.array([1.0, 4.0, 20.0])

    def ranged(pin: Task, constant: float, factor: float = 1.0) -> Ranged:
        forces = np.zeros((3, 2, 3))
        forces[:, 0, 0], forces[:, 1, 1] = factor * force, constant
        return pin, PinLoads("landing", ("left", "middle"), forces), factor * force

    other = replace(task, lugs=tuple(replace(x, tilt=0.0) for x in task.lugs))
    stronger = replace(task, material=replace(task.material, yield_strength=1e9))
    for same in (task, stronger):
        assert landing_scales(ranged(task, 5.0), ranged(same, 5.0, 1.5))
    assert landing_scales(ranged(task, 0.0), ranged(other, 0.1))  # weights
    assert not landing_scales(ranged(task, 5.0), ranged(other, 5.0))
    assert not landing_scales(ranged(task, 5.0), ranged(task, 4.0))
    assert not landing_scales(ranged(task, 0.0), ranged(task, 4.0))
