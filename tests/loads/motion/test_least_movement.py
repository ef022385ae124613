"""The least movement of joints by which redundant links close, against closed forms."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import pytest

from loads import GROUND, Body, Connection, Joint, Linkage, Slider, Turn
from loads.motion.complex_points import number
from loads.motion.least_movement import least_movement
from loads.motion.mobility import mobility
from loads.motion.planar_equations import PlanarEquations
from loads.motion.positions import Path

Point = tuple[float, float]
Places = Mapping[str, Point]
CRANKS = ("AD", "BE", "CF")


def joint(at: Places, name: str, body: str, carrier: str) -> Joint:
    return Joint(name, at[name], (Connection(f"{name}1", body),), carrier)


def three_cranks(at: Places) -> Linkage:
    """Cranks AD, BE and CF on the ground carry one coupler; the first is driven."""
    joints = [joint(at, crank[0], crank, GROUND) for crank in CRANKS]
    joints += [joint(at, crank[1], crank, "coupler") for crank in CRANKS]
    bodies = [Body(name, 1.0, (0.0, 0.0), 0.0) for name in (*CRANKS, "coupler")]
    drawn = float(np.angle(number(at["D"]) - number(at["A"])))
    turn = Turn("motor", "AD", drawn)
    return Linkage(tuple(bodies), tuple(joints), ("motor",), turns=(turn,))


def trammel(at: Places) -> Linkage:
    """A bar AB whose ends slide along x and y; a crank from O joins it at M."""
    joints = (
        joint(at, "A", "bar", "block x"),
        joint(at, "B", "bar", "block y"),
        joint(at, "M", "bar", "crank"),
        joint(at, "O", "crank", GROUND),
    )
    names = ("bar", "crank", "block x", "block y")
    bodies = tuple(Body(name, 1.0, (0.0, 0.0), 0.0) for name in names)
    (ax, ay), (bx, by) = at["A"], at["B"]
    sliders = (
        Slider("x", GROUND, "block x", (ax - 1.0, ay), (ax, ay), (1.0, 0.0)),
        Slider("y", GROUND, "block y", (bx, by - 1.0), (bx, by), (0.0, 1.0)),
    )
    return Linkage(bodies, joints, ("x",), sliders=sliders)


def require_motion(
    draw: Callable[[Places], Linkage], at: Places, moves: Places, reach: tuple[float, float]
) -> None:
    """The moved linkage has one degree of freedom and follows its drive to both ends."""
    moved = draw({k: (x + moves[k][0], y + moves[k][1]) for k, (x, y) in at.items()})
    assert mobility(moved).degrees == 1
    drawn = moved.drives[0].drawn
    for end in reach:
        way = Path(
            PlanarEquations(moved),
            lambda t, end=end: (drawn + t * (end - drawn))[:, None],  # type: ignore[misc]
            np.linspace(0.0, 1.0, 20),
        )
        assert np.isfinite(way.at(np.array([1.0]))).all()


def moved_cranks(at: Places) -> dict[str, Point]:
    """The movements that make three cranks equal: to their mean, by half at either end.

    Cranks and coupler close in motion if and only if the cranks are equal and parallel, and
    sum |mean - crank|^2 / 2 is least for the mean.
    """
    vectors = {crank: number(at[crank[1]]) - number(at[crank[0]]) for crank in CRANKS}
    mean = sum(vectors.values()) / 3.0
    out: dict[str, Point] = {}
    for crank, vector in vectors.items():
        half = 0.5 * (mean - vector)
        out[crank[0]], out[crank[1]] = (-half.real, -half.imag), (half.real, half.imag)
    return out


@pytest.mark.parametrize("seed", range(3))
def test_three_cranks_move_to_their_mean(seed: int) -> None:
    """Ends of cranks of 220 mm off by a millimetre at random, pivots not in line."""
    random = np.random.default_rng(seed)
    exact = {"A": (0.0, 0.0), "B": (0.3, 0.1), "C": (0.6, 0.0)}
    exact |= {"D": (0.1, 0.2), "E": (0.4, 0.3), "F": (0.7, 0.2)}
    at = {k: (x + random.normal(0.0, 1e-3), y + random.normal(0.0, 1e-3))
          for k, (x, y) in exact.items()}  # fmt: skip
    reach = (np.radians(30.0), np.radians(120.0))
    found = least_movement(three_cranks, at, (np.array([reach[0]]), np.array([reach[1]])))
    assert found is not None
    assert found.gap > 1e-4
    expected = moved_cranks(at)
    for name, move in expected.items():
        assert found.moves[name] == pytest.approx(move, abs=1e-10)
    assert found.largest == pytest.approx(max(np.hypot(*m) for m in expected.values()), rel=1e-6)
    require_motion(three_cranks, at, found.moves, reach)


def test_a_trammel_and_its_crank_move_to_the_nearest_exact_one() -> None:
    """M is midway between A and B, and O where their ways cross: linear conditions, whose nearest
    solution is the projection.
    """
    at = {"A": (0.3, 0.001), "B": (0.0012, 0.25), "M": (0.1515, 0.1245), "O": (0.0, -0.0004)}
    reach = np.array([0.95]), np.array([1.02])  # the slider is 1 m long as drawn
    found = least_movement(trammel, at, reach)
    assert found is not None
    conditions = np.array([
        [1, 0, 1, 0, -2, 0, 0, 0],
        [0, 1, 0, 1, 0, -2, 0, 0],
        [0, 0, 1, 0, 0, 0, -1, 0],
        [0, 1, 0, 0, 0, 0, 0, -1],
    ])  # fmt: skip
    drawn = np.array(list(at.values())).ravel()
    nearest = -np.linalg.pinv(conditions) @ (conditions @ drawn)
    assert np.array(list(found.moves.values())).ravel() == pytest.approx(nearest, abs=1e-8)
    require_motion(trammel, at, found.moves, (0.95, 1.02))


IN_LINE: Places = {
    **{"A": (0.0, 0.0), "B": (0.3, 0.0), "C": (0.6015, 0.0)},
    **{"D": (0.0, 0.2), "E": (0.3, 0.2), "F": (0.6, 0.2)},
}


def test_pivots_in_line_close_in_motion_too() -> None:
    """There, cranks that differ by +a, 0 and -a close to first order in a, so that movements are
    between half of and all that makes the cranks equal, and no longer in sum.
    """
    reach = (np.radians(60.0), np.radians(90.0))
    found = least_movement(three_cranks, IN_LINE, (np.array([reach[0]]), np.array([reach[1]])))
    assert found is not None
    assert found.members == ("E1", "F1")
    assert 0.25e-3 < found.largest < 0.5e-3
    equal = sum(np.square(move).sum() for move in moved_cranks(IN_LINE).values())
    assert sum(np.square(move).sum() for move in found.moves.values()) < equal
    require_motion(three_cranks, IN_LINE, found.moves, reach)


def test_what_closes_does_not_move() -> None:
    exact = {**IN_LINE, "C": (0.6, 0.0)}
    found = least_movement(three_cranks, exact, (np.array([1.0]), np.array([2.0])))
    assert found is not None
    assert found.largest == 0.0
    assert found.gap < 1e-12
