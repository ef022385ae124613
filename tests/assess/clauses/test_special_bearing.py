"""14 CFR 25.619, 25.623 and 25.693: the special factor in bearing, by hand."""

from __future__ import annotations

from dataclasses import replace

import pytest

from assess.checks import margins_of
from assess.lug_factors import LugFactors
from assess.margin import Margin
from assess.situation import LoadFactors, Situation
from fea.support.lugs.lug import Bushing, Lug
from tests.assess.strength.test_strength import S235, in_double_shear
from tests.support.each import each

HARD, SOFT = (replace(S235, name=n, bearing_strength=x) for n, x in (("h", 900e6), ("s", 400e6)))


def joint(special: float | None, lug: Lug) -> Situation:
    """10 kN on 16 mm by 15 mm."""
    s = in_double_shear(0.008, 0.001, 0.015, 0.016, 10e3, HARD)
    factors = {} if special is None else {"B": LugFactors(bearing=special)}
    return replace(s, codes=("aircraft",), lugs=(lug,), lug_factors=factors)


def borne(s: Situation) -> list[Margin]:
    return [m for m in margins_of(s) if m.method == "special factor in bearing"]


@each("lug", [Lug("B", 0.05, SOFT), Lug("B", 0.05, HARD, bushing=Bushing(0.002, SOFT))])
def test_the_softest_metal_bears(lug: Lug) -> None:
    """400 MPa x 16 x 15 mm = 96 kN; 1.5 x 3.33 times 10 kN."""
    (m,) = borne(joint(3.33, lug))
    assert m.allowable == pytest.approx(96e3)
    assert m.margin == pytest.approx(96.0 / (1.5 * 3.33 * 10.0) - 1.0)
    assert (m.at, m.material, m.level) == ("B", "s", "ultimate")
    assert m.passing is not None
    assert m.passing.value == pytest.approx(0.015 * m.used)


def test_only_the_highest_factor_counts() -> None:
    """25.619: a fitting factor of 1.15 is in it, unless it is the larger one."""
    lug = Lug("B", 0.05, SOFT)
    (above,), (below,) = borne(joint(2.0, lug)), borne(joint(1.1, lug))
    assert above.factor == pytest.approx(1.5 * 2.0)
    assert below.factor == pytest.approx(1.5 * 1.15)
    stated = LoadFactors(fitting=3.0, fitting_stated=True)
    (m,) = borne(replace(joint(2.0, lug), factors=stated))
    assert m.factor == pytest.approx(1.5 * 3.0)


def test_what_is_missing_is_named() -> None:
    (m,) = borne(joint(2.0, Lug("B", 0.05, S235)))
    assert m.needs == "material.S235.bearing_strength"
    assert not borne(joint(None, Lug("B", 0.05, SOFT)))
