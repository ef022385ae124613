"""Many cases of a test: in one collected test, or a sample of them in CI."""

from __future__ import annotations

import functools
import inspect
import itertools
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import pytest

Test = Callable[..., None]


def sampled(cases: Iterable[Any], every: int, first: int = 0) -> list[Any]:
    """Return cases for `pytest.mark.parametrize`, of which CI runs one in `every`; the others are
    marked `long` and run in `make test-all` only.

    first: the number of the first case that CI runs
    """
    return [
        case
        if number % every == first % every
        else pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=pytest.mark.long)
        for number, case in enumerate(cases)
    ]


def in_turn(name: str, cases: Sequence[Any]) -> Callable[[Test], Test]:
    """Return a decorator for several tests of the same cases, of which CI runs one case in each
    test.

    Each test takes the next case, so that CI runs every case in one of the tests or another; the
    others are marked `long`.
    """
    turn = itertools.count()

    def decorate(test: Test) -> Test:
        mark = pytest.mark.parametrize(name, sampled(cases, every=len(cases), first=next(turn)))
        decorated: Test = mark(test)
        return decorated

    return decorate


def each(names: str | Sequence[str], cases: Iterable[Any]) -> Callable[[Test], Test]:
    """Run a test once for every case, as one collected test that reports all failures together.

    This is for cases that take milliseconds: collecting, scheduling and reporting a thousand tests
    takes longer than running them. It takes the arguments of `pytest.mark.parametrize` and stacks
    like it. `tmp_path`, `monkeypatch` and `capsys` are made anew for each case; other fixtures are
    shared.

    names: arguments of the test, one or several
    cases: a value for one name, a tuple of values for several
    """
    keys = re.findall(r"\w+", names) if isinstance(names, str) else list(names)
    single = isinstance(names, str) and len(keys) == 1
    rows = [(case,) if single else tuple(case) for case in cases]
    if not rows:
        raise ValueError(f"no cases of {', '.join(keys)}")

    def decorate(test: Test) -> Test:
        @functools.wraps(test)
        def run(**fixtures: Any) -> None:
            failures: list[BaseException] = []
            labels = []
            for number, row in enumerate(rows):
                values = dict(zip(keys, row, strict=True))
                try:
                    with _fresh(fixtures, number) as own:
                        test(**own, **values)
                except (Exception, pytest.fail.Exception) as error:
                    label = ", ".join(f"{key}={value!r:.80}" for key, value in values.items())
                    error.add_note(f"case {number}: {label}")
                    failures.append(error)
                    labels.append(label)
            if failures:
                message = f"{len(failures)} of {len(rows)} cases failed: {'; '.join(labels)}"
                raise BaseExceptionGroup(message, failures)

        signature = inspect.signature(test)
        kept = [p for p in signature.parameters.values() if p.name not in keys]
        run.__signature__ = signature.replace(parameters=kept)  # type: ignore[attr-defined]
        return run

    return decorate


@contextmanager
def _fresh(fixtures: dict[str, Any], number: int) -> Iterator[dict[str, Any]]:
    """Yield the fixtures of a test for one of its cases."""
    own = dict(fixtures)
    if "tmp_path" in own:
        own["tmp_path"] = fixtures["tmp_path"] / str(number)
        own["tmp_path"].mkdir()
    if "capsys" in own:
        own["capsys"].readouterr()
    with pytest.MonkeyPatch.context() as patch:
        if "monkeypatch" in own:
            own["monkeypatch"] = patch
        yield own
