"""A pin that is safe with links alike, and fails with another stiffness of them, is not safe."""

from __future__ import annotations

from dataclasses import replace

import pytest

from reports.data.dependence import depends_on
from reports.data.row import PinResult, SharingRange
from reports.data.unknowns import factor_spread
from tests.places.test_outcomes_beneath import pin as with_contact
from tests.reports.test_unknowns import pin as in_joint
from tests.support.results.judged_results import row
from tests.support.results.rows import with_values


def _over_links(factor: float, low: float, high: float) -> PinResult:
    """A row of which 1.5 is required, and parts of its stress at the ends of the range."""
    pin = row("x", "converged", factor, factor > 1.5)
    stress = pin.max_von_mises
    assert stress is not None
    over = SharingRange((low * stress, high * stress), "AE stiffer", "all links stiffer in torsion")
    changed = replace(pin, sharing=over)
    return replace(changed, depends_on=depends_on(changed))


def test_a_safe_pin_depends_where_links_may_load_it_more() -> None:
    pin = _over_links(2.0, 0.5, 2.0)
    (one,) = pin.depends_on
    assert (one.what, one.over) == ("all links stiffer in torsion", "links")
    assert one.factor == pytest.approx(1.0)
    assert pin.outcome == "depends"
    assert not _over_links(2.0, 0.5, 1.2).depends_on


def test_a_pin_that_fails_may_be_safe_with_other_links() -> None:
    pin = _over_links(1.4, 0.5, 2.0)
    assert [d.what for d in pin.depends_on] == ["AE stiffer"]
    assert pin.outcome == "fails"


def test_the_open_range_of_the_factor_has_that_over_links() -> None:
    assert factor_spread(_over_links(2.0, 0.5, 2.0)) == pytest.approx((1.0, 4.0))


def _with_links(made: PinResult, most: float) -> PinResult:
    """A row whose stress is up to `most` times as large over the stiffness of its links."""
    stress = made.max_von_mises or 0.0
    over = SharingRange((stress, most * stress), "", "AE stiffer")
    if made.places is not None and made.places.contact is not None:
        deep = made.places.contact.beneath
        over = replace(over, beneath=(deep, most * deep), deepest="AE stiffer")
    changed = replace(made, sharing=over)
    return replace(changed, depends_on=depends_on(changed))


def test_links_with_joint_or_landing_fail_a_pin_that_is_safe_over_each() -> None:
    """2.6 / 1.3 = 2.0 guided, 2.6 / 1.4 = 1.86 with the links, 1.43 with both, of 1.5; all were
    safe. Likewise 2.6 / 1.5 = 1.73 at 0.1 s, and 1.24 with the links.
    """
    for made, other, factor in (
        (in_joint(2.6, (0.9, 1.3)), "joint and links", 2.6 / 1.3 / 1.4),
        (in_joint(2.6, None, ("rectangular",)), "landing and links", 2.6 / 1.5 / 1.4),
        (in_joint(3.1, (0.9, 1.3), ("rectangular",)), "joint, landing and links",
         3.1 / 1.3 / 1.5 / 1.4),
    ):  # fmt: skip
        assert made.outcome == "safe"
        (one,) = _with_links(made, 1.4).depends_on
        assert (one.what, one.over) == ("together", other)
        assert one.factor == pytest.approx(factor, rel=1e-9)
    assert _with_links(in_joint(2.6, (0.9, 1.3)), 1.3).outcome == "safe"  # 1.54


def test_links_that_take_what_lies_beneath_contact_beyond_what_is_permitted() -> None:
    """71,000 of 78,667 psi, with its error: 1.2 times as much is 85,200; the row's 59,000 is
    70,800. The pin was safe.
    """
    (one,) = _with_links(with_contact(70000.0), 1.2).depends_on
    assert (one.what, one.value, one.over) == ("beneath", "AE stiffer", "links")
    assert one.factor == pytest.approx(118.0 / 85.2)
    assert _with_links(with_contact(70000.0), 1.1).outcome == "safe"


def test_a_range_over_the_joint_that_has_its_error_is_not_given_it_twice() -> None:
    """An error of 60 %, and foundations up to 3 times the stress with theirs: 6 / 3 / 1.1 = 1.82 of
    1.5. Nose legs in side loads were said to depend.
    """
    made = in_joint(6.0, (0.9, 1.3))
    stress = made.max_von_mises or 0.0
    assert made.joint is not None
    assert made.joint.range is not None
    free = replace(made.joint.range.variations[0], interval=(0.5 * stress, 3.0 * stress))
    over = replace(made.joint.range, max_von_mises=(0.5 * stress, 3.0 * stress), variations=(free,))
    wide = with_values(
        made, joint=replace(made.joint, range=over), error_estimate=0.6 * stress, depends_on=()
    )
    assert _with_links(wide, 1.1).outcome == "safe"
    assert [d.over for d in _with_links(wide, 1.4).depends_on] == ["joint and links"]  # 1.43
