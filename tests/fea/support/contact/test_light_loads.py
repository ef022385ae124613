"""Light loads find their contact in loose lugs, where hardly more cells touch than hold the pin."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np
import pytest

from fea.core.linear_solver import SolveError
from fea.core.pin_loads import Floats
from fea.support.contact.contact import ContactProblem
from fea.support.contact.contact_state import ContactState, rotation
from fea.support.contact.least_energy import least_energy_cells
from pinbase.arrays import Mask
from tests.fea.support.contact.test_contact import resultants, small_and_loose

GUIDED, ELASTIC = (math.inf, math.inf), (2e6, 2e6)


def edged(
    sectors: int, rings: int, gap: float, rounding: float, tilt: tuple[float, float]
) -> ContactProblem:
    """Two loose lugs of other tilt stiffness whose rims are further away by their rounding, m."""
    x = (np.arange(rings) + 0.5) / rings
    rim = rounding * (np.maximum(0.0, np.abs(x - 0.5) - 0.35) / 0.15) ** 2
    return small_and_loose(sectors, rings).changed(gap + np.tile(rim, 2), tilt)


def assert_contact(
    contact: ContactProblem,
    state: ContactState,
    forces: Floats,
    couple: tuple[float, float] = (0.0, 0.0),
) -> None:
    """Check all conditions of contact, the gaps computed again from the forces and motions."""
    force = state.pressure.ravel() * contact.area
    motion, *_ = np.linalg.lstsq(
        contact._motions[state.active.ravel()],
        -(contact._open + contact._compliance @ force)[state.active.ravel()],
    )
    size = np.abs(contact._open).max() + np.abs(contact._compliance @ force).max()
    again = contact._open + contact._compliance @ force + contact._motions @ motion
    assert force.min() >= 0.0
    assert np.abs(again[force > 0.0]).max() < 1e-9 * size
    assert state.gap.min() >= 0.0
    if np.linalg.matrix_rank(contact._motions[force > 0.0]) == contact._motions.shape[1]:
        assert again.min() > -1e-9 * size  # (otherwise motions are not unique)
    ring, rings = resultants(contact, state), len(contact.bands.z) // 2
    load = np.abs(forces).max()
    assert np.add.reduceat(ring, [0, rings]) == pytest.approx(forces, abs=1e-9 * load)
    z = contact.bands.z
    x, y = (z - 0.5 * (z.min() + z.max())) @ ring
    assert (x + couple[1], couple[0] - y) == pytest.approx((0.0, 0.0), abs=1e-9 * load)


CIRCLES = {
    "tilting": (edged(24, 6, 99.7e-6, 6.4e-6, ELASTIC), [[64.735, 0.0], [-64.808, 0.104]]),
    "guided": (edged(24, 6, 35.5e-6, 83.8e-6, GUIDED), [[676.33, 0.0], [-675.62, -0.1724]]),
    "fine": (edged(48, 12, 35.7e-6, 0.39e-3, GUIDED), [[163.8441, 0.0], [-163.8438, 5.43e-5]]),
}


@pytest.mark.parametrize("name", CIRCLES)
def test_active_sets_that_run_in_circles(name: str) -> None:
    """Pins whose own weight is part of the load: the active set alone does not find their contact,
    from no larger load either.
    """
    contact, forces = CIRCLES[name]
    at = np.array(forces)
    assert contact._settled(contact.required_resultants(at), contact.first_cells(at)) is None
    assert_contact(contact, contact.solve(at), at)


def test_random_light_loads_find_their_contact() -> None:
    """Between 0.1 N and 100 kN, out of balance by up to a third or by next to nothing, also with
    couples, in lugs loose by 10 to 200 um.
    """
    random = np.random.default_rng(7)
    for _ in range(40):
        tilt = (GUIDED, ELASTIC, (math.inf, 2e6))[random.integers(3)]
        gap, rounding = 10.0 ** random.uniform((-5.3, -6.0), (-4.0, -3.3))
        contact = edged(*((24, 6), (32, 8))[random.integers(2)], gap, rounding, tilt)
        load = 10.0 ** random.uniform(-1.0, 5.0)
        forces = load * np.array([[1.0, 0.0], [-1.0, 0.0]])
        forces[1] += load * 10.0 ** random.uniform(-6.0, -0.5) * random.normal(size=2)
        forces = forces @ rotation(random.choice([0.0, random.uniform(0.0, 6.0)]))
        arm = random.choice([0.0, 1e-2]) * 10.0 ** random.uniform(-6.0, 0.0)
        mx, my = load * arm * random.normal(size=2)
        state = contact.solve(forces, (mx, my))
        assert_contact(contact, state, forces, (mx, my))


def test_a_first_guess_that_holds_a_lug_by_one_cell() -> None:
    """Whose force no other cell takes, beside a lug that tilts easily: such a set of cells settles
    out of balance, and must not be taken for a couple that no lug reacts.
    """
    random = np.random.default_rng(5)
    contact = edged(24, 6, 50e-6, 20e-6, (math.inf, 2.0))
    forces = np.array([[1e3, 0.0], [-1e3, 0.0]])
    alone = 0
    for _ in range(40):
        start = np.zeros((12, 24), dtype=bool)
        start[6:] = random.random((6, 24)) < random.choice([0.02, 0.5])
        start[random.integers(6), random.integers(24)] = True
        settled = contact._settled(contact.required_resultants(forces), start.ravel().copy())
        alone += settled is None
        assert_contact(contact, contact.solve(forces, start=start), forces)
    assert alone  # some of them do not settle by themselves


def test_a_line_of_cells_moves_along_its_lug_until_its_neighbours_touch() -> None:
    """A loose middle lug whose force points beside the only line of cells in contact, which cannot
    react the part across it: four steps, from whichever side, where the active set ran in circles.
    """
    contact = small_and_loose(24, 6, 3)
    line = np.zeros((18, 24), dtype=bool)
    line[:6, 7:18] = line[12:, 7:18] = line[6:12, 0] = True
    guess = np.zeros(line.size, dtype=bool)
    for gap, load, side in itertools.product((5e-6, 1e-4), (10.0, 1e3), (0.002, -0.01)):
        loose = contact.changed(np.repeat([0.0, gap, 0.0], 6), (math.inf,) * 3)
        forces = load * np.outer([0.5, -1.0, 0.5], [1.0, side])
        required = loose.required_resultants(forces)
        state, least = loose._settled(required, line.ravel()), loose._by_energy(required, guess)
        assert state is not None
        assert least is not None
        assert state.steps == 4
        assert list(np.flatnonzero(state.active[6:12].any(axis=0))) == [0, 1 if side > 0 else 23]
        assert state.pressure == pytest.approx(least.pressure, abs=1e-9 * state.pressure.max())


def test_loose_forks_settle_without_a_descent(monkeypatch: pytest.MonkeyPatch) -> None:
    """Random forks in which some lugs are loose, under loads out of line, each followed by a turned
    and smaller one: of 600 solutions 267 had taken a descent, and take 11 now.
    """
    descents = []

    def by_energy(self: ContactProblem, required: Floats, first: Mask) -> ContactState | None:
        descents.append(required)
        return descend(self, required, first)

    descend = ContactProblem._by_energy
    monkeypatch.setattr(ContactProblem, "_by_energy", by_energy)
    random = np.random.default_rng(5)
    for _ in range(40):
        contact = small_and_loose(24, 6, 3)
        gaps = random.choice([0.0, 1.0], 3) * 10.0 ** random.uniform(-6.0, -4.0, 3)
        tilt = random.choice([math.inf, 2e6], 3).tolist()
        contact = contact.changed(np.repeat(gaps, 6), tilt)
        left, load = 0.5 + 0.1 * random.uniform(-1.0, 1.0), 10.0 ** random.uniform(0.0, 5.0)
        forces = load * np.array([[left, 0.0], [-1.0, 0.0], [1.0 - left, 0.0]])
        forces += load * 10.0 ** random.uniform(-6.0, -1.0) * random.normal(size=(3, 2))
        state = contact.solve(forces)
        contact.solve(0.7 * forces @ rotation(0.1), start=state.active)
    assert len(descents) <= 4  # of 80


@pytest.mark.parametrize("load", [1.0, 1e3])
def test_a_couple_that_no_lug_reacts_is_told(load: float) -> None:
    """Of lugs free to tilt in single shear; the descent is asked, too, since it may be the one to
    find out.
    """
    contact = edged(24, 6, 50e-6, 20e-6, (0.0, 0.0))
    forces = load * np.array([[1.0, 0.0], [-1.0, 0.0]])
    with pytest.raises(SolveError, match="no lug reacts"):
        contact.solve(forces)
    required = contact.required_resultants(forces)
    with pytest.raises(SolveError, match="no lug reacts"):
        contact._by_energy(required, np.zeros(len(contact.area), dtype=bool))


@pytest.mark.parametrize("rings", [6, 12])
def test_three_free_lugs_bear_only_what_has_no_couple(rings: int) -> None:
    """By statics: forces at equal distances balance where the outer ones are equal. SciPy's
    nonnegative least squares says so of others, too (scipy/scipy#25389), and the descent had no end
    then: `pinstress size` ran for hours.
    """
    contact = small_and_loose(4 * rings, rings, 3)
    contact = contact.changed(contact.bands.gap, (0.0, 0.0, 0.0))
    nothing = np.zeros(len(contact.area), dtype=bool)
    for left, load in itertools.product((1e-4, 1e-3, 0.01, 0.3, 0.5), (1.0, 1e3, -1e3, -1e6)):
        required = contact.required_resultants(
            load * np.array([[left, 0.0], [-1.0, 0.0], [1.0 - left, 0.0]])
        )
        if left == 0.5:
            state = contact._by_energy(required, nothing)
            assert state is not None
            assert state.pressure.min() >= 0.0
        else:
            with pytest.raises(SolveError, match="no lug reacts"):
                contact._by_energy(required, nothing)


def test_a_descent_that_round_off_keeps_from_ending_is_told() -> None:
    """Minima of cells that always find another one to close."""

    def least(active: Mask) -> tuple[Floats, Callable[[], Floats]]:
        gaps = np.where(active, 0.0, -random.uniform(size=20))
        return np.where(active, 1.0, 0.0), lambda: gaps

    def another(gap: Floats, overlaps: Mask, active: Mask) -> Mask:
        active[:] = random.uniform(size=20) < 0.5
        return overlaps & (random.uniform(size=20) < 0.5)

    random = np.random.default_rng(2)
    with pytest.raises(SolveError, match="does not settle"):
        least_energy_cells(np.zeros(20), least, lambda _: 0.0, another)


def test_least_energy_is_that_of_nonnegative_least_squares() -> None:
    """|A x - b| over x >= 0 against SciPy, from zero and from a start."""
    from scipy.optimize import nnls

    random = np.random.default_rng(3)
    for _ in range(20):
        A, b = random.normal(size=(30, 25)), random.normal(size=30)

        def least(
            active: Mask, A: Floats = A, b: Floats = b
        ) -> tuple[Floats, Callable[[], Floats]]:
            x = np.zeros(A.shape[1])
            x[active] = np.linalg.lstsq(A[:, active], b)[0]
            return x, lambda: np.where(active, 0.0, A.T @ (A @ x - b))

        def energy(x: Floats, A: Floats = A, b: Floats = b) -> float:
            return 0.5 * float(np.sum((A @ x - b) ** 2))

        def chosen(_: Floats, overlaps: Mask, __: Mask) -> Mask:
            return overlaps

        exact, _ = nnls(A, b)
        for start in (np.zeros(25), random.uniform(size=25)):
            active, force = least_energy_cells(start, least, energy, chosen)
            assert force == pytest.approx(exact, abs=1e-10)
            assert (active == (exact > 0.0)).all()
