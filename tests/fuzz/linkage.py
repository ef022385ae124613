"""Linkages drawn as the grammar draws them, changed, and their reactions."""

from __future__ import annotations

import cmath
import math
import random
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import pinstress
from pinstress.analysis.gather.gather import loads_only
from tests.fuzz import draw_mechanism
from tests.fuzz.quantity import Quantity, Tree, angle, write

Floats = NDArray[np.float64]
Cases = dict[str, dict[str, Floats]]


def draw(seed: int, friction: bool = True) -> Tree:
    """A study of a linkage alone: all its cases."""
    rng = random.Random(f"linkage {seed}")
    drawn = draw_mechanism.mechanism(rng)
    if not friction:
        for part in (
            *drawn.mechanism.get("slider", {}).values(),
            *drawn.mechanism["joint"].values(),
        ):
            part.pop("friction", None)
            part.pop("diameter", None)
    return {"title": "A linkage", "units": "m-N-s", "mechanism": drawn.mechanism,
            "case": drawn.cases}  # fmt: skip


def reactions(tree: Tree, spelling: random.Random | None = None) -> Cases:
    """By case and connection the force on the pin along the case, (T, 2) N in world axes, and
    what the drive does ("drive"), (T, 1) N or N m.
    """
    with tempfile.TemporaryDirectory() as folder:
        study = pinstress.load_study(write(tree, Path(folder), spelling))
        results = loads_only(study)
    newton = study.system.factor("force")
    does = study.system.factor("force" if "slider" in tree["mechanism"]["drive"] else "moment")
    found: Cases = {}
    for case in results.reactions:
        forces = case.forces[..., :2] * newton
        found[case.case] = {c: forces[:, k] for k, c in enumerate(case.connections)}
    for drive in results.drive:
        found[drive.case]["drive"] = drive.force[:, None] * does
    return found


def compare(one: Cases, other: Cases, accuracy: float = 1e-9) -> None:
    """The same, as parts of the largest force of each case."""
    assert one.keys() == other.keys()
    for case, wanted in one.items():
        assert wanted.keys() == other[case].keys()
        for name, values in wanted.items():
            same = name == "drive"
            size = max(np.abs(v).max() for k, v in wanted.items() if (k == "drive") == same)
            assert np.abs(other[case][name] - values).max() <= accuracy * size, (case, name)


def moved(tree: Tree, turn: float, shift: complex) -> Tree:
    """The same linkage elsewhere: every place and direction turned about the origin, then moved."""
    unit = cmath.rect(1.0, turn)

    def place(at: Any) -> Any:
        z = complex(at[0].value, at[1].value) * unit + shift
        return [Quantity(z.real, "length"), Quantity(z.imag, "length")]

    def vector(v: Any) -> Any:
        plain = not isinstance(v[0], Quantity)
        z = complex(*(v if plain else (q.value for q in v[:2]))) * unit
        return [z.real, z.imag] if plain else [
            *(Quantity(x, v[0].dimension) for x in (z.real, z.imag)), *v[2:]
        ]  # fmt: skip

    m = tree["mechanism"]
    gravity = m["gravity"] or [Quantity(0.0, "acceleration"), Quantity(-9.80665, "acceleration")]
    joints = {k: j | {"at": place(j["at"])} for k, j in m["joint"].items()}
    bodies = {
        k: b | ({"centre": place(b["centre"])} if "centre" in b else {})
        for k, b in m["body"].items()
    }
    sliders = {
        k: s | {"joints": [j if isinstance(j, str) else place(j) for j in s["joints"]],
                "direction": vector(s["direction"])}
        for k, s in m.get("slider", {}).items()
    }  # fmt: skip
    made = m | {"gravity": vector(gravity), "joint": joints, "body": bodies,
                "drive": turned_drive(m["drive"], turn)}  # fmt: skip
    if sliders:
        made["slider"] = sliders
    cases = {}
    for name, case in tree["case"].items():
        apply = [load | {"force": vector(load["force"])} for load in case["apply"]]
        at = case.get("position")
        if at is not None and at.dimension == "angle":
            at = angle(at.value + turn)
        cases[name] = case | {"apply": apply} | ({} if at is None else {"position": at})
    return tree | {"mechanism": made, "case": cases}


def turned_drive(drive: Tree, turn: float) -> Tree:
    """The same course, that much further on; a slider's turns with it."""
    if "slider" in drive:
        return drive
    if "table" in drive:
        table = drive["table"]
        rows = [r | {"position_deg": r["position_deg"] + math.degrees(turn)} for r in table.rows]
        return drive | {"table": type(table)(table.name, tuple(rows))}
    return drive | {key: angle(drive[key].value + turn) for key in ("start", "end")}
