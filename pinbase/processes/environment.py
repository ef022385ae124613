"""Environment variables that libraries read, set so that they do not affect a run."""

from __future__ import annotations

import os

import click

from pinbase.processes.threads import hold_threads

MAX_TIMESTAMP = 253_402_300_799  # the end of the year 9999, the last that Python supports
EPOCH_VARIABLE = "SOURCE_DATE_EPOCH"


def settle_surroundings() -> None:
    """One thread per numeric library; plots without windows; no pydantic plugins, for which it
    searches all installed packages; an invalid SOURCE_DATE_EPOCH removed, because libraries fail
    on it at import (our files contain no time).
    """
    hold_threads()
    os.environ["MPLBACKEND"] = "agg"
    os.environ["PYDANTIC_DISABLE_PLUGINS"] = "__all__"
    stated = os.environ.get(EPOCH_VARIABLE)
    if stated is not None and not (stated.isdecimal() and int(stated[:20]) <= MAX_TIMESTAMP):
        del os.environ[EPOCH_VARIABLE]
        click.echo(f"Warning: {EPOCH_VARIABLE} is not a time in seconds and is ignored.", err=True)
