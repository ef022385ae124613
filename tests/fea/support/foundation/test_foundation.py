"""A pin in its lugs as a beam on foundations: closed forms, limits, and compared with contact."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.joints.foundation import clevis, largest_moment
from benchmarks.joints.random_joints import JointTrial, joint_trials
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.core.requirement import Requirement
from fea.solve.solve import solve_pin
from fea.support.contact.solve_joint import ContactModel
from fea.support.foundation.foundation_model import (
    LONG_LUG_ERROR,
    PLAIN_MOMENT_ERROR,
    SINGLE_SHEAR_ERROR,
    TUBE_ERROR,
    FoundationModel,
    JointFoundation,
    foundation_stiffness,
    moment_error,
)
from fea.support.foundation.supported_beam import SupportedBeam, refined, respond
from fea.support.lugs.lug import Lug
from geometry import Pin, Segment
from tests.support.each import sampled

D, FORCE = 0.02, 50e3
STEEL = Material("steel", 210e9, 0.3, density=7850.0)
FORK = np.array([[[-0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [-0.5, 0.0, 0.0]]]) * FORCE
PULL = PinLoads("pull", ("L", "M", "R"), FORK)
SHEAR = PinLoads("shear", ("A", "B"), FORCE * np.array([[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]]))


def single(first: float, second: float, pin: Material = STEEL) -> FoundationModel:
    """Two lugs a diameter thick, half a diameter apart, with the stiffness of their tilts."""
    over = Segment(0.1 * D, D)
    a, b = (Segment(D, D, connection=name) for name in "AB")
    shape = Pin("S", (over, a, Segment(0.5 * D, D), b, over))
    tilts = {"A": first, "B": second}
    return FoundationModel(shape, pin, [Lug(n, 2.5 * D, STEEL, tilt=k) for n, k in tilts.items()])


def couples(found: JointFoundation) -> Floats:
    """Of the lugs on the pin about their bands' middles, by forces along x, (T, B) N m."""
    bands = found.bands
    arm = bands.z - bands.middles[bands.band]
    each = found.loads.forces[:, :, 0] * arm + found.loads.moments[:, :, 1]
    return np.stack([each[:, bands.band == b].sum(axis=1) for b in range(len(found.lugs))], axis=1)


def odd() -> tuple[FoundationModel, PinLoads]:
    """Steps, a bore, fillets, a narrow ring, all kinds of tilt, weight, forces in two planes."""
    pin = Pin(
        "P",
        (
            Segment(0.004, D, 0.008),
            Segment(0.011, D, 0.008, connection="A"),
            Segment(0.003, 0.026, 0.008),
            Segment(0.030, 0.026, 0.01, connection="B"),
            Segment(0.0007, D, 0.01),
            Segment(0.015, D, 0.01, connection="C"),
        ),
        fillet=0.0005,
    )
    tilts = {"A": 2e4, "B": 0.0, "C": math.inf}
    lugs = [Lug(name, 0.06, STEEL, tilt=k) for name, k in tilts.items()]
    forces = np.array([[[-2e4, 1e4, 300.0], [5e4, 2e4, -800.0], [0.0, 0.0, 500.0]]])
    body = np.array([300.0, -9.81, 0.0])
    forces[0, 2, :2] = -forces[0, :2, :2].sum(axis=0) - 7850.0 * pin.volume * body[:2]
    return FoundationModel(pin, STEEL, lugs), PinLoads("P", ("A", "B", "C"), forces, body=body)


def test_equilibrium() -> None:
    """Rings have their link's force, the moment closes, and a lug that is free exerts no couple."""
    model, loads = odd()
    found = model.solve(loads)
    by_band = found.loads.forces.reshape(1, 3, 8, 3).sum(axis=2)
    assert by_band == pytest.approx(loads.forces, abs=1e-10 * 5e4)
    at = found.bending_moment(np.linspace(0.0, found.pin.length, 101))[0]
    assert np.abs(at[-1]).max() < 1e-10 * np.abs(at).max()
    assert abs(couples(found)[0, 1]) < 1e-10 * 5e4 * found.pin.length


def test_the_moment_does_not_depend_on_the_number_of_rings() -> None:
    """At the ends of bands, beyond which it is exact; what rings add is where in a band."""
    model, loads = odd()
    z = np.array([[b.z0, b.z1] for b in map(model.whole.band, "ABC")]).ravel()
    few, many = (
        FoundationModel(model.whole, STEEL, model.lugs, rings).solve(loads).bending_moment(z)
        for rings in (1, 20)
    )
    usual = model.solve(loads).bending_moment(z)
    assert few == pytest.approx(usual, abs=1e-10 * np.abs(usual).max())
    assert many == pytest.approx(usual, abs=1e-10 * np.abs(usual).max())


def test_planes_are_apart_and_instants_too() -> None:
    """A load turned by a quarter turns the line load; twice the load is twice of it."""
    model = FoundationModel(*_steel(clevis(20, 10, 1)))
    forces = np.concatenate([FORK, 2.0 * FORK, FORK[:, :, [1, 0, 2]]])
    first, twice, turned = model.solve(replace(PULL, forces=forces, body=np.zeros(3))).line_load
    assert twice == pytest.approx(2.0 * first, rel=1e-12)
    assert turned[:, ::-1] == pytest.approx(first, rel=1e-12)
    assert not first[:, 1].any()


def _steel(shape: tuple[Pin, list[Lug]]) -> tuple[Pin, Material, list[Lug]]:
    return shape[0], STEEL, shape[1]


def test_a_symmetric_joint_is_symmetric() -> None:
    found = FoundationModel(*_steel(clevis(20, 10, 1))).solve(PULL)
    load = found.line_load[0, :, 0]
    assert load == pytest.approx(load[::-1], rel=1e-9)
    z = np.linspace(0.0, found.pin.length, 41)
    moment = found.bending_moment(z)[0, :, 0]
    assert moment == pytest.approx(moment[::-1], abs=1e-9 * np.abs(moment).max())


@pytest.mark.parametrize("shear", [0.0, 1.0 / 8e8])
def test_a_long_beam_under_an_end_load(shear: float) -> None:
    """Hetenyi's semi-infinite beam, V = V0 exp(-a z) (cos bz - a / b sin bz), with a = b = lambda
    where no shear deforms, and a^2 - b^2 = k / (2 kappa G A), a^2 + b^2 = sqrt(k / (E I)).
    """
    k, bending = 1.8e11, 1.0 / 1649.0
    size, apart = math.sqrt(k * bending), k * shear / 2.0
    a, b = math.sqrt((size + apart) / 2.0), math.sqrt((size - apart) / 2.0)
    tiny = 1e-5 / a  # the lug that loads the end
    stations = np.r_[0.0, tiny + np.linspace(0.0, 30.0, 61) / a]
    pieces = len(stations) - 1
    lug = np.r_[0, np.ones(pieces - 1, dtype=np.int64)]
    beam = SupportedBeam(
        stations, np.full(pieces, bending), np.full(pieces, shear), np.full(pieces, k),
        np.zeros(pieces), lug,
    )  # fmt: skip
    middles = np.array([tiny / 2.0, (stations[1] + stations[-1]) / 2.0])
    found = respond(beam, middles, (0.0, math.inf)).force[:, 1]
    z = stations[1:] - tiny
    V = np.exp(-a * z) * (np.cos(b * z) - a / b * np.sin(b * z))
    assert found[0] == pytest.approx(-1.0, rel=1e-6)
    assert found[1:] == pytest.approx(V[:-1] - V[1:], abs=2e-5)


def test_long_pieces_are_cut() -> None:
    """1 / lambda at most, of which there are as many as needed."""
    wave = 4.0**0.25
    assert refined(np.array([0.0, 2.5, 3.0]), np.ones(2), np.array([4.0, 4.0])) == pytest.approx(
        [0.0, 2.5 / 3, 5.0 / 3, 2.5, 3.0]
    )
    assert refined(np.array([0.0, 50.0]), np.ones(1), np.zeros(1)) == pytest.approx([0.0, 50.0])
    assert len(refined(np.array([0.0, 3.5 * wave]), np.ones(1), np.ones(1))) == 5


def test_a_rigid_pin() -> None:
    """In two guided lugs: line loads are linear, with slopes that balance the forces' couple."""
    model = single(math.inf, math.inf, Material("rigid", 1e17, 0.3))
    found = model.solve(SHEAR)
    slope = FORCE * 1.5 * D / (2.0 * D**3 / 12.0)
    bands = found.bands
    arm = bands.z - bands.middles[bands.band]
    mean = np.array([-FORCE, FORCE])[bands.band] / D
    assert found.line_load[0, :, 0] == pytest.approx(mean - slope * arm, rel=1e-4)


def test_tilts_between_free_and_guided() -> None:
    """A stiff spring guides, a soft one leaves free, and one between is between."""
    loose, soft, some, stiff, guided = (
        couples(single(math.inf, tilt).solve(SHEAR))[0, 1]
        for tilt in (0.0, 1.0, 3e4, 1e12, math.inf)
    )
    assert abs(loose) < 1e-10 * FORCE * D
    assert soft == pytest.approx(0.0, abs=1e-3 * abs(guided))
    assert 0.1 < some / guided < 0.9
    assert stiff == pytest.approx(guided, rel=1e-6)


def test_the_beam_takes_the_loads() -> None:
    """solve_pin sees no imbalance, and its largest bending stress is that of the moment."""
    found = FoundationModel(*_steel(clevis(40, 20, 2))).solve(PULL)
    (solution,) = solve_pin(found.pin, STEEL, (), (found.loads,), Requirement(model="beam"))
    assert solution.peak.imbalance is None
    moment = largest_moment(found.bending_moment, found.pin)
    bending = 32.0 * moment / (math.pi * D**3)
    assert solution.peak.max_von_mises == pytest.approx(bending, rel=0.01)


def test_the_other_side_of_the_bore_carries_far_from_the_shear_plane() -> None:
    """As contact in three dimensions has it on the slender clevis: reversed at the outer ends."""
    load = FoundationModel(*_steel(clevis(40, 20, 2))).solve(PULL).line_load[0, :, 0]
    assert load[0] * FORK[0, 0, 0] < 0.0 < load[7] * FORK[0, 0, 0]


@pytest.mark.parametrize(
    ("lugs", "moment", "within"),
    [((20, 10, 1), 0.8418, 0.02), ((10, 5, 0.5), 0.9483, 0.035), ((40, 20, 2), 0.3845, 0.055)],
)
def test_clevises_against_contact_in_three_dimensions(
    lugs: tuple[float, float, float], moment: float, within: float
) -> None:
    """M / M0 at mid-span."""
    pin, eyes = clevis(*lugs)
    found = FoundationModel(pin, STEEL, eyes).solve(PULL)
    inner, outer, gap = lugs
    nominal = FORCE / 2.0 * (outer / 2.0 + gap + inner / 4.0) / 1e3
    ours = abs(found.bending_moment(np.array([pin.length / 2.0]))[0, 0, 0]) / nominal
    assert ours == pytest.approx(moment, abs=within)


def test_signs_are_those_of_contact() -> None:
    """Of moments and line loads, with weight, on a clevis."""
    pin, lugs = clevis(20, 10, 1)
    forces = FORK.copy()
    forces[0, :, 1] = 1e4 * np.array([1.0, -2.0, 1.0])
    forces[0, 1, 0] -= 7850.0 * pin.volume * 5e3
    loads = PinLoads("P", ("L", "M", "R"), forces, body=np.array([5e3, 0.0, 0.0]))
    truth = ContactModel(pin, STEEL, lugs).solve(loads)
    found = FoundationModel(pin, STEEL, lugs).solve(loads)
    z = np.linspace(0.0, pin.length, 41)
    moment = truth.bending_moment(z)
    assert found.bending_moment(z) == pytest.approx(moment, abs=0.06 * np.abs(moment).max())
    assert np.abs(moment[0, -1]).max() < 1e-6 * np.abs(moment).max()


def test_loads_that_are_refused() -> None:
    with pytest.raises(SolveError) as unbalanced:
        single(0.0, math.inf).solve(replace(SHEAR, forces=SHEAR.forces * [[[1.0], [0.8]]]))
    assert unbalanced.value.code == "not-in-equilibrium"
    with pytest.raises(SolveError) as turning:
        single(0.0, 0.0).solve(SHEAR)
    assert turning.value.code == "couple-not-reacted"


def test_free_lugs_whose_couples_balance() -> None:
    """Symmetric double shear needs no lug that reacts a couple."""
    pin, lugs = clevis(20, 10, 1)
    found = FoundationModel(pin, STEEL, [replace(lug, tilt=0.0) for lug in lugs]).solve(PULL)
    assert couples(found) == pytest.approx(np.zeros((1, 3)), abs=1e-9 * FORCE * D)


def test_lugs_that_do_not_fit() -> None:
    pin, lugs = clevis(20, 10, 1)
    with pytest.raises(ValueError, match="lug"):
        FoundationModel(pin, STEEL, lugs[:2])
    with pytest.raises(ValueError, match="wider"):
        moment_error(pin, STEEL, [*lugs[:2], replace(lugs[2], outer_diameter=D)])


def test_the_error_by_what_makes_it() -> None:
    pin, lugs = clevis(20, 10, 1)
    assert moment_error(pin, STEEL, lugs) == PLAIN_MOMENT_ERROR
    tube = Pin("T", tuple(replace(s, bore=0.5 * D) for s in pin.segments))
    assert moment_error(tube, STEEL, lugs) == PLAIN_MOMENT_ERROR + TUBE_ERROR
    long, eyes = clevis(40, 20, 2)
    assert moment_error(long, STEEL, eyes) == PLAIN_MOMENT_ERROR + LONG_LUG_ERROR
    two = single(math.inf, math.inf)
    assert moment_error(two.whole, STEEL, two.lugs) == PLAIN_MOMENT_ERROR + SINGLE_SHEAR_ERROR
    longest, wide = clevis(80, 20, 2)
    assert moment_error(longest, STEEL, wide) == math.inf
    assert moment_error(pin, STEEL, [*lugs[:2], replace(lugs[2], outer_diameter=5 * D)]) == math.inf


def _within(trial: JointTrial) -> bool:
    """Whether the largest moment of contact is within the stated error."""
    truth = ContactModel(trial.pin, trial.material, trial.lugs).solve(trial.loads)
    found = FoundationModel(trial.pin, trial.material, trial.lugs).solve(trial.loads)
    ratio = largest_moment(truth.bending_moment, trial.pin) / largest_moment(
        found.bending_moment, trial.pin
    )
    return abs(ratio - 1.0) <= moment_error(trial.pin, trial.material, trial.lugs) < math.inf


def test_contact_is_within_the_stated_error_of_three_pins() -> None:
    assert all(_within(trial) for trial in joint_trials(3, 4))


@pytest.mark.slow
@pytest.mark.parametrize("count", sampled([6, 20], every=2))
def test_contact_is_within_the_stated_error_of_most_pins(count: int) -> None:
    """19 in 20, on pins that had no part in any constant."""
    assert sum(_within(trial) for trial in joint_trials(count, 4)) >= math.floor(0.95 * count)


def test_a_foundation_is_softer_with_a_bore() -> None:
    lug = Lug("A", 2.5 * D, STEEL)
    solid, tube = (foundation_stiffness(Segment(D, D, bore), STEEL, lug) for bore in (0.0, 0.6 * D))
    assert tube < 0.8 * solid
