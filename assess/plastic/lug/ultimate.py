"""The ultimate load of a lug: the largest force of a pin that moves until it falls, or the metal
breaks.

Plane strain, finite strain, the true stress-strain curve, a rigid pin without friction. Two things
end the rise of the load: the shape of the lug, whose metal behind the pin thins and bulges faster
than it hardens, or a failure strain, if one is given, which the equivalent plastic strain reaches
somewhere at the bore. The first needs no more than the tensile strengths.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from scipy.sparse.linalg import splu

from assess.plastic.flow import FlowRule
from assess.plastic.lug.mesh import half_lug_mesh
from assess.plastic.lug.pulled_body import PulledBody, PulledState
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from geometry.shape.lug_outline import LugOutline
from pinbase.arrays import Floats
from pinbase.dimensions import Length, Lengths

ForcePerLength = Annotated[float, "force per length"]
ForcesPerLength = Annotated[Floats, "force per length"]

MESH_SIZES = 0.15, 0.1  # radii, of triangles at the bore: 3 and 6 s
# Steps of the pin, in radii.
FIRST_STEP, MAX_STEP, MIN_STEP = 0.002, 0.03, 1e-5
STEP_GROWTH = 1.4  # after a step of few iterations
FEW_ITERATIONS, MAX_ITERATIONS = 5, 15
RESIDUAL_TOLERANCE = 1e-6  # over the forces of the pin
DIVERGED = 1e4  # the same: beyond it Newton's method is given up
MAX_TRAVEL = 1.5  # radii
FALL = 0.015  # of the largest load: then it has been passed


@dataclass(frozen=True)
class PullCurve:
    """The pull of a pin: its displacement (S,), the load per thickness (S,) and the largest
    equivalent plastic strain (S,).
    """

    pin: Lengths
    load: ForcesPerLength
    strain: Floats

    def largest(self, failure_strain: float | None = None) -> tuple[float, float, float]:
        """The largest load up to a failure strain, N/m, the pin's way there, m, and the strain."""
        loads, ways, strains = self.load, self.pin, self.strain
        if failure_strain is not None and strains[-1] > failure_strain:
            last = int(np.argmax(strains > failure_strain))
            part = (failure_strain - strains[last - 1]) / (strains[last] - strains[last - 1])
            loads, ways, strains = (
                np.append(v[:last], v[last - 1] + part * (v[last] - v[last - 1]))
                for v in (loads, ways, strains)
            )
        top = int(np.argmax(loads))
        return float(loads[top]), float(ways[top]), float(strains[top])


@dataclass(frozen=True)
class LugUltimate:
    """The ultimate load per thickness of a lug, N/m.

    ended_by: "shape": the load falls; "strain": the failure strain is reached before.
    pin: how far it has moved. strain: the largest equivalent plastic strain then.
    mesh_error: the difference of the two meshes over the load; of the numerics alone.
    curve: of the finer mesh.
    """

    load: ForcePerLength
    ended_by: Literal["shape", "strain"]
    pin: Length
    strain: float
    mesh_error: float
    curve: PullCurve


def lug_ultimate(
    lug: LugOutline, material: Material, failure_strain: float | None = None
) -> LugUltimate:
    """The ultimate load of a lug.

    material: with its yield strength and true hardening curve, as of
    assess.plastic.lug.true_curve.
    failure_strain: equivalent plastic strain at which the metal breaks; None: it does not.

    Raises: ArgumentError for a material without yield strength; MeshError; SolveError.
    """
    coarse, fine = (pull(lug, material, size) for size in MESH_SIZES)
    load, way, strain = fine.largest(failure_strain)
    other = coarse.largest(failure_strain)[0]
    broke = failure_strain is not None and strain >= failure_strain * (1.0 - 1e-9)
    return LugUltimate(
        load, "strain" if broke else "shape", way, strain, abs(load - other) / load, fine
    )


def pull(
    lug: LugOutline,
    material: Material,
    size: float,
    finite: bool = True,
    max_travel: float = MAX_TRAVEL,
) -> PullCurve:
    """The pull of a lug until its load falls.

    size: of triangles at the bore, radii. finite: finite strain; otherwise shape and the pin's
    normals stay, and the load of a metal that does not harden tends to the limit load.
    max_travel: radii.

    Raises: ArgumentError; MeshError; SolveError where equilibrium is lost before the load falls.
    """
    body = PulledBody(half_lug_mesh(lug, size), FlowRule(material), finite)
    states = [body.at_rest()]
    step, rate = FIRST_STEP, np.zeros_like(body.start)
    while states[-1].pin < max_travel and not _fallen(states):
        now = states[-1]
        after, iterations = _step(body, now, rate * step, step)
        if after is None:
            step /= 2.0
            rate = np.zeros_like(rate)  # a guess along the last step may be what failed
            if step < MIN_STEP:
                raise SolveError(
                    f"the equilibrium of the pulled lug was lost after {now.pin:.3g} radii of the "
                    "bore",
                    "no-convergence",
                )
            continue
        states.append(after)
        rate = (after.nodes - now.nodes) / step
        if iterations < FEW_ITERATIONS:
            step = min(step * STEP_GROWTH, MAX_STEP)
    radius = lug.hole / 2.0
    return PullCurve(
        np.array([s.pin for s in states]) * radius,
        np.array([2.0 * s.load for s in states]) * radius,  # two halves
        np.array([s.equivalent.max() for s in states]),
    )


def _fallen(states: list[PulledState]) -> bool:
    return states[-1].load < (1.0 - FALL) * max(s.load for s in states)


def _step(
    body: PulledBody, before: PulledState, guess: Floats, step: float
) -> tuple[PulledState | None, int]:
    """The state after a step of the pin, or None, and the iterations of Newton's method."""
    moved = guess.copy()
    for iteration in range(MAX_ITERATIONS):
        unbalanced, tangent, state, size = body.residual(before, moved, before.pin + step)
        error = float(np.linalg.norm(unbalanced)) / size
        if error < RESIDUAL_TOLERANCE:
            return state, iteration
        if not error < DIVERGED:
            break
        try:
            change = splu(tangent).solve(-unbalanced)
        except RuntimeError:  # exactly singular
            break
        moved.reshape(-1)[body.free] += change
    return None, MAX_ITERATIONS
