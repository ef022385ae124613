"""The range of a yield strength: what it decides alone, and with other ranges, and what is told.

A factor is in proportion to the strength; the made-up rows require 1.5.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest

import pinstress
from assess.judgement import DEPENDS, FAILS, SAFE
from assess.plastic.lug.ultimate import pull
from assess.requirement import StatedRequirement
from assess.strength.model_stress import YIELD_METHOD
from fea.support.records import TOGETHER
from geometry.mesh.hexahedra import HexSize
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.in_python import study_from
from reports.data.dependence import YIELD_STRENGTH, depends_on
from reports.data.requirements import requirement_rows
from reports.data.row import PinResult, Units
from reports.data.unknowns import factor_spread, unknowns
from reports.text.certainty import flips, flips_words, measure_first, range_words
from tests.reports.test_unknowns import pin

UNITS = Units("in", "lbf", "psi", "s")
STUDY = """
title = "A pin of a steel whose yield strength lies between two values"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "900 MPa"
range = { yield_strength = ["LOW MPa", "1000 MPa"] }
[analysis]
required_safety_factor = 2.3
tolerance = 0.05
[case.pull]
kind = "given"
forces = { L = [0, 50000] }
[pin.P]
material = "steel"
clamp = ["start"]
fillet = 3
profile = [{ length = 20, diameter = 60 }, { length = 40, diameter = 40, connection = "L" }]
"""


def over(row: PinResult, low: float, high: float) -> PinResult:
    """A row whose strength lies between `low` and `high` times that of the study."""
    strength = row.yield_strength or 0.0
    row = replace(row, strength_range=(low * strength, high * strength))
    return replace(row, depends_on=depends_on(row))


def test_a_strength_that_alone_changes_the_outcome() -> None:
    """2.0 * 0.7 = 1.4 is too low: from the strength at which the upper end of the error is 1.5."""
    row = over(pin(2.0, None), 0.7, 1.1)
    assert row.outcome == DEPENDS
    (d,) = row.depends_on
    stress, error, strength = row.max_von_mises, row.error_estimate, row.yield_strength
    assert stress and error is not None and strength  # noqa: PT018
    assert (d.what, d.over) == (YIELD_STRENGTH, "strength")
    assert d.factor == pytest.approx(1.4)
    assert d.at == pytest.approx(0.7 * strength)
    assert d.flips_at == pytest.approx(1.5 * (stress + error))
    assert over(pin(2.0, None), 0.8, 1.1).outcome == SAFE


def test_a_pin_that_fails_is_safe_with_more_strength() -> None:
    stronger = over(pin(1.2, None), 0.9, 1.5)
    assert stronger.outcome == FAILS
    assert [d.factor for d in stronger.depends_on] == pytest.approx([1.8])
    assert over(pin(1.2, None), 0.9, 1.2).depends_on == ()


def test_strength_and_joint_that_change_an_outcome_only_together() -> None:
    """2.0 * 0.85 = 1.7 and 2.0 / 1.2 = 1.67 are enough, 2.0 * 0.85 / 1.2 = 1.42 is not."""
    row = over(pin(2.0, (0.9, 1.2)), 0.85, 1.0)
    assert row.outcome == DEPENDS
    (d,) = row.depends_on
    assert (d.what, d.over) == (TOGETHER, "strength and joint")
    assert d.factor == pytest.approx(2.0 * 0.85 / 1.2)
    assert flips(row, UNITS) == "the strength and joint values together"
    assert over(pin(2.0, (0.9, 1.2)), 0.95, 1.0).outcome == SAFE


def test_the_strength_is_told_among_what_is_open() -> None:
    row = over(pin(2.0, (0.9, 1.1)), 0.7, 1.2)
    assert factor_spread(row) == pytest.approx((2.0 * 0.7 / 1.1, 2.0 * 1.2 / 0.9))
    first, tilt = unknowns([row])
    assert (first.what, tilt.what) == (YIELD_STRENGTH, "tilt")
    ((_, value),) = first.rows
    assert (value.low, value.high) == pytest.approx((1.4, 2.4))
    assert flips_words(first, UNITS).startswith("A may fail below 88,900 psi")
    assert range_words(first, UNITS).endswith(" psi")
    assert measure_first([first, tilt]) == ["Measure first: yield strength (A)."]


def test_a_study_states_the_range(tmp_path: Path) -> None:
    """367 MPa with an error below 5 %: 2.3 needs 844 to 886 MPa."""
    path = tmp_path / "study.toml"
    path.write_text(STUDY.replace("LOW", "800"))
    (row,) = pinstress.run(pinstress.load_study(path)).pins
    assert row.outcome == DEPENDS
    (d,) = row.depends_on
    assert d.given == pytest.approx(900.0)
    assert 840.0 < (d.flips_at or 0.0) < 890.0
    path.write_text(STUDY.replace("LOW", "890"))
    assert pinstress.run(pinstress.load_study(path)).pins[0].outcome == SAFE
    path.write_text(STUDY.replace("LOW", "950"))
    with pytest.raises(InputError, match="between its lower and its upper end"):
        pinstress.load_study(path)


def test_checks_by_formula_hold_at_the_lower_end(tmp_path: Path) -> None:
    """As if the study stated the lower end alone; the row's own margin against yield stays at the
    value given, since the row depends on its range.
    """
    path = tmp_path / "study.toml"

    def margins(text: str) -> dict[str, float | None]:
        path.write_text(text)
        (row,) = pinstress.run(pinstress.load_study(path)).pins
        return {m.method: m.margin for m in row.worst}

    ranged = margins(STUDY.replace("LOW", "800"))
    alone = STUDY.replace('range = { yield_strength = ["LOW MPa", "1000 MPa"] }', "")
    given, low = margins(alone), margins(alone.replace("900 MPa", "800 MPa"))
    assert ranged.keys() == given.keys() == low.keys()
    differ = {name for name in given if given[name] != low[name]}
    assert len(differ) > 1
    for name in differ:
        expected = given if name == YIELD_METHOD else low
        assert ranged[name] == pytest.approx(expected[name])


def test_a_net_section_is_judged_at_the_end_at_which_it_carries_less() -> None:
    """Of a wide plate 0.6 b F_u/F_y sqrt(D/b) carries: less, the higher F_y is. By hand, with D 20,
    b 40, t 20, F_u 420, N_d 2: P_t is 121,691 N at F_y = 410 MPa and 199,574 N at 250 MPa, which
    let 150 kN pass. The metal hardens to less than the upper end, which is no error.
    """
    study = study_from("""
title = "A wide plate"
units = "mm-N-s"
[material.pin]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
[material.plate]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = 350
ultimate_strength = 420
range = { yield_strength = [250, 410] }
hardening = [[0.02, 400]]
[analysis]
joints = "prescribed"
model = "beam"
code = ["general", "lifting"]
design_factor = 2
[case.pull]
kind = "given"
forces = { L = [0, 150000] }
[pin.P]
material = "pin"
clamp = ["start"]
profile = [{ length = 20, diameter = 20 }, { length = 20, diameter = 20, connection = "L" }]
lug.L = { outer_diameter = 100, material = "plate" }
""")
    (row,) = pinstress.run(study).pins
    got = {f"{m.method}, {m.level}": m for m in row.worst if m.at == "L"}
    carries = {fy: 0.6 * 40.0 * 420.0 / fy * 0.5**0.5 for fy in (250.0, 410.0)}
    tension, bearing = (got[f"BTH-1 plate, {x}, limit"] for x in ("tension", "bearing"))
    assert tension.allowable == pytest.approx(420.0 * 40.0 * carries[410.0] / 2.4)
    assert 420.0 * 40.0 * carries[410.0] / 2.4 < 150e3 < 420.0 * 40.0 * carries[250.0] / 2.4
    assert "upper end" in tension.basis
    assert bearing.allowable == pytest.approx(1.25 * 250.0 * 400.0 / 2.0)
    assert "lower end" in bearing.basis
    for level, strength, end in (("limit", 250.0, 250.0), ("ultimate", 420.0, 410.0)):
        net = got[f"lug, net section, {level}"]
        used = 150e3 / (40.0 * carries[end]) / strength
        assert net.demand and net.allowable  # noqa: PT018
        assert net.demand / net.allowable == pytest.approx(used)


def test_requirements_on_collapse_know_the_range_and_those_on_rupture_do_not() -> None:
    """A factor on the limit load that the lower end of the strength misses, which a run at that
    end shows, was met. Rupture, by another strength, depended on it.
    """
    text = STUDY.replace("= 2.3", "= 1.0").replace("50000", "150000")
    text = text.replace("[analysis]", 'ultimate_strength = "1900 MPa"\n[analysis]')
    weak = text.replace('range = { yield_strength = ["LOW MPa", "1000 MPa"] }', "")
    weak = weak.replace('"900 MPa"', '"600 MPa"')
    ranged, weakest = (pinstress.run(study_from(x.replace("LOW", "600"))) for x in (text, weak))
    strong, weak_limit = (x.pins[0].limit_load for x in (ranged, weakest))
    assert strong is not None and weak_limit is not None  # noqa: PT018
    assert strong.lower is not None and weak_limit.lower is not None  # noqa: PT018
    between = (strong.lower * weak_limit.lower) ** 0.5
    collapse = StatedRequirement("P", "pull", "ultimate", "limit load", between)
    rupture = StatedRequirement("P", "pull", "ultimate", "rupture", 1.5)
    outcomes = []
    for results in (ranged, weakest):
        rows = requirement_rows(replace(results, stated=(collapse, rupture)))
        outcomes.append({r.check: (r.outcome, r.over) for r in rows if r.stated})
    assert [x["rupture"] for x in outcomes] == [("met", "")] * 2
    assert [x["limit load"] for x in outcomes] == [("depends", "strength"), ("not decided", "")]


HARDENING = """
title = "A pin that hardens and its lug, both perhaps weaker than stated"
units = "mm-N-s"
[material.pin]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = FY
hardening = [[0.05, LAST]]
RANGE
[material.lug]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = FY
ultimate_strength = 600
failure_strain = 0.1
RANGE
[analysis]
joints = "prescribed"
limit_load = "always"
tolerance = 0.3
[case.pull]
kind = "given"
forces = { L = [0, 9000] }
[pin.P]
material = "pin"
clamp = ["start"]
profile = [{ length = 10, diameter = 20 }, { length = 20, diameter = 20, connection = "L" }]
lug.L = { material = "lug", outer_diameter = 40, shank = { angle = "90 deg" } }
"""


@pytest.mark.slow
def test_collapse_and_rupture_hold_at_the_lower_end_of_the_strength(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As in a study that states the lower end alone. The limit load of a pin that hardens and the
    ultimate load of a lug (25 and 7 % too high here) stayed at the strength given.
    """
    monkeypatch.setattr("assess.plastic.lug.ultimate.MESH_SIZES", (0.4, 0.3))
    monkeypatch.setattr("assess.plastic.lug.ultimate.pull", partial(pull, max_travel=0.15))
    monkeypatch.setattr("assess.plastic.solve.MESH_SIZES", (HexSize(2, 0.5), HexSize(4, 0.5)))

    def used(strength: float, ends: str) -> dict[str, float]:
        text = HARDENING.replace("FY", str(strength)).replace("RANGE", ends)
        (row,) = pinstress.run(study_from(text.replace("LAST", str(1.25 * strength)))).pins
        return {m.method: m.used for m in row.worst if m.kind == "collapse"}

    ranged = used(400.0, "range = { yield_strength = [320, 480] }")
    assert set(ranged) == {"limit load, collapse", "lug, limit load", "lug, ultimate load"}
    assert ranged == pytest.approx(used(320.0, ""), rel=0.01)  # of coarse meshes
