"""Tests whether the error of local solids contains the truth: random pins compared with finer
meshes.

The references are computed on meshes of another family than those of a run: finer along all edges
of the cuts, and about every place where stress is nearly the largest. There are two references,
whose difference shows how reliable they are. The result of each pin is kept, so that an interrupted
benchmark can be resumed.
"""

from __future__ import annotations

import hashlib
import json
import math
import sys
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchmarks import ROOT
from benchmarks.cuts.random_cuts import CutTrial, cut_trials, kind_trials
from benchmarks.random_pins import STEEL
from benchmarks.timing import table
from fea.core.mesh_result import MeshMaximum
from fea.core.peak import Maximum
from fea.core.requirement import Requirement
from fea.cut.evaluate import cut_result, cut_solution
from fea.cut.local_solution import LocalFineness
from fea.cut.region import PIECE_REACH, loaded_bands, pieces
from fea.harmonic.section_solution import SectionProblem
from fea.singular.singularities import singularities_of
from fea.solve.solve import solve_pin

COUNT, KINDS, SEED = 30, 6, 7
TOLERANCE = 0.02
# For both references: the factors by which elements are smaller than on the last mesh of the run,
# along the edges of cuts and where stress is largest.
FINER = ((1.5, 2.2), (2.0, 3.0))
SECTION = 3  # levels by which the sections of the references are finer
LONGER = 2.0  # reach of the local solids of the references over that of a run
KEPT = ROOT / "build" / "benchmarks"


@dataclass(frozen=True)
class Inside:
    """The result of a pin.

    unknowns, of_reference: numbers of unknowns of the run and of the reference.
    off: relative error of the maximum. error: the estimated one.
    differ: relative difference of the references.
    spent, on_reference: processor times, s.
    """

    pin: str
    unknowns: int
    of_reference: int
    off: float
    error: float
    differ: float
    spent: float
    on_reference: float

    @property
    def inside(self) -> bool:
        """Whether the error contains the reference."""
        return self.off <= self.error

    @property
    def row(self) -> tuple[object, ...]:
        """The row of the table."""
        off, error, differ = (100.0 * x for x in (self.off, self.error, self.differ))
        yes = "yes" if self.inside else "no"
        times = self.of_reference / self.unknowns
        return self.pin, self.unknowns, round(times, 1), differ, off, error, yes


def cut_pins() -> str:
    """Return the comparison for random pins with holes."""
    return _contained("cut-pins", cut_trials(COUNT, SEED))


def cut_kinds() -> str:
    """Return the comparison for random pins with cuts of other kinds."""
    return _contained("cut-kinds", kind_trials(KINDS, SEED))


def _contained(name: str, trials: list[CutTrial]) -> str:
    kept = KEPT / f"{name}-{_code()}.jsonl"
    kept.parent.mkdir(parents=True, exist_ok=True)
    for trial in trials:
        pin = trial.pin.name
        if pin in _known(kept):  # read again, since several processes may share the work
            continue
        found = _trial(trial)
        print(*(found.row if found else (pin, "no local solid")), file=sys.stderr, flush=True)
        with kept.open("a", encoding="utf-8") as file:
            file.write(json.dumps([pin, found and vars(found)]) + "\n")
    known = _known(kept)
    return _told([known[trial.pin.name] for trial in trials])


def _known(kept: Path) -> dict[str, Inside | None]:
    """Return the kept results by pin."""
    lines = kept.read_text(encoding="utf-8").splitlines() if kept.exists() else []
    return {pin: Inside(**found) if found else None for pin, found in map(json.loads, lines)}


def _told(found: list[Inside | None]) -> str:
    rows = [one for one in found if one]
    inside = sum(one.inside for one in rows)
    away = [abs(one.off - one.error) > one.differ for one in rows]
    ratio = [one.off / one.error for one in rows]
    text = (
        f"{inside} of {len(rows)} inside; {len(found) - len(rows)} of {len(found)} have no maximum "
        f"or no local solid. The largest true error is {100.0 * max(o.off for o in rows):.2g} %, "
        f"the true error {np.median(ratio):.2g} of the estimated one (median; {max(ratio):.2g} at "
        f"most). Both references differ by {100.0 * float(np.median([o.differ for o in rows])):.2g}"
        f" % (median), and in {sum(away)} pins by less than would change what is inside. The runs "
        f"took {sum(o.spent for o in rows) / 60.0:.1f} minutes of processor time, the references "
        f"{sum(o.on_reference for o in rows) / 60.0:.1f}."
    )
    head = (
        "pin", "unknowns", "times as many of the reference", "references differ, %",
        "true error, %", "estimated, %", "inside",
    )  # fmt: skip
    return f"{text}\n\n{table(head, [one.row for one in rows])}"


def _code() -> str:
    """Return a name for the present state of the measured code, since results of other states do
    not count.
    """
    own = (Path(__file__), Path(__file__).with_name("random_cuts.py"))
    every = sorted(p for part in ("assess", "fea", "geometry") for p in (ROOT / part).rglob("*.py"))
    digest = hashlib.sha256(b"".join(path.read_bytes() for path in (*own, *every)))
    return digest.hexdigest()[:12]


def _trial(trial: CutTrial) -> Inside | None:
    """Return the result of a trial; None if the whole pin is solid, or its maximum at a
    singularity.
    """
    start = time.process_time()
    requirement = Requirement(TOLERANCE)
    found = solve_pin(trial.pin, STEEL, trial.clamps, (trial.loads,), requirement)[0].peak
    spent = time.process_time() - start
    if found.model != "harmonic+local" or found.verdict == "singular":
        return None
    value, error = found.max_von_mises, found.error_estimate
    assert value is not None
    assert error is not None
    start = time.process_time()
    first, second = _references(trial, found)
    true = second.maximum
    return Inside(
        found.pin, found.dofs, second.unknowns, abs(value / true - 1.0), error / true,
        abs(first.maximum / true - 1.0), spent, time.process_time() - start,
    )  # fmt: skip


def _references(trial: CutTrial, found: Maximum) -> list[MeshMaximum]:
    """Return the maxima of both reference meshes; the second is refined at the places that the
    first found.
    """
    pin, clamps, loads = trial.pin, trial.clamps, trial.loads
    assert found.location is not None
    x, y, z = found.location
    zones = singularities_of(pin.profile, STEEL, clamps, (loads,))
    problem = SectionProblem(pin.profile, STEEL, clamps, (loads,), zones)
    bands = loaded_bands(pin, loads.surfaces if clamps else pin.connections)
    about = pieces(pin, clamps, LONGER * PIECE_REACH, bands)
    last = len(found.history) - 1
    before = cut_result(cut_solution(problem, about, 0, (), bands), zones, loads)
    out = []
    for edges, spots in FINER:
        high = tuple(dict.fromkeys((found.location, *before.local_high)))
        near = replace(before, local_high=high, high=((math.hypot(x, y), z), *before.high))
        run = LocalFineness.of(last)
        finer = LocalFineness(run.edges * edges, run.spots * spots)
        solution = cut_solution(problem, about, last + SECTION, [near], bands, finer=finer)
        before = cut_result(solution, zones, loads)
        out.append(before)
    return out
