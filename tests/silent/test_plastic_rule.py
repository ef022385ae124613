"""A rule of this program that was printed as a clause of a standard, which is of something else.

"Plastic bending and shear" said "EN 1993-1-1, 6.2.6". That clause is shear alone; the circle of
M and V with A_v = 3 A / 4 is in no clause. It has its own name and formula now.

Independent: the circle by hand for a pin in double shear, and strips of a section that shear at one
stress, which leaves them sqrt(f_y^2 - 3 tau^2), by a linear program (scipy, HiGHS).
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import linprog

from assess.checks import CHECKS
from assess.situation import Situation
from assess.strength.hand_checks import BENDING_TEXTS
from assess.strength.plastic_bending import plastic_bending
from assess.strength.section_forces import section_forces
from fea.beam.round_section import Circle
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from tests.support.each import each
from tests.support.pins.plain_pins import double_shear

DIAMETER, YIELD = 0.016, 235e6


def test_the_rule_has_its_own_name_and_its_formula() -> None:
    steel = Material("S235", 210e9, 0.3, None, YIELD, 360e6)
    forces = np.array([[[-2500.0, 0.0, 0.0], [5000.0, 0.0, 0.0], [-2500.0, 0.0, 0.0]]])
    loads = PinLoads("pull", ("A", "B", "C"), forces)
    s = Situation(double_shear(0.008, 0.001, 0.015, DIAMETER), steel, loads)
    (found,) = plastic_bending(replace(s, section_forces=section_forces(s)[0]))
    assert found.method == "plastic bending and shear"
    assert found.clause == "rule of pinstress"
    assert "(M/M_pl)^2 + (V/V_pl)^2 <= 1, without axial force and torque" in found.basis
    M = 2500.0 * 0.005 / (YIELD * DIAMETER**3 / 6.0)
    V = 2500.0 / (0.75 * math.pi / 4.0 * DIAMETER**2 * YIELD / math.sqrt(3.0))
    assert found.demand == pytest.approx(math.hypot(M, V), rel=1e-5)


def test_no_check_of_this_program_is_named_after_a_clause_on_shear_alone() -> None:
    clauses = [check.clause for check in CHECKS] + [x for _, x in BENDING_TEXTS.values()]
    assert not any("1993-1-1" in clause for clause in clauses)


@each("v", [0.2, 0.6, 0.9])
@each("bore", [0.0, 0.6, 0.98])
def test_a_section_carries_what_the_circle_says(bore: float, v: float) -> None:
    """Where shear takes v of its yield stress, strips carry sqrt(1 - v^2) M_pl."""
    tau = v / math.sqrt(3.0)
    y = (np.arange(2000) + 0.5) / 1000.0 - 1.0
    width = np.sqrt(1.0 - y**2) - np.sqrt(np.maximum(bore**2 - y**2, 0.0))
    area = 2.0 * width / 1000.0
    limit = math.sqrt(1.0 - 3.0 * tau**2)
    carried = linprog(-area * y, A_eq=[area], b_eq=[0.0], bounds=[(-limit, limit)] * len(y))
    assert carried.fun is not None
    expected = math.sqrt(1.0 - v**2) * Circle(1.0, bore).plastic_modulus
    assert -carried.fun == pytest.approx(expected, rel=1e-4)
