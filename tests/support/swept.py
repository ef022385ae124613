"""The shipped pin, with a [vary]."""

from __future__ import annotations

import os
import signal

from pinstress import Study, shipped_studies, study_from
from pinstress.designs.batches import Batch, DesignProblem, Done, solve_batch

ONE_PIN = shipped_studies()["one_pin"].read_text(encoding="utf-8")
DIAMETER = "pin.B.profile[2].diameter"
FORCE = "case.landing.forces.B[2]"
STRENGTH = "material.AISI 4340.yield_strength"


def varied(parameters: str, head: str = 'sample = "sobol"\ncount = 4', text: str = ONE_PIN) -> str:
    """A study's text with [vary]: what comes before its parameters, and these."""
    return f"{text}\n[vary]\n{head}\n\n[vary.parameters]\n{parameters}\n"


def swept(parameters: str, head: str = 'sample = "sobol"\ncount = 4', text: str = ONE_PIN) -> Study:
    """Such a study."""
    return study_from(varied(parameters, head, text))


DEADLY = 2


def dying(problem: DesignProblem, batch: Batch) -> Done:
    """As solve_batch, but one design ends its process."""
    if DEADLY in batch.designs:
        os.kill(os.getpid(), signal.SIGKILL)
    return solve_batch(problem, batch)
