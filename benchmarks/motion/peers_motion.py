"""Our reactions compared with those of exudyn and MuJoCo, two codes that share nothing with ours.

Our code solves the loop equations at each instant; the others integrate every body and constraint
in time. Their errors decrease with the square of their step (exudyn's time step, MuJoCo's time
constant), so that results of two steps can be extrapolated to a step of zero.
"""

from __future__ import annotations

import math
import time
from functools import partial

import numpy as np

from benchmarks.motion.peers import Case, Code, Found, four_bar, landing_gear, ours
from benchmarks.motion.scissor import HIGH, LOW, SPAN, lift
from benchmarks.timing import seconds, table
from loads import CycloidalDrive, mobility
from pinbase.arrays import Floats

MISSING = (
    "exudyn and mujoco are not installed: "
    ".venv/bin/pip install --require-hashes -r requirements-bench.lock"
)

STAGES = (2, 6)  # of the scissor lifts

Quantities = dict[
    str, Floats
]  # (T, 2) of connections, or of sums of those that share; (T, 1) drive


def peers_motion() -> str:
    """Return the tables of reactions and drives of the landing gear, a four-bar and a scissor lift,
    by three codes.
    """
    try:
        from benchmarks.motion.peers_exudyn import EXUDYN
        from benchmarks.motion.peers_mujoco import MUJOCO
    except ModuleNotFoundError:
        return MISSING
    codes = (EXUDYN, MUJOCO)
    compared = [_compared(case, codes) for case in (landing_gear(), four_bar(), _lift(2))]
    return "\n\n".join([*compared, _cost([_lift(stages) for stages in STAGES], codes)])


def _lift(stages: int) -> Case:
    law = CycloidalDrive(LOW, HIGH, SPAN)
    times = np.linspace(0.0, SPAN, 41)[1:]
    return Case(f"scissor lift of {2 * stages + 3} bodies", lift(stages), law, times)


def _cost(cases: list[Case], codes: tuple[Code, ...]) -> str:
    """Return the table of times by the number of bodies; the other codes take the fewest of their
    steps.
    """
    rows: list[tuple[object, ...]] = []
    for case in cases:
        reference, count = _quantities(case, ours(case)), len(case.linkage.bodies)
        rows.append((count, "ours", "-", seconds(partial(ours, case)), "-"))
        for code in codes:
            start = time.perf_counter()
            found = code.solve(case, code.steps[0])
            spent = time.perf_counter() - start
            off = _largest(reference, _quantities(case, found, code.shares))
            rows.append((count, code.name, code.steps[0], spent, off))
    head = ("bodies", "code", "steps per instant", "s", "difference")
    return "\n\n".join(
        ("### Cost", f"{len(cases[0].times)} instants of scissor lifts:", table(head, rows))
    )


def _compared(case: Case, codes: tuple[Code, ...]) -> str:
    """Return the tables of one case."""
    reference = _quantities(case, ours(case))
    finest: list[Quantities] = []
    steps: list[tuple[object, ...]] = []
    agreement = []
    for code in codes:
        results = [_quantities(case, code.solve(case, n), code.shares) for n in code.steps]
        off = [_largest(reference, result) for result in results]
        for i, (n, size) in enumerate(zip(code.steps, off, strict=True)):
            steps.append((code.name, n, size, f"{math.log2(off[i - 1] / size):.2f}" if i else ""))
        before, last = results[-2:]
        limit = _largest(reference, {k: (4.0 * last[k] - before[k]) / 3.0 for k in last})
        steps.append((code.name, "extrapolated", limit, ""))
        finest.append(last)
        agreement.append(f"{off[-1]:.1g} with {code.name} ({limit:.1g} extrapolated)")
    rows = [
        (
            name,
            f"{_peak(values):.7g}",
            *(f"{_peak(f[name]):.7g}" if name in f else "" for f in finest),
            *(_difference(values, f[name]) if name in f else "" for f in finest),
        )
        for name, values in reference.items()
    ]
    names = [code.name for code in codes]
    return "\n\n".join(
        (
            f"### {case.name}\n\nPeaks (N, N m) and largest differences relative to the peak, "
            f"over {len(case.times)} instants:",
            table(("", "ours", *names, *(f"{name} off by" for name in names)), rows),
            "The largest difference of all, by the steps of the other code per instant:",
            table(("", "steps", "difference", "order"), steps),
            f"The {case.name} agrees to {' and '.join(agreement)}.",
        )
    )


def _quantities(case: Case, found: Found, shares: bool = True) -> Quantities:
    """Return the quantities that are compared; without `shares` only those that statics
    determines.
    """
    forces = {c.name: found.forces[:, i] for i, (_, c) in enumerate(case.linkage.connections)}
    shared = mobility(case.linkage).shared
    out = {name: force for name, force in forces.items() if shares or name not in shared}
    for joint in case.linkage.joints:
        together = [c.name for c in joint.connections if c.name in shared]
        if together:
            out[" + ".join(together)] = np.sum([forces[name] for name in together], axis=0)
    return out | {"drive": found.drive[:, None]}


def _peak(values: Floats) -> float:
    return float(np.linalg.norm(values, axis=1).max())


def _difference(reference: Floats, values: Floats) -> float:
    return _peak(values - reference) / _peak(reference)


def _largest(reference: Quantities, found: Quantities) -> float:
    return max(_difference(reference[name], values) for name, values in found.items())
