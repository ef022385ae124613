"""Gears and racks: ratios, forces of teeth and bearings, power, virtual work."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from loads import (
    GROUND,
    Applied,
    Body,
    Connection,
    Course,
    CycloidalDrive,
    Dynamics,
    Gear,
    Joint,
    Linkage,
    LinkageError,
    Rack,
    Sharing,
    Slider,
    Turn,
    at_rest,
    gear_pair,
    ledger,
    mobility,
    motion_reactions,
    rack_and_pinion,
)
from loads.linkage.gears import gap_weights
from loads.motion import loop_equations
from tests.support.each import each

ALPHA = math.radians(20.0)


def ground_joint(name: str, at: tuple[float, float], *bodies: str, friction: float = 0.0) -> Joint:
    return Joint(name, at, tuple(Connection(f"{name}.{b}", b, friction) for b in bodies), GROUND)


def force(found: Dynamics, name: str) -> np.ndarray:
    return found.reactions.force(name)[:, :2]


def train(friction: float = 0.0) -> Linkage:
    """Shigley's example 13-7 in shape: a pinion drives an idler, which drives a gear, in a line."""
    gears = (("2", 20.0, 0.0), ("3", 50.0, 0.0875), ("4", 30.0, 0.1875))
    at = {name: (x, 0.0) for name, _, x in gears}
    angle = {name: Gear(name, name) for name in at}
    return Linkage(
        bodies=tuple(Body(name, 0.0, at[name], 0.0) for name in at),
        joints=tuple(ground_joint(name, at[name], name, friction=friction) for name in at),
        driven=("pinion",),
        turns=(Turn("pinion", "2", 0.0),),
        teeth=(
            gear_pair("23", (angle["2"], angle["3"]), GROUND, (at["2"], at["3"]), (20, 50), ALPHA),
            gear_pair("34", (angle["3"], angle["4"]), GROUND, (at["3"], at["4"]), (50, 30), ALPHA),
        ),
    )


def test_a_train_has_the_ratio_of_its_teeth() -> None:
    course = Course(train(), [CycloidalDrive(0.0, 12.0, 1.0)], 0.0, 1.0)
    motion = course.at(np.linspace(0.0, 1.0, 7))
    for of in (motion.angle, motion.angular_velocity, motion.angular_acceleration):
        assert of("3") == pytest.approx(-0.4 * of("2"), abs=1e-12)
        assert of("4") == pytest.approx(20.0 / 30.0 * of("2"), abs=1e-12)


@each("sign", [1.0, -1.0])
def test_shafts_of_a_train_carry_tangential_and_radial_forces(sign: float) -> None:
    """Shigley's 13-14: W_t = T / r; W_r = W_t tan(20 deg) pushes apart on either flank; the idler's
    shaft carries 2 W_t, and no radial force as the three are in a line.
    """
    torque, r2, r4 = sign * 40.0, 0.025, 0.0375
    load = Applied("4", (0.1875, 0.0), couple=-torque * r4 / r2)
    found = motion_reactions("x", at_rest(train(), [0.0]), (load,), timed=False)
    tangential = torque / r2
    assert found.drive[0, 0] == pytest.approx(torque)
    radial = abs(tangential) * math.tan(ALPHA)
    assert force(found, "23")[0] == pytest.approx([radial, tangential])  # of 2 on 3
    assert force(found, "34")[0] == pytest.approx([radial, -tangential])
    assert force(found, "2.2")[0] == pytest.approx([-radial, -tangential])  # of the gear on its pin
    assert force(found, "3.3")[0] == pytest.approx([0.0, 2.0 * tangential], abs=1e-9 * radial)
    assert force(found, "4.4")[0] == pytest.approx([radial, -tangential])


def planetary(planets: int = 1, sharing: tuple[Sharing, ...] = ()) -> Linkage:
    """Sun of 24 teeth that is driven, ring of 72 that stands, planets of 24 on an arm."""
    distance = 0.096
    at = [distance * np.exp(2j * math.pi * k / planets) for k in range(planets)]
    names = [f"p{k}" for k in range(planets)]
    centre = ground_joint("O", (0.0, 0.0), "sun", "arm")
    teeth = []
    for name, z in zip(names, at, strict=True):
        place = (float(z.real), float(z.imag))
        planet, sun, ring = Gear(name, name), Gear("sun", "O"), Gear(GROUND, "O")
        centres = ((0.0, 0.0), place)
        teeth.append(gear_pair(f"s{name}", (sun, planet), "arm", centres, (24, 24), ALPHA))
        teeth.append(gear_pair(f"r{name}", (planet, ring), "arm", centres[::-1], (24, -72), ALPHA))
    pins = tuple(
        Joint(n, (float(z.real), float(z.imag)), (Connection(f"pin.{n}", n),), "arm")
        for n, z in zip(names, at, strict=True)
    )
    bodies = [Body("sun", 1.0, (0.0, 0.0), 1e-3), Body("arm", 2.0, (0.0, 0.0), 5e-3)]
    bodies += [Body(n, 0.4, p.at, 4e-4) for n, p in zip(names, pins, strict=True)]
    return Linkage(
        tuple(bodies), (centre, *pins), ("sun",), (), (Turn("sun", "sun", 0.0),), (0.0, -9.81),
        sharing, teeth=tuple(teeth),
    )  # fmt: skip


def test_a_planetary_train_turns_as_willis_says() -> None:
    motion = Course(planetary(), [CycloidalDrive(0.0, 9.0, 1.0)], 0.0, 1.0).at(np.array([0.3, 1.0]))
    arm = motion.angle("sun") / (1.0 + 72.0 / 24.0)
    assert motion.angle("arm") == pytest.approx(arm)
    assert motion.angle("p0") == pytest.approx(arm - 72.0 / 24.0 * arm)
    assert mobility(motion.linkage).degrees == mobility(motion.linkage).kutzbach == 1


def test_forces_of_a_planetary_train() -> None:
    """T on the sun: the planet's two teeth carry T / r_s each, its pin twice that, radial forces
    cancel; the arm's moment is 4 T.
    """
    linkage = replace(planetary(), gravity=(0.0, 0.0))
    load = Applied("arm", (0.0, 0.0), couple=-4.0 * 30.0)
    found = motion_reactions("x", at_rest(linkage, [0.7]), (load,), timed=False)
    assert found.drive[0, 0] == pytest.approx(30.0)
    tangential = 30.0 / 0.048
    for name in ("sp0", "rp0"):
        assert found.reactions.magnitudes[0, found.reactions.connections.index(name)] == (
            pytest.approx(tangential / math.cos(ALPHA))
        )
    turned = found.reactions.in_pin_axes("pin.p0")[0]
    assert turned[:2] == pytest.approx([0.0, 2.0 * tangential], abs=1e-9 * tangential)


def test_three_planets_share_by_stiffness() -> None:
    open_ = planetary(3)
    found = mobility(open_)
    assert (found.redundant, found.degrees) == (2, 1)
    assert {"sp0", "sp1", "sp2"} <= set(found.shared)
    rule = Sharing(("sp0", "sp1", "sp2"), (1.0, 1.0, 2.0))
    linkage = replace(planetary(3, (rule,)), gravity=(0.0, 0.0))
    load = Applied("arm", (0.0, 0.0), couple=-120.0)
    dynamics = motion_reactions("x", at_rest(linkage, [0.0]), (load,), timed=False)
    size = [np.linalg.norm(force(dynamics, f"sp{k}")[0]) * math.cos(ALPHA) for k in range(3)]
    assert np.array(size) * 0.048 == pytest.approx([7.5, 7.5, 15.0])
    assert dynamics.drive[0, 0] == pytest.approx(30.0)


def steering(turned: float = 0.3, rack_moves: bool = True) -> Linkage:
    """A pinion on the ground with a rack below it, all turned by an angle; or the rack stands and
    carries a carriage with the pinion.
    """
    u = np.exp(1j * turned)

    def place(z: complex) -> tuple[float, float]:
        return float((u * z).real), float((u * z).imag)

    rack, carriage = ("rack", GROUND) if rack_moves else (GROUND, "carriage")
    moving = "rack" if rack_moves else "carriage"
    slider = Slider("travel", GROUND, moving, place(-0.1 - 0.02j), place(-0.02j), place(1.0))
    centre = Joint("C", (0.0, 0.0), (Connection("bearing", "pinion"),), carriage)
    sides = (Gear("pinion", "C"), Rack(rack, "travel"))
    mesh = rack_and_pinion("mesh", sides, carriage, (0.0, 0.0), place(-0.02j), ALPHA)
    return Linkage(
        (Body("pinion", 0.5, (0.0, 0.0), 1e-4), Body(moving, 3.0, place(0.05 - 0.03j), 0.0)),
        (centre,), ("wheel",), (slider,), (Turn("wheel", "pinion", 0.0),), (0.0, -9.81),
        teeth=(mesh,),
    )  # fmt: skip


@each("rack_moves", [True, False])
@each("turned", [0.0, 0.3, 2.0])
def test_a_rack_travels_by_radius_times_angle(rack_moves: bool, turned: float) -> None:
    """The pinion above the rack turns counter-clockwise: its lower teeth, and with them the rack,
    go to the right (e^(i turned)); a carriage on a rack that stands rolls to the left.
    """
    linkage = steering(turned, rack_moves)
    motion = Course(linkage, [CycloidalDrive(0.0, 2.0, 1.0)], 0.0, 1.0).at(np.array([0.0, 1.0]))
    moving = "rack" if rack_moves else "carriage"
    at, _, _ = motion.point(moving, (0.0, 0.0))
    way = 0.02 * 2.0 * np.exp(1j * turned) * (1.0 if rack_moves else -1.0)
    assert at[1] - at[0] == pytest.approx([way.real, way.imag])


@each("push", [50.0, -50.0])
def test_forces_of_a_rack(push: float) -> None:
    linkage = replace(steering(0.0), gravity=(0.0, 0.0))
    load = Applied("rack", (0.05, -0.02), force=(-push, 0.0))
    found = motion_reactions("x", at_rest(linkage, [0.0]), (load,), timed=False)
    apart = abs(push) * math.tan(ALPHA)
    assert found.drive[0, 0] == pytest.approx(0.02 * push)
    assert force(found, "mesh")[0] == pytest.approx([push, -apart])
    assert force(found, "bearing")[0] == pytest.approx([-push, apart])
    assert found.sliders.normal[0, 0] == pytest.approx(apart)
    # About the slider's end at the pitch point, with the load on the same line: no couple.
    assert found.sliders.couple[0, 0] == pytest.approx(0.0, abs=1e-12)


BETA = math.radians(30.0)


def wedge(rack: str, closing: bool) -> Linkage:
    """A wedge on the floor lifts a follower in a guide; on the incline between them one has a rack,
    the other the pinion. The incline closes the loop of the three sliders if it comes last.
    """
    u, centre = np.exp(1j * BETA), (0.0, 0.3)
    carrier = "follower" if rack == "wedge" else "wedge"
    to_rack = 0.02 * u * (-1j if rack == "wedge" else 1j)

    def place(z: complex) -> tuple[float, float]:
        return float(z.real), float(z.imag)

    pitch = complex(*centre) + to_rack
    incline = Slider("incline", "wedge", "follower", place(pitch - 0.1 * u), place(pitch), place(u))
    floor = Slider("floor", GROUND, "wedge", (-0.5, 0.0), (0.0, 0.0), (1.0, 0.0))
    guide = Slider("guide", GROUND, "follower", (0.0, 0.0), (0.0, 0.3), (0.0, 1.0))
    sides = (Gear("pinion", "C"), Rack(rack, "incline"))
    return Linkage(
        (Body("wedge", 1.0, (0.0, 0.0), 0.0), Body("follower", 1.0, centre, 0.0),
         Body("pinion", 0.5, centre, 1e-4)),
        (Joint("C", centre, (Connection("bearing", "pinion"),), carrier),), ("wheel",),
        (floor, guide, incline) if closing else (incline, floor, guide),
        (Turn("wheel", "pinion", 0.0),), (0.0, 0.0),
        teeth=(rack_and_pinion("mesh", sides, carrier, centre, place(to_rack), ALPHA),),
    )  # fmt: skip


@each("rack", ["wedge", "follower"])
@each("closing", [True, False])
def test_a_rack_whose_slider_closes_a_loop(rack: str, closing: bool) -> None:
    """Statics of a wedge without friction: of the load on the follower the teeth have the sine, the
    incline the cosine less the radial force that pushes off the pinion, the floor all, and the
    guide nothing.
    """
    load = Applied("follower", (0.0, 0.3), force=(0.0, -100.0))
    found = motion_reactions("x", at_rest(wedge(rack, closing), [0.0]), (load,), timed=False)
    assert bool(gap_weights(found.motion.linkage, found.motion.loops.closing).any()) is closing
    tangential = 100.0 * math.sin(BETA)
    assert abs(found.drive[0, 0]) == pytest.approx(0.02 * tangential)
    tooth = float(np.linalg.norm(force(found, "mesh")[0]))
    assert tooth == pytest.approx(tangential / math.cos(ALPHA))
    radial = tangential * math.tan(ALPHA)
    normal = dict(
        zip((s.name for s in found.motion.linkage.sliders), found.sliders.normal[0], strict=True)
    )
    assert normal["incline"] == pytest.approx(100.0 * math.cos(BETA) - radial)
    assert normal["floor"] == pytest.approx(100.0)
    assert normal["guide"] == pytest.approx(0.0, abs=1e-9)


def five_bar(friction: float = 0.0, alpha: float = ALPHA) -> Linkage:
    """A geared five-bar (Norton, fig. 2-22): two cranks on meshing gears, two links between; drawn
    so that a crank closes a loop, and its gear's other joint.
    """
    A, E = (0.0, 0.0), (0.12, 0.0)
    B, D = (0.03, 0.06), (0.15, 0.05)
    C = (0.08, 0.16)
    bodies = (
        Body("left", 1.0, (0.01, 0.02), 2e-3),
        Body("right", 1.3, (0.13, 0.02), 3e-3),
        Body("link", 0.6, (0.05, 0.11), 1e-3),
        Body("other", 0.7, (0.12, 0.11), 1e-3),
    )
    joints = (
        ground_joint("A", A, "left", friction=friction),
        ground_joint("E", E, "right", friction=friction),
        Joint("B", B, (Connection("B1", "left"), Connection("B2", "link"))),
        Joint("D", D, (Connection("D1", "right"), Connection("D2", "other"))),
        Joint("C", C, (Connection("C2", "other", friction),), "link"),
    )
    mesh = gear_pair("mesh", (Gear("left", "A"), Gear("right", "E")), GROUND, (A, E), (2, 1), alpha)
    return Linkage(
        bodies, joints, ("crank",), (), (Turn("crank", "left", 0.0),), (0.0, -9.81), teeth=(mesh,)
    )


LOAD = Applied("other", (0.08, 0.16), force=(-70.0, 40.0))


def moved(linkage: Linkage, end: float = 2.0) -> Course:
    return Course(linkage, [CycloidalDrive(0.0, end, 1.0)], 0.0, 1.0)


@each(
    "linkage",
    [five_bar(), five_bar(friction=1e-3), planetary(), steering()],
)
def test_power_balances(linkage: Linkage) -> None:
    motion = moved(linkage).at(np.linspace(0.0, 1.0, 41))
    body = linkage.bodies[-1]
    load = Applied(body.name, body.centre, force=(-70.0, 40.0), couple=3.0)
    assert ledger(motion_reactions("x", motion, (load,))).violation < 1e-12


def bodies_balance(found: Dynamics, linkage: Linkage, load: Applied) -> float:
    """The largest force or moment (over a length of 0.1 m) that is missing for Newton and Euler on
    any body, from the reported reactions alone.
    """
    motion, worst = found.motion, 0.0
    for body in linkage.bodies:
        centre, _, acceleration = motion.point(body.name, body.centre)
        total = -body.mass * (acceleration - np.array(linkage.gravity))
        moment = -body.inertia * motion.angular_acceleration(body.name)  # type: ignore[operator]
        pushes = []
        for joint, connection in linkage.connections:
            at = motion.joint(joint.name)[0]
            if connection.body == body.name:
                pushes.append((at, -force(found, connection.name)))
            if joint.fixed_in == body.name:
                pushes.append((at, force(found, connection.name)))
        for teeth in linkage.teeth:
            at = motion.point(teeth.carrier, teeth.at)[0]
            for other, sign in zip(teeth.bodies, (-1.0, 1.0), strict=True):
                if other == body.name:
                    pushes.append((at, sign * force(found, teeth.name)))
        if load.body == body.name:
            pushes.append((motion.point(body.name, load.at)[0], np.array([load.force])))
        for k, turn in enumerate(found.actuators):
            if isinstance(turn, Turn) and turn.body == body.name:
                moment = moment + found.drive[:, k]
        for at, push in pushes:
            arm = at - centre
            total = total + push
            moment = moment + arm[:, 0] * push[:, 1] - arm[:, 1] * push[:, 0]
        worst = max(worst, float(np.abs(total).max()), float(np.abs(moment).max()) / 0.1)
    return worst


def test_every_body_of_a_geared_five_bar_is_in_balance() -> None:
    linkage = five_bar()
    found = motion_reactions("x", moved(linkage).at(np.linspace(0.0, 1.0, 23)), (LOAD,))
    assert np.abs(found.reactions.forces).max() > 100.0
    assert bodies_balance(found, linkage, LOAD) < 1e-9


def test_the_drive_of_a_geared_five_bar_follows_from_virtual_work() -> None:
    """Against differences of positions alone; the pressure angle does no work."""
    for alpha in (0.0, ALPHA):
        linkage = five_bar(alpha=alpha)
        torque = motion_reactions("x", at_rest(linkage, [0.5]), (LOAD,), timed=False).drive[0, 0]
        work, step = 0.0, 1e-5
        for sign in (1.0, -1.0):
            motion = at_rest(linkage, [0.5 + sign * step])
            work += sign * float(motion.point("other", LOAD.at)[0][0] @ np.array(LOAD.force))
            work += sign * sum(-9.81 * b.mass * motion.point(b.name, b.centre)[0][0, 1]
                               for b in linkage.bodies)  # fmt: skip
        assert torque == pytest.approx(-work / (2.0 * step), rel=1e-8)


def test_gears_round_a_four_bar_whose_sides_carry_them() -> None:
    """Every side of a parallelogram is a carrier, so no tree of joints has all their centres: the
    forces that then act at the member that closes the loop balance every body.
    """
    at = {"A": (0.0, 0.0), "B": (0.01, 0.1), "C": (0.13, 0.12), "D": (0.12, 0.0)}
    sides = (("a", "A", "B"), ("b", "B", "C"), ("c", "D", "C"))
    gears = tuple(f"g{j}" for j in at)
    bodies = [Body(n, 1.0, at[p], 2e-3) for n, p, _ in sides]
    bodies += [Body(g, 0.5, at[g[1]], 1e-3) for g in gears]
    joined = {"A": "a", "B": "ab", "C": "bc", "D": "c"}
    joints = tuple(
        Joint(
            j, p, tuple(Connection(f"{j}.{b}", b) for b in (*joined[j], f"g{j}")),
            GROUND if j in "AD" else None,
        )
        for j, p in at.items()
    )  # fmt: skip
    teeth = tuple(
        gear_pair(p + q, (Gear(f"g{p}", p), Gear(f"g{q}", q)), c, (at[p], at[q]), (3, 2), ALPHA)
        for c, p, q in (("a", "A", "B"), ("b", "B", "C"), ("c", "C", "D"))
    )
    linkage = Linkage(
        tuple(bodies), joints, ("crank", "gear"), (),
        (Turn("crank", "a", 0.0), Turn("gear", "gA", 0.0)), (0.0, -9.81), teeth=teeth,
    )  # fmt: skip
    laws = [CycloidalDrive(0.0, 0.6, 1.0), CycloidalDrive(0.0, -4.0, 1.0)]
    load = Applied("gD", at["D"], force=(30.0, -20.0), couple=0.0)
    found = motion_reactions("x", Course(linkage, laws, 0.0, 1.0).at(np.linspace(0, 1, 9)), (load,))
    loops = found.motion.loops
    assert gap_weights(linkage, loops.closing).any()
    assert bodies_balance(found, linkage, load) < 1e-9
    assert ledger(found).violation < 1e-12


def test_friction_feels_the_radial_force() -> None:
    """Statically: a pinion's bearing carries W / cos(alpha), so its friction couple is that times
    the radius of the friction circle, of both gears.
    """
    circle = 2e-3
    linkage = replace(train(friction=circle), teeth=train().teeth[:1])
    linkage = replace(linkage, bodies=linkage.bodies[:2], joints=linkage.joints[:2])
    linkage = replace(linkage, joints=train(circle).joints[:2])
    motion = moved(linkage).at(np.array([0.5]))
    load = Applied("3", (0.0875, 0.0), couple=100.0)
    found = motion_reactions("x", motion, (load,))
    bearing = found.reactions.magnitudes[0, 0]
    tooth = found.reactions.magnitudes[0, 2]
    assert bearing == pytest.approx(tooth)
    tangential = tooth * math.cos(ALPHA)
    # The load drives gear 3 forwards, which turns clockwise here: friction helps to hold it.
    assert abs(tangential) * 0.0625 == pytest.approx(100.0 + bearing * circle)
    assert ledger(found).violation < 1e-12


def test_batches_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    linkage, times = five_bar(friction=1e-3), np.linspace(0.0, 1.0, 30)
    course = moved(linkage)
    whole = motion_reactions("x", course.at(times), (LOAD,))
    monkeypatch.setattr(
        loop_equations, "MATRIX_BATCH_ENTRIES", 7 * course.loops.rows * course.loops.columns
    )
    parts = motion_reactions("x", course.at(times), (LOAD,))
    assert parts.reactions.forces == pytest.approx(whole.reactions.forces, rel=1e-12, abs=1e-9)


def test_gears_that_lock_each_other_are_named() -> None:
    """Three gears in a triangle, each of which meshes with the other two."""
    at = {"a": (0.0, 0.0), "b": (0.1, 0.0), "c": (0.05, 0.05 * math.sqrt(3.0))}
    pairs = (("a", "b"), ("b", "c"), ("c", "a"))
    teeth = tuple(
        gear_pair(p + q, (Gear(p, p), Gear(q, q)), GROUND, (at[p], at[q]), (1, 1), ALPHA)
        for p, q in pairs
    )
    linkage = Linkage(
        tuple(Body(n, 1.0, p, 1e-3) for n, p in at.items()),
        tuple(ground_joint(n, p, n) for n, p in at.items()),
        ("a",),
        turns=(Turn("a", "a", 0.0),),
        teeth=teeth,
    )
    with pytest.raises(LinkageError, match=r"ab, bc, ca do not meet.*gears") as wrong:
        moved(linkage)
    assert wrong.value.code == "does-not-close"


def test_circles_that_cannot_touch_are_refused() -> None:
    pair = (Gear("a", "A"), Gear("b", "B"))
    apart = ((0.0, 0.0), (1.0, 0.0))
    none = [(apart, radii) for radii in ((2, -2), (-1, -2), (0, -2), (-2, 0), (0, 0))]
    for centres, radii in ((((0.0, 0.0), (0.0, 0.0)), (1, 2)), *none):
        with pytest.raises(LinkageError) as wrong:
            gear_pair("g", pair, GROUND, centres, radii, ALPHA)
        assert wrong.value.code == "gears-apart"
