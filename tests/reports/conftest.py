"""A made-up run, for all tests of what is drawn and written of one."""

from __future__ import annotations

import pytest

from reports.data.fields import Field
from reports.data.results import Results
from tests.support.results.made_up_run import make_field, make_results


@pytest.fixture(scope="session")
def results() -> Results:
    return make_results()


@pytest.fixture(scope="session")
def solid() -> Field:
    return make_field()
