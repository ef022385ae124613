"""In space the lengths of a pin place its bands, and so its links: designs of other lengths had the
forces of the first of them.
"""

from __future__ import annotations

import numpy as np
import pytest

from pinstress import load_study
from pinstress.explore.sweep.evaluate import Evaluator
from pinstress.explore.sweep.number import number_at
from pinstress.study.model.cases import CaseLoads, case_loads
from pinstress.study.model.mechanism.linkage import any_linkage
from tests.conftest import ROOT


def test_designs_of_other_lengths_have_forces_of_their_own() -> None:
    """Those of the changed study by itself; 1.5 times the first length of L moves them by 2.5 %,
    and the moments by 16 %.
    """
    study = load_study(ROOT / "studies" / "side_stay.toml")
    number = number_at(study, "pin.L.profile[1].length")
    evaluator = Evaluator(study, [number], ["L"], ["retract"])
    found: list[CaseLoads] = []
    for times in (1.0, 1.5):
        values = [times * number.nominal]
        changed = evaluator.changed(values)
        loads = evaluator.loads_of(changed, values)["retract"]
        assert isinstance(loads, CaseLoads)
        alone = case_loads(changed, "retract", any_linkage(changed))
        for ours, theirs in (
            (loads.reactions.forces, alone.reactions.forces),
            (loads.reactions.moments, alone.reactions.moments),
        ):
            assert ours == pytest.approx(theirs, rel=1e-9, abs=1e-9 * np.abs(theirs).max())
        found.append(loads)
    first, longer = (x.reactions.forces for x in found)
    assert np.abs(longer - first).max() > 0.02 * np.abs(first).max()
