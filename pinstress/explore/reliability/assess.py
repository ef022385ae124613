"""Probabilities of failure of a study's pins, by methods that check each other.

Plain sampling is enough where enough samples fail. FORM finds the points where failure is most
likely. Importance sampling about these points estimates small probabilities from far fewer designs.
All probabilities come from designs that were solved as in a run: nothing is fitted or interpolated.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from pinbase.processes.pool import Progress
from pinstress.analysis.cache import user_cache
from pinstress.explore.reliability.designs import SolvedDesigns, random_numbers
from pinstress.explore.reliability.drivers import base_samples, indices
from pinstress.explore.reliability.form import (
    NOISY_CLOSENESS,
    SMOOTH_CLOSENESS,
    Closeness,
    DesignPoint,
    LimitState,
    design_point,
    distinct,
    form_quantile,
)
from pinstress.explore.reliability.open_ranges import (
    left_out,
    with_open_ranges,
    without_strength_ranges,
)
from pinstress.explore.reliability.risk import AssessedRow, RiskColumn, Sample, risk_of
from pinstress.explore.reliability.sampling import importance_draws, plain_draws
from pinstress.explore.sweep.batches import DesignProblem, evaluator_of, shapes
from pinstress.explore.sweep.evaluate import Evaluator
from pinstress.explore.sweep.number import Path
from pinstress.explore.sweep.parameters import Parameter
from pinstress.explore.sweep.possible import drawn, require_balance
from pinstress.study.model.hardened import require_strengths
from pinstress.study.model.lugs import with_given_lugs
from pinstress.study.model.requirements import checks_besides_yield
from pinstress.study.reading.file import Study
from pinstress.study.reading.inputs import inputs, require_unchanged
from pinstress.study.schema.vary import ReliabilityTable
from reports.data.reliability import SYSTEM_ROW, Driver, FirstOrder, Reliability, Spread
from reports.data.results import Results
from reports.data.row import PinResult
from reports.data.unknowns import growth
from reports.format.words import not_judged

if TYPE_CHECKING:
    from pinstress.explore.sweep.cluster import Cluster

Array = NDArray[np.float64]

MAX_SEARCH_STARTS = 3  # failing samples from which further design points are sought
MAX_DIRECTION_COSINE = 0.7  # two directions with a smaller cosine count as different
# Distance beyond the nearest design point at which others are sought, in standard deviations
SEARCH_DISTANCE_BEYOND = 1.0
MAX_CENTRES = 40  # centres of importance sampling


def assess(
    study: Study,
    nominal: Results,
    jobs: int,
    progress: Progress,
    pins: Sequence[str] | None = None,
    cases: Sequence[str] | None = None,
    cluster: Cluster | None = None,
) -> Reliability:
    """Assess the reliability of a study's pins in its load cases.

    nominal: results of the study as it is.
    jobs: number of processes that solve samples.
    cluster: solves the samples instead of local processes; solved designs are kept in the user's
    cache.

    Raises: InputError for a study without random numbers or without strengths, and if a file of the
    study changes meanwhile.
    """
    settings, before = study.table.reliability, inputs(study)
    parameters, space = random_numbers(study)
    laws = {path for p in parameters for path in p.number.paths}
    described = without_strength_ranges(study, laws)
    problem = DesignProblem.of(described, [p.number for p in parameters], pins, cases)
    evaluator, elsewhere = evaluator_of(problem), None
    require_strengths(study, (pin for pin, _ in evaluator.table))
    require_balance(study, evaluator, drawn(study, parameters))
    if cluster is not None:
        from pinstress.explore.reliability.on_cluster import design_rows

        elsewhere = partial(design_rows, cluster, problem, user_cache())
    designs = SolvedDesigns(evaluator, space, jobs, progress, elsewhere)
    plain = plain_draws(settings.samples, space.size, settings.seed)
    sampled = Sample(plain, designs.at(plain.u, "plain sampling"))
    forms = _first_orders(described, parameters, designs, sampled, cases)
    centres = [c for form in forms for c in form.centres]
    weighted = weighted_sample(designs, centres, settings)
    shares = _indices(designs, settings) if space.lower is None else None
    require_unchanged(study, before)
    materials = {name: pin.material for name, pin in study.table.pin.items()}
    open_rows = replace(
        nominal, pins=tuple(with_open_ranges(p, laws, materials[p.pin]) for p in nominal.pins)
    )
    assessed = _assessed_rows(parameters, designs, forms, shares, open_rows)
    of_study = [row.nominal for row in assessed if row.column.row is not None]
    growths = np.array([growth(row) for row in of_study])
    return Reliability(
        title=study.table.title,
        study=str(study.path),
        limit=settings.factor,
        probability=settings.probability,
        confidence=settings.confidence,
        samples=settings.samples,
        seed=settings.seed,
        parameters=tuple((p.key, p.law_text) for p in parameters),
        risks=tuple(risk_of(row, sampled, weighted, settings, growths) for row in assessed),
        correlations=_correlations(study),
        solved=dict(designs.solved),
        reasons=dict(designs.reasons),
        notes=tuple(_notes(study, nominal, evaluator.table, laws)),
    )


def _assessed_rows(
    parameters: tuple[Parameter, ...],
    designs: SolvedDesigns,
    forms: list[_Form],
    shares: list[list[tuple[Spread, Spread]]] | None,
    nominal: Results,
) -> list[AssessedRow]:
    """Return the rows of the study; if there are several, the row of the system comes first.

    shares: Sobol indices of each row and, last, of the system; None for correlated numbers.
    """
    rows = {(p.pin, p.case): p for p in nominal.pins}
    assessed = []
    for k, (pin, case) in enumerate(designs.evaluator.table):
        drivers = _drivers(parameters, designs, forms[k], shares[k] if shares else None)
        row = AssessedRow(pin, case, RiskColumn(k), rows.get((pin, case)), forms[k].result, drivers)
        assessed.append(row)
    if len(assessed) > 1:
        drivers = _drivers(parameters, designs, None, shares[-1] if shares else None)
        system = SYSTEM_ROW, SYSTEM_ROW, RiskColumn(None), _worst(nominal), None, drivers
        assessed.insert(0, AssessedRow(*system))
    return assessed


def _correlations(study: Study) -> tuple[str, ...]:
    """Return the correlations between the study's numbers, as text."""
    vary = study.table.vary
    assert vary is not None
    return tuple(f"{c.between[0]} and {c.between[1]}: {c.coefficient:g}" for c in vary.correlations)


@dataclass(frozen=True)
class _Form:
    """The FORM result of a row, its centres for importance sampling, its nearest design point."""

    result: FirstOrder
    centres: tuple[Array, ...] = ()
    nearest: DesignPoint | None = None


def _first_orders(
    study: Study,
    parameters: tuple[Parameter, ...],
    designs: SolvedDesigns,
    sampled: Sample,
    cases: Sequence[str] | None,
) -> list[_Form]:
    """Return the FORM results of all rows; for each row only its own pin is solved."""
    table = designs.evaluator.table
    forms: dict[tuple[str, str], _Form] = {}
    for pin in dict.fromkeys(pin for pin, _ in table):
        alone = designs.of_pin(Evaluator(study, parameters, [pin], cases))
        for k, row in enumerate(alone.evaluator.table):
            place, settings = table.index(row), study.table.reliability
            starts = starts_of(sampled, place, settings.factor)
            forms[row] = first_order(alone, k, starts, settings)
            if sampled.answers.depends[place]:
                about = forms[row].centres + _beneath(alone, k, settings)
                forms[row] = replace(forms[row], centres=about)
    return [forms[row] for row in table]


def first_order(
    designs: SolvedDesigns, row: int, starts: list[Array], settings: ReliabilityTable
) -> _Form:
    """Return the FORM result of a row.

    Design points are sought from the mean, from given starts, and from failing points farther out
    (`_failing_beyond`), as long as their directions differ from those of the known points.
    """
    size = designs.space.size
    close = NOISY_CLOSENESS if any(map(shapes, designs.evaluator.numbers)) else SMOOTH_CLOSENESS
    limit = designs.limit(row, settings.factor)
    points = [design_point(limit, np.zeros(size), close)]
    _search(points, starts, limit, close)
    _search(points, _failing_beyond(limit, distinct(points), size), limit, close)
    design_points = distinct(points)

    def unused(u: Array) -> Array:
        return -designs.at(u, "FORM").used[:, row]

    lowest = form_quantile(unused, settings.probability, size, close)
    value = -1.0 / lowest.value if lowest.value else np.inf
    centres = [p.u for p in design_points]
    if not lowest.why and all(np.linalg.norm(lowest.u - c) > 1.0 for c in centres):
        centres.append(lowest.u)
    if not design_points:
        return _Form(FirstOrder(np.nan, np.nan, value, 0, points[0].why), tuple(centres))
    nearest = design_points[0]
    result = FirstOrder(nearest.index, nearest.probability, value, len(design_points))
    return _Form(result, tuple(centres), nearest)


def _beneath(designs: SolvedDesigns, row: int, settings: ReliabilityTable) -> tuple[Array, ...]:
    """Return the point where excessive stress beneath contact is most likely, as a further centre
    of sampling; empty if none is found.
    """
    close = NOISY_CLOSENESS if any(map(shapes, designs.evaluator.numbers)) else SMOOTH_CLOSENESS
    limit = designs.limit(row, settings.factor, deep=True)
    point = design_point(limit, np.zeros(designs.space.size), close)
    return tuple(p.u for p in distinct([point]))


def starts_of(sampled: Sample, row: int, factor: float) -> list[Array]:
    """Return starts for the search of a row's design points.

    The starts are failing samples in different directions, the nearest to the mean first. If no
    sample fails, the only start is the worst sample.
    """
    u, used = sampled.draws.u, sampled.answers.used[:, row]
    if np.isnan(used).all():
        return []
    failing = np.flatnonzero(factor * used > 1.0)
    if not len(failing):
        return [u[int(np.nanargmax(used))]]
    order = failing[np.argsort(np.linalg.norm(u[failing], axis=1), kind="stable")]
    starts: list[Array] = []
    for at in order:
        direction = u[at] / np.linalg.norm(u[at])
        if all(direction @ k < MAX_DIRECTION_COSINE * float(np.linalg.norm(k)) for k in starts):
            starts.append(u[at])
        if len(starts) == MAX_SEARCH_STARTS:
            break
    return starts


def weighted_sample(
    designs: SolvedDesigns, centres: list[Array], settings: ReliabilityTable
) -> Sample | None:
    """Solve designs sampled about the centres (d,).

    Return None if there are no centres or the study requests no such samples.
    """
    separate: list[Array] = []
    for centre in sorted(centres, key=lambda c: float(np.linalg.norm(c))):
        if all(np.linalg.norm(centre - other) > 0.5 for other in separate):
            separate.append(centre)
    if not separate or not settings.importance_samples:
        return None
    draws = importance_draws(separate[:MAX_CENTRES], settings.importance_samples, settings.seed)
    return Sample(draws, designs.at(draws.u, "importance sampling"))


def _indices(
    designs: SolvedDesigns, settings: ReliabilityTable
) -> list[list[tuple[Spread, Spread]]] | None:
    """Return the Sobol indices of all rows and, last, of the system."""
    base = base_samples(settings.sobol_samples)
    if not base or designs.space.size < 2:
        return None

    def factors(u: Array) -> Array:
        answers = designs.at(u, "Sobol indices")
        return np.concatenate([answers.factors, answers.system.factors], axis=1)

    return indices(factors, designs.space.size, base, settings.seed, settings.confidence)


def _search(
    points: list[DesignPoint], starts: Iterable[Array], limit: LimitState, close: Closeness
) -> None:
    """Add the design points found from starts in other directions than the known points."""
    for start in starts:
        known = [p.direction @ start for p in points if not p.why]
        if all(cosine < MAX_DIRECTION_COSINE * float(np.linalg.norm(start)) for cosine in known):
            points.append(design_point(limit, start, close))


def _failing_beyond(limit: LimitState, known: list[DesignPoint], size: int) -> Iterable[Array]:
    """Return failing points (d,) beyond the distance of the nearest design point, along all axes
    and opposite to it. Design points that no sample reveals may lie near them.
    """
    if not known or known[0].index <= 0.0:
        return ()
    every = np.concatenate([np.eye(size), -np.eye(size), -known[0].direction[None, :]])
    probes = (known[0].index + SEARCH_DISTANCE_BEYOND) * every
    return list(probes[limit(probes) < 0.0])


def _drivers(
    parameters: tuple[Parameter, ...],
    designs: SolvedDesigns,
    form: _Form | None,
    shares: list[tuple[Spread, Spread]] | None,
) -> tuple[Driver, ...]:
    nearest = form.nearest if form else None
    parts = None if nearest is None else designs.space.importance(nearest.direction)
    return tuple(
        Driver(
            parameter.key,
            None if parts is None else float(parts[k]),
            *((None, None) if shares is None or np.isnan(shares[k][0].value) else shares[k]),
        )
        for k, parameter in enumerate(parameters)
    )


def _worst(nominal: Results) -> PinResult | None:
    known = [p for p in nominal.pins if p.safety_factor is not None]
    return min(known, key=lambda p: p.safety_factor or 0.0, default=None)


def _notes(
    study: Study, nominal: Results, table: Iterable[tuple[str, str]], laws: Collection[Path]
) -> Iterable[str]:
    yield (
        "Not included: the choice of the laws themselves, the model's idealisations (linear "
        "elasticity, the shape as drawn), and whatever does not vary."
    )
    in_lugs = with_given_lugs(study, (pin for pin, _ in table))
    if said := not_judged(in_lugs, checks_besides_yield(study)):
        yield said
    for p in nominal.pins:
        if p.lost_fits:
            where = ", ".join(x.where for x in p.lost_fits)
            yield (
                f"Pin {p.pin} comes loose in {p.case}: its press fit is lost in {where}. What else "
                "retains it is not judged here."
            )
    materials = {name: pin.material for name, pin in study.table.pin.items()}
    yield from left_out(nominal.pins, laws, materials)
    if any(p.verdict == "singular" for p in nominal.pins):
        yield (
            "Rows marked singular have unbounded stress at a corner or an edge (singular_zones.csv "
            "of a run says which); their factors are those outside the excluded zones."
        )
    if any(p.joint and p.joint.range for p in nominal.pins):
        yield (
            "The range over the joint is that of the study as it is, relative to its maximum; the "
            "links' own flexibility enters only there."
        )
