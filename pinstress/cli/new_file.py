"""Files named by the user: an existing one is never overwritten without permission."""

from __future__ import annotations

import os
from pathlib import Path

from pinstress.study.reading.errors import InputError


def require_new(path: Path, remedy: str) -> None:
    """Check that `path` does not exist, not even as a broken link.

    remedy: advice for the user.

    Raises: InputError if it exists.
    """
    if os.path.lexists(path):
        raise InputError(f"{path} exists already; {remedy}", code="exists")


def write_new(path: Path, content: bytes, remedy: str) -> None:
    """Create a file.

    Raises: InputError if it exists or cannot be written.
    """
    try:
        with path.open("xb") as file:  # does not follow links
            file.write(content)
    except FileExistsError:
        raise InputError(f"{path} exists already; {remedy}", code="exists") from None
    except OSError as error:
        raise InputError(
            f"{path}: cannot be written ({error.strerror})", code="cannot-write"
        ) from None
