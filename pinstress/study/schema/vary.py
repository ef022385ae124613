"""Keys in a study file of numbers that vary, for `sweep` and `reliability`."""

from typing import Annotated, Literal

from pydantic import Field

from pinbase.errors import ArgumentError
from pinstress.study.schema.rules import condition
from pinstress.study.schema.types import Coordinate, Number, StrictTable, Whole

MAX_DESIGNS = 1_000_000
MAX_PARAMETERS = 100
MAX_SAMPLES = 10_000_000
Pair = tuple[Coordinate, Coordinate]
Triple = tuple[Coordinate, Coordinate, Coordinate]


class ParameterTable(StrictTable):
    """The range of a number, `from` and `to`, or its probability distribution (law). All values are
    numbers in the study's units, or texts with a unit.
    """

    from_: Annotated[Coordinate | None, Field(alias="from")] = None
    """The least value; with `to`, all between are equally likely."""
    to: Coordinate | None = None
    """The largest value."""
    uniform: Pair | None = None
    """Least and largest value, the same as `from` and `to`."""
    normal: Pair | None = None
    """Mean and standard deviation."""
    lognormal: Pair | None = None
    """Mean and standard deviation of the number itself, not of its logarithm."""
    triangular: Triple | None = None
    """Least, most likely and largest value."""
    tolerance: Annotated[str, Field(max_length=200)] | None = None
    """Tolerance of a drawing about the number in the study: "+0.1 mm -0.05 mm", "±0.1 mm", or of a
    diameter an ISO 286 class such as "h7". It is a normal distribution about the middle of the
    tolerance, truncated at the limits, which are three standard deviations away."""
    within: Pair | None = None
    """Limits at which a normal or lognormal distribution is truncated."""
    steps: Annotated[Whole, Field(ge=1, le=MAX_DESIGNS)] | None = None
    """Number of values in a grid: evenly spaced from `from` to `to`; for a distribution, the
    medians of as many equally likely parts."""

    @condition
    def _one_law(self) -> None:
        ends = self.from_ is not None, self.to is not None
        laws = [x for x in PROBABILITY_LAWS if getattr(self, x) is not None]
        if any(ends) and not all(ends):
            raise ArgumentError("from and to belong together", "give-both")
        if len(laws) + any(ends) != 1:
            raise ArgumentError(
                f"give from and to, or one of {', '.join(PROBABILITY_LAWS)}", "give-one"
            )
        if self.within is not None and not (self.normal or self.lognormal):
            raise ArgumentError(
                "within cuts off a normal or a lognormal law only", "not-applicable"
            )


PROBABILITY_LAWS = ("uniform", "normal", "lognormal", "triangular", "tolerance")


class CorrelationTable(StrictTable):
    """The correlation of two numbers with normal distributions."""

    between: tuple[str, str]
    """Keys of two of the parameters, which have normal distributions without `within`."""
    coefficient: Annotated[Number, Field(gt=-1.0, lt=1.0)]
    """Coefficient of correlation."""


class VaryTable(StrictTable):
    """The numbers of the study that `pinstress sweep` varies, and the designs that it samples."""

    sample: Literal["grid", "sobol", "latin-hypercube", "random"] = "grid"
    """The designs: all combinations of `steps` values ("grid"), or `count` points of a scrambled
    Sobol sequence, a Latin hypercube or a random sample."""
    count: Annotated[Whole, Field(ge=1, le=MAX_DESIGNS)] = 256
    """Number of designs, except of a grid."""
    seed: Annotated[Whole, Field(ge=0, lt=2**63)] = 1
    """Seed of the random numbers: the same seed gives the same designs."""
    parameters: Annotated[dict[str, ParameterTable], Field(min_length=1, max_length=MAX_PARAMETERS)]
    """The numbers that vary, by their keys in the study as messages spell them, with elements
    counted from 1, in quotes: "pin.B.profile[2].diameter"."""
    correlations: Annotated[list[CorrelationTable], Field(max_length=MAX_PARAMETERS**2)] = []
    """Correlations of normal distributions; pairs that are not listed are independent."""


class ReliabilityTable(StrictTable):
    """The definition of failure and the probability for `pinstress reliability`, and the number of
    designs that it solves. The numbers in `[vary.parameters]` that have a distribution are random.
    """

    factor: Annotated[Number, Field(gt=0.0)] = 1.0
    """A pin fails where its factor of safety against yield is less than this."""
    probability: Annotated[Number, Field(gt=0.0, lt=1.0)] = 0.001
    """Largest allowed probability of failure; also the probability with which the reported factor
    of safety is not reached."""
    samples: Annotated[Whole, Field(ge=10, le=MAX_SAMPLES)] = 2_000
    """Number of designs of plain (Monte Carlo) sampling."""
    importance_samples: Annotated[Whole, Field(ge=0, le=MAX_SAMPLES)] = 1_000
    """Number of designs of importance sampling about the design points of FORM; 0 for none."""
    sobol_samples: Annotated[Whole, Field(ge=0, le=MAX_SAMPLES)] = 256
    """Base samples N of the Sobol indices, rounded down to eight sets of a power of two; they take
    N designs for each parameter and 2 N more. 0 for none. Not for correlated numbers."""
    seed: Annotated[Whole, Field(ge=0, lt=2**63)] = 1
    """Seed of the random numbers: the same seed gives the same result."""
    confidence: Annotated[Number, Field(gt=0.0, lt=1.0)] = 0.95
    """Confidence level of all intervals."""
