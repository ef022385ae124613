"""What was solved before is found again by all that it depends on, and by nothing else."""

from __future__ import annotations

import errno
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any

import meshio
import pytest

from fea.core.peak import Maximum, Refinement
from fea.solve import solve as solving
from fea.solve.solve import solve as solve_problem
from fea.support.support import PinProblem
from geometry import Pin, Segment
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from pinbase.records import pack
from pinstress import load_study, study_from
from pinstress.analysis import cache as cache_module
from pinstress.analysis.cache import Cache, user_cache
from pinstress.analysis.plan import prepare
from pinstress.analysis.stored import Entry, cache_key, independent_of_memory
from pinstress.cli.commands import run_command_line
from tests.conftest import ROOT
from tests.support.each import each, sampled
from tests.support.pins.pin_files import write_mesh
from tests.support.pins.studies import DOUBLE_SHEAR, TWO_PINS
from tests.support.programs.folder_contents import contents, flipped

RUN = ["run", "study.toml", "--jobs", "1"]

Solve = Callable[..., list[str]]

IN_LUGS = f"""
title = "A pin with a hole in three lugs"
units = "mm-N-s"
material.iron = {{ youngs_modulus = "170 GPa", poisson_ratio = 0.27, yield_strength = 300 }}
case.pull = {{ kind = "given", forces = {{ L = [-50, 0], M = [100, 0], R = [-50, 0] }} }}
[material.steel]
youngs_modulus = "205 GPa"
poisson_ratio = 0.3
yield_strength = 600
fatigue = {{ knee_stress = 200, knee_cycles = 1e6, slope = 5, mean_stress_sensitivity = 0.3 }}
[analysis]
joints = "JOINTS"
limit_load = "always"
[pin.P]
material = "steel"
profile = {DOUBLE_SHEAR}
hole = [{{ z = 21, diameter = 3 }}]
[pin.P.lug.L]
material = "iron"
outer_diameter = 50
friction = 0.1
"""


@pytest.fixture(scope="module")
def earlier(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a run, `out`, and the cache that it filled."""
    singularity = tmp_path_factory.mktemp("earlier")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(singularity)
        patch.setenv("PINSTRESS_CACHE", str(singularity / "cache"))
        Path("study.toml").write_text(TWO_PINS)
        assert run_command_line(RUN) == 0
    return singularity


@pytest.fixture
def folder(earlier: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache of our own that has both pins."""
    shutil.copytree(earlier / "cache", tmp_path / "cache")
    monkeypatch.setenv("PINSTRESS_CACHE", str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)
    return tmp_path / "cache"


@pytest.fixture
def solve(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Solve:
    """Runs a study and says which pins were solved."""
    solved: list[str] = []

    def counted(problem: PinProblem, *rest: Any) -> Any:
        solved.append(problem.pin.name)
        return solve_problem(problem, *rest)

    monkeypatch.setattr(solving, "solve", counted)

    def run(text: str = TWO_PINS, *options: str, status: int = 0) -> list[str]:
        solved.clear()
        Path("study.toml").write_text(text)
        assert run_command_line([*RUN, *options]) == status
        return sorted(solved)

    return run


def test_nothing_changed_nothing_solved_and_the_same_bytes(
    solve: Solve, earlier: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first = contents(earlier / "out")
    assert {"study/results.json", "study/vtk/A_press.vtu", "study/report.html"} <= set(first)
    assert solve() == []
    assert (
        "2 of 2 pins reused from the cache (--no-cache solves all again)."
        in capsys.readouterr().err
    )
    assert contents(Path("out")) == first


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("diameter = 24", "diameter = 24.001", ["B"]),
        ("fillet = 4", "fillet = 4.5", ["A"]),
        ("110 GPa", "111 GPa", ["B"]),
        ("600 MPa", "601 MPa", ["A"]),
        ("A = [30.0, 40.0]", "A = [30.0, 40.000000001]", ["A"]),
        ('kind = "given"', 'kind = "given"\ndistribution = "uniform"', ["A", "B"]),
        ("tolerance = 0.2", "tolerance = 0.21", ["A", "B"]),
        ("tolerance = 0.2", "tolerance = 0.2\nexcluded_distance = 0.11", ["A", "B"]),
        ('"harmonic"', '"beam"', ["A", "B"]),
        ('"Two pins"', '"Another title"', []),
    ],
)
def test_what_changed_is_solved(solve: Solve, old: str, new: str, expected: list[str]) -> None:
    assert old in TWO_PINS
    beam = '"beam"' in new  # which does not reach the tolerance
    assert solve(TWO_PINS.replace(old, new, 1), status=int(beam)) == expected


@each(("joints", "old", "new"), [
    ("prescribed", "yield_strength = 300", "yield_strength = 299"),  # of limit loads of lugs
    ("prescribed", "friction = 0.1", "friction = 0"),  # which leaves a note on what is left out
    ("contact", "outer_diameter = 50", "edge_radius = 0"),  # by default; now in proportion
    ("auto", "[analysis]", "[fatigue]\noccurrences = { pull = 1 }\n[analysis]"),  # not by a beam
])  # fmt: skip
def test_lugs_and_fatigue_are_part_of_the_question(joints: str, old: str, new: str) -> None:
    text = IN_LUGS.replace("JOINTS", joints)
    assert text.count(old) == 1
    plans = [prepare(study_from(x)) for x in (text, text.replace(old, new))]
    assert len({pack(cache_key(plan, plan.tasks[0])) for plan in plans}) == 2


def test_a_requirement_on_rupture_is_part_of_the_question() -> None:
    """With it, minor cases are solved as accurately as the others."""
    stated = '[[require]]\ncheck = "rupture"\nfactor = 3\n'
    text = IN_LUGS.replace("JOINTS", "prescribed").replace(
        "yield_strength = 600", "yield_strength = 600\nultimate_strength = 700"
    )
    plans = [prepare(study_from(x)) for x in (text, text + stated)]
    assert len({pack(cache_key(plan, plan.tasks[0])) for plan in plans}) == 2


def test_limit_loads_of_lugs_are_part_of_the_question() -> None:
    """`run --limit-load` finds them, and a run without it does not."""
    text = IN_LUGS.replace("JOINTS", "prescribed").replace('limit_load = "always"\n', "")
    plans = [prepare(study_from(text), limit_load=asked) for asked in (False, True)]
    assert len({pack(cache_key(plan, plan.tasks[0])) for plan in plans}) == 2


def test_options_are_part_of_the_question(solve: Solve) -> None:
    assert solve(TWO_PINS, "--vtk", "solid") == ["A", "B"]  # more fields
    assert solve(TWO_PINS, "--tolerance", "0.3") == ["A", "B"]
    assert solve(TWO_PINS, "--pins", "B", "--memory-limit", "500") == []
    assert solve(TWO_PINS, "--vtk", "none") == []
    assert not Path("out/study/vtk").exists()


def test_without_the_cache(solve: Solve, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    kept = contents(folder)
    assert solve(TWO_PINS.replace("fillet = 4", "fillet = 4.1"), "--no-cache") == ["A", "B"]
    assert contents(folder) == kept
    assert "solved before" not in capsys.readouterr().err


def test_damaged_entries_are_solved_anew(solve: Solve, folder: Path) -> None:
    for name, content in contents(folder).items():
        (folder / name).write_bytes(flipped(content))
    assert solve() == ["A", "B"]
    assert solve() == []


def test_sound_entries_of_something_else_are_not_trusted(solve: Solve, folder: Path) -> None:
    assert solve() == []
    plan = prepare(load_study("study.toml"))
    cache = user_cache()
    assert cache is not None
    a, b = (cache.key(cache_key(plan, task)) for task in plan.tasks)
    assert {a, b} == set(contents(folder))
    (folder / a).write_bytes((folder / b).read_bytes())  # under another name
    assert solve() == ["A"]
    cache.write(a, Refinement(1, 1.0, 1.0))  # another type
    assert solve() == ["A"]
    of_b = cache.read(b, Entry)
    assert of_b is not None
    cache.write(a, of_b)  # another pin, well sealed
    assert solve() == ["A"]
    assert solve() == []


def test_other_versions_and_other_source_ask_anew(
    solve: Solve, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as newer:
        newer.setattr(cache_module, "version", lambda n: "0" if n == "gmsh" else version(n))
        assert solve() == ["A", "B"]
    assert solve() == []


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EACCES])
def test_a_full_or_forbidden_folder_costs_nothing(
    solve: Solve, folder: Path, monkeypatch: pytest.MonkeyPatch, code: int
) -> None:
    replace = os.replace

    def fails(source: str, target: Path, **of: int) -> None:
        if Path(target).parent == folder:
            raise OSError(code, os.strerror(code))
        replace(source, target, **of)

    monkeypatch.setattr(os, "replace", fails)
    shutil.rmtree(folder)
    assert solve() == ["A", "B"]
    assert contents(folder) == {}  # no half of one either


def test_a_folder_that_cannot_be_made(solve: Solve, folder: Path) -> None:
    shutil.rmtree(folder)
    folder.write_text("a file")
    assert solve() == ["A", "B"]
    assert folder.read_text() == "a file"


def test_what_failed_is_not_kept(solve: Solve, monkeypatch: pytest.MonkeyPatch) -> None:
    study = TWO_PINS.replace("diameter = 24", "diameter = 23")

    def fails(problem: PinProblem, *rest: Any) -> Any:
        if problem.pin.name == "B":
            raise ArithmeticError("no mesh")
        return solve_problem(problem, *rest)

    with monkeypatch.context() as broken:
        broken.setattr(solving, "solve", fails)
        solve(study, status=3)
    assert solve(study) == ["B"]


@pytest.mark.slow
def test_two_runs_at_once_and_fields_of_a_whole_motion(tmp_path: Path) -> None:
    """The pin of the beam check, held in two ways, with a landing's range."""
    command = [sys.executable, "-m", "pinstress", "run", "studies/grenier2008.toml", "--vtk",
               "motion", "--pins", "B,C"]  # fmt: skip
    environment = os.environ | {"PINSTRESS_CACHE": str(tmp_path / "cache")}

    def start(out: str) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [*command, "--out", str(tmp_path / out / "x")], cwd=ROOT, env=environment, text=True,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        )  # fmt: skip

    both = [start("one"), start("two")]
    assert [process.communicate() and process.returncode for process in both] == [1, 1]
    third = start("three")
    assert "2 of 2 pins reused from the cache" in third.communicate()[1]
    assert third.returncode == 1
    once, again = contents(tmp_path / "one" / "x"), contents(tmp_path / "three" / "x")
    assert set(once) == set(again)
    fields = [name for name in once if name.startswith("vtk/")]
    assert len(fields) > 100
    assert [name for name in fields if once[name] != again[name]] == []


MESHED = """
title = "A mesh"
units = "mm-N-s"
[material.steel]
youngs_modulus = "205 GPa"
poisson_ratio = 0.3
[pin.P]
material = "steel"
geometry = "pin.FORMAT"
clamp = ["root"]
[pin.P.band]
B = { z = [30.0, 60.0] }
root = { z = [0.0, 10.0], connection = false }
[case.push]
kind = "given"
forces = { B = [0.0, 1000.0] }
"""


def key_of(study: Path) -> str:
    plan = prepare(load_study(study))
    return Cache(study.parent, "").key(cache_key(plan, plan.tasks[0]))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("form", "changes"), sampled([("ele", "pin.node"), ("vtk", "pin.vtk")], every=2)
)
def test_a_mesh_is_known_by_its_bytes_and_by_what_lies_beside(
    tmp_path: Path, form: str, changes: str
) -> None:
    pin = Pin("P", (Segment(0.06, 0.02, connection="B"),))
    solid = solid_mesh(pin, MeshSize(2.0))
    path = write_mesh(solid, tmp_path / f"pin.{form}", linear=True)
    study = tmp_path / "study.toml"
    study.write_text(MESHED.replace("FORMAT", form))
    first = key_of(study)
    assert key_of(study) == first
    content = (tmp_path / changes).read_bytes()
    mesh = meshio.read(path)
    mesh.points[:, 0] *= 1.0 + 1e-9
    meshio.write(path, mesh)
    assert (tmp_path / changes).read_bytes() != content
    assert key_of(study) != first


def test_what_more_memory_would_have_changed_is_not_kept(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(TWO_PINS)
    plan = prepare(load_study(tmp_path / "study.toml"), model="solid", memory=300.0)

    def peak(error: float, dofs: int) -> Maximum:
        meshes = (Refinement(dofs // 3, 1.0, 1.0), Refinement(dofs, 1.0, 1.0))
        return Maximum(
            "A", "press", "solid", "unconverged", "", 1.0, error, (0.0,) * 3, None, meshes
        )

    assert independent_of_memory(plan, plan.tasks[0], (peak(0.1, 20_000),))  # known
    assert not independent_of_memory(
        plan, plan.tasks[0], (peak(0.3, 20_000),)
    )  # the next takes some 450 MB
    assert independent_of_memory(
        plan, plan.tasks[0], (peak(0.3, 10_000),)
    )  # something else stopped it
    assert independent_of_memory(plan, plan.tasks[0], (peak(0.3, 200_000),))  # as large as they get
