"""Quick rows that a section governs as described, and the surface in another joint."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fea.core.places import Place, Places
from fea.core.requirement import Requirement
from fea.support.records import FRICTION, JointRange, Variation
from pinstress import study_from
from pinstress.analysis.plan import prepare
from pinstress.analysis.scaled import scaled_row
from reports.data.row import PinResult
from tests.pinstress.analysis.test_scaled import STUDY
from tests.places.test_outcomes_beneath import SECTION, SURFACE, contact
from tests.support.results.judged_results import row
from tests.support.results.made_up_joint import make_joint
from tests.support.results.rows import with_values

GUIDED, RUBBED = Variation("tilt", "guided", 62000.0), Variation(FRICTION, "0.1", 60000.0)


def _governed_by(governs: Place) -> PinResult:
    """A row of 59,000 psi of one place, with 50,000 at the other; errors of 2,500 at the surface
    and of 295 in the section.
    """
    section, surface = (59000.0, 50000.0) if governs == "section" else (50000.0, 59000.0)
    places = Places(
        governs,
        replace(SURFACE, max_von_mises=surface, error_estimate=2500.0),
        replace(SECTION, max_von_mises=section, error_estimate=295.0),
        contact(40000.0),
    )
    over = JointRange((59000.0, 62000.0), (GUIDED, RUBBED))
    joint = replace(make_joint(), range=over)
    return with_values(row("x", "converged", 2.0, True), places=places, joint=joint)


@pytest.mark.parametrize(("governs", "most"), [("section", 62000.0 * 1.05), ("surface", 62000.0)])
def test_a_surface_that_takes_over_has_its_own_error(governs: Place, most: float) -> None:
    """62,000 psi with guided lugs, at the surface: up to 65,100 with its error of 2,500 in 50,000,
    where the section as described has one of 0.5 %. If the surface governs, the row has its error.
    Friction is a ratio of two stresses and has none: it multiplies by 60 / 59.
    """
    (task,) = prepare(study_from(STUDY)).tasks
    made = _governed_by(governs)
    scaled = scaled_row(made, made, made, task, Requirement())
    assert scaled is not None
    assert scaled.joint is not None
    assert scaled.joint.range is not None
    guided, rubbed = scaled.joint.range.variations
    assert (guided.interval or (0.0, guided.max_von_mises))[1] == pytest.approx(most)
    assert rubbed.interval is None
    assert scaled.joint.range.max_von_mises[1] == pytest.approx(most * 60.0 / 59.0)
