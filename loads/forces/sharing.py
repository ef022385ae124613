"""Forces that rigid-body statics leaves undetermined, shared by connections as by springs."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from loads.linkage.linkage import Linkage, LinkageError
from loads.motion.mobility import Mobility
from pinbase.arrays import Complex, Floats


def undetermined(linkage: Linkage, freedom: Mobility) -> LinkageError:
    """The error for forces that rigid-body statics leaves undetermined.

    It asks for a sharing rule of the connections; there is no such rule for redundant sliders.
    """
    if not set(freedom.shared) & {name for name, _ in linkage.forces}:
        text = (
            f"sliders {', '.join(freedom.shared)} guide the same bodies, and rigid-body statics "
            "does not divide the load among them; keep one, with their distance or length as its "
            "bearing"
        )
        return LinkageError(text, "redundant-sliders", ("slider", freedom.shared[0]))
    text = (
        f"{_open(freedom)}; state how they share the load: [[mechanism.sharing]] with connections "
        "= [...] and stiffness = [...], one entry for each degree of redundancy"
    )
    for (one, other), pins in _joined_twice(linkage, freedom.shared):
        text += (
            f". Pins {' and '.join(pins)} join {one} and {other}; if these are one part, "
            f"write welded_to instead of the pins"
        )
    if linkage.driven and not freedom.degrees:
        text += (
            f". As drawn it is a structure that cannot move: remove the drive of "
            f"{', '.join(linkage.driven)}, which holds it once more; if it should move, correct "
            "the joints of the links that prevent it"
        )
    return LinkageError(text, "statically-indeterminate")


def _joined_twice(
    linkage: Linkage, shared: tuple[str, ...]
) -> Iterator[tuple[tuple[str, str], list[str]]]:
    """Pairs of bodies that several pins with shared connections join, and the names of the pins."""
    pins: dict[tuple[str, str], list[str]] = {}
    for joint in linkage.joints:
        bodies = [
            *([joint.fixed_in] if joint.fixed_in else []),
            *(c.body for c in joint.connections),
        ]
        if any(c.name in shared for c in joint.connections):
            for pair in combinations(sorted(bodies), 2):
                pins.setdefault(pair, []).append(joint.name)
    return ((pair, names) for pair, names in pins.items() if len(names) > 1)


def _open(freedom: Mobility) -> str:
    return f"rigid-body statics does not determine the forces at {', '.join(freedom.shared)}"


def shares(linkage: Linkage, forces: Complex, loose: Complex, freedom: Mobility) -> Floats:
    """Amounts (T, k) of self-equilibrated forces with which connections share loads as springs do.

    They minimise the sum of force^2 / stiffness over the connections and teeth of the rules.
    forces: (T, C) N, complex, any forces in equilibrium with the loads.
    loose: (T, C, k) N, complex, the k self-equilibrated sets of forces.
    freedom: mobility of the linkage, which names the connections whose force is undetermined.

    Raises: LinkageError without a rule, or with rules that leave a force undetermined.
    """
    names = [name for name, _ in linkage.forces]
    if not linkage.sharing:
        raise undetermined(linkage, freedom)
    members = [p for s in linkage.sharing for p in zip(s.connections, s.stiffness, strict=True)]
    which = [names.index(name) for name, _ in members]
    weight = np.tile([1.0 / stiffness for _, stiffness in members], 2)
    N = np.concatenate([loose[:, which].real, loose[:, which].imag], axis=1)
    g = np.concatenate([forces[:, which].real, forces[:, which].imag], axis=1)
    G = np.swapaxes(N, 1, 2) @ (weight[:, None] * N)
    if np.linalg.eigvalsh(G).min() < 1e-9 * weight.min():
        raise LinkageError(
            f"{_open(freedom)}, nor does the sharing over {', '.join(name for name, _ in members)}"
            "; name connections on each redundant path",
            "sharing-incomplete",
            ("sharing",),
        )
    b = -np.swapaxes(N, 1, 2) @ (weight * g)[..., None]
    return np.asarray(np.linalg.solve(G, b)[..., 0], dtype=np.float64)
