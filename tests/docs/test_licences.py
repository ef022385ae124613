"""The licences of all dependencies are on their page."""

from __future__ import annotations

import re

from docs.licences import PAGE, RUN, page, recorded
from tests.conftest import ROOT


def test_everything_that_is_locked_is_there() -> None:
    pinned = set()
    for lock in ("requirements.lock", "requirements-bench.lock"):
        for line in (ROOT / lock).read_text(encoding="utf-8").splitlines():
            if "==" in line and not line.startswith((" ", "#")):
                pinned.add(re.split(r"==|;| ", line)[0])
    assert len(pinned) > 100
    assert set(recorded()) == pinned


def test_the_page_is_what_the_packages_say() -> None:
    """Renewed by `python -m docs.licences`."""
    assert PAGE.read_text(encoding="utf-8") == page()


def test_what_runs_is_told_from_what_develops_and_from_extras() -> None:
    run = {name for name, (_, need) in recorded().items() if need == RUN}
    assert {"numpy", "gmsh", "tomlkit", "xlsxwriter", "kiwisolver"} <= run
    assert not run & {"pytest", "sphinx", "ruff", "ngsolve", "dask", "pandas", "typst"}
    needs = {name: need for name, (_, need) in recorded().items()}
    assert needs["tornado"] == "extra `cluster`"
    assert needs["pandas"] == "extra `fatigue`"
    assert needs["typst"] == "extra `pdf`"


def test_the_licences_that_decide_ours_are_named() -> None:
    """README.md: GPL because gmsh and cvxopt are."""
    licences = {
        name: licence
        for name, (licence, need) in recorded().items()
        if need == RUN or need.startswith("extra")
    }
    ours = {name for name, text in licences.items() if "GPL" in text or "General Public" in text}
    assert ours == {"gmsh", "cvxopt"}
