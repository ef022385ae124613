"""Ten machines in space compared with exudyn and MuJoCo: every component of every joint and drive.

`python -m benchmarks.space.peers_space` writes the other codes' results to
tests/loads/space/peers/.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from benchmarks.space import recorded
from benchmarks.space.machines import MACHINES
from benchmarks.space.ours import ours
from benchmarks.space.peer_forces import PeerForces
from benchmarks.timing import table

MISSING = (
    "exudyn and mujoco are not installed: "
    ".venv/bin/pip install --require-hashes -r requirements-bench.lock"
)
STEPS = 80  # of exudyn between two instants, doubled until its error is small enough
MAX_ERROR = 1e-7  # of the extrapolated forces, relative to the largest
MAX_STEPS = 1280  # with more steps, the errors of exudyn's iteration grow
MUJOCO_STEPS = (20, 31)  # closed positions between two instants: two paths to the same position


def peers_space() -> str:
    """Return the largest differences of ours from each other code, and of the other codes from each
    other.
    """
    try:
        results = peers()
    except ModuleNotFoundError:
        return MISSING
    rows: list[tuple[object, ...]] = []
    for name in MACHINES:
        own = ours(MACHINES[name](), recorded.instants(name))
        (exudyn, error), (mujoco, other) = (results[code][name] for code in ("exudyn", "mujoco"))
        rows.append(
            (
                name,
                len(MACHINES[name]()["joints"]),
                own.difference(mujoco),
                other,
                own.difference(exudyn),
                error,
                mujoco.difference(exudyn),
            )
        )
    head = ("machine", "joints", "ours − MuJoCo", "its error", "ours − exudyn", "its error")
    told = (
        f"Largest differences of all points, forces, moments and drives at {recorded.INSTANTS} "
        "instants, relative to the largest of their kind in the machine. The error of "
        "MuJoCo is what another path to the same positions changes; that of exudyn by what its "
        "extrapolated forces change when its steps are halved:"
    )
    return f"{told}\n\n{table((*head, 'MuJoCo − exudyn'), rows)}"


def peers() -> dict[str, dict[str, tuple[PeerForces, float]]]:
    """Return the forces of every machine by exudyn and MuJoCo, with their errors."""
    return {
        "exudyn": {name: _by_exudyn(name) for name in MACHINES},
        "mujoco": {name: _by_mujoco(name) for name in MACHINES},
    }


def _by_mujoco(name: str) -> tuple[PeerForces, float]:
    """Return the forces by MuJoCo, and their difference from those by another path to the same
    positions.
    """
    from benchmarks.space.peers_mujoco import solve

    runs = []
    for steps in MUJOCO_STEPS:
        end = MACHINES[name]()["duration"]
        forces = solve(MACHINES[name](), np.linspace(0.0, end, steps * recorded.INSTANTS + 1)[1:])
        runs.append(forces.every(steps))
    return runs[0], runs[0].difference(runs[1])


def _by_exudyn(name: str) -> tuple[PeerForces, float]:
    """Return the forces by exudyn, extrapolated to a step of zero, and their change when steps are
    halved.
    """
    from benchmarks.space.peers_exudyn import solve

    times, steps = recorded.instants(name), 4 * STEPS
    runs = [solve(MACHINES[name](), times, steps // k) for k in (4, 2, 1)]
    before, after = (_limit(*pair) for pair in pairwise(runs))
    error = before.difference(after)
    while error > MAX_ERROR and steps < MAX_STEPS:
        steps *= 2
        runs.append(solve(MACHINES[name](), times, steps))
        finer = _limit(*runs[-2:])
        error, after = after.difference(finer), finer
    return after, error


def _limit(coarse: PeerForces, fine: PeerForces) -> PeerForces:
    """Return two results of second order, the second with half the step, extrapolated to a step of
    zero.
    """
    return PeerForces(
        *((4.0 * getattr(fine, k) - getattr(coarse, k)) / 3.0 for k in PeerForces.fields())
    )


if __name__ == "__main__":
    for code, of_machines in peers().items():
        print(recorded.write(code, of_machines))
        print({name: error for name, (_, error) in of_machines.items()})
