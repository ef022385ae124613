"""Run every benchmark and print its table: `make bench`, or `python -m benchmarks assembly`.

With --record a table also goes to docs/measured/NAME.md, with the day and the machine, for the page
of the documentation that includes it.
"""

from __future__ import annotations

import sys

from benchmarks import (
    accuracy,
    calculix,
    coverage,
    failures,
    gear,
    growth,
    linear_solvers,
    modelling,
    models,
    motion_accuracy,
    ngsolve_peer,
    peers_motion,
    publications,
    recovery,
    shoulders,
    speed,
    tension,
)
from benchmarks.record import record

ALL = {
    "motion": speed.motion,
    "motion-accuracy": motion_accuracy.motion_accuracy,
    "assembly": speed.assembly,
    "solvers": linear_solvers.linear_solvers,
    "holding": modelling.holding,
    "terms": modelling.terms,
    "instants": modelling.instants,
    "fillet": accuracy.fillet,
    "recovery": recovery.recovery,
    "growth": growth.growth,
    "gear": gear.gear,
    "demo": speed.demo,
    "models": models.models,
    "shoulders": shoulders.shoulders,
    "coverage": coverage.contained,
    "corners": coverage.singular,
    "failures": failures.failures,
    "calculix": calculix.calculix,
    "ngsolve": ngsolve_peer.ngsolve,
    "tension": tension.tension,
    "peers-motion": peers_motion.peers_motion,
    "publications": publications.publications,
}


def main(arguments: list[str]) -> int:
    """Print the tables of the named benchmarks, or of all."""
    names = [a for a in arguments if a != "--record"]
    unknown = [n for n in names if n not in ALL]
    if unknown:
        print(f"no benchmark {unknown[0]!r}; there are {', '.join(ALL)}", file=sys.stderr)
        return 2
    for name in names or ALL:
        text = ALL[name]()
        print(f"\n## {name}\n\n{text}", flush=True)
        if "--record" in arguments:
            print(f"written: {record(name, text)}", file=sys.stderr)
    return 0


sys.exit(main(sys.argv[1:]))
