"""The study file's form: what `pinstress reliability` finds of a study with random numbers."""

from typing import Annotated

from pydantic import Field

from pinstress.schema.types import Number, StrictTable, Whole

MOST_SAMPLES = 10_000_000


class ReliabilityTable(StrictTable):
    """Which failure and which probability `pinstress reliability` looks at, and how many designs it
    solves. Random are the numbers in `[vary.parameters]` that have a law.
    """

    factor: Annotated[Number, Field(gt=0.0)] = 1.0
    """A pin fails where its factor of safety against yield is less than this."""
    probability: Annotated[Number, Field(gt=0.0, lt=1.0)] = 0.001
    """Largest allowed probability of failure; also that with which the reported factor of safety is
    not reached."""
    samples: Annotated[Whole, Field(ge=10, le=MOST_SAMPLES)] = 2_000
    """Number of designs of plain (Monte Carlo) sampling."""
    importance_samples: Annotated[Whole, Field(ge=0, le=MOST_SAMPLES)] = 1_000
    """Number of designs of importance sampling about the design points of FORM; 0 for none."""
    sobol_samples: Annotated[Whole, Field(ge=0, le=MOST_SAMPLES)] = 256
    """Base samples of the Sobol indices, which take as many designs for each parameter and twice
    more, rounded down to eight sets of a power of two; 0 for none. Not for correlated numbers."""
    seed: Annotated[Whole, Field(ge=0, lt=2**63)] = 1
    """Of the random numbers: the same seed gives the same result."""
    confidence: Annotated[Number, Field(gt=0.0, lt=1.0)] = 0.95
    """Confidence level of all intervals."""
