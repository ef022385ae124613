"""One mutant, by its number: made, checked, perhaps run."""

from __future__ import annotations

import random
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tests.conftest import ROOT
from tests.fuzz.child import End, run
from tests.fuzz.mutate import STUDY, TABLE, mutant

STUDIES = sorted(
    [*(ROOT / "studies").glob("*.toml"), *(ROOT / "studies" / "failures").glob("*.toml")]
)
QUICK = ("--no-pictures", "--tolerance", "0.5", "--jobs", "1", "--memory-limit", "300")


@dataclass(frozen=True)
class Case:
    """A command on a mutant, and how it ended."""

    seed: int
    study: str
    command: str
    end: End

    def __str__(self) -> str:
        return f"mutant {self.seed} of {self.study}, {self.command}: {self.end.wrong}"


def hunt(seed: int, place: Path, run_too: bool) -> Iterator[Case]:
    """Break a study, or a table beside it, and give it to the commands. What ends well is removed
    from `place` again.
    """
    rng = random.Random(seed)
    study = rng.choice(STUDIES)
    folder = place / f"{seed}"
    folder.mkdir()
    for path in study.parent.iterdir():
        if path.suffix == ".msh":
            shutil.copy(path, folder)
        elif path.name == study.stem:
            shutil.copytree(path, folder / path.name)
    shutil.copy(study, folder / "study.toml")
    named = [p for p in folder.rglob("*.csv") if p.name in study.read_text()]
    if named and rng.random() < 0.25:
        path, kinds = rng.choice(named), TABLE
    else:
        path, kinds = folder / "study.toml", STUDY
    path.write_bytes(mutant(path.read_text(), kinds, rng))
    bad = False
    commands = [["check", "study.toml"]]
    while commands:
        arguments = commands.pop(0)
        case = Case(seed, study.name, arguments[0], run(folder, arguments))
        bad |= bool(case.end.wrong)
        yield case
        if arguments[0] == "check" and case.end.status == 0:
            commands.append(["loads", "study.toml", "--no-pictures"])
        elif arguments[0] == "loads" and case.end.status == 0 and run_too:
            commands.append(["run", "study.toml", *QUICK])
    if not bad:
        shutil.rmtree(folder)
        for end in (".out", ".err"):
            folder.with_suffix(end).unlink()
