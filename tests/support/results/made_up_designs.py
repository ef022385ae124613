"""A table of designs as a sweep writes it, with made-up stresses."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pyarrow as pa

from pinbase.dimensions import Floats

REQUIRED = 1.5
YIELD = 700.0  # MPa
FAILING = ("no clearance is left", "geometry_without_room")


def made_up_designs(
    count: int,
    parameters: int = 5,
    rows: tuple[tuple[str, str], ...] = (("B", "landing"),),
    failing: float = 0.02,
    study: str = "made up",
) -> pa.Table:
    """Return a table of `count` designs, drawn from a fixed seed.

    The stress falls with the third power of the first parameter, the mass grows with the squares of
    all.
    failing: fraction of the designs without results
    """
    random = np.random.default_rng(1)
    keys = [f"pin.B.profile[{k + 1}].diameter" for k in range(parameters)]
    values = random.uniform(10.0, 30.0, (count, parameters))
    failed = random.random(count) < failing
    each = [_row(d, values[d], pin, case, random) for d in range(count) for pin, case in rows]
    for row in each:
        if failed[row["design"] - 1]:
            row |= dict.fromkeys(RESULTS) | {"reason": FAILING[0], "code": FAILING[1]}
            row |= {"verdict": "failed", "outcome": "not decided"}
        row |= dict(zip(keys, values[row["design"] - 1].tolist(), strict=True))
    laws = {key: {"unit": "mm", "law": "uniform 10 to 30"} for key in keys}
    return table_of(each, keys, laws, study)


RESULTS = ("max_von_mises", "error_estimate", "safety_factor", "verdict", "governing_time", "mass")
UNITS = {"max_von_mises": "MPa", "error_estimate": "MPa", "governing_time": "s", "mass": "kg"}


def _row(d: int, values: Floats, pin: str, case: str, random: Any) -> dict[str, Any]:
    rest = 1.0 + 0.02 * float(np.sin(values[1:]).sum()) + 0.1 * random.random()
    verdict = ("converged", "converged", "unconverged", "singular")[random.integers(4)]
    stress = 1.5e6 * rest / float(values[0]) ** 3 * (1.0 if pin == "B" else 0.8)
    return {
        "design": d + 1,
        "pin": pin,
        "case": case,
        "max_von_mises": stress,
        "error_estimate": 0.01 * stress,
        "safety_factor": YIELD / stress,
        "verdict": verdict,
        "outcome": "below yield" if stress < YIELD else "yields",
        "governing_time": float(random.integers(5)),
        "mass": 1e-3 * float((values**2).sum()),
        "reason": "" if verdict == "converged" else "made up",
        "code": "" if verdict == "converged" else verdict,
    }


def table_of(
    rows: list[dict[str, Any]],
    keys: list[str],
    laws: dict[str, dict[str, str]],
    study: str = "made up",
    required: float | None = REQUIRED,
) -> pa.Table:
    """Return rows as a table with the units and the metadata of a sweep."""
    texts = ("pin", "case", "verdict", "reason", "code")
    outcome = ["outcome"] if rows and all("outcome" in row for row in rows) else []
    order = ["design", "pin", "case", *keys, *RESULTS, *outcome, "reason", "code"]
    fields = []
    for name in order:
        kind = pa.string() if name in texts else pa.float64()
        if name == "design":
            kind = pa.int64()
        if any(isinstance(row[name], str) for row in rows):
            kind = pa.string()
        unit = laws[name]["unit"] if name in laws else UNITS.get(name, "")
        fields.append(pa.field(name, kind, metadata={"unit": unit}))
    told: dict[str, object] = {
        "study": study,
        "hash": "0" * 64,
        "units": "mm-N-s",
        "parameters": laws,
    }
    told |= {"required_safety_factor": required}
    schema = pa.schema(fields, metadata={"pinstress": json.dumps(told)})
    return pa.Table.from_pylist([{name: row[name] for name in order} for row in rows], schema)
