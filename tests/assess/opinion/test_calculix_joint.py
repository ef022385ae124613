"""A pin in its lugs by CalculiX: the mesh, the deck, what is read, and its answer beside ours."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from assess.opinion import calculix
from assess.opinion.calculix import CalculixError
from assess.opinion.calculix_joint import joint_deck, joint_opinion, stations_of
from assess.opinion.calculix_joint_answer import JointOpinion, contact_forces, edges
from assess.opinion.calculix_joint_deck import JointDeck, surface_weights
from assess.opinion.calculix_joint_mesh import Fineness, Hexahedra, annulus_mesh, pin_mesh
from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.core.requirement import Requirement
from fea.harmonic.field import HarmonicField
from fea.harmonic.superposition import Circumference
from fea.solve.solve import solve_pin
from fea.support.contact.resolution import Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Lug
from geometry import ArgumentError, Pin, Segment
from tests.support.errors import raises

D, EYE, FORCE = 0.02, 0.05, 50e3
STEEL = Material("steel", 210e9, 0.3)
COARSE = Fineness(rings=3, sectors=8, layers=1, eye=1, scale=1.0)
FORK = FORCE * np.array([[[-0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [-0.5, 0.0, 0.0]]])
PULL = PinLoads("pull", ("L", "M", "R"), FORK)
TURN = np.array([[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
SIDE = 1e3 * np.array([[[0.0, 1.0, 0.0], [0.0, -3.0, 0.0], [0.0, 2.0, 0.0]]])
OBLIQUE = PinLoads("pull", ("L", "M", "R"), FORK + SIDE)


def clevis(clearance: float = 0.0, radius: float = 0.0) -> tuple[Pin, list[Lug]]:
    """Of steel; the fork's sides tilt as their shanks bend."""
    left, middle, right = (
        Segment(t, D, connection=name) for t, name in zip((0.01, 0.02, 0.01), "LMR", strict=True)
    )
    over, apart = Segment(0.002, D), Segment(0.001, D)
    pin = Pin("P", (over, left, apart, middle, apart, right, over))
    tilts = dict(zip("LMR", (66e3, math.inf, 66e3), strict=True))
    return pin, [Lug(n, EYE, STEEL, clearance, radius, tilt) for n, tilt in tilts.items()]


def volume(mesh: Hexahedra) -> float:
    """By the divergence theorem over the corners' faces of every element, m^3."""
    faces = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    total = 0.0
    for a, b, c, d in faces:
        p, q, r, s = (mesh.nodes[mesh.elements[:, k]] for k in (a, b, c, d))
        centre = (p + q + r + s) / 4.0
        for one, two in ((p, q), (q, r), (r, s), (s, p)):
            total += float(np.einsum("ei,ei->", np.cross(one, two), centre)) / 6.0
    return total


@pytest.mark.parametrize(
    "segments",
    [
        (Segment(0.01, 0.02), Segment(0.02, 0.03)),
        (Segment(0.01, 0.02, 0.008), Segment(0.01, 0.03, 0.01), Segment(0.01, 0.02, 0.008)),
        (Segment(0.01, 0.02, 0.008), Segment(0.01, 0.02)),
    ],
)
@pytest.mark.parametrize("half", [False, True])
def test_a_mesh_fills_the_pin(segments: tuple[Segment, ...], half: bool) -> None:
    """Its corners lie on circles, so that it has a polygon's part of the volume; where a solid
    pin's core ends nothing is missing.
    """
    pin, fine = Pin("P", segments), Fineness(sectors=32)
    z = [np.array([a, b]) for a, b in zip(pin.stations, pin.stations[1:], strict=False)]
    mesh = pin_mesh(pin, z, fine, half)
    angle = 2.0 * math.pi / 32
    polygon = pin.volume * math.sin(angle) / angle * (0.5 if half else 1.0)
    assert volume(mesh) == pytest.approx(polygon, rel=1e-12)
    outside = mesh.nodes[np.unique(mesh.face(np.flatnonzero(mesh.outer == 0.01), 4)), :2]
    assert np.linalg.norm(outside, axis=1) == pytest.approx(np.full(len(outside), 0.01))


@pytest.mark.parametrize(("radius", "rel"), [(0.001, 1e-4), (0.0045, 1e-3)])
def test_a_mesh_fills_the_fillets_too(radius: float, rel: float) -> None:
    """Of the polygon's volume; the layers end on the arcs, and rings lie between them."""
    thick, shaft = Segment(0.006, 0.03), Segment(0.03, 0.02, connection="L")
    pin, fine = Pin("P", (thick, shaft, thick), fillet=radius), Fineness(sectors=32)
    mesh = pin_mesh(pin, stations_of(pin, {"L": 0.0005}, fine), fine, True)
    angle = 2.0 * math.pi / 32
    expected = 0.5 * pin.volume * math.sin(angle) / angle
    assert volume(mesh) == pytest.approx(expected, rel=rel)


def test_middles_of_edges_lie_where_calculix_has_them() -> None:
    """C3D20: 9 to 12 round the lower face, 13 to 16 round the upper one, 17 to 20 between; on
    straight edges of a core exactly halfway.
    """
    mesh = pin_mesh(Pin("P", (Segment(0.01, 0.02),)), [np.array([0.0, 0.01])], COARSE, False)
    x = mesh.nodes[mesh.elements[mesh.outer == 0.0]]
    around = [(0, 1), (1, 2), (2, 3), (3, 0)]
    pairs = [*around, *((a + 4, b + 4) for a, b in around), *((k, k + 4) for k in range(4))]
    for k, (a, b) in enumerate(pairs, 8):
        assert x[:, k] == pytest.approx((x[:, a] + x[:, b]) / 2.0)


def test_what_this_mesh_lacks_is_refused() -> None:
    bored = (Segment(0.01, 0.02, 0.0195), Segment(0.01, 0.03, 0.0195))
    pin = Pin("P", bored, fillet=0.001)  # a wall of a quarter of the radius
    with raises(ArgumentError, "fillet", "P"):
        pin_mesh(pin, [np.array([0.0, 0.01]), np.array([0.01, 0.02])], COARSE, False)
    with raises(ArgumentError, "not-a-multiple"):
        Fineness(sectors=20)
    pin, lugs = clevis()
    for wrong, code in (
        (PinLoads("m", ("L", "M", "R"), np.repeat(FORK, 2, axis=0)), "not-one-instant"),
        (PinLoads("m", ("L", "M", "R"), FORK[:, :, [1, 2, 0]]), "other-loads"),
        (PinLoads("m", ("L", "M", "R"), FORK, body=np.array([0.0, 9.8, 0.0])), "other-loads"),
    ):
        with raises(ArgumentError, code):
            joint_deck(pin, STEEL, lugs, wrong, COARSE)


def test_weights_of_the_outer_surface() -> None:
    """Its area and first moment, of a half; as close as parabolas come to arcs."""
    mesh = annulus_mesh((0.01, 0.025), np.array([0.01, 0.013, 0.02]), Fineness(sectors=32), True)
    _, weights = surface_weights(mesh)
    area = math.pi * 0.025 * 0.01
    assert weights.sum(axis=0) == pytest.approx([area, area * 0.015], rel=1e-5)


def sections(deck: JointDeck) -> dict[str, list[str]]:
    """Data lines by the keyword lines above them, of one name joined."""
    out: dict[str, list[str]] = {}
    for line in deck.lines():
        if line.startswith("*"):
            rows = out.setdefault(line, [])
        else:
            rows.append(line)
    return out


def test_the_deck_has_all_pairs_and_the_forces() -> None:
    """One pair for each ring; forces of all lugs but the first, which is fixed, of a half."""
    pin, lugs = clevis()
    deck, angle = joint_deck(pin, STEEL, lugs, PinLoads("p", ("L", "M", "R"), FORK @ TURN), COARSE)
    found = sections(deck)
    assert deck.half
    assert angle == pytest.approx(math.atan2(0.8, 0.6))
    pairs = found["*CONTACT PAIR, INTERACTION=DRY, TYPE=SURFACE TO SURFACE"]
    assert pairs == [f"PINLUG{i}R{k}, BORELUG{i}" for i in (1, 3, 5) for k in (1, 2, 3)]
    assert all(len(found[f"*SURFACE, NAME={name.split(',')[0]}"]) == 4 for name in pairs)
    applied = [float(line.split(",")[2]) for line in found["*CLOAD"]]
    assert applied == pytest.approx([FORCE / 2.0, -FORCE / 4.0])
    assert sum(eye.force[0] for eye in deck.eyes) == pytest.approx(0.0, abs=1e-9 * FORCE)


def test_the_deck_of_forces_in_no_plane_is_of_the_whole() -> None:
    pin, lugs = clevis()
    deck, angle = joint_deck(pin, STEEL, lugs, OBLIQUE, COARSE)
    applied = [float(line.split(",")[2]) for line in sections(deck)["*CLOAD"]]
    assert (deck.half, angle) == (False, 0.0)
    assert applied == pytest.approx([FORCE, -3e3, -FORCE / 2.0, 2e3])
    assert deck.pin.mesh.nodes[:, 1].min() == pytest.approx(-D / 2.0)


def test_friction_and_a_history_of_loads() -> None:
    """One step for each part of the load, in several increments; without friction nothing new."""
    pin, lugs = clevis()
    deck, _ = joint_deck(pin, STEEL, lugs, PULL, COARSE)
    plain = list(deck.lines())
    lines = list(replace(deck, friction=0.2, history=(1.0, 0.25)).lines())
    assert "*FRICTION" not in plain
    assert float(lines[lines.index("*FRICTION") + 1].split(",")[0]) == 0.2
    forces = [float(lines[k + 1].split(",")[2]) for k, x in enumerate(lines) if x == "*CLOAD"]
    assert forces[1] == pytest.approx(0.25 * forces[0])
    assert lines.count("*STEP") == lines.count("*END STEP") == 2
    assert plain[plain.index("*STATIC") + 1] != lines[lines.index("*STATIC") + 1]


def test_the_mean_motion_of_the_outer_surface() -> None:
    """Under a rigid shift and tilt of a lug its equations hold with the auxiliary nodes' values."""
    pin, lugs = clevis()
    deck, _ = joint_deck(pin, STEEL, lugs, PULL, COARSE)
    text = list(deck.lines())
    mesh, first = deck.eyes[0].part.mesh, 1 + len(deck.pin.mesh.nodes)
    z = mesh.nodes[:, 2]
    u = {first + k: 2.0 + 3.0 * (h - 0.007) for k, h in enumerate(z.tolist())}
    u |= {deck.unknowns // 3 + 1: 2.0, deck.unknowns // 3 + 2: 3.0}
    starts = [k for k, line in enumerate(text) if line == "*EQUATION"][:2]
    for start in starts:
        count, fields = int(text[start + 1]), []
        for line in text[start + 2 :]:
            fields += [float(x) for x in line.split(",")]
            if len(fields) == 3 * count:
                break
        terms = np.array(fields).reshape(-1, 3)
        assert (terms[:, 1] == 1).all()
        assert sum(c * u[int(n)] for n, _, c in terms) == pytest.approx(0.0, abs=1e-8)


def test_clearance_and_rounded_edges_are_in_the_bore() -> None:
    """The bore is wider by the clearance, touches the pin where the force presses it, and at its
    ends is wider by the radius of its edges.
    """
    pin, lugs = clevis(clearance=1e-4, radius=5e-4)
    deck, _ = joint_deck(pin, STEEL, lugs, PULL, COARSE)
    for eye, sign in zip(deck.eyes, (-1.0, 1.0, -1.0), strict=True):
        x = eye.part.mesh.nodes
        bore = np.unique(eye.part.mesh.face(np.flatnonzero(eye.part.mesh.inner == 0.01), 6))
        r = np.hypot(x[bore, 0] - sign * 5e-5, x[bore, 1])
        end = np.isin(x[bore, 2], [x[:, 2].min(), x[:, 2].max()])
        middle = np.abs(x[bore, 2] - eye.part.mesh.nodes[:, 2].mean()) < 2e-3
        assert r[end] == pytest.approx(np.full(end.sum(), 0.01 + 5e-5 + 5e-4))
        assert r[middle] == pytest.approx(np.full(middle.sum(), 0.01 + 5e-5))


def test_the_rounding_of_a_bore_never_presses_on_the_pin() -> None:
    """Elements are parabolas along z: with too few of them in the rounding one dips below the
    pin's surface, and the edges carry everything.
    """
    pin, lugs = clevis(radius=1e-3)
    deck, _ = joint_deck(pin, STEEL, lugs, PULL, replace(COARSE, rings=6))
    assert [len(eye.rings) for eye in deck.eyes] == [10, 10, 10]
    for eye in deck.eyes:
        mesh = eye.part.mesh
        faces = mesh.face(np.flatnonzero(mesh.inner == mesh.inner.min()), 6)
        r, z = np.hypot(*mesh.nodes[:, :2].T)[faces], mesh.nodes[:, 2][faces]
        for depth, height in zip(r - D / 2.0, z, strict=True):
            along = np.polyfit(height, depth, 2)
            between = np.linspace(height.min(), height.max(), 9)
            assert np.polyval(along, between).min() > -1e-7


def test_forces_of_contact_are_read(tmp_path: Path) -> None:
    path = tmp_path / "job.dat"
    path.write_text(
        "\n statistics for slave set PINLUG1R2, master set BORELUG1 and time  0.1E+01\n\n"
        "   total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)\n\n"
        "   -8.504373E+02 -7.654770E+02  1.894985E-13  1.769145E+00 -1.968380E+00 -7.751117E-03\n"
        "\n   center of gravity and mean normal\n\n   NaN NaN NaN 1. 2. 3.\n"
    )
    (found,) = contact_forces(path).items()
    assert found[0] == "PINLUG1R2"
    assert found[1][[0, 4]].tolist() == [-850.4373, -1.96838]


def made(stress: Floats, half: bool = False) -> JointOpinion:
    """Of a plain pin with two rings, 1 N on the first and -1 N on the second, nearer its end."""
    pin = Pin("P", (Segment(0.02, D, connection="A"),))
    mesh = pin_mesh(pin, [np.array([0.0, 0.01, 0.02])], Fineness(sectors=16), half)
    ends = np.array([[0.0, 0.01], [0.01, 0.02]])
    force = np.array([[1.0, 0.0], [-1.0, 0.0]])
    first = np.array([[0.005, 0.0], [-0.018, 0.0]])
    full = np.zeros((len(mesh.nodes), 6))
    full[:, 2] = mesh.nodes @ stress
    return JointOpinion(
        ends, force, first, mesh.nodes, mesh.elements, full, 0.5 * half, half, edges(pin), 1, 1, 1.0
    )


def test_moments_of_ring_forces() -> None:
    """Exact at ends of rings: where a ring's load is uneven, by its first moment."""
    found = made(np.zeros(3)).bending_moment(np.array([0.0, 0.005, 0.01, 0.02]))
    assert found[:, 0] == pytest.approx([0.0, 0.5 * 0.0025, 0.005, 0.013])
    assert not found[:, 1].any()
    assert made(np.zeros(3)).line_load[:, 0] == pytest.approx([100.0, -100.0])


def test_stress_at_a_point_and_the_largest_away_from_edges() -> None:
    """A linear field is read as it is; a half in turned axes is mirrored."""
    linear = made(np.array([1e9, 0.0, 0.0]))
    points = np.array([[0.003, 0.002, 0.004], [0.0085, -0.002, 0.013], [0.0, 0.0, 0.01]])
    assert linear.von_mises_at(points) == pytest.approx([3e6, 8.5e6, 0.0], abs=1e3)
    assert linear.largest(0.009) == pytest.approx(1e7)
    along = np.array([[math.cos(0.5), math.sin(0.5), 0.4], [math.cos(0.1), math.sin(0.1), 1.2]])
    half = made(np.array([1e9, 0.0, 0.0]), half=True).von_mises_at(along * [0.005, 0.005, 0.01])
    assert half == pytest.approx([5e6, 5e6 * math.cos(0.4)], rel=1e-3)


def test_edges_of_lugs_and_shoulders() -> None:
    shape = (
        Segment(0.01, 0.03, 0.01),
        Segment(0.01, 0.02, 0.01, connection="A"),
        Segment(0.01, 0.02),
    )
    found = {tuple(x) for x in edges(Pin("P", shape)).round(9).tolist()}
    assert found == {(0.01, 0.01), (0.01, 0.02), (0.005, 0.02)}


def test_small_forces_and_gaps() -> None:
    """In one proportion, of which the results are the same multiple."""
    pin, lugs = clevis(clearance=1e-4)
    small = replace(COARSE, scale=0.01)
    decks = [joint_deck(pin, STEEL, lugs, PULL, f)[0] for f in (COARSE, small)]
    for one, other in zip(decks[0].eyes, decks[1].eyes, strict=True):
        assert other.force == pytest.approx(0.01 * one.force)
        gaps = [eye.part.mesh.nodes[:, 0].max() - EYE / 2.0 for eye in (one, other)]
        assert gaps[1] == pytest.approx(0.01 * gaps[0], abs=1e-12)


def test_what_a_run_wrote_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Forces of a half are doubled and turned to the pin's axes, and as all results enlarged by
    the scale; a run with tension in the contact is known.
    """

    def stand_in(folder: Path) -> str:
        text = (folder / "job.inp").read_text()
        count = text.split("*ELEMENT")[0].count("\n") - 1
        head = "total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)\n\n"
        names = re.findall(r"SLAVE=(\w+)", text)
        blocks = (f" statistics for slave set {n}, x\n {head} 3. 9. 0. 0. 0.5 0.\n" for n in names)
        (folder / "job.dat").write_text("\n".join(blocks))
        rows = "".join(f" -1{k:10}{1e4:12.5E}{5 * f'{0.0:12.5E}'}\n" for k in range(count))
        (folder / "job.frd").write_text(f" -4  STRESS\n{rows} -3\n")
        words = " iteration 1\n iteration 2\n zero-size increment is appended\n"
        return f"{words} Total CalculiX Time: 2.5\n"

    monkeypatch.setattr(calculix, "run", stand_in)
    pin, lugs = clevis()
    loads = PinLoads("pull", ("L", "M", "R"), FORK @ TURN)
    found = joint_opinion(pin, STEEL, lugs, loads, replace(COARSE, scale=0.01))
    assert found.force == pytest.approx(np.tile([360.0, 480.0], (9, 1)))
    assert found.first == pytest.approx(np.tile([60.0, 80.0], (9, 1)))
    assert found.ends[[0, 3, 8]] == pytest.approx(
        np.array([[0.002, 0.0045], [0.013, 0.018], [0.0415, 0.044]])
    )
    assert found.von_mises_at(np.array([[0.001, 0.002, 0.02]])) == pytest.approx([1e6])
    assert (found.iterations, found.seconds, found.appended) == (2, 2.5, True)


def test_a_run_that_wrote_nothing_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "ccx").write_text("#!/bin/sh\necho Total CalculiX Time: 2.5\n")
    (tmp_path / "ccx").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    pin, lugs = clevis()
    with raises(CalculixError, "unreadable-results"):
        joint_opinion(pin, STEEL, lugs, PULL, COARSE)


@pytest.mark.long
@pytest.mark.peers
@pytest.mark.parametrize("clearance", [5e-5, 0.0])
def test_calculix_agrees_on_a_clevis(clearance: float) -> None:
    """The largest bending moment within 3 %, the stress of the tension fibre at mid-span within
    5 %, and the force on every ring within 8 % of the largest, of a mesh that is coarse at the
    lugs' sharp edges; in a direction of no axis.
    """
    pin, lugs = clevis(clearance)
    loads = PinLoads("pull", ("L", "M", "R"), FORK @ TURN)
    theirs = joint_opinion(pin, STEEL, lugs, loads, Fineness(rings=6, sectors=16, eye=2))
    ours = ContactModel(pin, STEEL, lugs, Resolution(rings=6)).solve(loads)
    middle = np.array([0.023])
    mine, other = ours.bending_moment(middle)[0], theirs.bending_moment(middle)
    assert other == pytest.approx(mine, rel=0.03)
    apart = np.abs(theirs.force - ours.loads.forces[0, :, :2])
    assert apart.max() < 0.08 * np.abs(theirs.force).max()
    requirement = Requirement(model="harmonic", meshes=2)
    answer = solve_pin(ours.pin, STEEL, (), (ours.loads,), requirement)[0].answer
    assert isinstance(answer, HarmonicField)
    fields, angle = answer.fields, math.atan2(0.8, 0.6)
    near = np.hypot(fields.points[:, 0] - D / 2.0, fields.points[:, 1] - 0.023).argmin()
    own = Circumference(fields, ours.loads).envelope(np.array([near]), np.array([angle]))
    fibre = theirs.von_mises_at(np.array([[0.006, 0.008, 0.023]]))
    assert fibre[0] == pytest.approx(float(own[0, 0]), rel=0.05)
