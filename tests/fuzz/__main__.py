"""Break the shipped studies: python -m tests.fuzz --mutants 2000 [--seed 1] [--runs 10]

Every mutant is checked, one in some is also run; those that end badly are kept in a folder.
"""

from __future__ import annotations

import argparse
import collections
import tempfile
from pathlib import Path

from tests.fuzz.hunt import hunt


def main() -> int:
    """The number of mutants that ended badly, at most 1."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mutants", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1, help="of the first mutant")
    parser.add_argument("--runs", type=int, default=10, help="one in so many is run, too")
    asked = parser.parse_args()
    keep = Path(tempfile.mkdtemp(prefix="pinstress-fuzz-"))
    found: collections.Counter[str] = collections.Counter()
    for i in range(asked.mutants):
        for case in hunt(asked.seed + i, keep, run_too=i % asked.runs == 0):
            found[f"{case.command} {case.end.status}"] += 1
            if case.end.wrong:
                found["wrong"] += 1
                print(f"{case}\n{case.end.err[-1500:]}\n", flush=True)
    print(", ".join(f"{name}: {n}" for name, n in sorted(found.items())))
    print(f"Those that ended badly are in {keep}." if found["wrong"] else "None ended badly.")
    return int(found["wrong"] > 0)


if __name__ == "__main__":
    raise SystemExit(main())
