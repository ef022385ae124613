"""Break what users give and end what they run:

    python -m tests.fuzz [--mutants 2000] [--files 200] [--kills 50] [--seed 1] [--record]
    python -m tests.fuzz grammar [--count 500] [--seed 7] [--record]

The second draws valid studies instead: each must run.

Mutants are of shipped studies (--mutants) and of tables, CAD files and meshes beside a study
(--files). Every one is checked, and moved if it can be; one in some is also run. --kills ends runs
at random moments. Without any number all three are done, as often as named here. What ends badly
is kept in a folder.
"""

from __future__ import annotations

import argparse
import collections
import sys
import tempfile
from collections.abc import Iterable
from functools import partial
from pathlib import Path

from benchmarks.record import record
from geometry.mesh.gmsh_session import silence
from tests.fuzz import grammar
from tests.fuzz.bodies import write_files
from tests.fuzz.hunt import Break, break_file, break_study, hunt
from tests.fuzz.kills import kill, whole_run

Row = tuple[str | int, ...]
ENDS = {"refused": "2", "done": "0", "not all reached": "1", "numerics": "3", "wrong": "wrong"}
MUTANTS = ("of", "command", "times", *ENDS)
CLASSES = ("class", "studies", *grammar.KINDS, "defects")
REASONS = ("ended", "times", "seeds", "judged", "said")
KILLS = ("ended at random", "times", "at its end before", "folder absent", "old", "new",
         "half-written", "processes left", "status not 130")  # fmt: skip


def main() -> int:
    """The number of mutants and kills that ended badly, at most 1."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("what", nargs="?", choices=["grammar"], help="valid studies")
    for what in ("mutants", "files", "kills"):
        parser.add_argument(f"--{what}", type=int, default=0)
    parser.add_argument("--count", type=int, default=500, help="of valid studies")
    parser.add_argument("--seed", type=int, default=1, help="of the first of each")
    parser.add_argument("--runs", type=int, default=10, help="one in so many is run, too")
    parser.add_argument("--record", action="store_true", help="also into docs/measured")
    asked = parser.parse_args()
    if asked.what == "grammar":
        return valid(asked)
    if not (asked.mutants or asked.files or asked.kills):
        asked.mutants, asked.files, asked.kills = 2000, 200, 50
    keep = Path(tempfile.mkdtemp(prefix="pinstress-fuzz-"))
    wrong: list[str] = []
    if asked.mutants:
        rows = mutants("studies", break_study, asked.seed, asked.mutants, asked.runs, keep, wrong)
        tell("mutants", MUTANTS, rows, asked)
    if asked.files:
        with silence():
            write_files(keep / "whole")
        broken = partial(break_file, keep / "whole")
        rows = mutants("files", broken, asked.seed, asked.files, asked.runs, keep, wrong)
        tell("files", MUTANTS, rows, asked)
    if asked.kills:
        ends = [kills_row(jobs, asked.seed, asked.kills, keep, wrong) for jobs in (1, 2)]
        tell("kills", KILLS, ends, asked)
    print(f"Those that ended badly are in {keep}." if wrong else "None ended badly.")
    return int(bool(wrong))


def valid(asked: argparse.Namespace) -> int:
    """Run studies drawn at random; the number of defects, at most 1."""
    keep = Path(tempfile.mkdtemp(prefix="pinstress-fuzz-"))
    found = []
    for seed in range(asked.seed, asked.seed + asked.count):
        found.append(one := grammar.ended(seed, keep))
        if not one.judged:
            print(f"study {seed}: {one.kind}: {one.message}", flush=True)
    options = f"grammar --count {asked.count}"
    tell("grammar", CLASSES, grammar.classes_table(found), asked, options)
    tell("grammar-reasons", REASONS, grammar.reasons_table(found), asked, options)
    wrong = sum(not one.judged for one in found)
    print(f"{wrong} of {len(found)} are defects, in {keep}." if wrong else "No defects.")
    return min(wrong, 1)


def tell(
    part: str, columns: Row, rows: Iterable[Row], asked: argparse.Namespace, options: str = ""
) -> None:
    """Print a table, and record it if that is asked for."""
    lines = [columns, ("---",) * len(columns), *rows]
    text = "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)
    print(f"\n{text}\n", flush=True)
    if asked.record:
        command = f"python -m tests.fuzz {options or f'--{part} {getattr(asked, part)}'}"
        command += f" --seed {asked.seed}"
        command += f" --runs {asked.runs}" * (part in ("mutants", "files"))
        print(f"written: {record(f'fuzz-{part}', text, command)}", file=sys.stderr)


def mutants(
    what: str, broken: Break, seed: int, many: int, every: int, keep: Path, wrong: list[str]
) -> list[Row]:
    """Rows of the table, one for each command; what ends badly is printed as it comes."""
    place = keep / what
    place.mkdir()
    found: dict[tuple[str, str], collections.Counter[str]] = {}
    for i in range(many):
        for case in hunt(seed + i, place, i % every == 0, broken):
            kind = what if what == "studies" else Path(case.of).suffix
            end = "wrong" if case.end.wrong else str(case.end.status)
            found.setdefault((kind, case.command), collections.Counter())[end] += 1
            if case.end.wrong:
                wrong.append(str(case))
                print(f"{case}\n{case.end.err[-1500:]}\n", flush=True)
    return [
        (*name, counts.total(), *(counts[end] for end in ENDS.values()))
        for name, counts in sorted(found.items())
    ]


def kills_row(jobs: int, seed: int, many: int, keep: Path, wrong: list[str]) -> Row:
    """A row of the table of kills."""
    folder = keep / f"kills{jobs}"
    folder.mkdir()
    longest = whole_run(folder, jobs)
    ended = []
    for i in range(many):
        ended.append(one := kill(seed + i, folder, jobs, longest))
        if one.wrong:
            wrong.append(str(one))
            print(f"kill {seed + i}: {one}", flush=True)
    found = collections.Counter(k.found for k in ended)
    return (
        f"run --jobs {jobs}",
        many,
        sum(k.ended for k in ended),
        *(found[f] for f in ("absent", "old", "new", "half")),
        sum(k.left for k in ended),
        sum("status" in k.wrong for k in ended),
    )


if __name__ == "__main__":
    raise SystemExit(main())
