"""J. Bowman, Kinematic and dynamic analysis of an airplane's landing gear, Ohio University (2019).

| quantity | tolerance | because |
| --- | --- | --- |
| weights of the bars | last digit | |
| angles, deg | 0.02 of -26.92, 0.05 of 301.9 | the print rounds between its steps (ours: -26.932) |
| angular rates | 1e-4 to 5e-4, 0.5 to 2 of the last digit | they follow from these angles |
| the drive's rates | 5e-4 of 0.824 and -0.2303 | half a digit of the first; -0.2299 goes with it |
| printed forces from the printed system | 6e-5 | half a unit of their last digit |
| ours from it with its errors put right | 5e-4 | its entries have four digits |
| balance of powers | 1e-9 | round-off |

The coupler's angle and rates are mirrored in print. The printed forces solve a wrong system, whose
errors are put right one after the other.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from loads import Dynamics, ledger, mobility
from loads.motion.four_bar import four_bar
from pinstress import load_study
from pinstress.study.model import cases as build
from pinstress.study.model.mechanism.linkage import linkage
from pinstress.study.reading.file import Study
from tests.conftest import INCH, LBF

STUDIES = Path(__file__).parents[2] / "studies"
UNKNOWNS = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y", "T2")


def rows(name: str) -> list[dict[str, str]]:
    text = (STUDIES / "bowman2019" / name).read_text(encoding="utf-8")
    return list(csv.DictReader(text.splitlines()))


def printed_system() -> tuple[np.ndarray, np.ndarray]:
    table = rows("printed_system.csv")
    A = np.array([[float(r[u]) for u in UNKNOWNS] for r in table])
    return A, np.array([float(r["right"]) for r in table])


@pytest.fixture(scope="module")
def study() -> Study:
    return load_study(STUDIES / "bowman2019.toml")


@pytest.fixture(scope="module")
def snapshot(study: Study) -> Dynamics:
    found = build.case_loads(study, "snapshot", linkage(study)).dynamics
    assert found is not None
    return found


def ours(found: Dynamics) -> np.ndarray:
    """In the order of the unknowns, lbf and lbf in."""
    names = ("F12", "F32", "F43", "F14")
    forces = np.concatenate([found.reactions.force(n)[0, :2] for n in names]) / LBF
    return np.append(forces, found.drive[0, 0] / LBF / INCH)


def test_mobility_and_class(study: Study) -> None:
    drawn = linkage(study)
    assert (mobility(drawn).kutzbach, mobility(drawn).degrees) == (1, 1)
    ring = four_bar(drawn)
    assert ring is not None
    assert ring.kind == "crank-rocker (Grashof)"
    assert [round(x / INCH, 9) for x in ring.lengths] == [32, 12, 30, 26]


def test_the_bars_weigh_what_table_9_says() -> None:
    from loads.linkage.mass_properties import round_bar

    pound = 0.45359237
    for length, mass in ((12, 42.8), (30, 107.1), (26, 92.8)):
        m, _ = round_bar(length * INCH, 4 * INCH, 0.284 * pound / INCH**3)
        assert round(m / pound, 1) == mass


def test_angles_and_rates_of_the_snapshot(snapshot: Dynamics) -> None:
    motion = snapshot.motion
    a, b, o4 = (motion.joint(j)[0][0] @ [1.0, 1.0j] for j in ("A", "B", "O4"))
    assert 180.0 - np.degrees(np.angle(b - a)) % 360.0 == pytest.approx(-26.92, abs=0.02)
    assert np.degrees(np.angle(b - o4)) % 360.0 == pytest.approx(301.9, abs=0.05)
    assert -motion.angular_velocity("coupler")[0] == pytest.approx(-0.0749, abs=1e-4)
    assert motion.angular_velocity("rocker")[0] == pytest.approx(0.363, abs=5e-4)
    assert -motion.angular_acceleration("coupler")[0] == pytest.approx(-0.1294, abs=2e-4)
    assert motion.angular_acceleration("rocker")[0] == pytest.approx(-0.181, abs=5e-4)


def test_the_snapshot_is_on_the_drives_way(study: Study) -> None:
    """The printed rates are those of the cycloid where it passes 315 degrees."""
    from pinstress.study.model.mechanism.drives import laws

    (law,) = laws(study)
    times = np.linspace(0.0, 5.0, 500001)
    angle, rate, second = law(times)
    t = int(np.argmin(np.abs(angle - np.radians(315.0))))
    assert rate[t] == pytest.approx(0.824, abs=5e-4)
    assert second[t] == pytest.approx(-0.2303, abs=5e-4)


def test_the_printed_system_gives_the_printed_forces() -> None:
    printed = {
        f"{r['name']}{r['quantity'][-1]}" if r["name"] != "crank" else "T2": float(r["published"])
        for r in rows("published.csv")
        if r["quantity"] in ("force_x", "force_y", "drive_torque")
    }
    A, b = printed_system()
    for name, value in zip(UNKNOWNS, np.linalg.solve(A, b), strict=True):
        assert value == pytest.approx(printed[name], abs=6e-5)


def test_putting_its_errors_right_leads_to_ours(snapshot: Dynamics) -> None:
    A, b = printed_system()
    wanted = ours(snapshot)
    far = np.abs(np.linalg.solve(A, b) - wanted)
    assert far[8] > 300.0
    for r in rows("corrections.csv"):
        i = int(r["row"]) - 1
        if r["column"] == "right":
            b[i] = float(r["right_value"])
        else:
            A[i, UNKNOWNS.index(r["column"])] = float(r["right_value"])
    assert np.linalg.solve(A, b) == pytest.approx(wanted, rel=5e-4)


def test_power_balances_at_all_instants(study: Study) -> None:
    found = build.case_loads(study, "retract", linkage(study)).dynamics
    assert found is not None
    assert ledger(found).violation < 1e-9
    motion = found.motion
    assert motion.v[[0, -1]] == pytest.approx(0.0, abs=1e-12)  # a cycloid rests at both ends
    assert motion.a[[0, -1]] == pytest.approx(0.0, abs=1e-12)


def test_the_other_branch_is_another_linkage(study: Study, tmp_path: Path) -> None:
    text = study.path.read_text(encoding="utf-8").replace('side = "left"', 'side = "right"')
    text = text.replace('values = "bowman2019/published.csv"', "")
    path = tmp_path / "other.toml"
    path.write_text(text, encoding="utf-8")
    ours, other = linkage(study), linkage(load_study(path))
    rings = [four_bar(x) for x in (ours, other)]
    assert rings[0] is not None
    assert rings[1] is not None
    assert rings[1].lengths == pytest.approx(rings[0].lengths)
    assert ours.joint("B").at != pytest.approx(other.joint("B").at)
    assert not rings[0].crossed
    assert not rings[1].crossed  # the crank nearly aligned with the ground, B on its other side
