"""A joint that was solved before, with something changed: what depends on it is solved again."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.solve.solve import solve_in_lugs
from fea.support.contact import variations
from fea.support.contact.resolution import RESOLUTIONS, Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Lug
from fea.support.support import PinProblem
from geometry import Pin, Segment
from pinbase.memo import Memo

STEEL = Material("steel", 210e9, 0.3, yield_strength=500e6)
PIN = Pin(
    "P",
    (
        Segment(0.002, 0.02),
        Segment(0.020, 0.02, connection="A"),
        Segment(0.001, 0.02),
        Segment(0.010, 0.02, connection="B"),
        Segment(0.002, 0.02),
    ),
)
LUGS = tuple(Lug(name, 0.05, STEEL) for name in ("A", "B"))
THICKER = replace(PIN, segments=(replace(PIN.segments[0], diameter=0.022), *PIN.segments[1:]))
ROUGH = Resolution(4, 12, 4, 6.0)


def arrays(model: ContactModel) -> list[np.ndarray]:
    return [model.of_pin, model.of_lugs, model.wavy]


@pytest.mark.parametrize(
    ("pin", "material", "lugs", "made"),
    [
        (PIN, replace(STEEL, name="other", yield_strength=400e6), LUGS, 0),
        (PIN, STEEL, tuple(replace(x, clearance=1e-5, tilt=0.0) for x in LUGS), 0),
        (THICKER, STEEL, LUGS, 1),  # the pin
        (PIN, STEEL, (LUGS[0], replace(LUGS[1], outer_diameter=0.06)), 1),
        (PIN, STEEL, (LUGS[0], replace(LUGS[1], material=replace(STEEL, poisson_ratio=0.2))), 1),
        (PIN, replace(STEEL, youngs_modulus=200e9), LUGS, 3),
    ],
)
def test_only_flexibilities_that_change_are_found_again(
    pin: Pin, material: Material, lugs: tuple[Lug, ...], made: int
) -> None:
    memo = Memo()
    ContactModel(PIN, STEEL, LUGS, ROUGH, memo)
    before = memo.made
    ours = ContactModel(pin, material, lugs, ROUGH, memo)
    assert memo.made - before == made
    for one, other in zip(
        arrays(ours), arrays(ContactModel(pin, material, lugs, ROUGH)), strict=True
    ):
        assert np.array_equal(one, other)


def pull(force: float) -> PinLoads:
    return PinLoads("pull", ("A", "B"), np.array([[[force, 1e3, 0.0], [-force, -1e3, 0.0]]]))


@pytest.mark.slow
def test_a_joint_is_varied_on_its_last_cells_only(monkeypatch: pytest.MonkeyPatch) -> None:
    """The range over the joint decides nothing about the cells."""
    varied, over_joint = [], variations._over_joint

    def counted(model: ContactModel, *rest: Any) -> Any:
        varied.append(model.cells)
        return over_joint(model, *rest)

    monkeypatch.setattr(variations, "_over_joint", counted)
    problem = PinProblem(PIN, STEEL, LUGS, (pull(20e3),))
    (found,) = solve_in_lugs(problem, Requirement(0.02))
    assert found.joint is not None
    assert found.joint.range is not None
    assert found.joint.range.variations
    assert varied == [RESOLUTIONS[1]]


@pytest.mark.slow
def test_the_order_of_problems_changes_no_bit() -> None:
    """Nor does a memo that forgets everything at once."""
    requirement = Requirement(0.2, cells="rough")
    loose = tuple(replace(lug, clearance=2e-5) for lug in LUGS)
    problems = [
        PinProblem(PIN, STEEL, LUGS, (pull(20e3),)),
        PinProblem(PIN, STEEL, LUGS, (pull(4e3),)),
        PinProblem(PIN, STEEL, loose, (pull(20e3),)),
        PinProblem(THICKER, STEEL, LUGS, (pull(20e3),)),
    ]

    def maxima(memo: Memo | None, order: int) -> list[tuple[float | None, ...]]:
        out = []
        for problem in problems[::order]:
            (found,) = solve_in_lugs(replace(problem, memo=memo), requirement)
            assert found.joint is not None
            assert found.joint.range is not None
            over = (x.max_von_mises for x in found.joint.range.variations)
            out.append((found.peak.max_von_mises, found.peak.error_estimate, *over))
        return out[::order]

    fresh = maxima(None, 1)
    assert len(set(fresh)) == len(problems)
    assert maxima(Memo(), 1) == fresh
    assert maxima(Memo(), -1) == fresh
    assert maxima(Memo(1), 1) == fresh
