"""The stress of a lug about a pin: plane contact, directions, instants, and thickness."""

import math
from functools import partial

import numpy as np
import pytest

from fea.core.material import Material
from fea.lug.in_joint import degrees_from_shank
from fea.lug.lug_load import LugLoad
from fea.lug.lug_stress import BoreStress, LugInPlane, bore_stresses
from fea.lug.plane_fields import Elasticity, plane_fields
from fea.lug.through_thickness import EyeStress, eye_stress
from fea.support.contact.flexibility import lug_rings
from fea.support.foundation.plane_contact import half_angle, largest_pressure
from fea.support.lugs.lug import Bushing, Lug, Shank
from geometry import Pin, Segment
from geometry.shape.lug_outline import HeadShape, LugOutline
from geometry.shape.rings import annulus, graded
from pinbase.arrays import Floats

STEEL = Material("steel", 210e9, 0.3, yield_strength=700e6)
RADIUS, THICKNESS = 0.01, 0.02
NO_EYE = EyeStress(np.zeros((2, 1, 1)), np.zeros((2, 1, 1)))


def lug(
    shape: HeadShape = "round", ratio: float = 2.5, clearance: float = 0.0, **other: float
) -> Lug:
    outer = ratio * 2.0 * RADIUS
    shank = Shank(shape, other.get("width", outer), 2.0 * outer, other.get("end", outer / 2.0))
    return Lug("A", outer, STEEL, clearance, shank=shank)


def load(force: Floats, angle: float = 0.0, times: Floats | None = None) -> LugLoad:
    """Even pressure through the thickness, of the force's harmonic alone."""
    force = np.atleast_2d(force)
    pressure = np.zeros((2, len(force), 1, 2))
    pressure[1, :, 0] = force / (math.pi * RADIUS * THICKNESS)
    angles = np.full(len(force), angle)
    return LugLoad(force, pressure, np.array([THICKNESS]), angles, times)


def largest(of: Lug, given: LugLoad, inner: float = 0.0) -> dict[str, BoreStress]:
    make = partial(LugInPlane, of, STEEL, inner, RADIUS)
    return {x.place: x for x in bore_stresses(make, NO_EYE, given)}


@pytest.mark.parametrize("gap", [0.0, 0.5, 2.0, 10.0])
def test_pressure_in_a_large_plate_is_perssons(gap: float) -> None:
    """Exact, of a disc in a plate of its material; gap over force per length and modulus."""
    Q = 1e6
    wide = 60.0 * 2.0 * RADIUS
    plate = Lug(
        "A", wide, STEEL, 2.0 * gap * Q / STEEL.youngs_modulus,
        shank=Shank("square", wide, wide, wide / 2.0),
    )  # fmt: skip
    (pressure,) = LugInPlane(plate, STEEL, 0.0, RADIUS).contact.pressures(np.array([[-Q, 0.0]]))
    assert pressure.max() * RADIUS / Q == pytest.approx(largest_pressure(gap), rel=0.01)
    arc = (pressure > 0.0).sum() / len(pressure) * math.pi
    assert arc == pytest.approx(half_angle(gap), abs=math.radians(2.0))


def test_pull_on_a_straight_lug_has_the_published_concentration() -> None:
    """Ekvall 1986, K_tb = 2.75 (W / D - 1)^-0.675 on the bearing stress, a fit over lugs of W / D
    from 1.33 to 4.5, which falls to nothing for wide lugs; ours is 11 % above it at 3.5.
    """
    for ratio, near in ((1.8, 0.06), (2.5, 0.05), (3.5, 0.12)):
        stress = largest(lug(ratio=ratio), load(np.array([-50e3, 0.0])))["free"]
        bearing = 50e3 / (2.0 * RADIUS * THICKNESS)
        assert stress.hoop / bearing == pytest.approx(2.75 * (ratio - 1.0) ** -0.675, rel=near)
        assert abs(math.remainder(stress.angle, 2.0 * math.pi)) == pytest.approx(
            math.pi / 2.0, abs=0.25
        )
        assert stress.mesh < 0.03 * stress.hoop


def test_pushing_stresses_less_than_pulling() -> None:
    pull, push = (largest(lug(), load(np.array([x, 0.0])))["free"] for x in (-1e4, 1e4))
    assert push.hoop < 0.5 * pull.hoop


def test_load_and_lug_may_turn_together() -> None:
    """The stress depends on the direction of the force from the shank alone."""
    turn = 0.7
    c, s = math.cos(turn), math.sin(turn)
    force = np.array([-3e4, 2e4])
    turned = np.array([c * force[0] - s * force[1], s * force[0] + c * force[1]])
    one, other = largest(lug(), load(force)), largest(lug(), load(turned, turn))
    for place, stress in one.items():
        assert other[place].von_mises == pytest.approx(stress.von_mises, rel=1e-9)
        assert other[place].angle == pytest.approx(stress.angle)


def test_a_mirrored_force_gives_the_mirrored_stress() -> None:
    up, down = (largest(lug(), load(np.array([-3e4, y])))["free"] for y in (2e4, -2e4))
    assert up.hoop == pytest.approx(down.hoop, rel=3e-3)
    assert math.remainder(up.angle + down.angle, 2.0 * math.pi) == pytest.approx(0.0, abs=0.05)


def test_without_clearance_stress_follows_the_force() -> None:
    one, ten = (largest(lug(), load(np.array([-x, 0.0]))) for x in (1e3, 1e4))
    for place, stress in one.items():
        assert ten[place].von_mises == pytest.approx(10.0 * stress.von_mises, rel=1e-9)


def test_clearance_raises_pressure_and_stress() -> None:
    tight, loose = (largest(lug(clearance=x), load(np.array([-5e4, 0.0]))) for x in (0.0, 1e-4))
    assert loose["free"].hoop > 1.1 * tight["free"].hoop
    force = np.array([[-5e4 / THICKNESS, 0.0]])
    pressures = (
        LugInPlane(lug(clearance=x), STEEL, 0.0, RADIUS).contact.pressures(force).max()
        for x in (0.0, 1e-4)
    )
    assert next(pressures) * 1.3 < next(pressures)


def test_the_worst_instant_is_found_and_between_instants_too() -> None:
    times = np.linspace(0.0, 1.0, 11)
    force = np.stack([-1e4 * (1.0 - (times - 0.47) ** 2), np.zeros(11)], axis=1)
    stress = largest(lug(), load(force, times=times))["free"]
    assert stress.time == pytest.approx(0.5)
    top = largest(lug(), load(np.array([-1e4, 0.0])))["free"].von_mises
    assert stress.von_mises + stress.sampling == pytest.approx(top, rel=1e-9)


def test_instants_of_next_to_no_force_do_no_harm() -> None:
    """In a large clearance they touch less than a sector."""
    of = lug(clearance=1e-3)
    force = np.array([[-1e-6, 0.0], [-5e4, 0.0], [1e-3, 1e-3]])
    alone = largest(of, load(force[1]))["free"]
    every = largest(of, load(force))["free"]
    assert every.instant == 1
    assert every.von_mises == pytest.approx(alone.von_mises, rel=1e-12)


def test_without_force_there_is_no_stress() -> None:
    """As at the instant at which a joint is varied, where one of its lugs may be free."""
    assert not largest(lug(), load(np.zeros((2, 2))))


def test_a_couple_alone_is_no_force_of_round_off() -> None:
    """It would be lost in a clearance, and with it the stress of all lugs of a pin."""
    pressure = np.zeros((2, 1, 4, 2))
    pressure[1, 0, :, 0] = 2e8, 1e8, -1e8, -2e8 * (1.0 + 1e-12)
    length = np.full(4, THICKNESS / 4.0)
    force = math.pi * RADIUS * np.einsum("trp,r->tp", pressure[1], length)
    assert force.any()
    given = LugLoad(force, pressure, length, np.zeros(1)).without_round_off()
    assert not given.force.any()
    eye = EyeStress(np.tile(np.eye(4), (2, 1, 1)))
    make = partial(LugInPlane, lug(clearance=2e-5), STEEL, 0.0, RADIUS)
    (free,) = bore_stresses(make, eye, given)
    assert (free.place, free.von_mises > 0.0) == ("free", True)
    even = load(np.array([-50e3, 0.0]))
    assert (even.without_round_off().force == even.force).all()


def test_an_eccentric_bore_is_stressed_more_at_the_thin_side() -> None:
    """Of a head whose end is nearer to the bore."""
    middle, near = (
        largest(lug(end=x * 2.0 * RADIUS), load(np.array([-1e4, 0.0])))["free"].hoop
        for x in (1.25, 1.0)
    )
    assert near > 1.05 * middle


def test_a_press_fit_alone_stresses_a_lug_and_load_comes_on_top() -> None:
    bronze = Material("bronze", 110e9, 0.34)
    eye = lug()
    fitted, bonded = (
        Lug("A", eye.outer_diameter, STEEL, bushing=Bushing(2e-3, bronze, x), shank=eye.shank)
        for x in (2e-5, 0.0)
    )
    tiny, full = np.array([-1.0, 0.0]), np.array([-2e4, 0.0])
    residual = largest(fitted, load(tiny))["bushing"]
    both, alone = (largest(x, load(full))["bushing"] for x in (fitted, bonded))
    assert residual.hoop > 0.2 * both.hoop
    assert max(residual.hoop, alone.hoop) < both.hoop <= 1.01 * (residual.hoop + alone.hoop)


def eye_of(thickness: float = THICKNESS) -> tuple[EyeStress, Floats]:
    """The stress of an eye of this thickness, and the lengths of its rings."""
    ends = graded(thickness, 8)
    pin = Pin("P", (Segment(thickness, 2.0 * RADIUS, connection="A"),))
    rings = lug_rings(annulus(pin, "A", 5.0 * RADIUS, ends), lug(), 10.0)
    return eye_stress(rings, lug(), 8), np.diff(ends)


def test_even_pressure_stresses_a_thick_eye_as_a_plane_one_on_the_mean() -> None:
    """Two models: the body of revolution in three dimensions, and plane stress."""
    eye, length = eye_of()
    plane = plane_fields(LugOutline("ring", 2.0, 5.0), Elasticity(0.3)).bore
    for n in range(7):
        solid = eye.bore[n].sum(axis=1) @ (length / length.sum())
        wave = np.cos(n * plane.angles)
        flat = ((plane.hoop[n] + wave) * wave).mean() * (2.0 if n else 1.0)
        assert solid == pytest.approx(flat, abs=0.06)


def test_pressure_on_one_face_stresses_that_face_more() -> None:
    eye, length = eye_of()
    force = np.array([[-1e4, 0.0]])
    even = np.zeros((3, 1, 8, 2))
    even[0], even[1, :, :, 0] = 1e6, force[0, 0] / (math.pi * RADIUS * THICKNESS)
    uneven = even.copy()
    uneven[:, :, :4] *= 1.5
    uneven[:, :, 4:] *= 0.5
    make = partial(LugInPlane, lug(), STEEL, 0.0, RADIUS)
    a, b = (
        {x.place: x for x in bore_stresses(make, eye, LugLoad(force, x, length, np.zeros(1)))}
        for x in (even, uneven)
    )
    assert b["free"].ring < 4
    assert b["free"].hoop > 1.02 * a["free"].hoop


def test_an_angle_has_no_round_off() -> None:
    """The free bore opposite to the shank was at 57.30e-9 degrees on the page."""
    assert [str(degrees_from_shank(x)) for x in (1e-9, -1e-9)] == ["0.0", "0.0"]
    assert degrees_from_shank(math.pi * 1.5) == -90.0
