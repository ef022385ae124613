"""A report.html that someone else may have written opens no address and no file.

Before, `plots` and `pdf` fetched the data of specifications (http and file), and pictures in
drawings, and typst read files of the current folder.

What is independent: a server of HTTP in a process of its own, whose log is read.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

import reports.plots.draw as drawing
from pinbase.errors import Damaged
from reports.plots.draw import svg
from reports.plots.self_contained import require_no_address, require_self_contained
from tests.support.each import each
from tests.support.programs.command_line import run_here
from tests.support.results.mutants import repacked
from tests.support.results.small_folder import SECRET


@pytest.fixture
def server(tmp_path: Path) -> Iterator[tuple[str, Callable[[], str]]]:
    """The address of a server that is another process, and what it was asked for."""
    log = tmp_path / "log"
    with log.open("w") as file:
        process = subprocess.Popen(
            [sys.executable, "-u", "-m", "http.server", "0", "--bind", "127.0.0.1"],
            cwd=tmp_path, stdout=subprocess.PIPE, stderr=file, text=True,
        )  # fmt: skip
    assert process.stdout is not None
    port = process.stdout.readline().partition(" port ")[2].split()[0]
    try:
        yield f"http://127.0.0.1:{port}", log.read_text
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


def specs(address: str, file: str) -> dict[str, Any]:
    here = {"x": {"value": 0}, "y": {"value": 0}}
    values = {"values": [{"a": 1, "u": address}, {"a": 2, "u": file}]}
    lookup = [{"lookup": "a", "from": {"data": {"url": address}, "key": "a", "fields": ["b"]}}]
    return {
        "data": {"data": {"url": address}, "mark": "point"},
        "file": {"data": {"url": f"file://{file}"}, "mark": "point"},
        "path": {"data": {"url": file}, "mark": "point"},
        "lookup": {"data": values, "transform": lookup, "mark": "point"},
        "datum": {"data": values, "mark": "image", "encoding": {**here, "url": {"field": "u"}}},
        "value": {"data": values, "mark": {"type": "image", "url": address}, "encoding": here},
        "link": {"data": values, "mark": "point", "encoding": {"href": {"field": "u"}}},
        "layer": {"layer": [{"data": {"url": address}, "mark": "point"}]},
        "concat": {"vconcat": [{"data": {"url": address}, "mark": "point"}]},
    }


def test_a_plot_with_an_address_is_refused() -> None:
    for name, spec in specs("http://127.0.0.1:9/x", "/etc/passwd").items():
        with pytest.raises(Damaged, match="no plot of pinstress has"):
            require_no_address(spec, name)


DRAWINGS = {
    "image": '<image href="{}" width="9" height="9"/>',
    "old": '<image xlink:href="{}" width="9" height="9"/>',
    "upper": '<IMAGE href="{}"/>',
    "use": '<use href="{}#a"/>',
    "fill": '<rect fill="url({}#a)" width="9" height="9"/>',
    "filter": '<filter id="f"><feImage href="{}"/></filter>',
    "quoted": "<rect style=\"fill: url( '{}' )\"/>",
    "encoded": '<rect style="fill: &#117;rl({})"/>',
    "style": "<style>rect {{ fill: url({}) }}</style>",
    "import": "<style>@import '{}';</style>",
    "html": '<foreignObject><img src="{}"/></foreignObject>',
    "script": "<script>fetch('{}')</script>",
}
HEAD = (
    '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
    'viewBox="0 0 9 9"{}>'
)


@each("way", DRAWINGS)
def test_a_drawing_with_an_address_is_refused(way: str) -> None:
    drawn = HEAD.format("") + DRAWINGS[way].format("http://127.0.0.1:9/x") + "</svg>"
    with pytest.raises(Damaged):
        require_self_contained(drawn, "it")


def test_a_drawing_declares_no_type_and_may_speak_of_addresses() -> None:
    entity = (
        '<!DOCTYPE svg [<!ENTITY a SYSTEM "file:///etc/passwd">]>' + HEAD.format("") + "&a;</svg>"
    )
    sheet = '<?xml-stylesheet href="http://127.0.0.1:9/"?>' + HEAD.format("") + "</svg>"
    for drawn in (entity, sheet, "<svg", ""):
        with pytest.raises(Damaged):
            require_self_contained(drawn, "it")
    fine = (
        HEAD.format(' aria-label="url(http://a)"')
        + '<defs><pattern id="h"/></defs><rect fill="url(#h)"/><text>url(http://a)</text></svg>'
    )
    require_self_contained(fine, "it")


@pytest.mark.slow
def test_no_address_is_opened(
    server: tuple[str, Callable[[], str]], folder: Path, tmp_path: Path
) -> None:
    address, asked = server
    page = folder / "report.html"
    text = page.read_text(encoding="utf-8")
    before = sorted(p.name for p in folder.iterdir())

    def given(plots: dict[str, Any], pictures: str) -> None:
        def drawn(content: bytes) -> bytes:
            paper = json.loads(content)
            paper["pins"][0]["drawing"] = pictures
            return json.dumps(paper).encode()

        def named(content: bytes) -> bytes:
            return json.dumps(json.loads(content) | plots).encode()

        page.write_text(repacked(repacked(text, "paper", drawn), "plots", named), encoding="utf-8")

    for name, spec in specs(f"{address}/d.json", str(tmp_path / "secret")).items():
        given({"surface.landing.B": [name, spec]}, HEAD.format("") + "</svg>")
        for command in ("plots", "pdf"):
            made = run_here(command, "out", cwd=tmp_path)
            assert made.returncode == 2, made.stderr
            assert "no plot of pinstress has" in made.stderr
    for name, part in DRAWINGS.items():
        given({}, HEAD.format("") + part.format(f"{address}/{name}.png") + "</svg>")
        assert run_here("pdf", "out", cwd=tmp_path).returncode == 2
    assert sorted(p.name for p in folder.iterdir()) == before
    assert asked() == ""


@pytest.mark.slow
def test_the_engine_itself_is_allowed_no_address(
    server: tuple[str, Callable[[], str]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A second barrier: where the first misses one. That the server would be asked is shown by what
    draws SVG, which has no such switch.
    """
    import vl_convert

    address, asked = server
    monkeypatch.setattr(drawing, "require_no_address", lambda *_: None)
    for spec in specs(f"{address}/d.json", str(tmp_path / "secret")).values():
        with suppress(ValueError):  # what it opens is asked for, whatever it says
            svg(spec)
    assert asked() == ""
    picture = HEAD.format("") + f'<image href="{address}/asked.png" width="9" height="9"/></svg>'
    with suppress(ValueError):
        vl_convert.svg_to_png(picture)
    assert "GET /asked.png" in asked()


def test_the_pdf_reads_no_file_of_the_current_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import typst

    from reports.pdf.typeset import FIXED_DATE, _compiled

    (tmp_path / "secret").write_bytes(SECRET)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(typst.TypstError, match="not found"):
        _compiled({"main": b'#read("secret")'}, FIXED_DATE)
