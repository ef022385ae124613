"""The check that designs of a study can be built and are in equilibrium, before any is solved."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from pinbase.keys import key_part
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

# If a tenth of the designs is impossible, 32 of them include an impossible one with a probability
# of 97 %. A design takes a millisecond, with a mechanism a tenth of a second.
TRIED_DESIGNS, TRIED_MECHANISMS = 32, 8
MAX_TRIED_RANGES = 20  # each end of a range takes as long as a design
# A value in a message, but not the index of a key ("profile[2]") or a line number (":18:").
VALUE_PATTERN = re.compile(r"(?<![\w.\[:])[-+]?\d[\d,]*(?:\.\d+)?(?:[eE][-+]?\d+)?(?![\w\]])")


@dataclass
class Cause:
    """A cause for which designs cannot be built.

    reason: the message of one such design. ends: the ends of ranges that give such designs, by key.
    designs: number of such designs among those tried.
    """

    reason: str
    ends: dict[str, list[str]] = field(default_factory=dict)
    designs: int = 0


Causes = dict[tuple[str, str], Cause]  # by code, and by the message without its values


def drawn(study: Study, parameters: Sequence[Parameter]) -> Floats:
    """Return designs (N, p), SI, drawn by the laws of the parameters with a fixed seed."""
    matrix = correlations_of(study, parameters, sampled=False)
    z = np.random.default_rng(0).standard_normal((TRIED_DESIGNS, len(parameters)))
    z = z if matrix is None else z @ root_of(matrix).T
    return np.stack([p.of_normal(z[:, k]) for k, p in enumerate(parameters)], axis=1)


def impossible_designs(
    study: Study, evaluator: Evaluator, parameters: Sequence[Parameter], values: Floats
) -> list[str]:
    """Return a warning for each cause for which designs cannot be built. Tried are the ends of
    ranges, with all other numbers as in the study, and some of the designs.

    values: (N, p) of the parameters, SI.

    Raises: InputError as `tried` does.
    """
    causes = _impossible_ends(evaluator, parameters)
    count = tried(study, evaluator, values, causes)
    return [_warning(cause, count, parameters) for cause in causes.values()]


def _warning(cause: Cause, count: int, parameters: Sequence[Parameter]) -> str:
    many = f"{cause.designs} of {count} designs tried"
    if not cause.ends:
        only = f".parameters.{key_part(parameters[0].key)}" if len(parameters) == 1 else ""
        return f"vary{only}: {many} cannot be built: {cause.reason}"
    (first, *others), values = cause.ends, cause.ends
    where = f"vary.parameters.{key_part(first)}: impossible at {' and '.join(values[first])}"
    where += "".join(f", {key_part(key)} at {' and '.join(values[key])}" for key in others)
    also = f" and in {many}" if cause.designs else ""
    return f"{where}{also}: {cause.reason}"


def tried(study: Study, evaluator: Evaluator, values: Floats, causes: Causes) -> int:
    """Build some designs and their loads, without solving any, and return their number.

    values: (N, p) of the parameters, SI; evenly spaced rows are tried.
    causes: the causes for which designs cannot be built are added to this.

    Raises: InputError if given forces that vary independently leave pins out of equilibrium that
    are in equilibrium as the study describes them.
    """
    most = TRIED_DESIGNS if study.table.mechanism is None else TRIED_MECHANISMS
    rows = np.unique(np.linspace(0, len(values) - 1, most).astype(int))
    held = _unheld_rows(evaluator.study, evaluator, [n.nominal for n in evaluator.numbers])
    unbalanced: dict[tuple[str, str], list[str]] = {}
    for row in rows:
        try:
            design = evaluator.changed(values[row])
            for key, reason in _unheld_rows(design, evaluator, values[row]).items():
                if key not in held:
                    unbalanced.setdefault(key, []).append(reason)
        except (InputError, ArithmeticError) as error:
            for cause in _causes_of(error, causes):
                cause.designs += 1
    for (pin, case), reasons in unbalanced.items():
        if isinstance(study.table.case[case], GivenCase) and study.table.pin[pin].balance is None:
            raise study.error(
                f"vary: in {len(reasons)} of {len(rows)} designs tried the given forces on pin "
                f"{pin} in case {case} are out of equilibrium, since they vary one by one: "
                f"{reasons[0]}; name the link that balances the others, as "
                f"pin.{key_part(pin)}.balance = "
                f'"{_closing(study, pin, case, evaluator)}", and remove its forces from the cases',
                at="vary",
                code="unbalanced-designs",
            )
    return len(rows)


def _impossible_ends(evaluator: Evaluator, parameters: Sequence[Parameter]) -> Causes:
    """Return the causes for which designs at the ends of ranges cannot be built, with all other
    numbers as in the study. Only uniform and triangular laws have ends.
    """
    nominal = [number.nominal for number in evaluator.numbers]
    causes: Causes = {}
    for k, parameter in enumerate(parameters[:MAX_TRIED_RANGES]):
        if not isinstance(parameter.law, Uniform | Triangular):
            continue
        for end in dict.fromkeys(parameter.quantile(np.array([0.0, 1.0])).tolist()):
            values = [*nominal[:k], end, *nominal[k + 1 :]]
            try:
                _unheld_rows(evaluator.changed(values), evaluator, values)
            except (InputError, ArithmeticError) as error:
                for cause in _causes_of(error, causes):
                    cause.ends.setdefault(parameter.key, []).append(parameter.number.text(end))
    return causes


def _causes_of(error: InputError | ArithmeticError, causes: Causes) -> list[Cause]:
    """Return the causes for which a design cannot be built; new ones are added to the known ones.

    Messages that differ only in their values, such as "1.05 times as large" and "2 times as large",
    have the same cause.
    """
    if not isinstance(error, InputError):
        error = InputError(str(error).partition("\n")[0])
    codes, lines = error.codes, error.lines
    keys = {(code, VALUE_PATTERN.sub("#", line)): line
            for code, line in zip(codes, lines, strict=True)}  # fmt: skip
    return [causes.setdefault(key, Cause(line)) for key, line in keys.items()]


def require_balance(study: Study, evaluator: Evaluator, values: Floats) -> None:
    """Check the equilibrium of designs as `tried` does, if any given force varies.

    Raises: InputError as `tried` does.
    """
    paths = [path for number in evaluator.numbers for path in number.paths]
    if any(path[0] == "case" and path[2] in ("forces", "moments") for path in paths):
        tried(study, evaluator, values, {})


def _unheld_rows(
    study: Study, evaluator: Evaluator, values: Iterable[float]
) -> dict[tuple[str, str], str]:
    """Return why pins of a design are out of equilibrium, by pin and case; empty if none is.

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
    """Return a connection of a pin whose force does not vary; the last one if all vary."""
    varied = {path[3] for number in evaluator.numbers for path in number.paths
              if path[:3] == ("case", case, "forces") and len(path) > 3}  # fmt: skip
    connections = study.connections(pin)
    return next((c for c in connections if c not in varied), connections[-1])
