"""The finished searches of `size --least-weight`, which are kept as they end."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from pinstress.explore.size.lightest_pin import Lightest


@dataclass(frozen=True)
class FinishedSearch:
    """The result of a pin's search, and the number of the round to which the search belongs."""

    round: int
    lightest: Lightest


class SearchLog:
    """The log of searches in rounds. The rounds are the same in every run of a command, so that a
    round and a pin identify a search.

    done: finished searches of an earlier run.
    keep: called after each search with all finished searches.
    """

    def __init__(
        self,
        done: Iterable[FinishedSearch] = (),
        keep: Callable[[tuple[FinishedSearch, ...]], None] = lambda _: None,
    ) -> None:
        self._done = {(search.round, search.lightest.pin): search for search in done}
        self._keep, self._round = keep, 0

    def __len__(self) -> int:
        return len(self._done)

    def begin(self) -> None:
        """Begin the next round."""
        self._round += 1

    def get(self, pin: str) -> Lightest | None:
        """Return the result of a pin in this round; None if it is not finished."""
        search = self._done.get((self._round, pin))
        return search.lightest if search else None

    def add(self, lightest: Lightest) -> None:
        """Keep a result of this round."""
        self._done[self._round, lightest.pin] = FinishedSearch(self._round, lightest)
        self._keep(tuple(self._done.values()))
