"""Laws of probability against SciPy's, and the designs that are sampled by them."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest
from scipy import stats

from pinstress.explore.sweep.correlations import correlations_of
from pinstress.explore.sweep.fits import limits_of
from pinstress.explore.sweep.laws import (
    Floats,
    Law,
    LogNormal,
    Normal,
    Triangular,
    Uniform,
    of_tolerance,
)
from pinstress.explore.sweep.number import Number
from pinstress.explore.sweep.parameters import parameters_of
from pinstress.explore.sweep.sample import designs_of
from pinstress.study.schema.units import UNIT_SYSTEMS
from pinstress.study.schema.vary import VaryTable
from tests.support.each import each
from tests.support.programs.swept import DIAMETER, FORCE, STRENGTH, swept

SIGMA = float(np.sqrt(np.log1p(0.2**2)))
KNOWN: dict[str, tuple[Law, Any]] = {
    "uniform": (Uniform(2.0, 5.0), stats.uniform(2.0, 3.0)),
    "normal": (Normal(10.0, 2.0), stats.norm(10.0, 2.0)),
    "cut off": (Normal(10.0, 2.0, 9.0, 15.0), stats.truncnorm(-0.5, 2.5, 10.0, 2.0)),
    "upper tail": (Normal(0.0, 1.0, 5.0, 9.0), stats.truncnorm(5.0, 9.0)),
    "lognormal": (
        LogNormal(10.0, 2.0),
        stats.lognorm(SIGMA, scale=10.0 / np.sqrt(1.0 + 0.2**2)),
    ),
    "triangular": (Triangular(1.0, 2.0, 5.0), stats.triang(0.25, 1.0, 4.0)),
    "right-angled": (Triangular(1.0, 5.0, 5.0), stats.triang(1.0, 1.0, 4.0)),
}


@each("name", KNOWN)
def test_quantiles_are_those_of_scipy(name: str) -> None:
    law, known = KNOWN[name]
    u = np.array([1e-6, 0.01, 0.2, 0.25, 0.5, 0.9, 0.999, 1.0 - 1e-9])
    np.testing.assert_allclose(law.quantile(u), known.ppf(u), rtol=1e-9)
    z = stats.norm.ppf(u)
    np.testing.assert_allclose(law.of_normal(z), known.ppf(u), rtol=1e-7)


def test_a_lognormal_law_is_given_by_its_own_mean_and_deviation() -> None:
    found = LogNormal(10.0, 2.0).quantile((np.arange(200_000) + 0.5) / 200_000)
    assert found.mean() == pytest.approx(10.0, rel=1e-4)
    assert found.std() == pytest.approx(2.0, rel=1e-3)


def test_a_lognormal_law_that_is_cut_off_stays_within() -> None:
    law = LogNormal(10.0, 2.0, 9.0, 12.0)
    u = np.linspace(0.0, 1.0, 11)
    whole = KNOWN["lognormal"][1]
    low, high = whole.cdf(9.0), whole.cdf(12.0)
    np.testing.assert_allclose(law.quantile(u), whole.ppf(low + u * (high - low)), rtol=1e-9)
    assert law.within == pytest.approx(high - low)


def test_a_lognormal_law_that_is_cut_off_above_says_so() -> None:
    assert LogNormal(10.0, 2.0, 0.0, 12.0).text(str, str).endswith("cut off at 0.0 and 12.0")
    assert LogNormal(10.0, 2.0).text(str, str).endswith("deviation 2.0")


def _number(nominal: float, dimension: str = "length") -> Number:
    return Number("key", ("pin",), dimension, nominal, "mm", 1e-3)


@each(
    ("text", "low", "high"),
    [
        ("+0.1 mm -0.05 mm", -50.0, 100.0),
        ("-0.05 +0.1", -50.0, 100.0),
        ("+0.1/0", 0.0, 100.0),
        ("+0.1 -0.05 mm", -50.0, 100.0),  # the study's own unit
        ("0 -2e-4 in", -5.08, 0.0),
        ("±0.1 mm", -100.0, 100.0),
        ("h7", -30.0, 0.0),
        ("H7", 0.0, 30.0),
        ("g6", -29.0, -10.0),
        ("F8", 30.0, 76.0),
        ("js9", -37.0, 37.0),
    ],
)
def test_tolerances_of_a_drawing_are_limits(text: str, low: float, high: float) -> None:
    """Micrometres from a nominal diameter of 60 mm."""
    found = np.array(limits_of(text, _number(0.06), UNIT_SYSTEMS["mm-N-s"])) - 0.06
    np.testing.assert_allclose(found, np.array([low, high]) * 1e-6, atol=1e-15)


def test_the_law_of_a_tolerance_ends_at_its_limits() -> None:
    law = of_tolerance(9.9, 10.1)
    assert law.quantile(np.array([0.0, 0.5, 1.0])) == pytest.approx([9.9, 10.0, 10.1])
    assert law.deviation == pytest.approx(0.2 / 6.0)


VARIED = f"""
"{DIAMETER}" = {{ from = "1 in", to = "3 in", steps = 3 }}
"{FORCE}" = {{ normal = ["-988 lbf", 100], steps = 4 }}
"{STRENGTH}" = {{ normal = ["225 ksi", "5 ksi"], steps = 1 }}
"""


def _designs(head: str, more: str = "") -> Floats:
    study = swept(VARIED + more, head)
    parameters = parameters_of(study)
    assert study.table.vary is not None
    return designs_of(study.table.vary, parameters, correlations_of(study, parameters))


@each("sample", ["sobol", "latin-hypercube", "random"])
def test_a_sample_is_the_same_for_the_same_seed(sample: str) -> None:
    head = f'sample = "{sample}"\ncount = 8\nseed = '
    first, again, other = (_designs(head + seed) for seed in ("1", "1", "2"))
    assert first.shape == (8, 3)
    np.testing.assert_array_equal(first, again)
    assert not np.isclose(first, other).any()


def test_a_sobol_sequence_fills_every_half_of_every_law_alike() -> None:
    found = _designs('sample = "sobol"\ncount = 64')
    laws: list[Law] = [p.law for p in parameters_of(swept(VARIED))]
    for k, law in enumerate(laws):
        assert (found[:, k] < law.quantile(np.array([0.5]))).sum() == 32


def test_a_count_that_is_no_power_of_two_gives_no_warning() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(_designs('sample = "sobol"\ncount = 5')) == 5


def test_a_grid_has_all_combinations_the_first_parameter_slowest() -> None:
    found = _designs('sample = "grid"')
    assert found.shape == (12, 3)
    np.testing.assert_allclose(found[::4, 0], np.array([1.0, 2.0, 3.0]) * 0.0254, rtol=1e-15)
    middles = stats.norm(-988.0, 100.0).ppf([0.125, 0.375, 0.625, 0.875])
    np.testing.assert_allclose(found[:4, 1] / (0.45359237 * 9.80665), middles, rtol=1e-12)
    assert len(np.unique(found[:, 2])) == 1


def test_correlated_numbers_vary_together() -> None:
    pair = f'[[vary.correlations]]\nbetween = ["{FORCE}", "{STRENGTH}"]\ncoefficient = -0.8\n'
    found = _designs('sample = "sobol"\ncount = 4096', pair)
    matrix = np.asarray(np.corrcoef(found.T))
    assert matrix[1, 2] == pytest.approx(-0.8, abs=0.01)
    assert np.abs(matrix[0, 1:]).max() < 0.01
    assert found[:, 2].std() == pytest.approx(5.0 * 6894757.293168361, rel=0.01)
    alone = _designs('sample = "sobol"\ncount = 4096')
    np.testing.assert_allclose(found[:, :2], alone[:, :2], rtol=1e-12)


def test_correlations_that_leave_nothing_free_are_followed() -> None:
    """A matrix that is singular: the third is the mean of the first two, but for its scale."""
    three = f"""
"{DIAMETER}" = {{ normal = [2, 0.1] }}
"{FORCE}" = {{ normal = [-988, 100] }}
"{STRENGTH}" = {{ normal = [225e3, 5e3] }}
"""
    root = 0.5**0.5
    pairs = "".join(
        f'[[vary.correlations]]\nbetween = ["{a}", "{STRENGTH}"]\ncoefficient = {root!r}\n'
        for a in (DIAMETER, FORCE)
    )
    study = swept(three + pairs, 'sample = "sobol"\ncount = 256')
    parameters = parameters_of(study)
    vary = study.table.vary
    assert isinstance(vary, VaryTable)
    x = designs_of(vary, parameters, correlations_of(study, parameters))
    z = (x - x.mean(axis=0)) / x.std(axis=0)
    np.testing.assert_allclose(z[:, 2], root * (z[:, 0] + z[:, 1]), atol=0.05)
