"""Conversion of values to plain JSON values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from reports.format.numbers import finite


def plain(value: Any) -> Any:
    """Return a value as JSON has it.

    Non-finite numbers become null, records objects of their fields, NumPy numbers ordinary ones.
    """
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: plain(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [plain(item) for item in value]
    if isinstance(value, bool | np.bool_):
        return bool(value)
    if isinstance(value, np.integer):
        return int(value)
    return finite(float(value)) if isinstance(value, float | np.floating) else value
