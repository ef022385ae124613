"""Run every benchmark and print its table: `make bench`, or `python -m benchmarks assembly`.

Benchmarks of accuracy run first, one on each core; those that measure times follow one by one. With
--record a table is also written to docs/measured/NAME.md, with the day and the machine, for the
page of the documentation that includes it. `--pins N` is the number of pins that `places` draws at
random, `--edits N` the number of edits.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from functools import partial

from benchmarks import failures, publications
from benchmarks.cuts import cut, cut_charts, cut_coverage
from benchmarks.joints import (
    cells,
    edge_peak,
    foundation,
    joint,
    joint_ccx,
    joint_derivatives,
    lugs,
    narrow_arcs,
    places,
    shanks,
    together,
)
from benchmarks.motion import motion_accuracy, peers_drop, peers_motion, scissor
from benchmarks.pins import (
    accuracy,
    coverage,
    growth,
    limit_load,
    linear_solvers,
    modelling,
    models,
    planes,
    recesses,
    recovery,
    shapes,
    shoulders,
    tension,
)
from benchmarks.record import record
from benchmarks.runs import (
    cluster,
    designs_page,
    edits,
    estimates,
    fits,
    force_tables,
    gear,
    least_weight,
    linkages,
    page,
    reliability,
    speed,
    sweep,
)
from benchmarks.solids import calculix, expected, ngsolve_peer
from benchmarks.space import many_bodies, peers_space
from pinbase.processes.pool import Job, ProcessDied, Tell, cores, in_parallel

ACCURACY = {
    "coverage": coverage.contained,  # first, since it takes longest
    "failures": failures.failures,
    "tension": tension.tension,
    "corners": coverage.singular,
    "cut-charts": cut_charts.cut_charts,
    "cut-scatter": cut_charts.cut_scatter,
    "cut-pins": cut_coverage.cut_pins,
    "cut-kinds": cut_coverage.cut_kinds,
    "holding": modelling.holding,
    "terms": modelling.terms,
    "instants": modelling.instants,
    "recovery": recovery.recovery,
    "expected": expected.expected,
    "edge-peak": edge_peak.edge_peak,
    "together": together.together,
    "places": places.places,
    "cells": cells.cells,
    "narrow-arcs": narrow_arcs.narrow_arcs,
    "shanks": shanks.shanks,
    "lugs": lugs.lugs,
    "fillet": accuracy.fillet,
    "reliability": reliability.reliability,
    "publications": publications.publications,
}
TIMES = {
    "motion": speed.motion,
    "scissor": scissor.scissor,
    "space": many_bodies.space,
    "linkages": linkages.linkages,
    "motion-accuracy": motion_accuracy.motion_accuracy,
    "assembly": speed.assembly,
    "solvers": linear_solvers.linear_solvers,
    "planes": planes.planes,
    "growth": growth.growth,
    "gear": gear.gear,
    "fits": fits.fits,
    "joint": joint.joint,
    "foundation": foundation.foundation,
    "joint-ccx": joint_ccx.joint_ccx,
    "limit_load": limit_load.limit_load,
    "cut": cut.cut,
    "derivatives": joint_derivatives.price,
    "least-weight": least_weight.saved,
    "estimates": estimates.estimates,
    "demo": speed.demo,
    "page": page.page,
    "designs-page": designs_page.designs_page,
    "shapes": shapes.shapes,
    "recesses": recesses.recesses,
    "models": models.models,
    "shoulders": shoulders.shoulders,
    "edits": edits.edits,
    "sweep": sweep.sweep,
    "force-tables": force_tables.force_tables,
    "cluster": cluster.cluster,
    "calculix": calculix.calculix,
    "ngsolve": ngsolve_peer.ngsolve,
    "peers-motion": peers_motion.peers_motion,
    "peers-drop": peers_drop.peers_drop,
    "peers-space": peers_space.peers_space,
}
ALL = ACCURACY | TIMES
COUNTED = ("--pins", "places", places.places), ("--edits", "edits", edits.edits)
ABREAST = max(2, cores())  # with 1, benchmarks would not run in processes of their own


def main(arguments: list[str]) -> int:
    """Print the tables of the named benchmarks, or of all."""
    for option, name, benchmark in COUNTED:
        if option in arguments:
            at = arguments.index(option)
            ALL[name] = partial(benchmark, int(arguments[at + 1]))
            arguments = arguments[:at] + arguments[at + 2 :]
    names = [a for a in arguments if a != "--record"]
    unknown = [n for n in names if n not in ALL]
    if unknown:
        print(f"no benchmark {unknown[0]!r}; there are {', '.join(ALL)}", file=sys.stderr)
        return 2
    start, status = time.perf_counter(), 0
    for name, text in _made(names or list(ALL)):
        if isinstance(text, ProcessDied):
            print(f"{name}: {text.reason}", file=sys.stderr)
            status = 3
            continue
        print(f"\n## {name}\n\n{text}", flush=True)
        if "--record" in arguments:
            print(f"written: {record(name, text)}", file=sys.stderr)
        print(f"{time.perf_counter() - start:.0f} s by now", file=sys.stderr)
    return status


def _made(names: list[str]) -> Iterator[tuple[str, str | ProcessDied]]:
    def job(name: str) -> Job[str]:
        def work(_: Tell) -> str:
            return ALL[name]()

        return Job(name, work)

    first = [n for n in names if n in ACCURACY]
    yield from zip(first, in_parallel([job(n) for n in first], ABREAST), strict=True)
    for name in names:
        if name in TIMES:  # each in its own process, so that memory is that of one benchmark
            (made,) = in_parallel([job(name)], ABREAST)
            yield name, made


sys.exit(main(sys.argv[1:]))
