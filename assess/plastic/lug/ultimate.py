"""The ultimate load of a lug: the pin is displaced until its force falls or the metal breaks.

The model has plane strain, finite strain, the true stress-strain curve and a rigid, frictionless
pin. Two things end the rise of the load: the shape of the lug, when the metal behind the pin thins
and bulges faster than it hardens; or a failure strain, if one is given, when the equivalent plastic
strain reaches it anywhere in the lug. The first needs only the tensile strengths.
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

MESH_SIZES = 0.15, 0.1  # triangle sizes at the bore, in radii; they take 3 and 6 s
# Steps of the pin, in radii.
FIRST_STEP, MAX_STEP, MIN_STEP = 0.002, 0.03, 1e-5
STEP_GROWTH = 1.4  # growth of the step after a step of few iterations
FEW_ITERATIONS, MAX_ITERATIONS = 5, 15
RESIDUAL_TOLERANCE = 1e-6  # relative to the forces of the pin
DIVERGED = 1e4  # residual, relative to these forces, at which Newton's method is abandoned
MAX_TRAVEL = 1.5  # largest displacement of the pin, in radii
FALL = 0.015  # drop below the largest load, relative to it, that shows that the peak is passed


@dataclass(frozen=True)
class PullCurve:
    """The load-displacement curve of a pin: its displacement (S,), the load per thickness (S,) and
    the largest equivalent plastic strain (S,).
    """

    pin: Lengths
    load: ForcesPerLength
    strain: Floats

    def largest(self, failure_strain: float | None = None) -> tuple[float, float, float]:
        """Return the largest load up to a failure strain, N/m, the displacement of the pin there,
        m, and the strain there.
        """
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

    ended_by: "shape" if the load falls; "strain" if the failure strain is reached first.
    pin: displacement of the pin at the ultimate load. strain: largest equivalent plastic strain at
    that load.
    mesh_error: the difference of the loads of the two meshes, relative to the load; covers the
    numerical error only.
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
    """Return the ultimate load of a lug.

    material: with its yield strength and true hardening curve, as from
    assess.plastic.lug.true_curve.
    failure_strain: equivalent plastic strain at which the metal breaks; None if it does not break.

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
    """Return the load-displacement curve of a lug until its load falls.

    size: triangle size at the bore, in radii. finite: whether strains are finite; otherwise the
    geometry and the normals of the pin do not change, and the load of a metal without hardening
    tends to the limit load.
    max_travel: largest displacement of the pin, in radii.

    Raises: ArgumentError; MeshError; SolveError if equilibrium is lost before the load falls.
    """
    body = PulledBody(half_lug_mesh(lug, size), FlowRule(material), finite)
    states = [body.at_rest()]
    step, rate = FIRST_STEP, np.zeros_like(body.start)
    while states[-1].pin < max_travel and not _fallen(states):
        now = states[-1]
        after, iterations = _step(body, now, rate * step, step)
        if after is None:
            step /= 2.0
            rate = np.zeros_like(rate)  # the predictor along the last step may be the cause
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
    """Return the state after a step of the pin (None if Newton's method fails), and the number of
    iterations.
    """
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
