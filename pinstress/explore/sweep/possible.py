"""Whether the designs of a study can be built and are in equilibrium, before any is solved."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from pinstress.explore.sweep.correlations import correlations_of, root_of
from pinstress.explore.sweep.evaluate import Evaluator
from pinstress.explore.sweep.laws import Floats, Triangular, Uniform
from pinstress.explore.sweep.parameters import Parameter
from pinstress.study.model.balance import unheld
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.model.tasks import tasks
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import GivenCase

# Where a tenth is impossible, 97 % of 32 designs find one; they take a millisecond each, with a
# mechanism a tenth of a second.
TRIED_DESIGNS, TRIED_MECHANISMS = 32, 8
MAX_TRIED_RANGES = 20  # each end takes as long as a design


@dataclass(frozen=True)
class TriedDesigns:
    """The designs that were tried, and why some of them are impossible.

    count: how many were tried. impossible: why designs cannot be built, with their number.
    """

    count: int
    impossible: dict[str, int]

    @property
    def warnings(self) -> list[str]:
        """A warning for each reason."""
        return [
            f"vary: {n} of {self.count} designs tried cannot be built: {reason}"
            for reason, n in self.impossible.items()
        ]


def drawn(study: Study, parameters: Sequence[Parameter]) -> Floats:
    """Return designs (N, p), SI, drawn by the laws of the parameters, always the same."""
    matrix = correlations_of(study, parameters, sampled=False)
    z = np.random.default_rng(0).standard_normal((TRIED_DESIGNS, len(parameters)))
    z = z if matrix is None else z @ root_of(matrix).T
    return np.stack([p.of_normal(z[:, k]) for k, p in enumerate(parameters)], axis=1)


def tried(study: Study, evaluator: Evaluator, values: Floats) -> TriedDesigns:
    """Build some designs and their loads, without solving any.

    values: (N, p) of the parameters, SI; some rows, evenly spaced, are tried.

    Raises: InputError where given forces that vary one by one leave pins out of equilibrium that
    are in equilibrium as the study describes them.
    """
    most = TRIED_DESIGNS if study.table.mechanism is None else TRIED_MECHANISMS
    rows = np.unique(np.linspace(0, len(values) - 1, most).astype(int))
    held = _unheld_rows(evaluator.study, evaluator, [n.nominal for n in evaluator.numbers])
    impossible, unbalanced = Counter[str](), dict[tuple[str, str], list[str]]()
    for row in rows:
        try:
            design = evaluator.changed(values[row])
            for key, reason in _unheld_rows(design, evaluator, values[row]).items():
                if key not in held:
                    unbalanced.setdefault(key, []).append(reason)
        except (InputError, ArithmeticError) as error:
            impossible[str(error).partition("\n")[0]] += 1
    for (pin, case), reasons in unbalanced.items():
        if isinstance(study.table.case[case], GivenCase) and study.table.pin[pin].balance is None:
            raise study.error(
                f"vary: in {len(reasons)} of {len(rows)} designs tried the given forces on pin "
                f"{pin} in case {case} are out of equilibrium, since they vary one by one: "
                f"{reasons[0]}; name the link that balances the others, as pin.{pin}.balance = "
                f'"{_closing(study, pin, case, evaluator)}", and remove its forces from the cases',
                at="vary",
                code="unbalanced-designs",
            )
    return TriedDesigns(len(rows), dict(impossible))


def impossible_ends(evaluator: Evaluator, parameters: Sequence[Parameter]) -> list[str]:
    """Return a warning for each end of a range at which the design cannot be built, with all other
    numbers as in the study.

    Only uniform and triangular laws have ends.
    """
    nominal = [number.nominal for number in evaluator.numbers]
    warnings = []
    for k, parameter in enumerate(parameters[:MAX_TRIED_RANGES]):
        if not isinstance(parameter.law, Uniform | Triangular):
            continue
        for end in dict.fromkeys(parameter.quantile(np.array([0.0, 1.0])).tolist()):
            values = [*nominal[:k], end, *nominal[k + 1 :]]
            try:
                _unheld_rows(evaluator.changed(values), evaluator, values)
            except (InputError, ArithmeticError) as error:
                shown = f"{end / parameter.number.factor:.6g} {parameter.number.unit}".rstrip()
                reason = str(error).partition("\n")[0]
                warnings.append(f"vary.parameters.{parameter.key}: impossible at {shown}: {reason}")
    return warnings


def require_balance(study: Study, evaluator: Evaluator, values: Floats) -> None:
    """Refuse designs as `tried` does, at once, where any given force varies."""
    paths = [path for number in evaluator.numbers for path in number.paths]
    if any(path[0] == "case" and path[2] in ("forces", "moments") for path in paths):
        tried(study, evaluator, values)


def _unheld_rows(
    study: Study, evaluator: Evaluator, values: Iterable[float]
) -> dict[tuple[str, str], str]:
    """Return why pins of a design are out of equilibrium, by pin and case.

    Raises: InputError for a design that cannot be built.
    """
    loads = evaluator.loads_of(study, [float(x) for x in values])
    right, out = dict[str, CaseLoads](), dict[tuple[str, str], str]()
    for name, case in loads.items():
        if isinstance(case, InputError):
            raise case
        right[name] = case
    for name in dict.fromkeys(pin for pin, _ in evaluator.table):
        for task in tasks(study, [pin_of(study, name)], right):
            out |= {(name, at): reason for at, reason in unheld(study, task).items()}
    return out


def _closing(study: Study, pin: str, case: str, evaluator: Evaluator) -> str:
    """Return a connection of a pin whose force does not vary; the last if all do."""
    varied = {path[3] for number in evaluator.numbers for path in number.paths
              if path[:3] == ("case", case, "forces") and len(path) > 3}  # fmt: skip
    connections = study.connections(pin)
    return next((c for c in connections if c not in varied), connections[-1])
