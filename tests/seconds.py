"""Lists the tests that take more than a second, which `make test` leaves to `make test-rest`.

    python -m pytest -n auto -m "not slow" --durations=0 --durations-min=0.05 > log
    python -m tests.seconds log

Tests that a log does not mention stay as they are.
"""

from __future__ import annotations

import math
import re
import sys
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path

LIST = Path(__file__).with_name("seconds.txt")
MAX_SECONDS = 1.0  # s of a function, over all its parameters
DURATION = re.compile(r"^([\d.]+)s (?:call|setup|teardown) +(tests/\S+?::\w+)", re.MULTILINE)


def functions() -> set[str]:
    """The listed functions, as pytest names them, without parameters."""
    return set(LIST.read_text(encoding="utf-8").split())


def changed(listed: set[str], logs: Iterable[str]) -> set[str]:
    """The functions that take seconds after what some logs say."""
    took = defaultdict[str, float](float)
    for log in logs:
        for seconds, function in DURATION.findall(log):
            took[function] += float(seconds)
    return {x for x in listed | took.keys() if took.get(x, math.inf) > MAX_SECONDS}


if __name__ == "__main__":
    logs = [Path(name).read_text(encoding="utf-8") for name in sys.argv[1:]]
    LIST.write_text("".join(f"{x}\n" for x in sorted(changed(functions(), logs))))
