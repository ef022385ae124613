"""Relations between the reactions of a linkage and of the same one said, placed or driven
otherwise; all exact.
"""

from __future__ import annotations

import cmath
import math
import random

import numpy as np
import pytest

from tests.fuzz.linkage import Cases, compare, draw, moved, reactions
from tests.fuzz.quantity import Quantity, Tree, mapped
from tests.support.each import sampled

SEEDS = range(12)
seeds = pytest.mark.parametrize("seed", sampled(SEEDS, every=3))
EXPONENTS = {  # of length, force and time
    "length": (1, 0, 0), "force": (0, 1, 0), "moment": (1, 1, 0), "mass": (-1, 1, 2),
    "inertia": (1, 1, 2), "density": (-4, 1, 2), "time": (0, 0, 1), "acceleration": (1, 0, -2),
    "angle": (0, 0, 0), "angular velocity": (0, 0, -1), "angular acceleration": (0, 0, -2),
    "velocity": (1, 0, -1),
}  # fmt: skip


@seeds
def test_units_change_nothing(seed: int) -> None:
    before = reactions(draw(seed))
    compare(before, reactions(draw(seed) | {"units": "in-lbf-s"}))
    compare(before, reactions(draw(seed) | {"units": "mm-N-s"}, random.Random(seed)))


@seeds
def test_forces_scale_as_their_dimension(seed: int) -> None:
    """Larger, stronger and slower by any numbers."""
    by = (3.0, 0.7, 2.2)

    def scaled(q: Quantity) -> Quantity:
        return q * math.prod(b**e for b, e in zip(by, EXPONENTS[q.dimension], strict=True))

    tree = draw(seed)
    tree["mechanism"]["gravity"] = tree["mechanism"]["gravity"] or [
        Quantity(0.0, "acceleration"), Quantity(-9.80665, "acceleration")
    ]  # fmt: skip
    before = reactions(tree)
    drive = by[1] * (1.0 if "slider" in tree["mechanism"]["drive"] else by[0])
    wanted = {
        case: {c: v * (drive if c == "drive" else by[1]) for c, v in found.items()}
        for case, found in before.items()
    }
    compare(wanted, reactions(mapped(tree, scaled)))


@seeds
@pytest.mark.parametrize(("turn", "shift"), [(0.0, 3.0 - 2.0j), (math.pi / 2, 0j), (2.3, -1j)])
def test_reactions_turn_with_the_linkage(seed: int, turn: float, shift: complex) -> None:
    unit = cmath.rect(1.0, turn)
    matrix = np.array([[unit.real, -unit.imag], [unit.imag, unit.real]])
    before = reactions(draw(seed))
    wanted = {
        case: {c: v if c == "drive" else v @ matrix.T for c, v in found.items()}
        for case, found in before.items()
    }
    compare(wanted, reactions(moved(draw(seed), turn, shift)))


@seeds
def test_a_motion_may_be_driven_backwards(seed: int) -> None:
    """Without friction: speeds are of the other sign, accelerations and forces the same."""
    tree = draw(seed, friction=False)
    drive: Tree = tree["mechanism"]["drive"]
    if "table" in drive:
        rows = drive["table"].rows
        back = [b | {"time": a["time"]} for a, b in zip(rows, rows[::-1], strict=True)]
        turned = drive | {"table": type(drive["table"])("drive.csv", tuple(back))}
    else:
        turned = drive | {"start": drive["end"], "end": drive["start"]}
    before = reactions(tree)
    after = reactions(tree | {"mechanism": tree["mechanism"] | {"drive": turned}})
    wanted = {
        case: {c: v[::-1] if case == "motion" else v for c, v in found.items()}
        for case, found in before.items()
    }
    compare(wanted, after)


@seeds
def test_names_change_nothing(seed: int) -> None:
    """To the last digit."""
    tree = draw(seed)
    before, mechanism = reactions(tree), tree["mechanism"]
    renamed = {name: f"{'zyxw'[i % 4]} {name}" for i, name in enumerate(mechanism["body"])}
    for joint in mechanism["joint"].values():
        joint["connections"] = {c: renamed.get(b, b) for c, b in joint["connections"].items()}
        if "fixed_in" in joint:
            joint["fixed_in"] = renamed.get(joint["fixed_in"], joint["fixed_in"])
    mechanism["body"] = {renamed[name]: body for name, body in mechanism["body"].items()}
    if "body" in mechanism["drive"]:
        mechanism["drive"]["body"] = renamed["crank"]
    for guide in mechanism.get("slider", {}).values():
        guide["bodies"] = [renamed.get(b, b) for b in guide["bodies"]]
    for case in tree["case"].values():
        for load in case["apply"]:
            load["body"] = renamed[load["body"]]
    compare(before, reactions(tree), accuracy=0.0)


@seeds
def test_loads_on_a_linkage_at_rest_add_up(seed: int) -> None:
    """Those of each load, and of gravity, by themselves; at rest no friction acts."""
    tree = draw(seed, friction=False)
    start = tree["case"].popitem()[1].get("position")
    two = [
        {"body": "crank", "force": [Quantity(100.0, "force"), Quantity(-30.0, "force")]},
        {"body": list(tree["mechanism"]["body"])[1], "couple": Quantity(20.0, "moment")},
    ]
    still: Tree = {"kind": "static"} | ({} if start is None else {"position": start})
    nothing = [Quantity(0.0, "acceleration")] * 2
    heavy = [Quantity(1.0, "acceleration"), Quantity(-9.0, "acceleration")]

    def under(gravity: list[Quantity], *loads: Tree) -> Cases:
        mechanism = tree["mechanism"] | {"gravity": gravity}
        return reactions(tree | {"mechanism": mechanism, "case": {"rest": still | {
            "apply": list(loads)}}})  # fmt: skip

    parts = [under(heavy), under(nothing, two[0]), under(nothing, two[1])]
    whole = under(heavy, *two)
    sums = {c: np.sum([p["rest"][c] for p in parts], axis=0) for c in whole["rest"]}
    compare(whole, {"rest": sums})
