"""`pinstress pdf` and `--pdf`: the report on paper."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from pinstress.cli import manifest
from pinstress.cli.commands import run_command_line
from pinstress.study.reading.shipped import shipped

BLOCK = """
[report]
revision = "B7"
date = 2026-03-31
prepared = "A. N. Other"
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run with its PDF, of a study with a title block."""
    folder = tmp_path_factory.mktemp("printed")
    study = folder / "one_pin.toml"
    study.write_bytes(shipped("one_pin.toml").read_bytes() + BLOCK.encode())
    options = ["--out", str(folder / "out"), "--pdf", "--quiet", "--tolerance", "0.5"]
    assert run_command_line(["run", str(study), *options]) == 0
    return folder / "out"


@pytest.fixture
def folder(made: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(made, tmp_path / "out"))


@pytest.mark.slow
def test_a_run_prints_what_the_folder_prints_later_to_the_last_byte(folder: Path) -> None:
    first = (folder / "report.pdf").read_bytes()
    (folder / "report.pdf").unlink()
    assert run_command_line(["pdf", str(folder)]) == 0
    assert (folder / "report.pdf").read_bytes() == first
    assert "report.pdf" in (manifest.listed(folder) or set())


@pytest.mark.seconds
def test_it_is_tagged_dated_and_has_its_fonts(folder: Path) -> None:
    pdf = (folder / "report.pdf").read_bytes()
    assert pdf.startswith(b"%PDF-")
    for part in (b"/StructTreeRoot", b"/Outlines", b"/Lang", b"pdfuaid:part>1<"):
        assert part in pdf, part
    assert b"2026-03-31T00:00:00" in pdf
    assert re.search(rb"/FontFile[23]", pdf) is not None
    assert b"A. N. Other" in pdf


def test_the_page_has_the_same_title_block(folder: Path) -> None:
    page = (folder / "report.html").read_text(encoding="utf-8")
    rows = re.findall(r"<td[^>]*>([^<]*)</td>", page[: page.index("<h1>")])
    assert {"B7", "A. N. Other", "2026-03-31"} <= set(rows)


@pytest.mark.seconds
def test_a_file_of_another_is_left_alone(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    known = manifest.listed(folder)
    assert known is not None
    (folder / "report.pdf").write_bytes(b"mine")
    manifest._write(folder, known - {"report.pdf"})
    assert run_command_line(["pdf", str(folder)]) == 2
    assert "did not write report.pdf" in capsys.readouterr().err
    assert (folder / "report.pdf").read_bytes() == b"mine"


@pytest.mark.seconds
def test_a_folder_without_results_is_not_said_to_have_no_page(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "results.json").unlink()
    assert run_command_line(["pdf", str(folder)]) == 2
    assert capsys.readouterr().err.endswith(": contains no results.json; run the study again\n")


@pytest.mark.seconds
def test_a_folder_without_a_page_is_refused(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "report.html").write_text("<html>", encoding="utf-8")
    before = (folder / "report.pdf").read_bytes()
    assert run_command_line(["pdf", str(folder)]) == 2
    assert "run it again" in capsys.readouterr().err
    assert (folder / "report.pdf").read_bytes() == before
    assert run_command_line(["pdf", str(tmp_path)]) == 2
