"""A pin under a course of loads, drawn as the grammar draws them, changed, and solved."""

from __future__ import annotations

import random
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import pinstress
from fea.core.requirement import Model
from tests.fuzz import draw_pin
from tests.fuzz.quantity import Csv, Quantity, Tree, write

Floats = NDArray[np.float64]
Change = Callable[[Floats, Floats], tuple[Floats, Floats]]
FORCES, MOMENTS = ("fx", "fy", "fz"), ("mx", "my", "mz")


@dataclass(frozen=True)
class Loaded:
    """A pin's table, forces and moments (T, C, 3) on its bands in the order of the profile, times
    (T,), and how loads spread.
    """

    pin: Tree
    forces: Floats
    moments: Floats
    times: Floats
    distribution: str = "uniform"
    name: str = "P"
    case: str = "case"
    units: str = "mm-N-s"

    @property
    def bands(self) -> list[str]:
        """Connections in the order of the profile."""
        return [s["connection"] for s in self.pin["profile"] if "connection" in s]

    @property
    def length(self) -> float:
        """m."""
        return float(sum(s["length"].value for s in self.pin["profile"]))

    def under(self, change: Change) -> Loaded:
        """The same pin, its forces and moments changed."""
        forces, moments = change(self.forces, self.moments)
        return replace(self, forces=forces, moments=moments)

    def at(self, *instants: int) -> Loaded:
        """Only these of its instants, at the first so many times."""
        rows = list(instants)
        forces, moments = self.forces[rows], self.moments[rows]
        times = np.linspace(0.0, 0.5 * (len(rows) - 1), len(rows))
        return replace(self, forces=forces, moments=moments, times=times)

    @property
    def tree(self) -> Tree:
        """The study, its loads in a table."""
        rows = []
        for k, time in enumerate(self.times):
            for j, band in enumerate(self.bands):
                row: Tree = {"connection": band, "time": Quantity(float(time), "time")}
                for names, kind, of in ((FORCES, "force", self.forces),
                                        (MOMENTS, "moment", self.moments)):  # fmt: skip
                    values = [Quantity(float(x), kind) for x in of[k, j]]
                    row |= dict(zip(names, values, strict=True))
                rows.append(row)
        case = {"kind": "given", "distribution": self.distribution}
        return {
            "title": "A relation",
            "units": self.units,
            "material": draw_pin.MATERIALS,
            "pin": {self.name: self.pin},
            "case": {self.case: case | {"table": Csv("loads.csv", tuple(rows))}},
        }


def draw(seed: int, instants: int = 3) -> Loaded:
    """Every other one under bearing pressures; every third one, and each that nothing holds, with
    moments.
    """
    rng = random.Random(f"relation {seed}")
    shape = draw_pin.profile(rng, rng.choice((1, 2)))
    clamp = draw_pin.clamps(rng, shape)
    names = [f"P{i}" for i in range(sum(s.band for s in shape.segments))]
    pin = draw_pin.table(shape, clamp, names)
    drawn = [draw_pin.instant(rng, {"P": pin}, True, bool(clamp)) for _ in range(instants)]
    forces, moments = (_along(drawn, key, names) for key in ("forces", "moments"))
    if seed % 3 and clamp:
        moments = np.zeros_like(forces)
    spread = ("uniform", "cosine")[seed % 2]
    return Loaded(pin, forces, moments, np.linspace(0.0, 1.0, instants), spread)


def _along(drawn: list[Tree], key: str, names: list[str]) -> Floats:
    """(T, C, 3) in SI; zero where none are drawn."""
    none = [Quantity(0.0, key)] * 3
    values = [[[q.value for q in now[key].get(c, none)] for c in names] for now in drawn]
    return np.array(values, dtype=np.float64)


@dataclass(frozen=True)
class Found:
    """A row of the results in SI; z: where the largest stress is."""

    maximum: float
    error: float
    time: float | None
    z: float
    verdict: str


def solve(
    study: Loaded | Tree, spelling: random.Random | None = None, model: Model = "harmonic"
) -> Found:
    """The one row of a study's results."""
    tree = study.tree if isinstance(study, Loaded) else study
    with tempfile.TemporaryDirectory() as folder:
        loaded = pinstress.load_study(write(tree, Path(folder), spelling))
        (row,) = pinstress.run(loaded, tolerance=0.3, model=model).pins
    assert row.verdict not in ("failed", "rigid"), row.note
    assert row.max_von_mises is not None
    assert row.error_estimate is not None
    assert row.location is not None
    factor = loaded.system.factor
    pascal, metre = factor("stress"), factor("length")
    return Found(
        row.max_von_mises * pascal,
        row.error_estimate * pascal,
        row.time,
        row.location[2] * metre,
        row.verdict,
    )
