"""Sliding distance, velocity and p v of links on their pins, against the closed forms of a
slider-crank, and of floating pins against the rotations of their links.
"""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest

import pinstress
from pinstress.analysis.gather.gather import loads_only
from pinstress.study.model.pins import pin as pin_of
from reports.data.results import Results
from reports.files import write_loads
from tests.conftest import ROOT
from tests.support.each import each

RATIO = 50.0 / 180.0  # crank over rod
OMEGA = 2.0 * math.pi / 0.25  # rad/s
BAND_A = 16.0 * 17.0  # mm^2, without the fillet
# Of the distance: what is lost between two instants about a reversal; 4e-5 for the piston
PATH = 1e-4


def loads_of(name: str) -> Results:
    return loads_only(pinstress.load_study(ROOT / "studies" / f"{name}.toml"))


@pytest.fixture(scope="module")
def crank() -> Results:
    return loads_of("slider_crank")


@each(
    ("connection", "path", "velocity", "turns_with"),
    [
        ("O", 8.0 * 2.0 * math.pi, 8.0 * OMEGA, "crank"),
        # The rod turns by asin(ratio sin) against the guide: against the crank it turns fully.
        ("A", 8.0 * 2.0 * math.pi, 8.0 * OMEGA * (1.0 + RATIO), "crank"),
        ("C", 6.0 * 4.0 * math.asin(RATIO), 6.0 * OMEGA * RATIO, "piston"),
    ],
)
def test_a_slider_crank_slides_as_its_closed_form_says(
    crank: Results, connection: str, path: float, velocity: float, turns_with: str
) -> None:
    (row,) = (row for row in crank.wear if row.connection == connection)
    assert (row.against, row.floats, row.case) == (turns_with, False, "turn")
    assert row.distance == pytest.approx(path, rel=PATH)
    assert row.velocity == pytest.approx(velocity, rel=PATH)


def test_pressure_and_p_v_are_those_of_the_forces(crank: Results) -> None:
    (table,) = crank.reactions
    assert table.times is not None
    (row,) = (row for row in crank.wear if row.connection == "A")
    k = table.connections.index("A")
    pressure = np.linalg.norm(table.forces[:, k, :2], axis=1) / BAND_A
    (motion,) = crank.motion
    rate = motion.angular_velocity[:, [motion.bodies.index(b) for b in ("rod", "crank")]]
    product = pressure * 8.0 * np.abs(rate[:, 0] - rate[:, 1])
    assert row.mean_pressure == pytest.approx(table.largest[k].force / BAND_A, rel=1e-4)
    assert row.velocity is not None
    assert row.pressure_velocity is not None
    assert product.max() * (1.0 - 1e-9) <= row.pressure_velocity
    assert row.pressure_velocity == pytest.approx(product.max(), rel=1e-3)
    assert row.time == pytest.approx(table.times[product.argmax()], abs=2e-3)
    assert row.pressure_velocity < row.mean_pressure * row.velocity


def test_each_ear_of_a_clevis_has_its_own_pressure_and_radius(crank: Results) -> None:
    """A thinner and shorter ear had the diameter of the other. Each bears half of the force."""
    text = (ROOT / "studies" / "slider_crank.toml").read_text(encoding="utf-8")
    band = '  { length = 20, diameter = 16, connection = "A" },\n'
    ear = '  { length = 9, diameter = 12, name = "FAR", ear_of = "A" },\n'
    text = text.replace(band, band + ear).replace("fillet = 3\n", "")
    forked = loads_only(pinstress.study_from(text))
    rows = {row.connection: row for row in forked.wear}
    (whole,) = (row for row in crank.wear if row.connection == "A")
    assert whole.velocity is not None
    force = whole.mean_pressure * BAND_A
    for name, diameter, length in ("A", 16.0, 20.0), ("FAR", 12.0, 9.0):
        row = rows[name]
        assert (row.pin, row.body) == ("A", "rod")
        assert row.mean_pressure == pytest.approx(0.5 * force / (diameter * length))
        assert row.velocity == pytest.approx(whole.velocity * diameter / 16.0)


def test_a_floating_pin_may_turn_with_any_of_its_links() -> None:
    results = loads_of("landing_gear")
    rows = {row.connection: row for row in results.wear if row.pin == "E"}
    (motion,) = (m for m in results.motion if m.case == "retract")
    turn = {body: np.radians(motion.angle[:, k]) for k, body in enumerate(motion.bodies)}
    bodies = {name: row.body for name, row in rows.items()}
    radius = band_radius("E")
    for name, row in rows.items():
        assert row.floats
        paths = {
            other: radius * np.abs(np.diff(turn[bodies[name]] - turn[other])).sum()
            for link, other in bodies.items()
            if link != name
        }
        assert row.against == max(paths, key=lambda body: paths[body])
        assert row.distance == pytest.approx(max(paths.values()), rel=1e-4)


def band_radius(pin: str) -> float:
    """The radius of the bands of a pin of the landing gear, which are all alike, in."""
    shape = pin_of(pinstress.load_study(ROOT / "studies" / "landing_gear.toml"), pin)
    (radius,) = {shape.band(name).radius for name in shape.connections}
    return radius / 0.0254


def test_a_particle_has_a_pressure_but_no_rotation() -> None:
    rows = {row.connection: row for row in loads_of("landing_gear").wear}
    assert rows["J2"].mean_pressure > 0.0
    assert rows["J2"].distance is rows["J2"].pressure_velocity is None


def test_cases_at_rest_slide_nowhere() -> None:
    assert {row.case for row in loads_of("landing_gear").wear} == {"retract"}
    assert not loads_of("one_pin").wear


def test_the_table_is_written_and_shown(crank: Results, tmp_path: Path) -> None:
    write_loads(crank, tmp_path)
    with (tmp_path / "wear.csv").open(encoding="utf-8") as file:
        (line,) = (line for line in csv.DictReader(file) if line["connection"] == "C")
    assert float(line["sliding_distance"]) == pytest.approx(24.0 * math.asin(RATIO), rel=PATH)
    assert line["turns_with"] == "piston"
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Sliding and wear" in page
    assert "p v [MPa·mm/s]" in page
