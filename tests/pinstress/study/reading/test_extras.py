"""Optional packages: one that is missing is named, with its extra, before any work."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

import pytest

import pinstress
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.extras import EXTRAS
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.programs.command_line import ONE_PIN, run_here
from tests.support.programs.swept import FORCE, swept, varied

LOADS = f'"{FORCE}" = {{ from = -1000, to = -500 }}'
FATIGUE = """
[material."AISI 4340".fatigue]
knee_stress = "50 ksi"
knee_cycles = 1e6
slope = 5
scatter = 4
mean_stress_sensitivity = 0.2
[fatigue]
life = 1000
failure_probability = 0.1
[fatigue.occurrences]
landing = 1
"""
RUN, SWEEP = ("run", "study.toml", "--out", "out"), ("sweep", "study.toml", "--out", "out")
# What needs a package: the study, the command, and how its message begins.
USERS = [
    ("distributed", varied(LOADS), (*SWEEP, "--scheduler", "tcp://nowhere:1"), "--scheduler"),
    ("cryptography", ONE_PIN, ("cluster-keys", "keys"), "cluster-keys"),
    ("pylife", ONE_PIN + FATIGUE, RUN, "study.toml:38: fatigue"),
    ("typst", ONE_PIN, (*RUN, "--pdf"), "--pdf"),
    ("typst", ONE_PIN, ("pdf", "out"), "pdf"),
]


@each(("package", "text", "command", "start"), USERS)
def test_one_line_names_the_extra(
    package: str,
    text: str,
    command: tuple[str, ...],
    start: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    (tmp_path / "study.toml").write_text(text, encoding="utf-8")
    monkeypatch.setitem(sys.modules, package, None)
    refused = run_here(*command, cwd=tmp_path)
    assert refused.returncode == 2
    assert refused.stderr == (
        f"Error: {start}: needs {package}, which is not installed: "
        f"pip install 'pinstress[{EXTRAS[package]}]'\n"
    )
    assert not (tmp_path / "out").exists()


def test_users_of_python_get_the_same_error(monkeypatch: pytest.MonkeyPatch) -> None:
    for package in EXTRAS:
        monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(InputError, match=r"fatigue: needs pylife, .*\[fatigue\]") as raised:
        pinstress.run(pinstress.study_from(ONE_PIN + FATIGUE))
    assert raised.value.code == "missing-extra"
    with pytest.raises(InputError, match=r"--scheduler: needs distributed, .*\[cluster\]"):
        pinstress.sweep(swept(LOADS), scheduler="tcp://nowhere:1")


def test_extras_are_those_of_the_project() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    for package, extra in EXTRAS.items():
        if package == "pandas":  # which pylife brings
            continue
        requirements = project["optional-dependencies"][extra]
        assert any(requirement.startswith(f"{package}>=") for requirement in requirements)
        assert not any(line.startswith(package) for line in project["dependencies"])
