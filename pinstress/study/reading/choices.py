"""Options of an analysis in addition to its study, checked for the command line and for Python."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable
from numbers import Integral, Real
from typing import TYPE_CHECKING, TypedDict, TypeVar, get_args

from pinstress.study.reading.errors import InputError
from pinstress.study.schema.shown import as_text, listed, near

if TYPE_CHECKING:
    from fea.core.requirement import Model


V = TypeVar("V")
MAX_ARGUMENT = sys.float_info.max


class Selection(TypedDict, total=False):
    """Keyword arguments of analysis.plan.prepare; None means as in the study."""

    pins: Iterable[str] | None
    cases: Iterable[str] | None
    model: Model | None
    tolerance: float | None
    memory: float | None
    limit_load: bool


class ChoiceError(InputError):
    """A bad argument, with whose name the message begins; on the command line it is an option."""

    @property
    def of_option(self) -> str:
        """The message with the option's name."""
        argument, _, message = str(self).partition(":")
        return f"--{argument.replace('_', '-')}:{message}"


def select(
    names: Iterable[str], wanted: Iterable[str] | None, what: str, argument: str = ""
) -> list[str]:
    """Return the wanted names in the order of `names`, or all.

    argument: the argument that gave the wanted names, {what}s by default.

    Raises: ChoiceError for an unknown name, or an empty list.
    """
    known = dict.fromkeys(names)
    if wanted is None:
        return list(known)
    argument = argument or f"{what}s"
    if isinstance(wanted, str | bytes) or not isinstance(wanted, Iterable):
        like = next(iter(known), "A")
        raise ChoiceError(
            f"{argument}: must be a list of names such as [{like!r}], not {as_text(wanted)}",
            code="not-a-list",
        )
    wanted_names: list[object] = list(wanted)
    if not wanted_names:
        raise ChoiceError(
            f"{argument}: the list is empty; choose among {listed(known)}", code="empty"
        )
    for name in wanted_names:
        if not isinstance(name, str) or name not in known:
            hint = near(name, known)
            raise ChoiceError(
                f"{argument}: the study has no {what} {as_text(name)}; {hint}",
                code=f"unknown-{what}",
            )
    chosen = set(wanted_names)
    return [name for name in known if name in chosen]


def require_model(model: Model | None) -> Model | None:
    """Return the model.

    Raises: ChoiceError for an unknown model.
    """
    from fea.core.requirement import Model  # slow to import

    must = f"must be one of {listed(get_args(Model))}"
    right = model is None or model in get_args(Model)
    return _require(right, "model", model, must, "unknown-model")


def require_tolerance(tolerance: float | None) -> float | None:
    """Return the tolerance.

    Raises: ChoiceError unless it is between 0 and 1.
    """
    right = tolerance is None or (_is_number(tolerance) and 0.0 < tolerance < 1.0)
    return _require(right, "tolerance", tolerance, "must be between 0 and 1", "out-of-range")


def require_positive(argument: str, value: float | None, endless: bool = False) -> float | None:
    """Return the value.

    endless: whether it may be infinite.

    Raises: ChoiceError unless it is positive.
    """
    most = math.inf if endless else MAX_ARGUMENT
    right = value is None or (_is_number(value) and 0.0 < value <= most)
    return _require(right, argument, value, "must be a positive number", "not-positive")


def require_count(argument: str, value: int | None) -> int | None:
    """Return the value.

    Raises: ChoiceError unless it is a whole number of at least 1.
    """
    right = value is None or _is_count(value)
    return _require(right, argument, value, "must be a whole number of at least 1", "not-a-count")


def _require(right: bool, argument: str, value: V, must: str, code: str) -> V:
    if not right:
        raise ChoiceError(f"{argument}: {must}, not {as_text(value)}", code=code)
    return value


def _is_count(value: object) -> bool:
    return not isinstance(value, bool) and isinstance(value, Integral) and int(value) >= 1


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)
