"""A results folder may have been written by someone else: nothing outside of it is read or written
for it (nor is an address opened: test_addresses_in_a_folder.py).

Before: `pdf` wrote through a link called report.pdf into the file it led to, `plots` through a link
called plots, and wherever the names in report.html said; `sweep --resume` wrote through links at
NAME.partial; a cell that named a point beyond the last ended `view` and `plots` by signal 11.

What is independent: files outside the folder, whose bytes are compared; links made by another user,
where the tests run as root.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import zlib
from base64 import b64encode
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pinstress.cli.plots as plots_command
from pinbase.errors import Damaged
from pinstress.cli import manifest
from pinstress.explore.sweep.parts import BatchFolder, Identity
from pinstress.explore.sweep.table import write_table
from reports.folder.damaged import inflated
from reports.folder.inside import read_inside, write_inside
from reports.vtk.vtu import read_vtu
from tests.support.programs.command_line import pinstress, run_here
from tests.support.programs.swept import varied
from tests.support.results.mutants import repacked, with_block
from tests.support.results.small_folder import SECRET, VTU

NOBODY = 65534


def list_as_ours(folder: Path) -> None:
    """As a neighbour would, all that is there."""
    (folder / manifest.MANIFEST_FILE).unlink()
    manifest.complete(folder)


# Links.


@dataclass(frozen=True)
class Linked:
    """An entry that is a link, and the command that comes to it."""

    entry: str
    command: tuple[str, ...]


LINKED = [
    Linked("report.pdf", ("pdf", "out")),
    Linked("report.pdf.partial", ("pdf", "out")),
    Linked("report.html", ("pdf", "out")),
    Linked("report.html", ("plots", "out")),
    Linked("results.json", ("plots", "out")),
    Linked("results.json", ("view", "out", "--screenshot", "a.png")),
    Linked("results.json", ("compare", "out", "out")),
    Linked(VTU, ("view", "out", "--screenshot", "a.png")),
    Linked("vtk", ("view", "out", "--screenshot", "a.png")),
    Linked("vtk", ("plots", "out")),
    Linked("plots", ("plots", "out")),
]


def draws_quickly(work: Any, _: int) -> list[Any]:
    """Instead of engines: files with a few bytes."""
    found: list[Any] = []
    for name, made in work:
        path = made.args[-1] / Path(name).name if made.args[-1].is_dir() else made.args[-1]
        path.write_bytes(b"drawn")
        found.append(None if name == "report.pdf" else [path])
    return found


@pytest.mark.parametrize("linked", LINKED, ids=lambda x: f"{x.entry}-{x.command[0]}")
def test_a_link_inside_is_neither_read_nor_written(
    linked: Linked, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(plots_command, "apart", draws_quickly)
    monkeypatch.setattr(plots_command, "renderer_problem", lambda: None)
    entry = folder / linked.entry
    outside = folder.parent / "elsewhere"
    if entry.exists():
        entry.rename(outside)  # what would do if it were read
    elif linked.entry == "plots":
        outside.mkdir()
    else:
        outside.write_bytes(SECRET)
    entry.symlink_to(outside)
    list_as_ours(folder)
    before = {p: p.read_bytes() for p in folder.parent.rglob("*") if p.is_file()}
    made = run_here(*linked.command, cwd=folder.parent)
    assert made.returncode == 2
    name = linked.entry.split("/")[0] if linked.entry == "plots" else linked.entry
    assert name in made.stderr
    assert made.stderr.count("\n") == 1
    assert entry.is_symlink()
    after = {p: p.read_bytes() for p in folder.parent.rglob("*") if p.is_file()}
    assert {p: b for p, b in after.items() if p.name != manifest.MANIFEST_FILE} == {
        p: b for p, b in before.items() if p.name != manifest.MANIFEST_FILE
    }


@pytest.mark.parametrize("name", ["plots/reactions.landing.svg", "plots/reactions.landing.png"])
def test_a_link_among_the_plots(name: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plots_command, "renderer_problem", lambda: "none")

    def drawn(work: Any, _: int) -> list[Any]:
        into = work[0][1].args[-1]
        (into / Path(name).name).write_bytes(b"drawn")
        return [[into / Path(name).name]] + [[] for _ in work[1:]]

    monkeypatch.setattr(plots_command, "apart", drawn)
    (folder / "plots").mkdir()
    (folder / name).symlink_to(folder.parent / "secret")
    list_as_ours(folder)
    made = run_here("plots", "out", cwd=folder.parent)
    assert made.returncode == 2
    assert "is a link" in made.stderr
    assert (folder.parent / "secret").read_bytes() == SECRET


def test_a_link_made_by_another_user(folder: Path) -> None:
    """The folder is theirs, the file is ours; the one who draws may write both."""
    ours = folder.parent / "secret"
    ours.chmod(0o600)
    theirs = folder.parent / "theirs"
    theirs.mkdir()
    root = os.getuid() == 0
    reachable = [p for p in theirs.parents if len(p.parts) > 2] if root else []
    modes = {p: p.stat().st_mode for p in reachable}
    try:
        for path in reachable:  # of pytest's folders, which are ours alone
            path.chmod(0o755)
        if root:
            os.chown(theirs, NOBODY, NOBODY)
        plant = (
            "import os, shutil, sys\n"
            "source, there, ours, root = sys.argv[1:]\n"
            "if root == 'True': os.setgid(65534); os.setuid(65534)\n"
            "shutil.copytree(source, there, dirs_exist_ok=True)\n"
            "os.symlink(ours, there + '/report.pdf')\n"
            "text = open(there + '/.pinstress.json').read()\n"
            "os.unlink(there + '/.pinstress.json')\n"
            'new = text.replace(\'"results.json"\', \'"results.json", "report.pdf"\')\n'
            "open(there + '/.pinstress.json', 'w').write(new)\n"
        )
        arguments = [str(folder), str(theirs), str(ours), str(root)]
        subprocess.run([sys.executable, "-c", plant, *arguments], check=True)
        assert (theirs / "report.pdf").lstat().st_uid == (NOBODY if root else os.getuid())
        made = run_here("pdf", "theirs", cwd=folder.parent)
    finally:
        for path, mode in modes.items():
            path.chmod(mode)
    assert made.returncode == 2
    assert "report.pdf is a link" in made.stderr
    assert ours.read_bytes() == SECRET


def test_names_lead_nowhere_else(folder: Path) -> None:
    page = folder / "report.html"
    for name in ("../../secret", "/tmp/secret", "a/b", "..", ".hidden", "a\0b", "z" * 5000):
        text = page.read_text(encoding="utf-8")
        other = repacked(text, "plots", lambda _, n=name: json.dumps({n: ["", {}]}).encode())  # type: ignore[misc]
        (folder / "report.html").write_text(other, encoding="utf-8")
        made = run_here("plots", "out", cwd=folder.parent)
        assert made.returncode == 2
        assert "is no name of a plot" in made.stderr
        page.write_text(text, encoding="utf-8")
    content = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    for name in ("../../elsewhere/B", "/B", "B\\..\\C", "B\0", ""):
        content["pins"][0]["pin"] = name
        (folder / "results.json").write_text(json.dumps(content), encoding="utf-8")
        made = run_here("view", "out", "--screenshot", "a.png", cwd=folder.parent)
        assert made.returncode == 2
        assert "pins[0].pin is wrong" in made.stderr
    for name in ("../secret", "a/../b", "/etc/passwd", "", "a//b", "a\0b"):
        with pytest.raises(OSError, match="no name of a file"):
            read_inside(folder, name, 1000)
        with pytest.raises(OSError, match="no name of a file"):
            write_inside(folder, name, b"")


@pytest.mark.parametrize("name", ["results.json", "report.html", VTU])
@pytest.mark.parametrize("kind", ["folder", "pipe", "device"])
def test_no_file_where_one_belongs(name: str, kind: str, folder: Path) -> None:
    """A pipe has no end, and opening it waits."""
    path = folder / name
    path.unlink()
    if kind == "folder":
        path.mkdir()
    elif kind == "pipe":
        os.mkfifo(path)
    else:
        path.symlink_to("/dev/zero")
    command = ["pdf", "out"] if name == "report.html" else ["view", "out", "--screenshot", "a.png"]
    made = run_here(*command, cwd=folder.parent)
    assert made.returncode == 2
    assert name in made.stderr
    assert made.stderr.count("\n") == 1


# Fields.


def with_array(text: str, name: str, content: bytes, stated: int | None = None) -> bytes:
    header = text.index(f'Name="{name}')
    begin, end = text.index(">", header) + 1, text.index("<", header)
    return (text[:begin] + with_block(content, stated) + text[end:]).encode()


@pytest.mark.parametrize("node", [10, -1, 2**31 - 1, 10_000_000])
def test_a_cell_beyond_the_points_is_said(node: int, folder: Path) -> None:
    """The field is one tetrahedron of ten points."""
    kind = "<i8" if 'Int64" Name="connectivity' in (folder / VTU).read_text() else "<i4"
    nodes = np.array([0, 1, 2, 3, 4, 5, 6, 7, 8, node], dtype=kind)
    (folder / VTU).write_bytes(
        with_array((folder / VTU).read_text(), "connectivity", nodes.tobytes())
    )
    made = run_here("view", "out", "--screenshot", "a.png", cwd=folder.parent)
    assert made.returncode == 2
    assert f"{VTU} is damaged: a cell has the node {node:,} of 10" in made.stderr


@pytest.mark.slow
def test_a_cell_beyond_the_points_ends_no_process(folder: Path) -> None:
    nodes = np.array([0, 1, 2, 3, 4, 5, 6, 7, 8, 10_000_000], dtype="<i4")
    (folder / VTU).write_bytes(
        with_array((folder / VTU).read_text(), "connectivity", nodes.tobytes())
    )
    for command in (["view", "out", "--screenshot", "a.png"], ["plots", "out"]):
        made = pinstress(*command, cwd=folder.parent)
        assert made.returncode == 2, made.stderr
        assert made.stderr.count("\n") == 1
        assert "is damaged" in made.stderr


def test_what_unpacks_to_more_than_it_may_is_not_unpacked(folder: Path) -> None:
    text = (folder / VTU).read_text()
    for stated in (None, 120, 2**62):
        bomb = with_array(text, "displacement", bytes(20_000_000), stated)
        assert len(bomb) < 200_000
        with pytest.raises(Damaged, match="not 120 bytes long"):
            read_vtu(bomb, "it")
    packed = b64encode(zlib.compress(bytes(20_000_000))).decode()
    with pytest.raises(Damaged, match="more than 1 MB"):
        inflated(packed, 2**20, "it")


# Other versions.


@pytest.mark.parametrize(("number", "words"), [(1, "an older"), (3, "a newer"), (17, "a newer")])
def test_another_schema_is_said(number: int, words: str, folder: Path) -> None:
    content = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    content = {"schema": f"pinstress-results/{number}", "rows": content}
    (folder / "results.json").write_text(json.dumps(content), encoding="utf-8")
    for command in (
        ["view", "out", "--screenshot", "a.png"], ["compare", "out", "out"], ["plots", "out"],
        ["pdf", "out"],
    ):  # fmt: skip
        made = run_here(*command, cwd=folder.parent)
        assert made.returncode == 2
        assert f"{words} version of pinstress (schema pinstress-results/{number};" in made.stderr
        assert "out: results.json" in made.stderr
        assert "run the study again" in made.stderr
        assert "Traceback" not in made.stderr


# Sweeps.


def test_no_link_at_a_partial_name_is_followed(tmp_path: Path) -> None:
    import pyarrow as pa

    out, secret = tmp_path / "out", tmp_path / "secret"
    secret.write_bytes(SECRET)
    (out / "parts").mkdir(parents=True)
    table = pa.table({"design": [1, 2]})
    parts = BatchFolder(out, Identity("a", "b", 2, "sobol"))
    ways: dict[str, Callable[[], None]] = {
        "designs.parquet": lambda: write_table(table, out / "designs.parquet"),
        "designs.html": lambda: write_inside(out, "designs.html", b"page"),
        "parts/sweep.json": parts.begin,
        "parts/00000001.parquet": lambda: parts.write(table),
    }
    for name, write in ways.items():
        for at in (name + ".partial", name):
            (out / at).symlink_to(secret)
            with pytest.raises(OSError, match="is a link"):
                write()
            (out / at).unlink()
        (out / (name + ".partial")).write_bytes(b"of a process that was killed")
        write()
        assert (out / name).is_file()
        assert not (out / (name + ".partial")).exists()
    assert secret.read_bytes() == SECRET


@pytest.mark.parametrize(
    "name",
    ["designs.parquet", "designs.html.partial", "parts/sweep.json.partial", "parts/7.parquet"],
)
def test_a_sweep_goes_on_in_no_folder_with_links(name: str, tmp_path: Path) -> None:
    study = varied('"pin.B.profile[2].diameter" = { uniform = [1.9, 2.1] }')
    (tmp_path / "study.toml").write_text(study, encoding="utf-8")
    (tmp_path / "secret").write_bytes(SECRET)
    out = tmp_path / "out"
    (out / "parts").mkdir(parents=True)
    manifest.begin(out)
    BatchFolder(out, Identity("a", "b", 2, "sobol")).begin()
    (out / name).symlink_to(tmp_path / "secret")
    made = run_here("sweep", "study.toml", "--out", "out", "--resume", cwd=tmp_path)
    assert made.returncode == 2
    assert f"{name} is a link" in made.stderr
    assert (tmp_path / "secret").read_bytes() == SECRET


def test_a_file_is_complete_or_as_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_inside(tmp_path, "plots/a.svg", b"first")
    monkeypatch.setattr(os, "replace", _fails)
    with suppress(OSError):
        write_inside(tmp_path, "plots/a.svg", b"second")
    assert [p.name for p in (tmp_path / "plots").iterdir()] == ["a.svg"]
    assert (tmp_path / "plots" / "a.svg").read_bytes() == b"first"


def _fails(*_: object, **__: object) -> None:
    raise OSError(28, "No space left on device")
