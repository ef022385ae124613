"""A cut pin under other loads: its solids are solved again only where the loads change them."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.cut.local_model import LocalModel
from fea.solve.solve import solve
from fea.support.support import PinProblem
from geometry import CutPin, Hole
from pinbase.memo import Memo
from tests.fea.cut.test_cut import MIDDLE, STEEL, d
from tests.support.each import each
from tests.support.pins.plain_pins import SHAFT

PIN = CutPin(SHAFT, (Hole(MIDDLE, d),))
TWO_MESHES = Requirement(0.01, meshes=2)


def bent(across: tuple[float, float], memo: Memo | None) -> Maximum:
    """The maximum in four-point bending by forces (x, y) in N."""
    signs = np.array([1.0, -1.0, -1.0, 1.0])
    loads = PinLoads("bending", SHAFT.connections, signs[None, :, None] * [*across, 0.0])
    (solution,) = solve(PinProblem(PIN, STEEL, (), (loads,), memo=memo), TWO_MESHES)
    return solution.peak


@each(
    ("then", "meshes"),
    [
        ((1500.0, 400.0), 0),
        ((3000.0, 800.0), 0),  # in proportion, else round-off may choose among equal places
        ((1500.0, -400.0), 1),  # the highest stress moves, about which the second mesh is fine
        ((1500.0, 0.0), 2),  # other unit loads
    ],
)
def test_other_loads_are_answered_as_if_solved_alone(
    then: tuple[float, float], meshes: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To the last bit, whatever was solved before."""
    made = []
    before = LocalModel.solve

    def counted(self: LocalModel, *args: object) -> object:
        made.append(self)
        return before(self, *args)  # type: ignore[arg-type]

    monkeypatch.setattr(LocalModel, "solve", counted)
    memo = Memo()
    bent((1500.0, 400.0), memo)
    first = len(made)
    found = bent(then, memo)
    assert (first, len(made) - first) == (2, meshes)
    alone = bent(then, None)
    assert (found.max_von_mises, found.error_estimate) == (
        alone.max_von_mises,
        alone.error_estimate,
    )
