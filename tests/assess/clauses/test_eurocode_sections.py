"""EN 1993-1-1, 6.2.8 to 6.2.10, of round sections: sums on paper, and the moment that integrals of
a yielding section leave.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from assess.checks import margins_of
from assess.clauses.eurocode_sections import plastic_shear, section_use, torsion_resistance
from assess.margin import Margin
from assess.situation import Situation
from fea.beam.round_section import Circle
from geometry import Pin
from tests.assess.strength.test_strength import S235, in_double_shear
from tests.support.each import each

METHOD = "EN 1993-1-1 section"
SOLID, TUBE, FY = Circle(0.01), Circle(0.01, 0.006), 235e6


def used(section: Circle, v: float, m: float, n: float, t: float) -> float:
    """R of parts of the plastic resistances to shear, bending, pull and torsion."""
    forces = (
        v * plastic_shear(section, FY), m * section.plastic_modulus * FY, n * section.area * FY,
        t * torsion_resistance(section, FY),
    )  # fmt: skip
    return float(section_use(section, FY, *(np.array([x]) for x in forces))[0])


@each("section", [SOLID, TUBE])
@each("depth", [0.0, 0.3, 0.6, 0.9])
def test_the_moment_that_an_axial_force_leaves(section: Circle, depth: float) -> None:
    """6.2.9: the stress changes its sign at a depth of the radius; both parts by integrals."""
    y = np.linspace(-section.outer, section.outer, 200_001)
    width = 2.0 * (
        np.sqrt(np.maximum(section.outer**2 - y**2, 0.0))
        - np.sqrt(np.maximum(section.inner**2 - y**2, 0.0))
    )
    sign = np.where(y > -depth * section.outer, 1.0, -1.0)
    n = float(np.trapezoid(width * sign, y)) / section.area
    m = float(np.trapezoid(width * sign * y, y)) / section.plastic_modulus
    assert used(section, 0.0, m, n, 0.0) == pytest.approx(1.0, rel=1e-3)
    assert used(section, 0.46, m, n, 0.0) == pytest.approx(1.0, rel=1e-3)


@each("v", [0.52, 0.6, 0.75, 0.9])
def test_shear_above_half_lowers_the_yield_strength(v: float) -> None:
    """6.2.8: at v = 0.75 rho is 0.25, and three quarters of the plastic moment are left."""
    rho = (2.0 * v - 1.0) ** 2
    assert used(SOLID, v, 1.0 - rho, 0.0, 0.0) == pytest.approx(1.0, rel=1e-4)
    assert used(SOLID, 2 * v, 2 * (1.0 - rho), 0.0, 0.0) == pytest.approx(2.0, rel=1e-4)
    assert used(SOLID, v - 0.1, 1.0 - rho, 0.0, 0.1) == pytest.approx(1.0, rel=1e-4)


def test_shear_and_torsion_alone() -> None:
    assert used(TUBE, 0.8, 0.0, 0.0, 0.0) == pytest.approx(0.8)
    assert used(TUBE, 0.3, 0.0, 0.0, 0.4) == pytest.approx(0.7)
    assert used(TUBE, 0.0, 0.0, 0.0, 0.0) == 0.0


@each("part", [1.0, 1e-3, 1e-9])
def test_a_use_is_proportional_to_the_load(part: float) -> None:
    """Also to newton metres and newtons that are fractions of one."""
    for v, m, n in ((0.0, 0.5, 0.0), (0.0, 0.0, 0.5), (0.3, 0.4, 0.2), (0.1, 0.4, 0.2)):
        whole = used(SOLID, v, m, n, 0.0)
        assert used(SOLID, part * v, part * m, part * n, 0.0) == pytest.approx(part * whole)


def in_civil(along: float, torque: float = 0.0, bore: float = 0.0) -> Situation:
    """A pin of 16 mm in double shear, pulled along its axis and twisted from A to C."""
    s = replace(in_double_shear(0.02, 0.002, 0.03, 0.016, 10e3), codes=("civil",))
    forces, moments = s.loads.forces.copy(), np.zeros((1, 3, 3))
    forces[0, [0, 2], 2], moments[0, [0, 2], 2] = (along, -along), (torque, -torque)
    pin = Pin("P", tuple(replace(x, bore=bore) for x in s.pin.segments))
    return replace(s, profile=pin, loads=replace(s.loads, forces=forces, moments=moments))


def section_margin(s: Situation) -> Margin:
    (margin,) = (m for m in margins_of(s) if m.method == METHOD)
    return margin


def test_margins_on_paper() -> None:
    """10 kN across, M = F (b + 4 c + 2 a) / 8 at mid-span, 15 kN along: m and n in the middle."""
    bent, pulled = section_margin(in_civil(0.0)), section_margin(in_civil(15e3))
    m = 10e3 * 0.078 / 8.0 / (0.016**3 / 6.0 * FY)
    assert bent.demand == pytest.approx(m, rel=1e-3)
    assert bent.factor == 1.5
    n = 15e3 / (math.pi / 4.0 * 0.016**2 * FY)
    circle = Circle(0.008)
    assert pulled.demand == pytest.approx(used(circle, 0.0, m, n, 0.0), rel=1e-3)
    assert pulled.demand > bent.demand  # type: ignore[operator]
    assert pulled.work[-1].result.value == pytest.approx(pulled.demand)
    assert pulled.passing is not None
    assert pulled.passing.symbol == "diameter"


def test_a_partial_factor_divides_the_strength() -> None:
    """A pin bent, pulled and twisted at gamma 1.25 is one at 1 under 1.25 times the loads."""
    s = in_civil(15e3, torque=20.0)
    more = replace(s.loads, forces=1.25 * s.loads.forces, moments=1.25 * s.loads.moments)
    lower = section_margin(replace(s, partial=replace(s.partial, M0=1.25)))
    assert lower.used == pytest.approx(section_margin(replace(s, loads=more)).used)


@each("bore", [0.0, 0.008])
def test_the_diameter_that_would_pass_does(bore: float) -> None:
    """With the bore as it is."""
    found = section_margin(in_civil(15e3, bore=bore)).passing
    assert found is not None
    s = in_civil(15e3, bore=bore)
    wider = Pin("P", tuple(replace(x, diameter=found.value) for x in s.pin.segments))
    assert section_margin(replace(s, profile=wider)).used == pytest.approx(1.0, rel=1e-5)


def test_torsion_counts_as_shear() -> None:
    """80 N m of a resistance of 109."""
    turned = section_margin(in_civil(0.0, torque=80.0))
    quantities = {q.symbol: q.value for w in turned.work for q in w.quantities}
    assert quantities["T_Ed"] == pytest.approx(80.0, rel=1e-6)
    assert turned.demand > section_margin(in_civil(0.0)).demand  # type: ignore[operator]


@each("torque", [0.0, 22.0, 23.0, 60.0])
def test_the_formula_that_is_shown_gives_the_result(torque: float) -> None:
    """Bent by 67.5 N m of 160 in the middle, b is 0.42; up to v = 0.21, by 22.96 N m of 109, it is
    shown alone.
    """
    s = replace(in_double_shear(0.02, 0.05, 0.03, 0.016, 2e3), codes=("civil",))
    moments = np.zeros((1, 3, 3))
    moments[0, [0, 2], 2] = (torque, -torque)
    last = section_margin(replace(s, loads=replace(s.loads, moments=moments))).work[-1]
    shown = {q.symbol: q.value for q in last.quantities}
    assert ("v" in shown) == (torque > 22.96)
    b, v = shown["b"], shown.get("v", 0.0)
    assert last.result.value == pytest.approx(4.0 * v * v / (4.0 * v - b) if v else b, rel=1e-9)


def test_a_slender_tube_is_named() -> None:
    """d/t of 160: above 70 for S235."""
    thin = section_margin(in_civil(0.0, bore=0.0158))
    assert "class 1 or 2" in thin.needs


def test_reactions_along_the_pin_that_no_formula_gives_are_named() -> None:
    """What a structure's lugs take along the axis is in the solved joint alone."""
    s = in_civil(15e3)
    forces = s.loads.forces.copy()
    forces[0, 2, 2] = 0.0
    one_sided = replace(s, loads=replace(s.loads, forces=forces))
    assert "solved joint" in section_margin(one_sided).needs


def test_general_does_not_have_it() -> None:
    s = replace(in_civil(0.0), codes=("general",))
    assert not any(m.method == METHOD for m in margins_of(s))


def test_a_strength_is_asked_for() -> None:
    s = replace(in_civil(0.0), material=replace(S235, yield_strength=None))
    assert section_margin(s).needs == "material.S235.yield_strength"
