"""Relations between the reactions of a linkage in space and of the same one said or placed
otherwise; all exact.
"""

from __future__ import annotations

import math
import random
import tempfile
from pathlib import Path

import numpy as np
import pytest

import pinstress
from pinbase.arrays import Floats
from pinstress.analysis.gather.gather import loads_only
from tests.fuzz import draw_space
from tests.fuzz.quantity import Quantity, Tree, mapped, write
from tests.support.each import sampled

Wrenches = dict[tuple[str, str], Floats]
seeds = pytest.mark.parametrize("seed", sampled(range(12), every=4))
ACCURACY = 1e-8  # of the largest force or moment: those of a few Newton steps
VECTORS = ("at", "centre", "gravity", "force", "axis", "second_axis", "pin_axis", "depth_along")


def draw(seed: int) -> Tree:
    """A study of a linkage in space alone."""
    drawn = draw_space.spatial(random.Random(f"space {seed}"))
    return {"title": "A linkage in space", "units": "m-N-s", "mechanism": drawn.mechanism,
            "case": drawn.cases}  # fmt: skip


def wrenches(tree: Tree, spelling: random.Random | None = None) -> Wrenches:
    """Force (N) and moment (N m) on the pin in world axes, (T, 6), by case and connection."""
    with tempfile.TemporaryDirectory() as folder:
        study = pinstress.load_study(write(tree, Path(folder), spelling))
        results = loads_only(study)
    newton, moment = study.system.factor("force"), study.system.factor("moment")
    return {
        (case.case, c): np.hstack([case.forces[:, k] * newton, case.moments[:, k] * moment])
        for case in results.reactions
        for k, c in enumerate(case.connections)
    }


def compare(one: Wrenches, other: Wrenches) -> None:
    """The same, as parts of the largest component of each kind."""
    assert one.keys() == other.keys()
    for part in (slice(0, 3), slice(3, 6)):
        size = max(np.abs(v[:, part]).max() for v in one.values())
        for key, wanted in one.items():
            assert np.abs(other[key][:, part] - wanted[:, part]).max() <= ACCURACY * size, key


@seeds
def test_units_change_nothing(seed: int) -> None:
    before = wrenches(draw(seed))
    compare(before, wrenches(draw(seed) | {"units": "in-lbf-s"}))
    compare(before, wrenches(draw(seed), random.Random(seed)))


@seeds
def test_reactions_turn_with_the_linkage(seed: int) -> None:
    """Turned about any axis and moved; gravity and loads turn with it."""
    rng = np.random.default_rng(seed)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    shift = rng.normal(size=3)

    def moved(node: object, key: str = "") -> object:
        if isinstance(node, dict):
            return {k: moved(v, k) for k, v in node.items()}
        if not isinstance(node, list):
            return node
        if key not in VECTORS:
            return [moved(v) for v in node]
        numbers = [q.value if isinstance(q, Quantity) else q for q in node]
        turned = turn @ numbers + (shift if key in ("at", "centre") else 0.0)
        if not isinstance(node[0], Quantity):
            return [float(x) for x in turned]
        return [Quantity(float(x), node[0].dimension) for x in turned]

    tree = draw(seed)
    down = [Quantity(x, "acceleration") for x in (0.0, 0.0, -9.80665)]
    tree["mechanism"].setdefault("gravity", down)
    wanted = {
        key: np.hstack([v[:, :3] @ turn.T, v[:, 3:] @ turn.T]) for key, v in wrenches(tree).items()
    }
    after = tree | {k: moved(tree[k]) for k in ("mechanism", "case")}
    compare(wanted, wrenches(after))


@seeds
def test_reactions_scale_as_their_dimension(seed: int) -> None:
    """Larger, stronger and slower by any numbers."""
    by = {"length": (1, 0, 0), "force": (0, 1, 0), "mass": (-1, 1, 2), "inertia": (1, 1, 2),
          "density": (-4, 1, 2), "time": (0, 0, 1), "acceleration": (1, 0, -2),
          "angle": (0, 0, 0), "torsional stiffness": (1, 1, 0)}  # fmt: skip
    factors = (3.0, 0.7, 2.2)

    def scaled(q: Quantity) -> Quantity:
        return q * math.prod(b**e for b, e in zip(factors, by[q.dimension], strict=True))

    tree = draw(seed)
    down = [Quantity(x, "acceleration") for x in (0.0, 0.0, -9.80665)]
    tree["mechanism"].setdefault("gravity", down)
    size = np.array([0.7] * 3 + [2.1] * 3)
    wanted = {key: v * size for key, v in wrenches(tree).items()}
    compare(wanted, wrenches(mapped(tree, scaled)))


@seeds
def test_names_and_the_order_of_tables_change_nothing(seed: int) -> None:
    tree = draw(seed)
    mechanism = tree["mechanism"]
    turned = {
        k: dict(reversed(v.items())) if k in ("joint", "body") else v for k, v in mechanism.items()
    }
    before = wrenches(tree)
    compare(before, wrenches(tree | {"mechanism": turned}))
    drives = mechanism["drive"]
    if isinstance(drives, list):
        compare(before, wrenches(tree | {"mechanism": mechanism | {"drive": drives[::-1]}}))
