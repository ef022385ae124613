"""Optional packages, which the extras of pyproject.toml install."""

from __future__ import annotations

from importlib.util import find_spec

from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study

EXTRAS = {  # the extra of each package
    "cryptography": "cluster",
    "distributed": "cluster",
    "pandas": "fatigue",  # pylife needs it
    "pylife": "fatigue",
    "typst": "pdf",
}
MISSING = "missing-extra"


def require_package(package: str, user: str) -> None:
    """Require an optional package before the work that needs it begins.

    user: the option or command that needs it, with which the message begins.

    Raises: InputError if it is not installed; the message names the extra that installs it.
    """
    if problem := _missing(package):
        raise InputError(f"{user}: {problem}", code=MISSING)


def require_fatigue(study: Study) -> None:
    """Require the packages of the fatigue assessment of a study, if it has one.

    Raises: InputError with the line of [fatigue], as `require_package`.
    """
    if study.table.fatigue is not None and (problem := _missing("pylife")):
        raise study.error(f"fatigue: {problem}", code=MISSING)


def _missing(package: str) -> str:
    """Return the remedy if a package is not installed; empty if it is."""
    if find_spec(package) is not None:
        return ""
    return f"needs {package}, which is not installed: pip install 'pinstress[{EXTRAS[package]}]'"
