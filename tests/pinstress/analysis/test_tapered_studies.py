"""What a study does with cones beyond their stress: sizes, remedies, drawing, limit load, lugs."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest

from assess.plastic.solve import limit_load
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from geometry import Pin, Segment
from geometry.shape.dimensions import dimensions
from pinstress import load_study, run
from pinstress.study.model.pins import far_ends, outline, pin
from pinstress.study.schema.units import UNIT_SYSTEMS
from reports.data.results import PinShape
from reports.page.pin_drawing import draw_pin
from tests.support.pins.studies import resized_text
from tests.support.results.made_up_run import make_results

CONE = Pin(
    "P",
    (
        Segment(0.03, 0.03, bore=0.004, connection="B"),
        Segment(0.01, 0.03, bore=0.004, end_diameter=0.02, end_bore=0.002),
        Segment(0.03, 0.02, bore=0.002, fillet=0.001, edge_radii=(0.0, 0.001)),
    ),
)
STUDY = """
title = "Cones"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "500 MPa"
[pin.P]
material = "steel"
profile = [
  { length = 10, diameter = [18, "20 mm"], bore = [4, 2], edge_radius = [1, 0] },
  { length = 30, diameter = 20, bore = 2, connection = "B" },
]
[pin.M]
material = "steel"
meridian = [[0, 9], [10, 10, 1], [40, 10]]
bore_meridian = [[0, 2], [40, 1]]
band.C = { z = [20, 30] }
[case.push]
kind = "given"
forces = { B = [0, 1000], C = [0, 1000] }
"""


def test_size_scales_all_that_lies_across(tmp_path: Path) -> None:
    text = resized_text(STUDY, {"P": 1.5, "M": 1.5}, UNIT_SYSTEMS["mm-N-s"])
    made = tomllib.loads(text)["pin"]
    cone, plain = made["P"]["profile"]
    assert cone == {
        "length": 10, "diameter": [27, "30 mm"], "bore": [6, 3], "edge_radius": [1.5, 0],
    }  # fmt: skip
    assert plain["diameter"] == 30
    assert made["M"]["meridian"] == [[0, 13.5], [10, 15, 1.5], [40, 15]]
    assert made["M"]["bore_meridian"] == [[0, 3], [40, 1.5]]
    (tmp_path / "a.toml").write_text(STUDY)
    (tmp_path / "b.toml").write_text(text)
    small, large = (load_study(tmp_path / f"{x}.toml") for x in "ab")
    for name in "PM":
        assert pin(large, name).volume == pytest.approx(2.25 * pin(small, name).volume, rel=1e-3)


def test_a_dimension_of_a_cone_is_its_neighbours(steel: Material) -> None:
    """So that a change makes no step."""
    every = {d.key: d for d in dimensions(CONE)}
    across = {key for key in every if "diameter" in key or "bore" in key}
    assert across == {
        f"profile[{k}].{x} & profile[2].{x}[{end}]"
        for k, end in ((1, 1), (3, 2)) for x in ("diameter", "bore")
    }  # fmt: skip
    wider = every["profile[3].diameter & profile[2].diameter[2]"].changed(0.024)
    assert [s.diameters for s in wider.segments] == [(0.03, 0.03), (0.03, 0.024), (0.024, 0.024)]
    thin = Pin("T", (Segment(1.0, 3.0, end_diameter=2.0), Segment(1.0, 2.0, end_diameter=1.0)))
    keys = [d.key for d in dimensions(thin) if "diameter" in d.key]
    shared = "profile[1].diameter[2] & profile[2].diameter[1]"
    assert keys == ["profile[1].diameter[1]", shared, "profile[2].diameter[2]"]


def test_a_cone_has_no_limit_load(steel: Material) -> None:
    loads = PinLoads("c", ("B",), np.array([[[1000.0, 0.0, 0.0]]]))
    yielding = Material("y", 2.1e11, 0.3, None, 3e8)
    found = limit_load(CONE, yielding, ("end",), loads)
    assert (found.method, "cones" in found.note) == ("none", True)


def test_a_cone_is_drawn_as_one() -> None:
    shape = PinShape("P", tuple(outline(CONE)), "steel", None, far_ends(CONE))
    drawn = draw_pin(shape, make_results().units)
    assert drawn.count("<polygon") == 2
    assert "⌀0.03–0.02 / 0.004–0.002" in drawn
    assert far_ends(Pin("C", CONE.segments[:1])) == ()


IN_LUGS = """
title = "Double shear"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
[pin.P]
material = "steel"
profile = [
  FIRST
  { length = 10, diameter = 20, connection = "A" },
  { length = 2, diameter = 20 },
  { length = 20, diameter = 20, connection = "B" },
  { length = 2, diameter = 20 },
  { length = 10, diameter = 20, connection = "C" },
  LAST
]
lug.A = { edge_radius = 0.5 }
lug.B = { edge_radius = 0.5 }
lug.C = { edge_radius = 0.5 }
[case.push]
kind = "given"
forces = { A = [0, -5000], B = [0, 10000], C = [0, -5000] }
"""


@pytest.mark.long
@pytest.mark.slow
def test_chamfers_outside_of_lugs_change_nothing(tmp_path: Path) -> None:
    """In contact; the stress is largest between the lugs."""
    found = []
    for name, first, last in (
        ("plain", "{ length = 4, diameter = 20 },", "{ length = 4, diameter = 20 },"),
        ("cones", "{ length = 4, diameter = [16, 20] },", "{ length = 4, diameter = [20, 16] },"),
    ):
        path = tmp_path / f"{name}.toml"
        path.write_text(IN_LUGS.replace("FIRST", first).replace("LAST", last))
        (row,) = run(load_study(path)).pins
        found.append(row)
    plain, cones = found
    assert plain.model == cones.model == "harmonic"
    assert plain.max_von_mises is not None
    assert cones.max_von_mises == pytest.approx(plain.max_von_mises, rel=0.01)
