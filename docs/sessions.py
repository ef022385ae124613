"""Pages that show a terminal: their commands are run, and their output is compared.

In a page's ```toml, ```python and ```text blocks the first line is `# FILE`, or `# FILE,
continued`, if they are files; in its ```console blocks lines after `$ ` are commands, the others
what they print on stdout and then on stderr, where `...` stands for any lines. Numbers may differ
by a hundredth, and round-off by more; so may the number of designs that a search tries, which
round-off decides.

    python -m docs.sessions docs/tutorial.md

does the same and writes into the page what is printed now.
"""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

BLOCK = re.compile(r"^```(toml|python|text|console)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FILE = re.compile(r"# (?P<name>[\w.-]+)(?P<more>, continued)?$")
NUMBER = re.compile(r"[-−]?\d[\d,]*\.?\d*(?:e[-+]?\d+)?")
CLOSE, ROUND_OFF = 0.01, 1e-12
TRIED = re.compile(r"^(.* designs)\n(.* )\d+$", re.MULTILINE)  # of the row beneath
PROGRAMS = {"pinstress": (sys.executable, "-m", "pinstress"), "python": (sys.executable,)}
OTHERS = ("sed", "ls", "echo")  # other commands that may be shown


@dataclass(frozen=True)
class Step:
    """A command, what the page says it prints, and where in the page that stands."""

    command: str
    shown: str
    start: int
    end: int


@dataclass(frozen=True)
class Played:
    """A step, what it printed and its exit status."""

    step: Step
    printed: str
    status: int


def play(page: str, folder: Path) -> Iterator[Played]:
    """Write the files of a page into a folder and run its commands there, in the page's order."""
    last = 0
    for block in BLOCK.finditer(page):
        if block[1] != "console":
            _write(block[2], folder)
            continue
        for step in _steps(block):
            words = shlex.split(step.command)
            if words[0] in PROGRAMS:
                words = [*PROGRAMS[words[0]], *words[1:]]
            elif words[0] not in OTHERS:
                raise ValueError(f"a page may not run {words[0]}")
            words = [str(last) if word == "$?" else word for word in words]
            anew = os.environ | {"PINSTRESS_CACHE": ""}
            done = subprocess.run(words, cwd=folder, env=anew, capture_output=True, text=True)
            last = done.returncode
            lines = (done.stdout + done.stderr).splitlines()
            yield Played(step, "".join(f"{line.rstrip()}\n" for line in lines), last)


def _write(text: str, folder: Path) -> None:
    first, rest = text.split("\n", 1)
    found = FILE.match(first)
    if found is None:
        return  # shown only
    with (folder / found["name"]).open("a" if found["more"] else "w", encoding="utf-8") as file:
        file.write(rest)


def _steps(block: re.Match[str]) -> Iterator[Step]:
    for part in re.finditer(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", block[2], re.MULTILINE):
        start = block.start(2)
        yield Step(part[1], part[2], start + part.start(2), start + part.end(2))


def differences(shown: str, printed: str) -> list[str]:
    """Lines that a page shows and that are not printed, in words; none if all is well."""
    shown, printed = (TRIED.sub(r"\1\n\2", text) for text in (shown, printed))
    parts = re.split(r"^\.\.\.\n", shown, flags=re.MULTILINE)
    lines, at = printed.splitlines(), 0
    for k, part in enumerate(parts):
        want = part.splitlines()
        places = range(at, len(lines) - len(want) + 1) if k else [0]
        if k and k == len(parts) - 1:
            places = [len(lines) - len(want)]
        place = next((i for i in places if _alike(want, lines[i : i + len(want)])), None)
        if place is None or place < at:
            return [f"shown:\n{part}", f"printed:\n{printed}"]
        at = place + len(want)
    if at < len(lines) and len(parts) == 1:
        return [f"not shown: {line}" for line in lines[at:]]
    return []


def _alike(shown: list[str], printed: list[str]) -> bool:
    return len(shown) == len(printed) and all(
        _same(a, b) for a, b in zip(shown, printed, strict=True)
    )


def _same(shown: str, printed: str) -> bool:
    """The same words, and numbers close to each other."""
    if NUMBER.sub("#", shown).split() != NUMBER.sub("#", printed).split():
        return False
    pairs = zip(NUMBER.findall(shown), NUMBER.findall(printed), strict=True)
    return all(_close(_value(a), _value(b)) for a, b in pairs)


def _value(text: str) -> float:
    return float(text.replace(",", "").replace("−", "-"))


def _close(a: float, b: float) -> bool:
    return abs(a - b) <= max(CLOSE * max(abs(a), abs(b)), ROUND_OFF)


def renewed(page: str, played: list[Played]) -> str:
    """The page with what is printed now; what it leaves out with `...` stays as it is shown."""
    for one in reversed(played):
        if "...\n" not in one.step.shown:
            page = page[: one.step.start] + one.printed + page[one.step.end :]
    return page


def main(paths: list[str]) -> None:
    """Renew pages in place."""
    for path in map(Path, paths):
        page = path.read_text(encoding="utf-8")
        with tempfile.TemporaryDirectory() as folder:
            path.write_text(renewed(page, list(play(page, Path(folder)))), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
