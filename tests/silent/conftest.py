"""A results folder beside a file that is none of it."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from tests.support.results.small_folder import SECRET, small_folder


@pytest.fixture(scope="session")
def small_results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return small_folder(tmp_path_factory.mktemp("small") / "out")


@pytest.fixture
def folder(small_results: Path, tmp_path: Path) -> Path:
    """A copy of it, and `secret` beside it."""
    copy = tmp_path / "out"
    subprocess.run(["cp", "-r", str(small_results), str(copy)], check=True)
    (tmp_path / "secret").write_bytes(SECRET)
    return copy
