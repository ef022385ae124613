"""Runs of studies that reuse common results: meshes, flexibilities of lugs, unit fields.

The result is that of `pinstress.run` to the last bit, whatever was run before, as
tests/pinstress/analysis/test_engine.py shows.
"""

from __future__ import annotations

from pinbase.memo import Memo
from pinstress import Study
from pinstress.analysis.engine import Engine
from pinstress.analysis.results import RunResults

MEMO = Memo()


def remembered(study: Study) -> RunResults:
    """Return the results of a run, reusing what was solved before in this process.

    Not for tests that replace a part of the solution: a remembered row does not use it.
    """
    return Engine(study, memo=MEMO).answer()
