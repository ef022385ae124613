"""The output of `pinstress check` on a study."""

from __future__ import annotations

from pinstress.cli.check import examine
from pinstress.study.reading.file import Study


def describe(study: Study) -> tuple[str, list[str], list[str]]:
    """Return the summary of a study, and the reasons and warnings of its examination.

    Raises: InputError as `examine`.
    """
    x = examine(study)
    return "\n".join(x.lines), x.unheld, x.warnings
