"""Errors that end a command with a message instead of a traceback."""

from __future__ import annotations


class InputError(Exception):
    """Bad input: the message names the file, the key and what would be right. Exit status 2."""
