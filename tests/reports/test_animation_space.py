"""The animation of a linkage in space."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from reports.animation.page import render_animation, write_animations
from reports.data.skeleton import AppliedCouple
from reports.format.drawing.projection import isometric, three_views
from tests.support.results.animation_reader import Reader
from tests.support.results.space_results import landing_gear


def test_a_linkage_in_space_starts_in_its_isometric_view(tmp_path: Path) -> None:
    """Its picture stands without the script, whose places are from the middle of the motion."""
    gear = landing_gear()
    skeleton = gear.space[0]
    assert "animation_retract.html" in [path.name for path in write_animations(gear, tmp_path)]
    page = Reader((tmp_path / "animation_retract.html").read_text(encoding="utf-8"))
    data = page.data
    scale, middle = data["places"]["scale"], np.array(data["space"]["middle"])
    places = np.array(data["at"]).reshape(len(skeleton.joints), -1, 3)
    known = np.moveaxis(scale * (skeleton.position - middle), 1, 0)
    assert np.abs(places - known).max() < 0.0051  # hundredths of a pixel
    view = isometric(skeleton.up)
    drawn = [
        [float(x) for x in re.findall(r"-?[\d.]+", g["transform"])]
        for g in page.having("data-joint")
    ]
    seen = view(known[:, 0]) * [1.0, -1.0] + [480.0, 280.0]
    assert np.array(drawn) == pytest.approx(seen, abs=0.0051)
    for c, force in enumerate(data["connections"]):
        components = np.stack([force[key] for key in ("fx", "fy", "fz")], axis=1)
        assert np.abs(components - gear.reactions[0].forces[:, c]).max() < 1.0
    # The pins of the trunnions and the axle; the others are spherical.
    assert [axis is not None for axis in data["space"]["axes"]] == [True, True, False, True, False]
    assert len(page.having("data-axis")) == 3
    assert all(name in page.text for name in ("Isometric", "Front", "Right side", "Top"))


def test_a_couple_has_its_own_scale_and_unit() -> None:
    gear = landing_gear()
    skeleton = gear.space[0]
    axle = skeleton.axes[:, 3]
    size = np.linspace(100.0, 2500.0, len(axle))[:, None]
    couple = AppliedCouple("wheel", skeleton.position[:, 3], size * axle)
    page = Reader(render_animation(replace(skeleton, couples=(couple,)), gear))
    (found,) = page.data["couples"]
    assert found["at"] == page.data["at"][3]
    components = np.stack([found[key] for key in ("fx", "fy", "fz")], axis=1)
    assert np.abs(components - size * axle).max() < 0.1
    assert page.data["arrow"]["couple"] == pytest.approx(2500.0)
    assert page.data["fixed"]["couple"]["unit"] == "N·mm"
    assert len(page.having("data-applied")) == len(page.having("data-size-of")) == 2


def test_everything_of_a_linkage_in_space_fits_the_views_of_a_drawing() -> None:
    """At every instant, with the arrows of its forces also as square roots."""
    gear = landing_gear()
    skeleton, table = gear.space[0], gear.reactions[0]
    data = Reader(render_animation(skeleton, gear)).data
    places = np.array(data["at"]).reshape(len(skeleton.joints), -1, 3)
    longest, largest = data["arrow"]["longest"], data["arrow"]["largest"]
    for view in (isometric(skeleton.up), *three_views(skeleton.up)):
        for c, connection in enumerate(data["connections"]):
            force = table.forces[:, c]
            size = np.linalg.norm(force, axis=1, keepdims=True)
            tips = places[connection["joint"]] + longest * force / np.sqrt(size * largest)
            assert (np.abs(view(tips)) < [480.0, 280.0]).all()
