"""Jobs side by side: their answers, their failures, and that no process is left over."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from functools import partial

import pytest

from pinbase.processes.pool import Job, ProcessDied, Tell, cores, in_parallel, processes
from pinstress.study.reading.errors import InputError
from tests.support.each import each


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


@each("most", [1, 2, 5])
def test_answers_come_in_the_order_of_the_jobs(most: int) -> None:
    told: list[tuple[str, float]] = []
    work = [Job(f"{x}", partial(square, x)) for x in (0.0, 1.0, 2.0, 3.0)]
    found = in_parallel(work, most, lambda message, part: told.append((message, part)))
    assert found == [0.0, 1.0, 4.0, 9.0]
    assert any("squaring 2.0" in message for message, _ in told)
    parts = [part for _, part in told]
    assert parts == sorted(parts)
    assert parts[-1] == (1.0 if most > 1 else 0.75)
    assert multiprocessing.active_children() == []


def where(_: Tell) -> int:
    time.sleep(0.05)
    return os.getpid()


def test_there_are_as_many_processes_as_jobs_at_a_time_and_none_beside_this_one_for_one() -> None:
    work = [Job("pid", where)] * 6
    assert in_parallel(work, 1) == [os.getpid()] * 6
    apart = in_parallel(work, 2)
    assert len(set(map(str, apart))) == 2
    assert os.getpid() not in apart


def name(called: str, _: Tell) -> str:
    return called


def crash(_: Tell) -> int:
    os.kill(os.getpid(), signal.SIGKILL)
    return 0


@pytest.mark.parametrize("most", [2, 3])
def test_a_process_that_dies_costs_the_job_it_was_doing_alone(most: int) -> None:
    """Also when all processes have died before the last job."""
    names = "a!b!!!c!"
    work = [Job[object](n, crash if n == "!" else partial(name, n)) for n in names]
    found = in_parallel(work, most)
    assert ["!" if isinstance(f, ProcessDied) else f for f in found] == list(names)
    assert all("signal 9" in f.reason for f in found if isinstance(f, ProcessDied))


def wrong(_: Tell) -> None:
    raise InputError("no such thing")


def sleep(_: Tell) -> None:
    time.sleep(60.0)


def test_an_exception_is_raised_with_the_jobs_name_and_ends_the_others() -> None:
    before = child_processes()
    with pytest.raises(InputError, match="no such thing") as caught:
        in_parallel([Job("long", sleep), Job("pin Q", wrong)], 2)
    (note,) = caught.value.__notes__
    assert note.startswith("pin Q, in its own process:")
    assert "in wrong" in note  # the traceback of that process
    assert child_processes() == before


def unsent(_: Tell) -> None:
    raise ValueError(lambda: 1)


def test_what_cannot_be_sent_is_told_all_the_same() -> None:
    with pytest.raises(RuntimeError, match=r"pin Q, in its own process"):
        in_parallel([Job("pin Q", unsent)] * 2, 2)


def deaf(tell: Tell) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    tell("deaf")
    time.sleep(60.0)


def test_an_interrupt_ends_processes_that_do_not_listen() -> None:
    """As those inside a mesher's own code, which hear of no signal."""

    def interrupt(message: str, _: float) -> None:
        if "deaf" in message:
            raise KeyboardInterrupt

    before = child_processes()
    with pytest.raises(KeyboardInterrupt):
        in_parallel([Job("a", deaf), Job("b", deaf)], 2, interrupt)
    assert child_processes() == before


@pytest.mark.slow
@pytest.mark.linux
def test_a_child_that_is_ended_as_it_starts_does_nothing_of_its_parents() -> None:
    """Under the parent's handlers, which raise, it would go on where the parent is."""
    code = """
import os
from functools import partial
from pinbase.processes import interrupts
from pinbase.processes.pool import Job, in_parallel
from tests.pinbase.processes.test_workers import sleep, wrong
from pinstress import InputError

own = os.getpid()
interrupts.listen()
for _ in range(200):
    try:
        in_parallel([Job("long", sleep), Job("pin Q", wrong)], 2)
    except InputError:
        continue
    finally:
        if os.getpid() != own:
            print("a child is here")
print("done")
"""
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert (said.stdout, said.stderr) == ("done\n", "")


def test_there_is_a_core() -> None:
    assert 1 <= cores() <= (os.cpu_count() or 1)


@pytest.mark.linux
def test_no_forks_beside_other_threads() -> None:
    """They would leave locks held in the child: gmsh then waits for ever."""
    stop = threading.Event()
    thread = threading.Thread(target=stop.wait)
    thread.start()
    try:
        assert processes(None) == processes(4) == 1
    finally:
        stop.set()
        thread.join()


def test_as_many_processes_as_asked_for_where_none_runs() -> None:
    code = "from pinbase.processes.pool import processes; print(processes(3), processes(None))"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert said.stdout.split() == ["3", str(cores())]
