"""Loads of planar studies out of their plane: keys, equilibrium, ranges, messages."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from loads import Reactions
from loads.space.out_of_plane import Links, OutOfPlane, stiffness_of
from pinbase.arrays import Floats
from pinstress import load_study
from pinstress.study.model.cases import CaseLoads, case_loads
from pinstress.study.model.mechanism.linkage import linkage
from pinstress.study.reading.errors import InputError
from tests.conftest import INCH, LBF, ROOT
from tests.support.each import each

SIDE = """
[case.side]
kind = "static"
position = 30.70

[[case.side.apply]]
body = "tyre"
at = [-39.294675, -60]
force = [0, 30000, 10000]
"""
BODIES = ("AE", "EF", "BC", "EBJ", "FDG", "CDG", "CYL", "PIS", "tyre", "further")
PLANAR = SIDE.replace(", 10000]", "]")
GROUND = {"A": -1, "D1": -1, "D2": -1, "H": -1}  # connections on pins that are fixed in the ground


def _loads(folder: Path, case: str, more: str = "", z: str = "") -> CaseLoads:
    text = (ROOT / "studies" / "landing_gear.toml").read_text(encoding="utf-8")
    # Tables of its own before those that a copied study would need files for.
    text = text.split("[published]")[0] + "[mechanism]" + text.split("[mechanism]", 1)[1]
    text = text.replace("[mechanism.joint.A]\n", f"[mechanism.joint.A]\n{z}")
    path = folder / "side.toml"
    path.write_text(text + case + more, encoding="utf-8")
    study = load_study(path)
    return case_loads(study, "side", linkage(study))


def test_a_side_force_on_the_tyre_of_the_main_job(tmp_path: Path) -> None:
    """The sum of the wrenches on the ground is the load; forces in the plane are as without it."""
    solved, flat = _loads(tmp_path, SIDE), _loads(tmp_path, PLANAR)
    r = solved.reactions
    assert np.array_equal(r.forces[..., :2], flat.reactions.forces[..., :2])
    assert not flat.reactions.moments.any()
    assert not flat.reactions.forces[..., 2].any()
    fz = sum(r.force(name)[0, 2] for name in GROUND)
    assert fz == pytest.approx(10_000 * LBF, rel=1e-9)
    # About the middle of J2: the force at the ground is (60 - 48.656514) in below J2.
    arm = (60.0 - 48.656514) * INCH
    k = r.connections.index("J2")
    assert r.forces[0, k, 2] == pytest.approx(10_000 * LBF, rel=1e-9)
    assert r.moments[0, k, 0] == pytest.approx(-arm * 10_000 * LBF, rel=1e-6)


def test_a_floating_pin_is_in_equilibrium_at_its_bands(tmp_path: Path) -> None:
    """Its links press at the middles of their bands: forces there and moments have no resultant."""
    r = _loads(tmp_path, SIDE).reactions
    # Middles of the bands of pin E, from its profile, in from its start; a fillet of 0.15 in at the
    # one end of E2 and E3 is no part of their bands.
    bands = {"E1": 1.25, "E2": 7.134375 + 0.075, "E3": 9.165625 - 0.075}
    moment, force = np.zeros(3), np.zeros(3)
    for name, z in bands.items():
        k = r.connections.index(name)
        moment += r.moments[0, k] + np.cross([0.0, 0.0, z * INCH], r.forces[0, k])
        force += r.forces[0, k]
    # Its weight, 14.16 lbf at the middle of its links.
    weight = np.array([0.0, -14.159421669136941 * LBF, 0.0])
    middle = sum(bands.values()) / 3 * INCH
    moment += np.cross([0.0, 0.0, middle], weight)
    largest = np.abs(r.forces).max()
    assert force + weight == pytest.approx(np.zeros(3), abs=1e-9 * largest)
    assert moment == pytest.approx(np.zeros(3), abs=1e-9 * largest)


def test_stated_stiffness_leaves_no_range(tmp_path: Path) -> None:
    """Each body twice, and all in torsion, then groups; with all stated nothing is open."""
    alone = [x for x, _ in _loads(tmp_path, SIDE).shared if "than the rest" not in x]
    assert len(alone) == 2 * (len(BODIES) + 1)
    stated = "".join(f"[mechanism.link_stiffness.{b}]\ndiameter = 2\n" for b in BODIES)
    assert not _loads(tmp_path, SIDE, stated).shared


def test_groups_of_links_raise_loads_more_than_one_link_alone(tmp_path: Path) -> None:
    """Beside links that are at random ten times as stiff as the others: the force on D1 and the
    moment on G1 were at most half of what such links may cause, and pins safe on them.
    """
    solved = _loads(tmp_path, SIDE)
    assert solved.dynamics is not None
    assert solved.side is not None
    balance = OutOfPlane(solved.dynamics, solved.side.loads, solved.side.offsets)
    known = stiffness_of(solved.dynamics.motion.linkage, solved.side.links)
    draw, drawn = np.random.default_rng(7), []
    for _ in range(150):
        ends = draw.choice([10.0**-0.5, 10.0**0.5], len(known))
        other = {x: known[x].times(times) for x, times in zip(known, ends, strict=True)}
        drawn.append(_sizes(balance.reactions(Links(other))))
    largest: Floats = np.max(drawn, axis=0)
    every = {text: _sizes(x.reactions) for text, x in solved.shared}
    most = np.max(list(every.values()), axis=0)
    matter = largest > 1e-2 * largest.max(axis=1, keepdims=True)
    assert np.all(most[matter] > 0.85 * largest[matter])
    alone = np.max([x for text, x in every.items() if "than the rest" not in text], axis=0)
    assert np.any(alone[matter] < 0.6 * largest[matter])


def _sizes(r: Reactions) -> Floats:
    """Forces, then moments across the pin, of every connection, (2, C)."""
    return np.asarray(np.linalg.norm([r.forces[0], r.moments[0]], axis=-1))


def test_stiffer_links_take_more(tmp_path: Path) -> None:
    nominal = _loads(tmp_path, SIDE)
    others = dict(nominal.shared)
    k = nominal.reactions.connections.index("A")
    stiff = others["AE 10 times stiffer"].reactions.moments[0, k]
    soft = others["AE 10 times more flexible"].reactions.moments[0, k]
    size = [float(np.linalg.norm(m[:2])) for m in (soft, nominal.reactions.moments[0, k], stiff)]
    assert size == sorted(size)


def test_stated_positions_along_pins_count_without_loads_out_of_the_plane(tmp_path: Path) -> None:
    """A pin that is placed elsewhere: the same forces in the plane now bend the linkage."""
    flat = _loads(tmp_path, PLANAR)
    placed = _loads(tmp_path, PLANAR, z="z = 5\n")
    assert np.array_equal(placed.reactions.forces[..., :2], flat.reactions.forces[..., :2])
    assert np.abs(placed.reactions.moments).max() > 0.0
    fz = sum(placed.reactions.force(name)[0, 2] for name in GROUND)
    assert fz == pytest.approx(0.0, abs=1e-9 * np.abs(placed.reactions.forces).max())


@each(
    ("more", "message"),
    [
        ("[mechanism.link_stiffness.EB]\ndiameter = 2\n", "no body 'EB'"),
        ("[mechanism.link_stiffness.AE]\n", "give one of diameter, section"),
        ("[mechanism.link_stiffness.AE]\ndiameter = 2\nbore = 3\n", "bore must be less"),
    ],
)
def test_messages(tmp_path: Path, more: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        _loads(tmp_path, SIDE, more)


def test_a_height_without_a_pin_that_has_one_is_refused(tmp_path: Path) -> None:
    """Pins are then placed beside each other, and z = 0 is nowhere: 2 in from J2 here."""
    at = SIDE.replace("-60]", "-60, 0]")
    with pytest.raises(InputError, match="measured from nowhere"):
        _loads(tmp_path, at)
    placed = _loads(tmp_path, at, z="z = 5\n").reactions
    in_plane = _loads(tmp_path, SIDE, z="z = 5\n").reactions
    k = placed.connections.index("J2")
    # What differs is the moment of the vertical force at another z than that of J2.
    more = placed.moments[0, k] - in_plane.moments[0, k]
    assert abs(more[0]) > 0.1 * INCH * 30_000 * LBF
    assert more[1:] == pytest.approx([0.0, 0.0], abs=1e-6 * abs(more[0]))


def test_links_that_do_not_yield_cannot_share(tmp_path: Path) -> None:
    bodies = ("AE", "EF", "BC", "EBJ", "FDG", "CDG", "CYL", "PIS")
    rigid = "".join(f"[mechanism.link_stiffness.{b}]\nrigid = true\n" for b in bodies)
    with pytest.raises(InputError, match=r"case\.side: .*nothing yields out of the plane"):
        _loads(tmp_path, SIDE, rigid)


def test_a_stated_stiffness_is_that_of_a_round_bar(tmp_path: Path) -> None:
    """Of link AE, 13.75 in long, held at its middle: 3 E I / L^3 to either joint."""
    half = 0.5 * np.hypot(-40.521953 + 39.234614, -0.005788 + 13.695392) * INCH
    bar = 3.0 * 210e9 * np.pi / 64.0 * (2.0 * INCH) ** 4 / half**3
    as_bar, as_stiff = (
        _loads(tmp_path, SIDE, f"[mechanism.link_stiffness.AE]\n{how}\n").reactions
        for how in ("diameter = 2", f'stiffness = "{bar} N/m"')
    )
    size = np.abs(as_bar.moments).max()
    assert as_stiff.moments == pytest.approx(as_bar.moments, abs=1e-6 * size)
