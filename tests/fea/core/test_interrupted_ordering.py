"""A signal that comes while METIS orders the unknowns ends the program as at any other moment."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import pytest

from tests.conftest import ROOT
from tests.support.programs.process_group import started

ORDERING = """
import numpy as np
import scipy.sparse as sp
from fea.core.linear_solver import _dissection
from pinbase.processes import interrupts

line = sp.diags([np.ones(29), np.ones(30), np.ones(29)], [-1, 0, 1])
plane = sp.kronsum(line, line)
K = sp.csr_matrix(sp.kronsum(plane, line))
interrupts.listen()
try:
    print("ordering", flush=True)
    while True:  # nearly all of the time in METIS, which sets handlers of its own meanwhile
        _dissection(K, np.arange(K.shape[0]))
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


@pytest.mark.linux
@pytest.mark.parametrize("ending", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_within_metis_is_an_interrupt(ending: signal.Signals) -> None:
    with started(
        [sys.executable, "-c", ORDERING],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ordering\n"
        time.sleep(0.5)
        process.send_signal(ending)
        outcome, errors = process.communicate(timeout=60)
    assert (outcome, errors) == ("interrupted\n", "")
