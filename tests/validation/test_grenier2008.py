"""M. Grenier, Determination of maximum stresses and factors of safety in a simple landing gear
mechanism during retract and landing, Binghamton University (2008).

The linkage is a reconstruction from the publication's tables (coordinates to 1e-6 in). Its forces
must come out as printed: 5e-4 for table 4, because 0.01 in at J moves the force in BC by 17 %; 1e-3
for the retract peaks, which follow from ratios of printed stresses (4 digits).
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from loads import CosineDrive, Dynamics, Linkage, Sharing, energy, ledger, move
from loads.forces import motion_reactions
from pinstress import build
from pinstress.pins import material
from pinstress.pins import pin as pin_of
from pinstress.pins import weight as weight_of
from pinstress.study import Study
from tests.conftest import INCH, LBF

TIMES = np.linspace(0.0, 4.0, 201)


@pytest.fixture(scope="module")
def landing(gear: Study, gear_linkage: Linkage) -> Dynamics:
    dynamics = build.case_loads(gear, "landing", gear_linkage).dynamics
    assert dynamics is not None
    return dynamics


@pytest.fixture(scope="module")
def retract(gear: Study, gear_linkage: Linkage) -> Dynamics:
    dynamics = build.case_loads(gear, "retract", gear_linkage).dynamics
    assert dynamics is not None
    return dynamics


def rows(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text().splitlines()))


def test_landing_magnitudes_are_those_of_table_4(gear: Study, landing: Dynamics) -> None:
    table = rows(gear.path.parent / "grenier2008" / "published_reactions.csv")
    assert len(table) == 18
    ours = dict(zip(landing.reactions.connections, landing.reactions.magnitudes[0], strict=True))
    for row in table:
        assert ours[row["connection"]] / LBF == pytest.approx(float(row["force"]), rel=5e-4)


def test_landing_directions_are_those_of_table_3(landing: Dynamics) -> None:
    """Each pin's components are printed in a frame of its own; scalar products of the forces on one
    pin do not depend on it. G1 . G3 and D1 . D2 hang on how the two levers share.
    """
    parts = {
        row["connection"]: float(row["force_lbf"])
        for row in rows(Path(__file__).with_name("grenier2008_table3.csv"))
    }
    printed = {
        name[:-1]: np.array([parts[name], parts[name[:-1] + "Y"]])
        for name in parts
        if name.endswith("X")
    }
    pairs = [(a, b) for a in printed for b in printed if a[0] == b[0] and a < b]
    assert len(pairs) == 12
    for a, b in pairs:
        ours = landing.reactions.force(a)[0] @ landing.reactions.force(b)[0] / LBF**2
        size = np.linalg.norm(printed[a]) * np.linalg.norm(printed[b])
        assert ours / size == pytest.approx(printed[a] @ printed[b] / size, abs=5e-4)


@pytest.mark.parametrize(
    ("connection", "peak"), [("A", 140.68), ("B", 101.06), ("F2", 83.82), ("H", 624.24)]
)
def test_retract_peaks_that_the_stresses_imply(
    retract: Dynamics, connection: str, peak: float
) -> None:
    force = np.linalg.norm(retract.reactions.force(connection), axis=1)
    assert force.max() / LBF == pytest.approx(peak, rel=1e-3)


def test_plain_least_squares_is_not_how_the_levers_share(
    gear_linkage: Linkage, retract: Dynamics
) -> None:
    from dataclasses import replace

    names = tuple(c.name for _, c in gear_linkage.connections)
    plain = replace(gear_linkage, sharing=(Sharing(names, (1.0,) * len(names)),))
    law = CosineDrive(30.70 * INCH, 41.96 * INCH, 4.0)
    other = motion_reactions("plain", move(plain, [law], TIMES))
    gap = np.linalg.norm(other.reactions.force("G1") - retract.reactions.force("G1"), axis=1)
    assert gap.max() / LBF > 10.0
    same = np.linalg.norm(other.reactions.force("E2") - retract.reactions.force("E2"), axis=1)
    assert same.max() / LBF < 1e-8


def test_the_radial_shares_at_g_are_equal(gear_linkage: Linkage, retract: Dynamics) -> None:
    d, g = retract.motion.joint("D")[0], retract.motion.joint("G")[0]
    u = (g - d) / np.linalg.norm(g - d, axis=1, keepdims=True)
    difference = retract.reactions.force("G1") - retract.reactions.force("G3")
    assert np.abs(np.sum(difference[:, :2] * u, axis=1)).max() / LBF < 1e-9


def test_only_the_two_levers_share(retract: Dynamics) -> None:
    assert retract.shared == ("D1", "D2", "G1", "G3")


def test_power_balances_at_every_instant(retract: Dynamics) -> None:
    """The drive is the only thing that does work besides gravity."""
    assert ledger(retract).violation < 1e-9


def test_work_is_the_change_of_energy(gear_linkage: Linkage, retract: Dynamics) -> None:
    """By Gauss's rule with 4 points in each of the 200 intervals, which never meets the instants
    of the solution: a check of velocities and forces against positions.
    """
    law = CosineDrive(30.70 * INCH, 41.96 * INCH, 4.0)
    at, weight = np.polynomial.legendre.leggauss(4)
    h = np.diff(TIMES)
    nodes = (TIMES[:-1, None] + h[:, None] * (at + 1.0) / 2.0).ravel()
    power = motion_reactions("gauss", move(gear_linkage, [law], nodes)).power[:, 0].reshape(-1, 4)
    work = np.concatenate([[0.0], np.cumsum(power @ weight * h / 2.0)])
    stored = energy(retract.motion)
    total = stored.kinetic + stored.potential
    assert np.abs(work - (total - total[0])).max() < 1e-6 * np.abs(work).max()
    assert np.abs(retract.work[:, 0] - work).max() < 1e-6 * np.abs(work).max()


@pytest.mark.parametrize(
    ("time", "speed", "acceleration"),
    [(1.4, 4.2827, 2.7672), (2.1, 5.6243, 2.6588), (3.1, 5.5502, 3.1508)],
)
def test_pin_f_moves_as_printed(
    retract: Dynamics, time: float, speed: float, acceleration: float
) -> None:
    k = int(np.argmin(np.abs(TIMES - time)))
    _, v, a = retract.motion.joint("F")
    assert round(float(np.linalg.norm(v[k])) / INCH, 4) == speed
    assert round(float(np.linalg.norm(a[k])) / INCH, 4) == acceleration


@pytest.mark.parametrize(
    ("pin", "weight"), [("C", 4.557258), ("F", 4.557109), ("E", 14.16), ("G", 14.96), ("J", 7.58)]
)
def test_pins_weigh_what_table_3_says(gear: Study, pin: str, weight: float) -> None:
    """Their weights follow from the differences of forces in table 3; C and F to 1e-6 because
    0.2 % leaves nothing for rounding (4.566 against 4.557).
    """
    density = material(gear, "AISI 4340").density
    assert density is not None
    assert weight_of(pin_of(gear, pin), density) / LBF == pytest.approx(weight, rel=2e-3)
