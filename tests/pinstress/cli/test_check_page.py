"""`pinstress check --open`: the page of a study before anything is solved, and a pin's line."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

import pinstress
from pinstress.cli.check import examine
from pinstress.cli.check_page import write_check_page
from pinstress.cli.commands import run_command_line
from tests.conftest import ROOT
from tests.pinstress.test_import import DRAW, SOLVE, loaded_by
from tests.support.described import describe
from tests.support.programs.command_line import ONE_PIN, QUICK, run_here

GEAR = ROOT / "studies" / "landing_gear.toml"
SVG = "{http://www.w3.org/2000/svg}"


def page_of(text: str, folder: Path) -> str:
    study = pinstress.study_from(text, ROOT / "studies")
    path = folder / "check.html"
    write_check_page(study, examine(study), path)
    return path.read_text(encoding="utf-8")


def drawings(page: str, kind: str) -> list[ET.Element]:
    return [ET.fromstring(svg) for svg in re.findall(rf'<svg class="{kind}".*?</svg>', page)]


def test_a_page_is_replaced_in_one_step(tmp_path: Path) -> None:
    """The former one, seen by its other name, was emptied first: if interrupted, it was lost."""
    page, other, link = (tmp_path / name for name in ("check.html", "other.html", "link.html"))
    first = page_of(ONE_PIN, tmp_path)
    other.hardlink_to(page)
    link.symlink_to(page)
    study = pinstress.study_from(ONE_PIN.replace("One pin", "Another"), ROOT / "studies")
    write_check_page(study, examine(study), link)
    assert other.read_text(encoding="utf-8") == first
    assert "Another" in page.read_text(encoding="utf-8")
    assert link.is_symlink()
    assert len(list(tmp_path.iterdir())) == 3


def test_lugs_are_drawn_to_the_scale_of_the_pin(tmp_path: Path) -> None:
    """The clevis: lugs of 50 mm about a pin of 20 mm, 10, 20 and 10 mm wide, 1 mm apart."""
    (drawing,) = drawings(page_of((ROOT / "studies" / "clevis.toml").read_text(), tmp_path), "pin")
    rectangles = [
        ([float(r.get(key, "nan")) for key in ("x", "width", "y", "height")], r.get("class"))
        for r in drawing.iter(f"{SVG}rect")
        if "x" in r.attrib  # not of a pattern
    ]
    lugs = np.array([box for box, name in rectangles if name == "lug"])
    pin = np.array([box for box, name in rectangles if name is None])
    scale = lugs[:, 1].max() / 20.0
    left = lugs[:, 0].min() - 2.0 * scale
    assert lugs[::2, 1] == pytest.approx(scale * np.array([10, 20, 10]), abs=0.02)
    assert (lugs[::2, 0] - left) / scale == pytest.approx([2, 13, 34], abs=0.01)
    top, foot = lugs[:, 2].min(), (lugs[:, 2] + lugs[:, 3]).max()
    assert foot - top == pytest.approx(50.0 * scale, abs=0.05)
    thick = (pin[:, 2] + pin[:, 3]).max() - pin[:, 2].min()
    assert thick == pytest.approx(20.0 * scale, abs=0.05)


def test_the_force_points_at_its_joint(tmp_path: Path) -> None:
    """The landing pushes the wheel up, at J, the lowest joint; in retraction nothing does."""
    retract, landing = drawings(page_of(GEAR.read_text(), tmp_path), "linkage")
    assert not arrow_lines(retract)
    (arrow,) = arrow_lines(landing)
    x1, y1, x2, y2 = map(float, re.findall(r"[\d.]+", arrow.get("d", "")))
    rings = [
        (float(c.get("cx", "nan")), float(c.get("cy", "nan"))) for c in landing.iter(f"{SVG}circle")
    ]
    lowest = max(rings, key=lambda at: at[1])
    assert x1 == pytest.approx(x2)
    assert x2 == pytest.approx(lowest[0])
    assert y1 > y2 > lowest[1]
    assert "194,100 lbf" in [text.text for text in landing.iter(f"{SVG}text")]


def arrow_lines(drawing: ET.Element) -> list[ET.Element]:
    return [path for path in drawing.iter(f"{SVG}path") if path.get("class") == "load"]


def test_it_has_every_pin_and_row_and_needs_nothing_else(tmp_path: Path) -> None:
    page = page_of(GEAR.read_text(), tmp_path)
    table = page[page.index("What would be solved") :]
    rows = re.findall(r"<tr><td[^>]*>(\w+)</td><td[^>]*>(\w+)</td>", table)
    names = [*"ABCDEFGHJ"]
    assert rows == [(name, case) for name in names for case in ("retract", "landing")]
    assert [d.findtext(f"{SVG}title") for d in drawings(page, "pin")] == [
        f"Profile of pin {name}" for name in names
    ]
    assert "<script" not in page
    assert not re.search(r"""(?:src|href)=|url\(["']?http|@import""", page)


def test_problems_come_first_and_names_are_escaped(tmp_path: Path) -> None:
    text = QUICK.replace('clamp = ["start"]', "").replace('"One pin"', '"<script>x</script>"')
    page = page_of(text, tmp_path)
    assert "<script>" not in page
    assert page.index("pin B is unconstrained in case landing") < page.index('<h2 id="pins">')


def test_the_command_writes_it_and_opens_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", lambda url: opened.append(url) or True)  # type: ignore[func-returns-value]
    (tmp_path / "study.toml").write_text(QUICK)
    assert run_here("check", "study.toml", cwd=tmp_path).returncode == 0
    assert not (tmp_path / "out").exists()
    done = run_here("check", "study.toml", "--open", "--no-browser", cwd=tmp_path)
    page = tmp_path / "out" / "study_check.html"
    assert page.is_file()
    assert str(page.relative_to(tmp_path)) in done.stderr
    run_here("check", "study.toml", "--out", "mine.html", cwd=tmp_path)
    assert (tmp_path / "mine.html").is_file()
    assert not opened
    run_here("check", "study.toml", "--open", cwd=tmp_path)
    assert opened == [page.as_uri()]


def test_it_takes_no_place_that_is_not_its_own(tmp_path: Path) -> None:
    """A study named by --out was replaced by the page; where no folder can be, there was a
    traceback, as in a folder that cannot be written.
    """
    (tmp_path / "study.toml").write_text(QUICK)
    done = run_here("check", "study.toml", "--out", "study.toml", cwd=tmp_path)
    assert (done.returncode, (tmp_path / "study.toml").read_text()) == (2, QUICK)
    assert "study.toml exists and is not a page" in done.stderr
    (tmp_path / "out").write_text("a file")
    done = run_here("check", "study.toml", "--open", "--no-browser", cwd=tmp_path)
    assert done.returncode == 2
    assert "out/study_check.html: cannot be written" in done.stderr.replace("\\", "/")
    for _ in range(2):
        assert run_here("check", "study.toml", "--out", "p.html", cwd=tmp_path).returncode == 0


def test_it_loads_nothing_that_solves_or_draws(tmp_path: Path) -> None:
    loaded = loaded_by("check", "studies/grenier2008.toml", "--out", str(tmp_path / "x.html"))
    assert "jinja2" in loaded
    assert not loaded & (SOLVE | DRAW - {"reports"})


def test_the_terminal_has_a_line_for_a_pin() -> None:
    """Links in the order of z, whatever the order of the profile's names."""
    study = pinstress.study_from((ROOT / "studies" / "clevis.toml").read_text())
    summary, *_ = describe(study)
    assert (
        "pin P: steel, 46 mm long, ⌀ 20, 7 segments, 1.112 N; loaded at LEFT, EYE, RIGHT; "
        "in contact with its lugs"
    ) in summary.splitlines()
    stepped, *_ = describe(pinstress.study_from(QUICK))
    assert "3.5 in long, ⌀ 2 to 4," in stepped


def test_a_page_below_a_file_is_refused_for_what_it_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "one.toml").write_text(ONE_PIN, encoding="utf-8")
    (tmp_path / "afile").write_text("", encoding="utf-8")
    page = tmp_path / "afile" / "page.html"
    assert run_command_line(["check", str(tmp_path / "one.toml"), "--out", str(page)]) == 2
    assert f"{page.parent} is a file, not a folder" in capsys.readouterr().err


def test_forces_that_only_a_run_finds_are_not_those_of_rest(tmp_path: Path) -> None:
    """A drop, and the ground loads of its reaction, had the leg's own weight as largest force."""
    page = page_of((ROOT / "studies" / "drop.toml").read_text(encoding="utf-8"), tmp_path)
    rows = [re.findall(r"<td[^>]*>(.*?)</td>", row) for row in re.findall("<tr>.*?</tr>", page)]
    planned = {tuple(row[:2]): row[-3:] for row in rows if len(row) == 7}
    assert {case for _, case in planned} == {"landing", "drag"}
    for (_, case), row in planned.items():
        assert row == ["301" if case == "landing" else "1", "–", "–"]
    assert page.count(": a run finds its forces</figcaption>") == 2
