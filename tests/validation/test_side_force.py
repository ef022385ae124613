"""The main job with a side force on its tyre, from the study to rows, in contact with lugs; and
under the landings of 14 CFR part 25.
"""

import math
from pathlib import Path

import numpy as np
import pytest

import pinstress
from assess.clauses.lug_out_of_plane import STRUCTURE_NEED
from pinstress.analysis.plan import all_loads
from pinstress.study.model.cases import CaseLoads
from pinstress.study.reading.file import load_study
from tests.conftest import ROOT
from tests.support.each import sampled

SIDE = """
[case.side]
kind = "static"
position = 30.70

[[case.side.apply]]
body = "tyre"
at = "J"
force = [0, 20000, 5000]
"""


def _study(folder: Path, more: str = SIDE) -> pinstress.Study:
    text = (ROOT / "studies" / "landing_gear.toml").read_text(encoding="utf-8")
    # Tables of its own before those that a copied study would need files for.
    text = text.split("[published]")[0] + "[mechanism]" + text.split("[mechanism]", 1)[1]
    path = folder / "gear.toml"
    path.write_text(text + more, encoding="utf-8")
    return load_study(path)


@pytest.mark.slow
@pytest.mark.parametrize("pin", sampled(["E", "A"], every=2))
def test_pins_carry_all_six_components(pin: str, tmp_path: Path) -> None:
    """E is floating, A fixed in the ground and without a shoulder."""
    (row,) = pinstress.run(_study(tmp_path), pins=[pin], cases=["side"], tolerance=0.1).pins
    assert row.max_von_mises
    assert row.verdict in ("converged", "unconverged")
    assert row.sharing is not None
    low, high = row.sharing.max_von_mises
    assert low < row.max_von_mises < high
    assert row.sharing.largest_load >= high / row.max_von_mises * (1.0 - 1e-12)
    (bent,) = (m for m in row.worst if m.method == "lug, bending out of its plane")
    lacking = bent.needs.split(", ")
    assert {"A": "pin.A.lug.A.shank", "E": "pin.E.lug.E2.shank"}[pin] in lacking
    assert (STRUCTURE_NEED in lacking) is (pin == "A")
    assert ("forces along the axis: that of A on its own band" in row.note) is (pin == "A")


@pytest.mark.long
@pytest.mark.slow
def test_a_landing_is_as_without_the_side_force_of_another_case(tmp_path: Path) -> None:
    asked = ((SIDE, ["landing", "side"]), ("", ["landing"]))
    runs = (
        pinstress.run(_study(tmp_path, more), pins=["E"], cases=cases, tolerance=0.1)
        for more, cases in asked
    )
    both, alone = (results["E", "landing"] for results in runs)
    assert both.verdict == alone.verdict == "converged"
    assert both.max_von_mises == pytest.approx(alone.max_von_mises, rel=0.01)
    assert both.sharing is None


PART_25 = ROOT / "studies" / "landing_gear_part25.toml"
DROPS = {"landing-weight": 10.0, "take-off-weight": 6.0, "reserve-energy": 12.0}  # ft/s
POUND, INCH = 4.4482216152605, 0.0254


def loads_of(study: pinstress.Study) -> dict[str, CaseLoads]:
    """The loads of all cases."""
    return all_loads(study, [*study.table.case])


def test_drops_of_part_25_are_those_of_a_mass_on_a_spring() -> None:
    """With lift equal to weight the largest reaction is v sqrt(m k), after a quarter of a period;
    the parts of the paragraphs follow from it.
    """
    stiffness = 106500.0 / 10.0 * POUND / INCH
    mass = 37500.0 * 0.45359237
    loads = loads_of(load_study(PART_25))
    for name, feet in DROPS.items():
        landing = loads[name].landing
        assert landing is not None
        peak = landing.peaks["vertical"]
        assert peak.value == pytest.approx(0.3048 * feet * math.sqrt(mass * stiffness), rel=1e-6)
        assert peak.time == pytest.approx(math.pi / 2.0 * math.sqrt(mass / stiffness), rel=1e-3)
        assert peak.time == pytest.approx(0.15, rel=1e-3)  # the publication's
    largest = 3.048 * math.sqrt(mass * stiffness)
    parts = {  # vertical, aft, and towards the pilot's left, who flies to -x: z
        "25.473-spin-up": (1.0, 0.8, 0.0),
        "25.473-spring-back": (1.0, -0.8, 0.0),
        "25.479-drag": (1.0, 0.25, 0.0),
        "25.479-drift-inboard": (0.75, 0.3, -0.1875),
        "25.479-drift-outboard": (0.75, 0.3, 0.1875),
    }
    assert [*loads] == [*DROPS, *parts]
    for name, (vertical, aft, side) in parts.items():
        ground = loads[name].ground
        assert ground is not None
        total = np.sum([force.force for force in ground.forces], axis=0)
        assert total == pytest.approx(largest * np.array([aft, vertical, side]), rel=1e-6), name


def test_landings_of_part_25_reach_the_aircraft_with_all_six_components() -> None:
    """Equilibrium of the whole gear. Weights drop out of the difference of two cases: between the
    drifts the side load alone acts, twice; among the others drag and vertical load.
    """
    study = load_study(PART_25)
    loads = loads_of(study)
    drift = [loads[f"25.479-drift-{side}"] for side in ("inboard", "outboard")]
    _in_equilibrium(*drift)
    others = [loads[f"25.{name}"] for name in ("473-spin-up", "473-spring-back", "479-drag")]
    for one in others[1:]:
        _in_equilibrium(others[0], one)


PART_23 = ROOT / "studies" / "light_gear_part23.toml"


def test_side_loads_of_part_23_to_the_left_and_right_mirror_each_other() -> None:
    """Every leg lies in a plane of its own, whatever the heights of bands on its pins: forces in
    the plane do not turn it out of it, and the other leg feels nothing of a side load.
    """
    loads = loads_of(load_study(PART_23))
    left, right = (loads[f"nose 23.499-side-{side}"].reactions for side in ("left", "right"))
    side = 2.25 * 0.7 * 350.0 * POUND
    aside = np.abs(np.concatenate([left.moments[0, :, 0], left.forces[0, :, 2] * INCH])).max()
    assert np.abs(left.force("V")[0, 2]) == pytest.approx(side, rel=1e-12)
    assert left.moments == pytest.approx(-right.moments, abs=1e-9 * aside)
    assert left.forces[..., 2] == pytest.approx(-right.forces[..., 2], abs=1e-9 * side)
    main = [left.connections.index(name) for name in ("A", "D", "E", "W")]
    assert np.abs(left.moments[0, main]).max() < 1e-9 * aside
    # The side load at the ground, 32 in beneath F, is carried by F and G alone.
    f, g = (left.connections.index(name) for name in "FG")
    about_x = left.moments[0, [f, g], 0].sum() + 2.0 * INCH * left.forces[0, g, 2]
    assert abs(about_x) == pytest.approx(32.0 * INCH * side, rel=1e-12)


def _in_equilibrium(one: CaseLoads, other: CaseLoads) -> None:
    """What A, D and H pass on, less the forces on the wheel, between two cases."""
    force, moment = np.zeros((2, 3))
    for case, sign in ((one, 1.0), (other, -1.0)):
        assert case.ground is not None
        assert case.dynamics is not None
        motion, r = case.dynamics.motion, case.reactions
        offsets = {} if case.side is None else case.side.offsets.connections
        for push in case.ground.forces:
            at = np.array([*motion.joint("J")[0][0], 0.0]) + push.arm
            force += sign * np.array(push.force)
            moment += sign * np.cross(at, push.force)
        for name in ("A", "D1", "D2", "H"):
            k, joint = r.connections.index(name), name[0]
            at = np.array([*motion.joint(joint)[0][0], offsets.get(name, 0.0)])
            force -= sign * r.forces[0, k]
            moment -= sign * (np.cross(at, r.forces[0, k]) + r.moments[0, k])
    size = 1e5 * POUND
    assert force == pytest.approx(np.zeros(3), abs=1e-9 * size)
    assert moment == pytest.approx(np.zeros(3), abs=1e-9 * size)
