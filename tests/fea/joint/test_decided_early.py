"""When meshes are enough: two only where the excluded distance leaves the maximum open anyway."""

from __future__ import annotations

import numpy as np
import pytest

from fea.asked import Asked, enough
from fea.core.material import Material
from fea.core.mesh_result import AtSingularity, MeshResult
from fea.core.pin_loads import PinLoads
from fea.joint.variations import Comparison
from fea.singular.singularities import Singularity
from fea.verdict import Seen, judge

STEEL = Material("steel", 210e9, 0.3, yield_strength=400e6)
ROUNDED = Singularity(
    0.01, 0.02, "rounded edge of a lug", ("lug A", "shaft"), 0.23, 0.0, 0.002, "round it more"
)
DECIDE = Asked(goal="decide", required=2.0)  # a limit of 200 MPa


def mesh(maximum: float, felt: float, interval: tuple[float, float] | None = None) -> MeshResult:
    """Stresses in MPa; felt: next to a rounded edge."""
    edge = AtSingularity(felt * 1e6, felt * 1e6, (0.0, 0.0, 0.0), bounded=True)
    ends = interval and (interval[0] * 1e6, interval[1] * 1e6)
    return MeshResult(1000, maximum * 1e6, 0, (0.0, 0.0, 0.0), (edge,), interval=ends)


def seen(*results: MeshResult) -> Seen:
    return Seen("P", "c", "harmonic", results, (0.1,) * len(results), 2.0**0.5)


@pytest.mark.parametrize(
    ("felt", "maximum", "done"),
    [
        (150.0, 100.0, True),  # far below the limit
        (500.0, 300.0, True),  # far above
        (90.0, 100.0, False),  # a third mesh makes it converge
        (250.0, 180.0, False),  # the limit is within what is uncertain
        (250.0, 168.0, False),  # not by the margin: up to 197 MPa
    ],
)
def test_two_meshes_decide(felt: float, maximum: float, done: bool) -> None:
    ends = None if felt < maximum else (0.9 * maximum, 1.15 * maximum)
    first, second = mesh(maximum, felt, ends), mesh(1.002 * maximum, felt, ends)
    assert enough(DECIDE, STEEL, seen(first, second)) is done
    assert not enough(DECIDE, STEEL, seen(first))
    assert not enough(Asked(), STEEL, seen(first, second))


def test_ends_that_change_from_mesh_to_mesh_widen_the_interval() -> None:
    before, last = mesh(100.0, 150.0, (92.0, 130.0)), mesh(100.0, 150.0, (94.0, 120.0))
    steady, moved = seen(last, last), seen(before, last)
    assert moved.relative == steady.relative
    ratio = 1.0 + moved.relative
    assert steady.range[1] == pytest.approx(120e6 * ratio)
    assert moved.range[1] == pytest.approx(130e6 * ratio)
    assert moved.range[0] == pytest.approx(92e6 * (1.0 - moved.relative))
    # the maximum was not governed by what is excluded before: nothing to compare with
    assert seen(mesh(100.0, 90.0), last).range == pytest.approx(steady.range)


@pytest.mark.parametrize(
    ("cells", "ends", "fine"),
    [
        (0.005, (180.0, 230.0), True),  # little of the tolerance
        (0.05, (180.0, 230.0), True),  # open whatever cells do, and less than half as uncertain
        (0.08, (180.0, 230.0), False),
        (0.05, (195.0, 205.0), False),  # finer cells may decide
        (0.05, (230.0, 260.0), True),  # decided
        (0.05, (180.0, 200.0), False),
    ],
)
def test_cells_are_fine_enough_where_what_is_excluded_leaves_a_decision_open(
    cells: float, ends: tuple[float, float], fine: bool
) -> None:
    low, high = (1e6 * x for x in ends)
    links = PinLoads("c", ("A",), np.zeros((1, 1, 3)))
    found = Comparison((low + high) / 2.0, (low, high), cells, links, ())
    assert found.fine(STEEL, DECIDE) is fine


def test_two_meshes_say_that_they_are_only_two() -> None:
    last = mesh(100.0, 150.0, (94.0, 120.0))
    peak = judge(seen(last, last), (ROUNDED,), 0.02)
    assert peak.verdict == "unconverged"
    assert "too-few-meshes" in peak.reasons
    assert "from two meshes only" in peak.note
