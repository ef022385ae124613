"""One mutant, by its number: made, checked, perhaps run."""

from __future__ import annotations

import random
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from tests.conftest import ROOT
from tests.fuzz import bodies
from tests.fuzz.child import End, run
from tests.fuzz.mutate import STUDY, TABLE, mutant
from tests.fuzz.mutate_file import damaged

STUDIES = sorted(
    [*(ROOT / "studies").glob("*.toml"), *(ROOT / "studies" / "failures").glob("*.toml")]
)
QUICK = ("--tolerance", "0.5", "--memory-limit", "300")


Break = Callable[[Path, random.Random], str]


@dataclass(frozen=True)
class Case:
    """A command on a mutant of a study, or of a file beside one, and how it ended."""

    seed: int
    of: str
    command: str
    end: End

    def __str__(self) -> str:
        return f"mutant {self.seed} of {self.of}, {self.command}: {self.end.wrong}"


def break_study(folder: Path, rng: random.Random) -> str:
    """Put a shipped study that is broken, or a table beside it, in a folder; its name."""
    study = rng.choice(STUDIES)
    for path in study.parent.iterdir():
        if path.suffix == ".msh":
            shutil.copy(path, folder)
        elif path.name == study.stem:
            shutil.copytree(path, folder / path.name)
    shutil.copy(study, folder / "study.toml")
    beside = [*folder.rglob("*.csv"), *folder.rglob("*.msh")]
    named = sorted(p for p in beside if p.name in study.read_text())
    if named and rng.random() < 0.25:
        path, kinds = rng.choice(named), TABLE
    else:
        path, kinds = folder / "study.toml", STUDY
    path.write_bytes(mutant(path.read_text(), kinds, rng))
    return study.name


def break_file(whole: Path, folder: Path, rng: random.Random) -> str:
    """Put a study in a folder, with a file of `whole` (tests.fuzz.bodies) that is broken; its
    name.
    """
    name = rng.choice(rng.choice(bodies.KINDS))
    shutil.copytree(whole, folder, dirs_exist_ok=True)
    (folder / "study.toml").write_text(bodies.study(name))
    path = folder / name
    path.write_bytes(damaged(path.read_bytes(), path.suffix == ".csv", rng))
    return name


def hunt(seed: int, place: Path, run_too: bool, broken: Break = break_study) -> Iterator[Case]:
    """Break something and give it to the commands. What ends well is removed from `place` again.
    run_too: whether what can be run is.
    """
    folder = place / f"{seed}"
    folder.mkdir()
    name = broken(folder, random.Random(seed))
    bad = False
    commands = [["check", "study.toml"]]
    while commands:
        arguments = commands.pop(0)
        case = Case(seed, name, arguments[0], run(folder, arguments))
        bad |= bool(case.end.wrong)
        yield case
        if arguments[0] == "check" and case.end.status == 0:
            commands.append(["loads", "study.toml"])
        elif arguments[0] == "loads" and case.end.status == 0 and run_too:
            jobs = "1" if broken is break_study else "2"
            commands.append(["run", "study.toml", "--no-cache", *QUICK, "--jobs", jobs])
    if not bad:
        shutil.rmtree(folder)
        for end in (".out", ".err"):
            folder.with_suffix(end).unlink()
