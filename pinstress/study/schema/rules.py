"""Rules on keys of a table of the study file that belong together or exclude each other."""

from collections.abc import Callable
from typing import Any

from pydantic import model_validator

from pinbase.errors import ArgumentError
from pinstress.study.schema.types import StrictTable


def require_one(what: str, *given: Any) -> None:
    """Raise ArgumentError unless exactly one value is given."""
    if sum(x is not None for x in given) != 1:
        raise ArgumentError(f"give {what}", "give-one")


def require_both(what: str, one: Any, other: Any) -> None:
    """Raise ArgumentError unless both values are given, or neither."""
    if (one is None) != (other is None):
        raise ArgumentError(f"{what} must be given together", "give-both")


def exactly_one(what: str, *keys: str) -> Any:
    """Return the validator of a table in which exactly one of some keys must be given."""
    return condition(lambda table: require_one(what, *(getattr(table, key) for key in keys)))


def both_or_none(one: str, other: str) -> Any:
    """Return the validator of a table in which two keys must be given together."""
    what = f"{one} and {other}"
    return condition(lambda table: require_both(what, getattr(table, one), getattr(table, other)))


def at_most_one(one: str, other: str) -> Any:
    """Return the validator of a table in which two keys may not be given together."""

    def check(table: StrictTable) -> None:
        if getattr(table, one) is not None and getattr(table, other) is not None:
            raise ArgumentError(f"give {one} or {other}, not both", "give-one")

    return condition(check)


def not_zero(*keys: str) -> Any:
    """Return the validator of a table in which vectors must not be zero, if they are given."""

    def check(table: StrictTable) -> None:
        for key in keys:
            if not any(getattr(table, key) or (1.0,)):
                text = f"{key} must not be zero; give its direction"
                raise ArgumentError(text, "no-direction")

    return condition(check)


def condition(check: Callable[[Any], None]) -> Any:
    """Return the validator of a whole table that raises the errors of `check`."""

    def checked(table: StrictTable) -> StrictTable:
        check(table)
        return table

    return model_validator(mode="after")(checked)
