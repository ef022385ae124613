"""A Dask scheduler and its workers, with checks that they answer, can work, and have our
versions.
"""

from __future__ import annotations

import asyncio
import inspect
import logging
import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from typing import Any

from distributed import CancelledError, Client, Future

from pinstress.explore.sweep import versions as asking
from pinstress.explore.sweep.connection import ClusterConnection
from pinstress.study.reading.errors import InputError

SCHEDULER_TIMEOUT = 10.0  # time within which a scheduler must answer, s
# Time within which it must have a worker that works, also if it starts workers on demand, s
WORKER_TIMEOUT = 30.0
CHECK_INTERVAL = 3.0  # time between two checks of the scheduler, s
WORKER_POLL_INTERVAL = 0.2  # time between two checks until there is a worker, s
IGNORED_WARNINGS = "Mismatched versions|Sending large graph"  # warnings of Dask
MAX_LISTED_WORKERS = 20  # largest number of workers listed in a message

VERSIONS_EXPRESSION = "[found := {}, exec(text, found), found['versions'](packages)][-1]"


class Cluster:
    """A connected scheduler.

    packages: packages of which workers must have our versions, in addition to pinstress and Python.
    tell: called with warnings.
    """

    patience = SCHEDULER_TIMEOUT

    def __init__(
        self,
        client: Client,
        connection: ClusterConnection,
        packages: Sequence[str],
        tell: Callable[[str], None],
    ) -> None:
        self.client, self.connection = client, connection
        self._packages, self._expected = packages, asking.versions(packages)
        self._tell = tell
        self._same, self._paused, self._told = set[str](), set[str](), set[str]()
        self._looked = self._able = 0.0
        self.workers = 0
        self.wait_for_worker()

    def wait_for_worker(self) -> None:
        """Wait until a worker can work.

        A task is submitted meanwhile, since without a task an adaptive cluster starts no worker.

        Raises: InputError, as `look`.
        """
        self._able, self.workers = time.monotonic(), 0
        request: Future[None] | None = None
        while not self.look(now=True):
            if request is None:
                request = self.client.submit(eval, "None", pure=False)
            time.sleep(WORKER_POLL_INTERVAL)

    def look(self, now: bool = False) -> int:
        """Check the scheduler and its workers, at most every CHECK_INTERVAL s unless `now`. Return
        the number of workers that can work; if there are none, the last such number.

        Raises: InputError if the scheduler does not answer, if no worker has worked for
        WORKER_TIMEOUT s, or if one has other versions.
        """
        if not now and time.monotonic() - self._looked < CHECK_INTERVAL:
            return self.workers
        workers = self._identities()
        self._looked = time.monotonic()
        self._ask([address for address in workers if address not in self._same])
        self._same &= set(workers)  # another worker may start at the same address
        self._tell_of_paused({a for a, worker in workers.items() if worker["status"] == "paused"})
        if any(_works(workers[address]) for address in self._same):
            self._able = time.monotonic()
        elif time.monotonic() - self._able > WORKER_TIMEOUT:
            raise self._unable(len(workers))
        able = [address for address in self._same if workers[address]["status"] == "running"]
        self.workers = len(able) or self.workers
        return self.workers

    def rows(self, future: Future[Any]) -> Any:
        """Return the result of a finished batch; None if it was lost with its worker."""
        try:
            return future.result(timeout=SCHEDULER_TIMEOUT)
        except TimeoutError:
            if future.status == "finished":
                self._tell_once("a worker that has solved designs does not answer; still waiting")
        except (CancelledError, OSError):
            if self.client.status != "running":
                raise self.lost() from None
        return None

    def lost(self) -> InputError:
        """Return the error that the scheduler has ended or cannot be reached."""
        return InputError(
            f"--scheduler: the connection to the scheduler at {self.connection.address} is lost",
            code="no-scheduler",
        )

    def require_same(self, answers: Mapping[str, Mapping[str, str] | BaseException]) -> None:
        """Check the versions of workers.

        answers: for each worker its versions, or the error of the request for them.

        Raises: InputError if workers have other versions.
        """
        lines = [f"{who}: {other}" for who, has in answers.items() if (other := self._other(has))]
        if lines:
            raise other_versions(lines)

    def _other(self, versions: Mapping[str, str] | BaseException) -> str:
        if isinstance(versions, BaseException):
            return short(versions)
        return ", ".join(
            f"{name} {versions.get(name, asking.MISSING_VERSION)} (here {version})"
            for name, version in self._expected.items()
            if versions.get(name) != version
        )

    def _identities(self) -> dict[str, Any]:
        """Return the scheduler's information on each of its workers."""
        try:
            scheduler: Any = self.client.scheduler
            said: dict[str, Any] = self.client.sync(
                scheduler.identity, callback_timeout=SCHEDULER_TIMEOUT
            )
        except TimeoutError:
            if self.client.status != "running":  # it tries to connect again
                raise self.lost() from None
            raise InputError(
                f"--scheduler: the scheduler at {self.connection.address} has not answered for "
                f"{SCHEDULER_TIMEOUT:g} s",
                code="no-scheduler",
            ) from None
        except (OSError, CancelledError, RuntimeError):
            raise self.lost() from None
        return dict(said["workers"])

    def _ask(self, new: Sequence[str]) -> None:
        """Ask workers for their versions; those that do not answer are asked again later.

        Raises: InputError if workers have other versions.
        """
        variables = {"text": inspect.getsource(asking), "packages": self._packages}

        async def one(address: str) -> Any:
            with suppress(TimeoutError, OSError):
                run: Any = self.client.run(
                    eval, VERSIONS_EXPRESSION, variables, workers=[address], on_error="return"
                )
                return (await asyncio.wait_for(run, SCHEDULER_TIMEOUT)).get(address)
            return None

        async def all_() -> list[Any]:
            return list(await asyncio.gather(*map(one, new)))

        if not new:
            return
        answers = dict(zip(new, self.client.sync(all_), strict=True))
        versions = {
            a: x for a, x in answers.items() if x is not None and not isinstance(x, OSError)
        }
        self.require_same(versions)
        self._same |= set(versions)

    def _tell_of_paused(self, paused: set[str]) -> None:
        for address in sorted(paused):
            self._tell_once(
                f"the worker {address} is paused, since its memory is nearly full: it begins no "
                "design until some is free (dask worker --memory-limit)"
            )
        self._paused = paused

    def _tell_once(self, message: str) -> None:
        if message not in self._told:
            self._told.add(message)
            self._tell(message)

    def _unable(self, count: int) -> InputError:
        """Return the error that no worker works.

        count: number of workers that the scheduler knows.
        """
        what, code = f"has no worker that answers, for {WORKER_TIMEOUT:g} s", "no-worker"
        if not count:
            what = f"has had no worker for {WORKER_TIMEOUT:g} s; start one with: "
            what += self.connection.worker_command
        elif self._paused:
            code = "workers-paused"
            what = "has only workers that are paused, since their memory is nearly full, and none "
            what += (
                f"has worked for {WORKER_TIMEOUT:g} s; give them more (dask worker --memory-limit)"
            )
        where = self.connection.address
        return InputError(f"--scheduler: the scheduler at {where} {what}", code=code)


def _works(worker: Mapping[str, Any]) -> bool:
    return bool(worker["status"] == "running" or worker["metrics"].get("executing"))


@contextmanager
def connected(
    connection: ClusterConnection, packages: Sequence[str], tell: Callable[[str], None]
) -> Iterator[Cluster]:
    """Connect to an existing Dask cluster, and check its workers.

    packages, tell: as in Cluster.

    Raises: InputError if nothing answers, if keys are refused, if there is no worker, or if one has
    other versions.
    """
    connection.require_answer(SCHEDULER_TIMEOUT)
    with _silent():
        try:
            client = _Closed(  # type: ignore[no-untyped-call]  # as all of dask
                connection.address,
                timeout=SCHEDULER_TIMEOUT,
                set_as_default=False,
                security=connection.security,
            )
        except Exception as error:  # Dask raises various errors if no scheduler answers there
            raise connection.no_scheduler(short(error)) from None
        try:
            yield Cluster(client, connection, packages, tell)
        finally:
            with suppress(TimeoutError, OSError):
                client.close(timeout=1.0)  # type: ignore[no-untyped-call]


class _Closed(Client):
    """A client that only this module closes; Python does not, even if it has never connected."""

    def __del__(self) -> None:
        pass


def other_versions(lines: Sequence[str]) -> InputError:
    """Return the error that workers have other versions.

    lines: differences, by worker.
    """
    beyond = len(lines) - MAX_LISTED_WORKERS
    more = [f"and {beyond} more"] if beyond > 0 else []
    return InputError(
        "\n".join(
            [
                "--scheduler: numbers could differ on workers with other versions than this "
                "process has; install the same there, or end them",
                *lines[:MAX_LISTED_WORKERS],
                *more,
            ]
        ),
        code="other-version",
    )


def short(error: BaseException) -> str:
    """Return the first line of an error."""
    return (str(error).strip() or type(error).__name__).splitlines()[0][:200]


@contextmanager
def _silent() -> Iterator[None]:
    """Silence Dask's messages inside a context.

    Dask logs connections that end, warns of versions, which are compared here, and warns of the
    size of sent files.
    """
    parts = "worker", "nanny", "scheduler", "core", "comm", "client"
    names = ("distributed", *(f"distributed.{part}" for part in parts), "tornado", "asyncio")
    loggers = [logging.getLogger(name) for name in names]
    before = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL + 1)
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message=f"(?s).*({IGNORED_WARNINGS})")
            yield
    finally:
        for logger, level in zip(loggers, before, strict=True):
            logger.setLevel(level)
