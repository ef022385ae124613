"""Pins of which a section governs as described, and the surface in a loose joint."""

from __future__ import annotations

from pathlib import Path

import pytest

from assess.judgement import DEPENDS
from fea.support.contact.joint_changes import largest_of
from fea.support.records import FRICTION, JointRange, Variation
from pinstress.analysis.results import RunResults
from pinstress.study.reading.in_python import study_from
from reports.data.row import PinResult
from tests.silent.test_checks_over_the_joint import SHANK, TEXT, TIGHT, solved
from tests.support.each import sampled
from tests.support.pins.remembered import remembered

SHORT = """profile = [
  { length = 5, diameter = 20 },
  { length = 20, diameter = 20, connection = "LEFT" },
  { length = 0.6, diameter = 20 },
  { length = 20, diameter = 20, connection = "EYE" },
  { length = 5, diameter = 20 },
]
"""
CLEVIS = SHORT.replace(
    """length = 20, diameter = 20, connection = "EYE" },""",
    """length = 40, diameter = 20, connection = "EYE" },
  { length = 0.6, diameter = 20 },
  { length = 20, diameter = 20, connection = "RIGHT" },""",
)
SWAPS = (
    (TEXT[TEXT.index("profile = [") : TEXT.index("[lug_defaults]")], SHORT),
    (", RIGHT = [-HALF, 0]", ""),
    ("WHOLE", "HALF"),
    ("edge_radius = 0.5", 'edge_radius = 0.5\ntilt = "guided"'),
    (
        "[analysis]",
        """[material.steel.fatigue]
knee_stress = "1 MPa"
knee_cycles = 1e6
slope = 5
mean_stress_sensitivity = 0.2
[fatigue.occurrences]
pull = 1
[analysis]""",
    ),
)
ALONE = """clearance = 0.0
[lug_defaults.range]
clearance = [0.0, END]
stiffness = [1, 1]
tilt = ["guided", "guided"]
"""


def of(clearance: str, required: float = 1.0) -> RunResults:
    asked = "required_safety_factor = 1.0", f"required_safety_factor = {required}"
    return solved(clearance, 25000.0, *SWAPS, asked)


@pytest.mark.slow
@pytest.mark.parametrize("end", sampled([0.1, 0.3], every=2))
def test_the_surface_has_its_own_error_and_growth_in_a_loose_joint(end: float) -> None:
    """Beside a joint that is loose. The error was that of the section, which has hardly any, so
    that a factor between the two was safe; and fatigue, which reads the surface, grew as the row.
    """
    (loose,) = of(f"clearance = {end}").pins
    (ranged,) = of(ALONE.replace("END", f"{end}")).pins
    assert loose.places
    assert loose.places.governs == "surface"
    at_least = loose.maximum.lower_end
    assert ranged.places
    assert ranged.places.governs == "section"
    assert ranged.maximum.upper_end < 1.003 * ranged.maximum.lower_end
    assert ranged.joint
    over, surface = ranged.joint.range, ranged.places.surface
    assert over
    assert over.across < 1.01
    reached = over.max_von_mises[1]
    assert reached > at_least
    # What the cells leave open of the surface as described is open of it in the loose joint.
    assert reached > 1.04 * over.variations[0].max_von_mises
    with_error = surface.max_von_mises + (surface.error_estimate or 0.0)
    assert ranged.surface_growth * with_error > at_least
    (between,) = of(ALONE.replace("END", f"{end}"), 700.0 / (0.99 * reached)).pins
    assert between.outcome == DEPENDS


def test_damage_grows_as_the_surface() -> None:
    """Beyond the knee it grows as the fifth power of stress."""
    results = of(ALONE.replace("END", "0.1"))
    (row,), fatigue = results.pins, results.fatigue
    assert fatigue is not None
    assert row.surface_growth > 1.05 * row.joint_growth
    for point in fatigue.points:
        grown = point.damage_over["joint"] / point.damage
        assert grown == pytest.approx(row.surface_growth**5, rel=1e-6)


def test_friction_multiplies_what_a_loose_joint_adds() -> None:
    """The stress did so; moments and forces counted the larger of both."""
    over = (
        Variation("clearance", "twice the given", 1.0, across=1.2, surface=1.5),
        Variation("tilt", "free", 1.0, across=1.1, surface=0.9),
        Variation(FRICTION, "0.2, load falling after a larger one", 1.0, across=1.3, surface=1.4),
        Variation(FRICTION, "0.2, load growing", 1.0, across=1.0, surface=0.7),
    )
    joint = JointRange((1.0, 1.0), over)
    assert joint.across == pytest.approx(1.2 * 1.3)
    assert joint.surface == pytest.approx(1.5 * 1.4)
    assert joint.growth(1.0) == joint.across


Instants = dict[str, tuple[float, float, float]]
SHEAR_THEN_BENT: Instants = {"shear": (25e3, 25e3, 0.0), "bent": (21e3, 42e3, 21e3)}


def rows_of(
    tmp_path: Path, joint: str, instants: Instants, *swaps: tuple[str, str]
) -> dict[str, PinResult]:
    """The rows of a case with two instants, "both", and of each as a case of its own."""
    rows = ["time,connection,fx,fy"]
    for t, (a, b, c) in enumerate(instants.values()):
        rows += [f"{t},LEFT,{-a},0", f"{t},EYE,{b},0", f"{t},RIGHT,{-c},0"]
    (tmp_path / "both.csv").write_text("\n".join(rows), encoding="utf-8")
    text = TEXT.replace("CLEARANCE", joint)
    for old, new in swaps:
        text = text.replace(old, new)
    text = text[: text.index("[case.pull]")] + '[case.both]\nkind = "given"\ntable = "both.csv"\n'
    for name, (a, b, c) in instants.items():
        force = f"LEFT = [{-a}, 0], EYE = [{b}, 0], RIGHT = [{-c}, 0]"
        text += f'[case.{name}]\nkind = "given"\nforces = {{ {force} }}\n'
    return {x.case: x for x in remembered(study_from(text, tmp_path)).pins}


def upper_ends(rows: dict[str, PinResult]) -> dict[str, float]:
    over = {case: x.joint.range for case, x in rows.items() if x.joint}
    return {case: x.max_von_mises[1] for case, x in over.items() if x}


def test_the_joint_is_varied_where_the_surface_peaks_too(tmp_path: Path) -> None:
    """Two instants as a case, beside each as a case of its own. At the first a section governs, at
    the second the surface is nearly as large, and grows more in soft lugs: it was not tried there.
    """
    soft = ALONE.replace("END", "0.0").replace("[1, 1]", "[0.5, 1]")
    rows = rows_of(tmp_path, soft, SHEAR_THEN_BENT, (SWAPS[0][0], CLEVIS), SWAPS[3])
    governs, high = (
        {case: x.places and x.places.governs for case, x in rows.items()},
        upper_ends(rows),
    )
    assert governs == {"both": "section", "shear": "section", "bent": "surface"}
    assert high["bent"] > 1.1 * high["shear"]
    assert high["both"] == pytest.approx(high["bent"], rel=0.01)


def test_foundations_are_varied_where_another_instant_may_govern(tmp_path: Path) -> None:
    """Where the smaller load bends a pin three times as much once its lugs are free to tilt, which
    they are not under the larger one.
    """
    long = (
        CLEVIS.replace("length = 20,", "length = 30,")
        .replace("= 40,", "= 60,")
        .replace("= 0.6,", "= 5,")
    )
    instants = {"shear": (25e3, 25e3, 0.0), "bent": (15e3, 30e3, 15e3)}
    beam = "[analysis]", '[analysis]\njoints = "foundation"'
    high = upper_ends(rows_of(tmp_path, TIGHT, instants, (SWAPS[0][0], long), beam))
    assert high["bent"] > 1.5 * high["shear"]
    assert high["both"] == pytest.approx(high["bent"], rel=1e-6)


@pytest.mark.slow
def test_lugs_are_varied_where_each_is_stressed_most(tmp_path: Path) -> None:
    """RIGHT carries nothing while the pin is stressed most: a looser joint changed nothing of it.
    Alone in that case, it had no stress, and neither had the other lugs.
    """
    loose = ALONE.replace("END", "0.05")
    rows = rows_of(tmp_path, loose, SHEAR_THEN_BENT, (SWAPS[0][0], CLEVIS), SWAPS[3], SHANK)
    found = {
        case: {x.connection: x for x in row.joint.lugs if x.place == "free"}
        for case, row in rows.items()
        if row.joint
    }
    assert found["both"]["RIGHT"].time == 1.0
    for case, lug in (("bent", "RIGHT"), ("shear", "LEFT"), ("shear", "EYE")):
        ours, alone = found["both"][lug], found[case][lug]
        ends = [x.over_joint * (x.max_von_mises + x.error_estimate) for x in (ours, alone)]
        assert min(ends) > 1.5 * alone.max_von_mises
        assert ends[0] == pytest.approx(ends[1], rel=0.1)


def test_the_largest_of_two_instants_has_the_interval_that_reaches_farthest() -> None:
    """Without one of its own a stress has the error of the row."""

    def merged(plain: float) -> Variation:
        (one,) = largest_of(
            (
                Variation("tilt", "free", plain, across=1.1, lugs=(("A", 1.2), ("B", 1.5))),
                Variation(
                    "tilt", "free", 1.3, interval=(1.2, 1.4), surface=2.0, lugs=(("A", 1.3),)
                ),
            )
        )
        return one

    below, above = merged(1.25), merged(1.5)
    assert (below.max_von_mises, below.interval) == (1.3, (1.25, 1.4))
    assert (above.max_von_mises, above.interval) == (1.5, None)
    assert (below.across, below.surface, dict(below.lugs)) == (1.1, 2.0, {"A": 1.3, "B": 1.5})
