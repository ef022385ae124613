"""Whatever stands in results.json, a VTU or report.html: `view`, `compare`, `plots` and `pdf` say
in one message what is wrong, where, and in which file, with exit status 2.

Before, of 80 damaged folders 34 ended in a traceback: KeyError, RecursionError, zlib.error,
UnicodeDecodeError, StopIteration, OverflowError.

What is independent: the damage is drawn by a seed and knows nothing of how the files are read;
beside it stand damages by hand, with the words that a reader needs.
"""

from __future__ import annotations

import json
import random
import re
import shutil
import subprocess
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import pytest

import pinbase.processes.apart as apart_module
import pinstress.cli.compare as compare_command
import pinstress.cli.plots as plots_command
import pinstress.cli.view as view_command
import reports.vtk.render as render
from pinbase.processes.apart import Failed
from tests.support.each import sampled
from tests.support.programs.command_line import pinstress, run_here
from tests.support.results.mutants import (
    DEEP,
    ODD,
    damaged_json,
    damaged_page,
    damaged_vtu,
    repacked,
)
from tests.support.results.small_folder import VTU, small_folder

RESULTS, PAGE = "results.json", "report.html"
DAMAGE: dict[str, Callable[[bytes, random.Random], bytes]] = {
    RESULTS: damaged_json,
    VTU: damaged_vtu,
    PAGE: damaged_page,
}
VIEW = ("view", "out", "--screenshot", "a.png", "--force")
COMPARE = ("compare", "out", "other", "--out", "compared", "--pictures")
COMMANDS: dict[str, list[tuple[str, ...]]] = {
    RESULTS: [VIEW, COMPARE, ("compare", "other", "out"), ("plots", "out")],
    VTU: [VIEW, COMPARE, ("plots", "out")],
    PAGE: [("plots", "out"), ("pdf", "out")],
}
QUICK, MANY = 15, 150  # mutants of each file


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("made")
    small_folder(folder / "out")
    shutil.copytree(folder / "out", folder / "other")
    content = json.loads((folder / "other" / RESULTS).read_text(encoding="utf-8"))
    content["pins"][0]["max_von_mises"] *= 2.0  # so that there is something to compare
    (folder / "other" / RESULTS).write_text(json.dumps(content), encoding="utf-8")
    return folder


@pytest.fixture
def folder(made: Path, tmp_path: Path) -> Path:
    """With out and other in it."""
    copy = tmp_path / "runs"
    shutil.copytree(made, copy)
    return copy


@pytest.fixture
def engineless(monkeypatch: pytest.MonkeyPatch) -> None:
    """Fields are read, and nothing is drawn, which takes a second each time."""

    def here(work: Any, seconds: int) -> list[Any]:
        found = [
            apart_module._guarded(partial(apart_module._untold, one), print) for _, one in work
        ]
        return [one if isinstance(one, Failed) else one.value for one in found]

    def drawn(_: object, path: Path, *__: object) -> None:
        path.write_bytes(b"drawn")

    for module in (plots_command, view_command, compare_command):
        monkeypatch.setattr(module, "apart", here)
        monkeypatch.setattr(module, "renderer_problem", lambda: None)
        monkeypatch.setattr(module, "preload", lambda *_: None)
    monkeypatch.setattr(apart_module, "_quiet", lambda: None)
    monkeypatch.setattr(render, "render_pin", drawn)
    monkeypatch.setattr(view_command, "render_pin", drawn)
    monkeypatch.setattr(plots_command, "draw_plot", lambda *_: [])
    monkeypatch.setattr(plots_command, "typeset", lambda *_: b"%PDF")
    monkeypatch.setattr(plots_command, "svg", lambda _: "<svg></svg>")


def require_said(made: subprocess.CompletedProcess[str], about: object) -> None:
    """Done, or what was not, in one message; a damaged name looks like a requirement that is gone,
    which is status 4.
    """
    assert made.returncode in (0, 1, 2, 4), about
    said = made.stderr.splitlines()
    errors = [line for line in said if line.startswith("Error")]
    gone = [line for line in said if line.startswith("Requirement")]
    assert bool(gone) == (made.returncode == 4), (about, said)
    assert len(errors) == (made.returncode in (1, 2)), (about, said)
    assert "Traceback" not in made.stderr + made.stdout, about
    assert set(said) - {*errors, *gone} <= {
        *(f"Written: out/{name}" for name in ("plots", "report.pdf")),
        "Comparison: compared/comparison.html",
        "No pictures of the pins: the folder has no fields (vtk/)",
    }, about


def damage(folder: Path, name: str, seed: int) -> bytes:
    """The file as it was."""
    path = folder / "out" / name
    before = path.read_bytes()
    path.write_bytes(DAMAGE[name](before, random.Random(seed)))
    return before


def try_all(folder: Path, name: str, seeds: range) -> set[int]:
    statuses = set()
    for seed in seeds:
        before = damage(folder, name, seed)
        for command in COMMANDS[name]:
            made = run_here(*command, cwd=folder)
            require_said(made, (seed, command))
            statuses.add(made.returncode)
            if made.returncode == 2:
                named = (Path(name).name, "out: no pin", "no such file")
                assert any(words in made.stderr for words in named), (seed, command)
        (folder / "out" / name).write_bytes(before)
    return statuses


@pytest.mark.parametrize("name", DAMAGE)
@pytest.mark.usefixtures("engineless")
def test_damaged_files_are_said(name: str, folder: Path) -> None:
    assert 2 in try_all(folder, name, range(QUICK))


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("name", DAMAGE)
@pytest.mark.usefixtures("engineless")
def test_many_damaged_files_are_said(name: str, folder: Path) -> None:
    assert try_all(folder, name, range(1000, 1000 + MANY)) == {0, 2}


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "seed"),
    sampled([(RESULTS, 500), (RESULTS, 501), (VTU, 502), (PAGE, 503)], every=4, first=2),
)
def test_damaged_files_are_said_by_the_program(name: str, seed: int, folder: Path) -> None:
    """With all its engines, in a process of its own."""
    damage(folder, name, seed)
    for command in COMMANDS[name]:
        require_said(pinstress(*command, cwd=folder), (seed, command))


@pytest.mark.slow
def test_plots_that_no_engine_draws_fail_alone(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They are specifications by their form: with odd values, of endless data, deep ones."""
    page = folder / "out" / PAGE
    endless = {"data": {"sequence": {"start": 0, "stop": 1e8}}, "mark": "point"}
    fine = {"data": {"values": [{"a": 1}]}, "mark": "point", "encoding": {"x": {"field": "a"}}}
    deep: dict[str, Any] = fine
    for _ in range(30):
        deep = {"layer": [deep]}
    odd = {f"odd{k}": ["", {"mark": value}] for k, value in enumerate(ODD[:12])}
    plots = {**odd, "endless": ["", endless], "deep": ["", deep], "fine": ["", fine]}
    text = repacked(page.read_text(encoding="utf-8"), "plots", lambda _: packed_json(plots))
    page.write_text(text, encoding="utf-8")
    shutil.rmtree(folder / "out" / "vtk")
    monkeypatch.setattr(plots_command, "PICTURE_SECONDS", 5)
    made = run_here("plots", "out", cwd=folder)
    require_said(made, "plots")
    assert made.returncode == 1
    assert (folder / "out" / "plots" / "fine.svg").is_file()
    assert not (folder / "out" / "plots" / "endless.svg").exists()


def packed_json(content: Any) -> bytes:
    return json.dumps(content, default=str).replace("1" + "0" * 400, "1e300").encode()


BY_HAND: dict[str, tuple[Callable[[dict[str, Any]], object], str]] = {
    "no key": (lambda c: c["pins"][0].pop("outcome"), "pins[0].outcome is missing"),
    "text": (
        lambda c: c["pins"][0].update(max_von_mises="9"),
        "pins[0].max_von_mises is no number",
    ),
    "truth": (lambda c: c["pins"][0].update(safety_factor=True), "pins[0].safety_factor is no"),
    "negative": (
        lambda c: c["pins"][0].update(safety_factor=-1.0),
        "pins[0].safety_factor is wrong",
    ),
    "huge": (lambda c: c["pins"][0].update(max_von_mises=1e300), "max_von_mises is wrong"),
    "digits": (lambda c: c["pins"][0].update(max_von_mises=10**400), "max_von_mises is"),
    "number": (lambda c: c["pins"][0].update(yields=1), "yields is neither true nor false"),
    "two": (lambda c: c["pins"][0].update(location=[0.0, 1.0]), "pins[0].location is wrong"),
    "twice": (lambda c: c["pins"].append(c["pins"][0]), "pin B in landing is there more than once"),
    "pins": (lambda c: c.update(pins={}), "pins is not a list"),
    "NaN": (lambda c: c.update(tolerance=float("nan")), "it has NaN, which is no number"),
    "units": (lambda c: c["units"].pop("time"), "units.time is missing"),
    "loads": (lambda c: c["loads"].append(None), "loads[1] is not an object"),
}


@pytest.mark.parametrize("way", BY_HAND)
def test_what_is_wrong_is_said_and_where(way: str, folder: Path) -> None:
    change, words = BY_HAND[way]
    path = folder / "out" / RESULTS
    content = json.loads(path.read_text(encoding="utf-8"))
    change(content)
    path.write_text(json.dumps(content), encoding="utf-8")
    for command in (VIEW, ("compare", "other", "out")):
        made = run_here(*command, cwd=folder)
        assert made.returncode == 2
        assert f"Error: out: {RESULTS} is damaged: " in made.stderr
        assert words in made.stderr


TEXTS = {
    b"": "results.json is empty",
    b'{"schema": "pinstress-results/2",\n "title": x}': "line 2, column 11: Expecting value",
    b"[" * DEEP: "nested too deeply",
    b'{"a": ' + b"[" * 200 + b"]" * 200 + b"}": "nested too deeply",
    b'{"a": ' + b"7" * 5000 + b"}": "a number of thousands of digits",
    b'{"a": "\xff"}': "no UTF-8 from byte 7 on",
    b'{"a": "\\ud800"}': "half a character",
    b"[]": "was not written by pinstress",
}


@pytest.mark.parametrize("content", TEXTS, ids=TEXTS.values())
def test_what_is_no_json_is_said_and_where(content: bytes, folder: Path) -> None:
    (folder / "out" / RESULTS).write_bytes(content)
    made = run_here(*VIEW, cwd=folder)
    assert made.returncode == 2
    assert TEXTS[content] in made.stderr


def test_units_of_no_system_are_said(folder: Path) -> None:
    """They ended in StopIteration."""
    path = folder / "out" / RESULTS
    text = path.read_text(encoding="utf-8").replace('"psi"', '"bar"')
    path.write_text(text, encoding="utf-8")
    made = run_here("compare", "other", "out", cwd=folder)
    assert made.returncode == 2
    assert re.search(r"out: results.json is damaged: units", made.stderr)


def test_what_is_whole_is_shown(folder: Path) -> None:
    """The reader refuses nothing that the program writes."""
    made = run_here("compare", "other", "out", cwd=folder)
    assert made.returncode == 0
    assert "decision" in made.stdout or "changed" in made.stdout
