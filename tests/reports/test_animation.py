"""The animation, on a four-bar whose positions are known in closed form."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from reports.animation.force_table import Fixed
from reports.animation.frames import MAX_FRAMES, frames, nice
from reports.animation.page import render_animation, write_animations
from reports.animation.player_data import speeds
from reports.animation.strip_chart import ticks
from reports.data.motion import AppliedForce
from reports.data.results import Results
from reports.data.row import Units
from reports.format.drawing.svg_labels import label_offsets
from tests.support.results.animation_reader import Reader
from tests.support.results.four_bar_results import COUPLER, CRANK, ROCKER, chain, four_bar, linkage

EVIL = "</script><i onload='x'>&quot;\"\\u003c{{ 1 }}<!--"


def render(results: Results) -> str:
    return render_animation(results.skeletons[0], results)


@pytest.fixture(scope="module")
def moving() -> Results:
    return four_bar()


def test_places_are_those_of_the_closed_form(moving: Results) -> None:
    data = Reader(render(moving)).data
    xy = np.array(data["at"]).reshape(4, -1, 2)
    places = data["places"]
    found = (
        np.stack([(xy[..., 0] - places["left"]), (places["top"] - xy[..., 1])], axis=-1)
        / places["scale"]
    )
    # Rounded to a hundredth of a pixel.
    assert np.abs(found - np.moveaxis(moving.motion[0].joint_position, 1, 0)).max() < (
        0.0051 / places["scale"]
    )
    for (p, q), length in zip(((0, 1), (1, 2), (2, 3)), (CRANK, COUPLER, ROCKER), strict=True):
        assert np.linalg.norm(found[p] - found[q], axis=1) == pytest.approx(length, abs=1e-3)


def test_forces_and_drive_have_five_digits(moving: Results) -> None:
    data = Reader(render(moving)).data
    table = moving.reactions[0]
    for c, found in enumerate(data["connections"]):
        assert (found["name"], found["joint"]) == (table.connections[c], c)
        assert np.abs(np.array(found["fx"]) - table.forces[:, c, 0]).max() < 0.01
        assert np.abs(np.array(found["f"]) - table.magnitudes[:, c]).max() < 0.01
    assert data["drives"][0]["position"][-1] == pytest.approx(360.0)
    assert data["fixed"]["drives"][0][1]["unit"] == "N·mm"


def test_the_script_finds_an_element_for_every_number(moving: Results) -> None:
    page = Reader(render(moving))
    data = page.data
    for attribute, values in (
        ("data-joint", data["joints"]),
        ("data-link", data["links"]),
        ("data-centre", data["links"]),
        ("data-arrow", data["connections"]),
        ("data-row", data["connections"]),
        ("data-curve", data["connections"]),
        ("data-position", data["drives"]),
    ):
        assert [int(a[attribute]) for a in page.having(attribute)] == list(range(len(values)))
    ids = {attrs["id"] for attrs in page.having("id")}
    assert set(re.findall(r'one\("#(\w+)"\)', page.scripts[1])) <= ids


@pytest.fixture(scope="module")
def pushed(moving: Results) -> Results:
    """The four-bar under a force on its second joint that grows and turns."""
    motion = moving.motion[0]
    count = len(motion.joint_position)
    turn = np.linspace(0.0, 3.0, count)
    force = (50.0 + 10.0 * turn)[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    load = AppliedForce(motion.bodies[0], motion.joint_position[:, 1], force)
    return replace(moving, motion=(replace(motion, applied=(load,)),))


def test_a_load_off_the_joints_is_joined_to_the_nearest_of_its_body(pushed: Results) -> None:
    """It hung in the air; one at a joint needs no line."""
    page = Reader(render(pushed))
    assert page.data["applied"][0]["lever"] is None
    assert ["d" in a for a in page.having("data-lever")] == [False]
    motion = pushed.motion[0]
    load = motion.applied[0]
    there = motion.joint_position[:, 1] * 0.9 + motion.joint_position[:, 0] * 0.1
    off = replace(load, position=there)
    pin = replace(off, body="pin C")  # a weight of a floating pin, which is no body here
    aside = Reader(render(replace(pushed, motion=(replace(motion, applied=(load, off, pin)),))))
    levers = [a["lever"] for a in aside.data["applied"]]
    assert levers == [None, 1, None]
    assert [a["data-lever"] for a in aside.having("data-lever") if "d" in a] == ["1"]


def test_an_applied_load_ends_before_its_point_and_says_its_size(pushed: Results) -> None:
    page = Reader(render(pushed))
    (applied,) = page.data["applied"]
    load = pushed.motion[0].applied[0]
    assert applied["at"] == page.data["at"][1]
    assert np.abs(np.array(applied["fx"]) - load.force[:, 0]).max() < 0.01
    assert np.abs(np.array(applied["fy"]) - load.force[:, 1]).max() < 0.01
    (arrow,) = page.having("data-applied")
    x, y, angle = map(float, re.findall(r"-?[\d.]+", arrow["transform"]))
    tag = [("data-applied" in a) for _, a in page.tags].index(True)
    (length,) = re.findall(r"translate\(([\d.]+)\)", page.tags[tag + 2][1]["transform"])
    reach = float(length) + page.data["arrow"]["gap"]
    tip = x + reach * np.cos(np.radians(angle)), y + reach * np.sin(np.radians(angle))
    assert tip == pytest.approx(applied["at"][:2], abs=0.05)
    scale = page.data["arrow"]["longest"] / page.data["arrow"]["largest"]
    assert float(length) == pytest.approx(50.0 * scale, abs=0.01)
    fixed = page.data["fixed"]["force"]
    assert f"{50.0:.{fixed['decimals']}f} {fixed['unit']}" in page.text
    assert 'data-show="applied"' in render(pushed)


def test_all_of_an_applied_load_is_on_the_picture(pushed: Results) -> None:
    """At every instant, with its size, also where arrows are square roots."""
    page = Reader(render(pushed))
    (applied,), arrow = page.data["applied"], page.data["arrow"]
    at = np.array(applied["at"]).reshape(-1, 2)
    force = np.stack([applied["fx"], applied["fy"]], axis=1)
    size = np.linalg.norm(force, axis=1, keepdims=True)
    reach = arrow["gap"] + arrow["longest"] * np.sqrt(size / arrow["largest"]) + 12.0
    tail = at - reach * force / size * np.array([1.0, -1.0])
    width, height = map(float, page.having("viewbox")[0]["viewbox"].split()[2:])
    assert tail.min() > 0.0
    assert (tail.max(axis=0) < [width, height]).all()


def test_without_applied_loads_there_is_no_choice_of_them(moving: Results) -> None:
    page = Reader(render(moving))
    assert page.data["applied"] == []
    assert "applied loads" not in page.text


def test_the_picture_stands_without_the_script(moving: Results) -> None:
    page = Reader(render(moving))
    data = page.data
    crank = page.tags[[("data-link" in a) for _, a in page.tags].index(True) + 1][1]["d"]
    ends = np.array(re.findall(r"-?[\d.]+", crank), dtype=float)
    assert ends == pytest.approx([*data["at"][0][:2], *data["at"][1][:2]])
    assert "Scripts are disabled" in page.text
    assert [a["hidden"] for _, a in page.tags if "controls" in a.get("class", "")] == ["", ""]


def test_all_stays_on_the_picture() -> None:
    results = four_bar()
    page = Reader(render(results))
    data = page.data
    box = next(a["viewbox"] for _, a in page.tags if a.get("id") == "scene").split()
    width, height = float(box[2]), float(box[3])
    longest, largest = data["arrow"]["longest"], data["arrow"]["largest"]
    for c in data["connections"]:
        at = np.array(data["at"][c["joint"]]).reshape(-1, 2)
        force = np.column_stack([c["fx"], np.negative(c["fy"])])
        size = np.linalg.norm(force, axis=1, keepdims=True)
        for tips in (
            at + longest * force / largest,
            at + longest * force / np.sqrt(size * largest),
        ):
            assert tips.min() > 0.0
            assert tips[:, 0].max() < width
            assert tips[:, 1].max() < height


def test_no_network_and_no_foreign_code(moving: Results) -> None:
    text = render(moving)
    assert "default-src 'none'" in text
    assert not re.search(r"https?://", text.replace("http://www.w3.org/2000/svg", ""))
    tags = Reader(text).tags
    assert not [t for t, _ in tags if t in ("link", "img", "iframe")]
    assert not [a for _, a in tags if "src" in a or "href" in a]


def test_names_are_shown_and_not_run(tmp_path: Path) -> None:
    plain = four_bar(5)
    joints = tuple(EVIL + n for n in "ABCD")
    motion = replace(
        plain.motion[0],
        case=EVIL,
        bodies=tuple(EVIL + b for b in plain.motion[0].bodies),
        joints=joints,
        links=tuple(pairwise(joints)),
        ground=(joints[0], joints[3]),
        connections=tuple(
            (EVIL + c, EVIL + b, EVIL + j) for c, b, j in plain.motion[0].connections
        ),
    )
    table = replace(
        plain.reactions[0],
        case=EVIL,
        note=EVIL,
        connections=tuple(EVIL + c for c in plain.reactions[0].connections),
    )
    drive = replace(plain.drive[0], case=EVIL, name=EVIL)
    odd = replace(
        plain,
        title=EVIL,
        units=Units("<i>", "<i>", "<i>", "<i>"),
        motion=(motion,),
        reactions=(table,),
        drive=(drive,),
    )
    (path,) = write_animations(odd, tmp_path)
    assert path.parent == tmp_path
    text = path.read_text(encoding="utf-8")
    page = Reader(text)
    assert text.count("</script>") == 2
    assert "<!--" not in text
    assert len(page.scripts) == 2
    assert not [a for t, a in page.tags if t == "i" and a]  # the tables' own marks have none
    assert not page.having("onload")
    assert page.data["joints"] == list(joints)
    assert page.data["connections"][0]["name"] == EVIL + "F12"
    assert EVIL in page.text
    assert page.having("aria-label")


def test_one_instant_is_a_still_picture_with_arrows(moving: Results) -> None:
    motion, table = moving.motion[0], moving.reactions[0]
    held = replace(
        linkage("held", None, motion.joints, motion.joint_position[7:8]), links=motion.links
    )
    still = replace(
        table,
        case="held",
        times=None,
        position=None,
        forces=table.forces[7:8],
        moments=table.moments[7:8],
    )
    page = Reader(render(replace(moving, motion=(held,), reactions=(still,), drive=())))
    assert len(page.having("data-arrow")) == 3
    assert not page.having("data-strip")
    assert not [a for a in page.having("id") if a["id"] in ("play", "seek")]
    assert not [t for t, _ in page.tags if t == "option" and "real time" in page.text]


def test_a_motion_without_forces_is_drawn(moving: Results) -> None:
    page = Reader(render(replace(moving, reactions=(), drive=())))
    assert page.data["connections"] == []
    assert not page.having("data-arrow")
    assert not [a for a in page.having("id") if a["id"] == "key"]


def test_forces_that_are_zero_have_no_arrow(moving: Results) -> None:
    table = replace(moving.reactions[0], forces=np.zeros((181, 3, 3)))
    page = Reader(render(replace(moving, reactions=(table,))))
    assert {a["visibility"] for a in page.having("data-arrow")} == {"hidden"}


def test_sliders_are_cylinders_or_run_on_rails(moving: Results) -> None:
    motion = moving.motion[0]
    b, c = (motion.joint_position[:, motion.joints.index(n)] for n in "BC")
    origin = np.zeros_like(b)
    straight = np.stack([np.linspace(2.0, 5.0, len(b)), np.zeros(len(b))], axis=1)
    slides = {"jack": np.stack([b, c], axis=1), "guide": np.stack([origin, straight], axis=1)}
    page = Reader(render(replace(moving, motion=(replace(motion, slides=slides),))))
    jack, guide = page.data["slides"]
    assert (jack["rail"], guide["rail"]) == (False, True)
    ends = np.array(guide["ends"]).reshape(-1, 2, 2)
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    assert length == pytest.approx(
        np.linspace(2.0, 5.0, 181) * page.data["places"]["scale"], abs=0.02
    )
    assert len(page.having("data-slide")) == 2


def test_sliders_without_any_joint_are_drawn(moving: Results) -> None:
    """Wedges, say."""
    motion = moving.motion[0]
    ends = motion.joint_position[:, [0, 1]]
    bare = replace(
        motion,
        bodies=("wedge",),
        links=((),),
        centre=motion.centre[:, :1],
        joints=(),
        ground=(),
        joint_position=np.zeros((181, 0, 2)),
        slides={"face": ends},
        connections=(),
    )
    table = replace(
        moving.reactions[0],
        connections=(),
        bodies=(),
        pins=(),
        forces=np.zeros((181, 0, 3)),
        moments=np.zeros((181, 0, 3)),
    )
    page = Reader(render(replace(moving, motion=(bare,), reactions=(table,))))
    assert len(page.having("data-slide")) == 1
    assert not page.having("data-joint")


def test_many_bodies_make_a_small_file_with_the_peaks() -> None:
    results = chain(13, 2001)
    table = results.reactions[0]
    text = render(results)
    data = Reader(text).data
    assert len(text.encode()) < 1_000_000
    assert len(data["time"]) <= MAX_FRAMES
    for c, found in enumerate(data["connections"]):
        assert max(found["f"]) == pytest.approx(table.magnitudes[:, c].max(), rel=1e-4)
    at = frames(results.skeletons[0], table, [])
    assert (at[0], at[-1]) == (0, 2000)
    assert np.diff(at).max() < 20


def test_the_same_bytes_twice(moving: Results, tmp_path: Path) -> None:
    first, second = tmp_path / "a", tmp_path / "b"
    for directory in (first, second):
        directory.mkdir()
        write_animations(moving, directory)
    (path,) = first.iterdir()
    assert path.name == "animation_turn.html"
    assert path.read_bytes() == (second / path.name).read_bytes()


def test_names_do_not_overlap() -> None:
    points = np.array([[[0.0, 0.0], [12.0, 0.0], [24.0, 0.0], [36.0, 4.0]]])
    sizes = np.tile([30.0, 14.0], (4, 1))
    lines = np.array([[[[-50.0, 0.0], [90.0, 0.0]]]])
    at = points[0] + label_offsets(points + 60.0, sizes, lines + 60.0, 13.0, (200.0, 120.0))
    for i in range(4):
        for j in range(i):
            assert np.any(np.abs(at[i] - at[j]) >= sizes[0])


def test_numbers_that_stand_still() -> None:
    force = Fixed.of(np.array([12.5, -1234.5]), "N")
    assert (force(-1234.5), force(0.2), force(-0.2)) == ("−1,234", "0", "0")
    assert Fixed.of(np.array([np.nan]), "N")(np.nan) == "–"
    large = Fixed.of(np.array([3.2e7]), "N")
    assert (large.unit, large(3.2e7)) == ("10⁶ N", "32.00")
    assert Fixed.of(np.array([3.2e-5]), "m")(1.6e-5) == "16.00"


def test_speeds_play_in_seconds() -> None:
    assert speeds(None) == []
    for duration in (0.01, 0.25, 4.0, 3600.0):
        chosen = [s for s, _, first in speeds(np.array([0.0, duration])) if first]
        assert len(chosen) == 1
        assert 2.0 <= duration / chosen[0] <= 12.0
    assert (1.0, "1× (real time)", True) in speeds(np.array([0.0, 4.0]))


def test_ticks_are_round() -> None:
    assert ticks(0.0, 4.0, 8) == [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0]
    assert [nice(x) for x in (0.0, 0.7, 5.0, 9.9)] == [1.0, 0.5, 5.0, 5.0]


def test_springs_between_two_points_are_drawn(moving: Results) -> None:
    """A jib and its cylinder carried 460 kN without a visible cause, the rope of the jib."""
    motion = moving.motion[0]
    b = motion.joint_position[:, motion.joints.index("B")]
    foot = np.array([-6.0, 9.0])
    springs = {"rope <1>": np.stack([np.broadcast_to(foot, b.shape), b], axis=1)}
    page = Reader(render(replace(moving, motion=(replace(motion, springs=springs),))))
    (shape,) = page.having("data-spring")
    (ends,) = page.data["springs"]
    places = page.data["places"]
    drawn = places["left"] + places["scale"] * foot[0], places["top"] - places["scale"] * foot[1]
    assert ends[:2] == pytest.approx(drawn, abs=0.02)
    corners = [float(x) for x in re.findall(r"-?[\d.]+", shape["d"])]
    assert corners[:2] == pytest.approx(ends[:2], abs=0.02)
    assert corners[-2:] == pytest.approx(ends[2:4], abs=0.02)
    assert "rope <1>" in page.text


def test_the_mean_of_a_drive_is_written_as_in_the_terminal(moving: Results) -> None:
    """A mean of zero was "0.0000"."""
    force = 0.02 * np.sin(np.linspace(0.0, 2.0 * np.pi, 181))
    drive = replace(moving.drive[0], force=force)
    assert drive.mean == 0.0
    notes = re.findall("mean [^,]*", Reader(render(replace(moving, drive=(drive,)))).text)
    assert notes == ["mean 0"]
