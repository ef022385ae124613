"""The margin of a lug against collapse by plastic flow."""

import math
from dataclasses import replace

import numpy as np
import pytest

from assess.clauses.lug_collapse import lug_collapse, lug_rupture
from assess.plastic.records import LugCollapse
from assess.situation import LoadFactors, Situation
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.lugs.lug import Lug, Shank
from tests.support.pins.plain_pins import double_shear

STEEL = Material("steel", 210e9, 0.3, None, 250e6)


def _situation(angle: float, limit: LugCollapse) -> Situation:
    """A pin in double shear whose middle lug pulls with 40 kN along x, its shank at an angle."""
    pin = double_shear(0.01, 0.001, 0.02, 0.02)
    name = pin.connections[1]
    lug = Lug(name, 0.05, STEEL, shank=Shank("round", 0.05, 0.08, 0.025, angle))
    forces = np.zeros((2, 3, 3))
    forces[0, :, 0] = [-20e3, 40e3, -20e3]
    loads = PinLoads("pull", pin.connections, forces)
    return Situation(
        pin, STEEL, loads, lugs=(lug,), sized=(lug,), factors=LoadFactors(ultimate=1.5),
        lug_collapses=(replace(limit, connection=name),),
    )  # fmt: skip


FOUND = LugCollapse("", 90e3, 92e3)


def test_the_lower_end_of_the_bracket_is_allowed() -> None:
    (margin,) = lug_collapse(_situation(0.0, FOUND))
    assert margin.demand == pytest.approx(40e3)
    assert margin.allowable == 90e3
    assert margin.margin == pytest.approx(90.0 / 60.0 - 1.0)
    assert "1.022" in margin.basis


def test_a_lug_that_is_only_pushed_is_named() -> None:
    for check, limit in ((lug_collapse, FOUND), (lug_rupture, replace(FOUND, breaks_by="strain"))):
        (margin,) = check(_situation(math.pi, limit))
        assert margin.allowable is None
        assert "only pushes" in margin.needs


def test_a_lug_without_a_request_has_no_margin() -> None:
    assert not lug_collapse(replace(_situation(0.0, FOUND), lug_collapses=()))


def test_an_oblique_load_is_not_judged() -> None:
    (margin,) = lug_collapse(_situation(0.5, FOUND))
    assert margin.allowable is None
    assert "along the shank" in margin.needs


def test_what_is_missing_is_named() -> None:
    (margin,) = lug_collapse(_situation(0.0, LugCollapse("", needs="pin.P.lug.B.shank")))
    assert margin.needs == "pin.P.lug.B.shank"


def test_the_ultimate_load_is_allowed_where_a_failure_strain_is_given() -> None:
    """Beside the limit load; a lug without that strain has none, a missing strength is named."""
    broken = replace(FOUND, ultimate=99e3, breaks_by="strain")
    (margin,) = lug_rupture(_situation(0.0, broken))
    assert (margin.allowable, margin.level) == (99e3, "ultimate")
    assert margin.margin == pytest.approx(99.0 / 60.0 - 1.0)
    assert "failure strain is reached" in margin.basis
    assert "20 bars" in margin.scatter
    assert lug_rupture(_situation(0.0, FOUND)) == []
    (across,) = lug_rupture(_situation(0.5, broken))
    assert "along the shank" in across.needs
    key = "material.steel.ultimate_strength"
    (lacking,) = lug_rupture(_situation(0.0, replace(FOUND, breaks_by=key)))
    assert lacking.needs == key
