"""What the study file may ask for that this version cannot do yet."""

from __future__ import annotations

from pinstress.errors import InputError
from pinstress.study import Study


def require_built(study: Study, model: str) -> None:
    """Raises: InputError for what the contract promises and this version does not have yet."""
    if model not in ("auto", "solid"):
        raise InputError(f"{study.path}: model {model!r} is not built yet; use solid or auto")
