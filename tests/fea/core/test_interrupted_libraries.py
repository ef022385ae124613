"""A signal that comes inside a library with handlers of its own ends the program as elsewhere."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import pytest

from tests.conftest import ROOT
from tests.support.each import sampled
from tests.support.programs.process_group import started

METIS = """
import numpy as np
import scipy.sparse as sp
from fea.core.linear_solver import _dissection

line = sp.diags([np.ones(29), np.ones(30), np.ones(29)], [-1, 0, 1])
plane = sp.kronsum(line, line)
K = sp.csr_matrix(sp.kronsum(plane, line))

def work():  # nearly all of the time in METIS, which sets handlers of its own meanwhile
    _dissection(K, np.arange(K.shape[0]))
"""
GMSH = """
import ctypes
import time

import gmsh
from geometry.mesh.gmsh_session import gmsh_model
from pinbase.processes.interrupts import INTERRUPT_SIGNALS

start = gmsh.initialize

def slow_start(**options):  # gmsh has the system's handlers at its start, for a millisecond
    for number in INTERRUPT_SIGNALS:
        ctypes.CDLL(None).signal(number, None)
    time.sleep(0.1)
    start(**options)

def work():
    with gmsh_model("empty"):
        pass

gmsh.initialize = slow_start
"""
INTERRUPTED = """
from pinbase.processes import interrupts

work()
interrupts.listen()
try:
    print("working", flush=True)
    while True:
        work()
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


ENDED = [
    *((METIS, signal.SIGINT), (GMSH, signal.SIGINT), (GMSH, signal.SIGTERM)),
    *((METIS, signal.SIGTERM), (METIS, signal.SIGHUP), (GMSH, signal.SIGHUP)),
]


@pytest.mark.linux
@pytest.mark.parametrize(("library", "ending"), sampled(ENDED, every=2))
def test_a_signal_within_a_library_is_an_interrupt(library: str, ending: signal.Signals) -> None:
    with started(
        [sys.executable, "-c", library + INTERRUPTED],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "working\n"
        time.sleep(0.5)
        process.send_signal(ending)
        outcome, errors = process.communicate(timeout=60)
    assert (outcome, errors) == ("interrupted\n", "")
