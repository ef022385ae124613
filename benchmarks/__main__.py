"""Run every benchmark and print its table: `make bench`, or `python -m benchmarks assembly`."""

from __future__ import annotations

import sys

from benchmarks import (
    accuracy,
    calculix,
    coverage,
    failures,
    motion_accuracy,
    peers_motion,
    publications,
    shoulders,
    speed,
)

ALL = {
    "motion": speed.motion,
    "motion-accuracy": motion_accuracy.motion_accuracy,
    "assembly": speed.assembly,
    "solvers": speed.solvers,
    "fillet": accuracy.fillet,
    "demo": speed.demo,
    "shoulders": shoulders.shoulders,
    "coverage": coverage.contained,
    "corners": coverage.singular,
    "failures": failures.failures,
    "calculix": calculix.calculix,
    "peers-motion": peers_motion.peers_motion,
    "publications": publications.publications,
}


def main(names: list[str]) -> int:
    """Print the tables of the named benchmarks, or of all."""
    unknown = [n for n in names if n not in ALL]
    if unknown:
        print(f"no benchmark {unknown[0]!r}; there are {', '.join(ALL)}", file=sys.stderr)
        return 2
    for name in names or ALL:
        print(f"\n## {name}\n\n{ALL[name]()}", flush=True)
    return 0


sys.exit(main(sys.argv[1:]))
