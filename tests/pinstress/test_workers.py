"""Jobs side by side: their answers, their failures, and that no process is left over."""

from __future__ import annotations

import multiprocessing
import os
import signal
import time
from functools import partial

import pytest

from pinstress.errors import InputError
from pinstress.workers import Died, Job, Tell, cores, side_by_side


def child_processes() -> list[int]:
    """Ours that are still there, dead or alive."""
    own, found = os.getpid(), []
    for entry in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{entry}/stat") as stat:
                after_name = stat.read().rpartition(")")[2].split()
        except OSError:
            continue
        if int(after_name[1]) == own:
            found.append(int(entry))
    return found


def square(x: float, tell: Tell) -> float:
    tell(f"squaring {x}")
    time.sleep(0.02 * (3.0 - x))  # the first ends last
    return x * x


@pytest.mark.parametrize("most", [1, 2, 5])
def test_answers_come_in_the_order_of_the_jobs(most: int) -> None:
    told: list[tuple[str, float]] = []
    work = [Job(f"{x}", partial(square, x)) for x in (0.0, 1.0, 2.0, 3.0)]
    found = side_by_side(work, most, lambda message, part: told.append((message, part)))
    assert found == [0.0, 1.0, 4.0, 9.0]
    assert any("squaring 2.0" in message for message, _ in told)
    parts = [part for _, part in told]
    assert parts == sorted(parts)
    assert parts[-1] == (1.0 if most > 1 else 0.75)
    assert multiprocessing.active_children() == []


def test_each_job_has_its_own_process_unless_there_is_one_at_a_time() -> None:
    work = [Job("pid", lambda _: os.getpid())] * 3
    assert side_by_side(work, 1) == [os.getpid()] * 3
    apart = side_by_side(work, 2)
    assert len({os.getpid(), *map(str, apart)}) == 4


def test_a_process_that_dies_costs_its_own_job_alone() -> None:
    def crash(_: Tell) -> int:
        os.kill(os.getpid(), signal.SIGKILL)
        return 0

    found = side_by_side([Job("a", lambda _: 1), Job("b", crash), Job("c", lambda _: 3)], 2)
    assert found[0] == 1
    assert found[2] == 3
    assert isinstance(found[1], Died)
    assert "signal 9" in found[1].reason


def test_an_exception_is_raised_with_the_jobs_name_and_ends_the_others() -> None:
    def wrong(_: Tell) -> None:
        raise InputError("no such thing")

    def sleep(_: Tell) -> None:
        time.sleep(60.0)

    before = child_processes()
    with pytest.raises(InputError, match="no such thing") as caught:
        side_by_side([Job("long", sleep), Job("pin Q", wrong)], 2)
    (note,) = caught.value.__notes__
    assert note.startswith("pin Q, in its own process:")
    assert "in wrong" in note  # the traceback of that process
    assert child_processes() == before


def test_what_cannot_be_sent_is_told_all_the_same() -> None:
    def wrong(_: Tell) -> None:
        raise ValueError(lambda: 1)

    with pytest.raises(RuntimeError, match=r"pin Q, in its own process"):
        side_by_side([Job("pin Q", wrong)] * 2, 2)


def test_an_interrupt_ends_processes_that_do_not_listen() -> None:
    """As those inside a mesher's own code, which hear of no signal."""

    def deaf(tell: Tell) -> None:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        tell("deaf")
        time.sleep(60.0)

    def interrupt(message: str, _: float) -> None:
        if "deaf" in message:
            raise KeyboardInterrupt

    before = child_processes()
    with pytest.raises(KeyboardInterrupt):
        side_by_side([Job("a", deaf), Job("b", deaf)], 2, interrupt)
    assert child_processes() == before


def test_there_is_a_core() -> None:
    assert 1 <= cores() <= (os.cpu_count() or 1)
