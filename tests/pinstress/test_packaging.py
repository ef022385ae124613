"""What a user installs: wheel, source distribution and checkout, each in an empty environment.

The environment is real, and so is the install. Dependencies alone, which are not what is tested,
are those of the interpreter that runs the tests, named in PYTHONPATH: an editable install's .pth is
not read there, so that the checkout cannot be imported. Those of the extras are hidden. Nothing is
fetched.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import sysconfig
import tarfile
import tomllib
import venv
import zipfile
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.conftest import ROOT
from tests.support.each import sampled

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PACKAGES = PROJECT["tool"]["importlinter"]["root_packages"]
LIBRARIES = os.pathsep.join(dict.fromkeys(sysconfig.get_paths()[k] for k in ("purelib", "platlib")))
EXTRAS = ("distributed", "dask", "tornado", "psutil", "pylife", "pandas", "h5py", "typst")
SHIPPED = "import pinstress; print(*pinstress.shipped_studies())"
HIDDEN = f"import sys; sys.modules |= dict.fromkeys({EXTRAS})"
OFFLINE = ("--no-index", "--no-deps", "--no-build-isolation", "--ignore-installed", "--quiet")


def done(folder: Path, *command: str | Path, status: int = 0) -> str:
    """What a command prints, run in a folder without anything of the checkout in its path. status:
    its exit status; what it prints of an error instead, if that is 2.
    """
    path = os.pathsep.join([str(folder / "hidden"), LIBRARIES])
    found = subprocess.run(
        [str(word) for word in command],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": path, "PINSTRESS_CACHE": str(folder / "cache")},
        capture_output=True,
        text=True,
    )
    assert found.returncode == status, found.stdout + found.stderr
    return found.stderr if status == 2 else found.stdout


def files(*folders: str) -> set[str]:
    """Files of the checkout in these folders, relative to it."""
    return {
        path.relative_to(ROOT).as_posix()
        for folder in folders
        for path in (ROOT / folder).rglob("*")
        if path.is_file() and not {"__pycache__", "out"} & set(path.parts)
    }


@pytest.fixture(scope="module")
def dist(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with both distributions."""
    folder = tmp_path_factory.mktemp("dist")
    build = (sys.executable, "-m", "hatchling", "build", "-d", folder)
    found = subprocess.run(build, cwd=ROOT, capture_output=True, text=True)
    assert found.returncode == 0, found.stderr
    return folder


def only(folder: Path, ending: str) -> Path:
    (found,) = folder.glob(f"*{ending}")
    return found


@pytest.mark.slow
def test_the_wheel_has_all_files_and_no_others(dist: Path) -> None:
    """Templates and styles of the report too, the studies under pinstress/, and the licence."""
    with zipfile.ZipFile(only(dist, ".whl")) as wheel:
        names = set(wheel.namelist())
    (info,) = {name.split("/")[0] for name in names if ".dist-info/" in name}
    wanted = files(*PACKAGES) | {f"pinstress/{name}" for name in files("studies")}
    assert {name for name in names if not name.startswith(info)} == wanted
    assert f"{info}/licenses/LICENSE" in names
    assert any(name.endswith(".j2") for name in names)


@pytest.mark.slow
def test_the_source_has_what_the_wheel_is_made_of_and_the_tests(dist: Path) -> None:
    with tarfile.open(only(dist, ".tar.gz")) as source:
        names = {name.partition("/")[2] for name in source.getnames()}
    assert files(*PACKAGES, "studies", "tests", "scripts") <= names
    assert {"LICENSE", "README.md", "pyproject.toml", "requirements.lock", "Makefile"} <= names
    assert not any(name.startswith((".venv", ".git/", "out/")) for name in names)


def test_a_citation_says_what_the_project_says() -> None:
    """CITATION.cff has one key a line, lists below it."""
    text, project = (ROOT / "CITATION.cff").read_text(encoding="utf-8"), PROJECT["project"]
    stated = dict(re.findall(r"^([\w-]+): (.+)$", text, re.MULTILINE))
    assert stated["version"] == project["version"]
    assert stated["license"] == project["license"]
    authors, keywords = re.split(r"^keywords:$", text, flags=re.MULTILINE)
    assert re.findall(r"^  - name: (.+)$", authors, re.MULTILINE) == [
        author["name"] for author in project["authors"]
    ]
    assert re.findall(r"^  - (.+)$", keywords, re.MULTILINE) == project["keywords"]


@dataclass(frozen=True)
class Installed:
    """An environment, in a folder of its own, and the files of our packages there; `shipped`: the
    path of a study.
    """

    folder: Path
    files: frozenset[str]
    shipped: Path

    @property
    def python(self) -> Path:
        return self.folder / "env" / "bin" / "python"


def installed(what: Path, folder: Path) -> Installed:
    """An empty environment into which a distribution or a checkout is installed."""
    venv.create(folder / "env", symlinks=True)
    python = folder / "env" / "bin" / "python"
    done(folder, sys.executable, "-m", "pip", "--python", python, "install", *OFFLINE, what)
    (folder / "hidden").mkdir()
    (folder / "hidden" / "sitecustomize.py").write_text(HIDDEN, encoding="utf-8")
    here = done(
        folder,
        python,
        "-c",
        f"import {', '.join(PACKAGES)}; from pinstress.study.reading.shipped import shipped\n"
        f"print(*(m.__file__ for m in ({', '.join(PACKAGES)})))\n"
        "print(shipped('grenier2008.toml'))",
    ).split()
    assert len(here) == len(PACKAGES) + 1
    inside = (folder / "env").resolve()
    assert all(inside in Path(path).resolve().parents for path in here)
    assert Path(here[-1]).is_file()
    site = Path(here[0]).parents[1]
    found = (p for room in PACKAGES for p in (site / room).rglob("*") if p.is_file())
    names = {p.relative_to(site).as_posix() for p in found if "__pycache__" not in p.parts}
    return Installed(folder, frozenset(names), Path(here[-1]))


@pytest.fixture(scope="module")
def from_wheel(dist: Path, tmp_path_factory: pytest.TempPathFactory) -> Installed:
    return installed(only(dist, ".whl"), tmp_path_factory.mktemp("wheel"))


@pytest.mark.slow
@pytest.mark.parametrize("ending", sampled(["pip install .", ".tar.gz"], every=2))
def test_every_way_installs_the_same(
    ending: str, dist: Path, from_wheel: Installed, tmp_path: Path
) -> None:
    """So that what the wheel's does, the others do, too. The program of each starts."""
    other = installed(only(dist, ending) if ending.startswith(".") else ROOT, tmp_path)
    assert other.files == from_wheel.files
    assert "pinstress" in done(tmp_path, other.python.with_name("pinstress"), "--version")


@pytest.mark.slow
def test_an_install_initialises_checks_and_runs(from_wheel: Installed) -> None:
    folder, program = from_wheel.folder, from_wheel.python.with_name("pinstress")
    assert "pinstress" in done(folder, program, "--version")
    done(folder, program, "init", "trial")
    assert "B" in done(folder, program, "check", "trial/one_pin.toml")
    done(folder, program, "check", from_wheel.shipped)
    studies = {Path(name).stem for name in files("studies") if name.count("/") == 1}
    listed = done(folder, from_wheel.python, "-c", SHIPPED)
    assert set(listed.split()) == studies
    printed = done(folder, program, "run", "trial/one_pin.toml")
    assert "safe" in printed
    out = folder / "out" / "one_pin"
    (pin,) = json.loads((out / "results.json").read_text(encoding="utf-8"))["pins"]
    assert pin["verdict"] == "converged"
    assert pin["meets_required"] is True
    assert "<title>" in (out / "report.html").read_text(encoding="utf-8")
    again = done(folder, program, "run", "trial/one_pin.toml")
    assert again == printed
    assert any((folder / "cache").iterdir())

    fatigue = from_wheel.shipped.with_name("fatigue.toml")
    for command in (
        ("run", fatigue, "--out", "refused"),
        ("run", "trial/one_pin.toml", "--pdf"),
        ("sweep", fatigue.with_name("lifting_arm.toml"), "--scheduler", "tcp://127.0.0.1:1"),
    ):
        assert "pip install 'pinstress[" in done(folder, program, *command, status=2)
