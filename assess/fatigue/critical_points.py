"""The few points of a pin at which fatigue is assessed, and the stress there over all load cases.

Damage depends on the range of stress, not on its peak, and is larger where the mean is tensile.
The surface is therefore searched for local maxima of `a + 0.3 m` over all cases, including zero
load. m is the signed von Mises stress of the tensor at the middle of the range of each component; a
is the largest von Mises stress of the difference from this tensor, which also measures stress that
changes its sign or direction. Singular zones are left out. Where lugs press on the pin, the stress
is that of fea.harmonic.fatigue_points. The points of the largest von Mises stress are added.

Only the mesh of the case with the largest stress is searched; on the meshes of other cases the
nearest node is read.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from assess.fatigue.records import CaseHistory, PointHistory
from fea.core.solution import StressPoints
from fea.core.voigt import von_mises
from fea.support.support import Solution
from pinbase.arrays import Floats, Ints
from pinbase.rounding import without_round_off

# The search is first coarse, then fine at the maxima found. These values are chosen by judgement.
SEARCH_ANGLES, FINAL_ANGLES = 16, 72  # angles about the axis
SEARCH_INSTANTS, FINAL_INSTANTS = 12, 48  # instants of each case
MEAN_STRESS_SENSITIVITY = 0.3  # usual mean stress sensitivity of steel
MAX_POINTS = 4  # local maxima that are assessed
MIN_SCORE = 0.3  # relative to the largest score: points below it are not candidates
MIN_SPACING = 0.25  # between local maxima, relative to the distance from the axis
MERGE_DISTANCE = 0.05  # relative to the distance from the axis: closer points are merged
STRIDE = 2  # every second point of the surface is searched
MAX_CANDIDATES = 500  # points whose neighbours are compared
NEIGHBOURS = 9  # points around a local maximum that are compared at all angles
SCORE_BATCH = 16_384  # points and angles, times cases, processed at once; limits memory


MIN_STRESS_SUM = 1e-9  # relative to the von Mises stress: a smaller sum of principal stresses is 0


@dataclass(frozen=True)
class _Place:
    point: Floats  # (3,) m, of a body of revolution at theta = 0
    angle: float
    chosen: str

    @property
    def location(self) -> Floats:
        x, y, z = self.point
        c, s = np.cos(self.angle), np.sin(self.angle)
        return np.array([c * x - s * y, s * x + c * y, z])


@dataclass(frozen=True)
class _Case:
    solution: Solution
    known: StressPoints

    def instants(self, most: int) -> Ints:
        """Return the numbers of at most `most` evenly spaced instants, plus the governing one."""
        even = np.linspace(0, self.known.count - 1, most).round().astype(np.int64)
        return np.unique(np.append(even, self.solution.instant))


def stress_histories(pin: str, solutions: Sequence[Solution]) -> tuple[PointHistory, ...]:
    """Return the stress histories at the critical points of a pin; empty if no case was solved."""
    cases = [
        _Case(solution, solution.answer.points(solution.loads))
        for solution in solutions
        if solution.answer is not None
    ]
    if not cases:
        return ()
    return tuple(
        PointHistory(
            pin, k, _tuple(place.location), place.chosen, _at(place, cases), cases[0].known.revolved
        )
        for k, place in enumerate(_places(cases), 1)
    )


def _tuple(point: Floats) -> tuple[float, float, float]:
    x, y, z = point.tolist()
    return x, y, z


def _at(place: _Place, cases: Sequence[_Case]) -> tuple[CaseHistory, ...]:
    """Return the stress of every case at a place."""
    histories = []
    for case in cases:
        known, loads = case.known, case.solution.loads
        row = _nearest(known, place.point[None])
        stress = known.at(row, np.array([place.angle]), np.arange(known.count))[0]
        signed, plain = signed_von_mises(stress), von_mises(stress)
        histories.append(CaseHistory(loads.case, loads.times, stress, plain, signed))
    return tuple(histories)


def _places(cases: Sequence[_Case]) -> list[_Place]:
    """Return the critical places; places that nearly coincide are merged."""
    out: list[_Place] = []
    for place in (*_local_maxima(cases), *_governing(cases)):
        near = MERGE_DISTANCE * float(np.hypot(*place.point[:2]))
        if all(np.linalg.norm(place.location - other.location) > near for other in out):
            out.append(place)
    return out


def _governing(cases: Sequence[_Case]) -> Iterator[_Place]:
    """Yield the place of the largest von Mises stress of the surface, for each case with stress.

    The largest first, whatever the order of the cases: of places that nearly coincide, the one with
    the larger stress is assessed.
    """
    for case in sorted(cases, key=_by_surface_stress):
        peak = case.solution.peak
        at = peak.location if peak.places is None else peak.places.surface.location
        text = f"largest von Mises stress, {peak.case}"
        if at is None or not peak.max_von_mises:
            continue
        x, y, z = at
        if case.known.revolved:
            yield _Place(np.array([np.hypot(x, y), 0.0, z]), float(np.arctan2(y, x)), text)
        else:
            yield _Place(np.array(at), 0.0, text)


def _by_surface_stress(case: _Case) -> tuple[float, str]:
    """Return what sorts cases by their largest stress of the surface, then by their names."""
    peak = case.solution.peak
    surface = peak if peak.places is None else peak.places.surface
    return -without_round_off(surface.max_von_mises or 0.0), peak.case


def _local_maxima(cases: Sequence[_Case]) -> Iterator[_Place]:
    """Yield the places of the local maxima of the score, the largest first."""
    base = max(cases, key=lambda case: case.solution.peak.max_von_mises or 0.0).known
    rows = np.flatnonzero(base.surface)
    if not len(rows):
        return
    every, points = base.points[rows], base.points[rows[::STRIDE]]
    score = _score(cases, points, SEARCH_ANGLES, SEARCH_INSTANTS).max(axis=1)
    whole, tree, radius = KDTree(every), KDTree(points), np.hypot(points[:, 0], points[:, 1])
    order = np.argsort(-score, kind="stable")[:MAX_CANDIDATES]
    chosen: list[int] = []
    for k in order:
        if len(chosen) == MAX_POINTS or score[k] <= MIN_SCORE * score[order[0]]:
            return
        # A candidate near a better point or near a chosen one is not a separate local maximum.
        near = tree.query_ball_point(points[k], MIN_SPACING * radius[k])
        if score[near].max() > score[k] or set(near) & set(chosen):
            continue
        chosen.append(int(k))
        _, about = whole.query(points[k], min(NEIGHBOURS, len(every)))
        about = np.atleast_1d(about)
        fine = _score(cases, every[about], FINAL_ANGLES, FINAL_INSTANTS)
        row, turn = np.unravel_index(fine.argmax(), fine.shape)
        angle = 2.0 * np.pi * float(turn) / FINAL_ANGLES if base.revolved else 0.0
        text = "largest range of stress" if len(chosen) == 1 else "local maximum of the range"
        yield _Place(every[about[row]], angle, text)


def _score(cases: Sequence[_Case], points: Floats, turns: int, instants: int) -> Floats:
    """Return the score (P, A), Pa: amplitude plus a part of the mean, over all cases and zero load.

    points: (P, 3) m.
    turns: number A of angles about the axis.
    instants: the largest number of instants of each case.
    """
    turns = turns if cases[0].known.revolved else 1
    angles = np.tile(2.0 * np.pi * np.arange(turns) / turns, len(points))
    known = [(c.known, np.repeat(_nearest(c.known, points), turns), c.instants(instants))
             for c in cases]  # fmt: skip
    chunk = max(SCORE_BATCH // len(cases), 1)
    score = np.zeros(len(angles))
    for k in range(0, len(angles), chunk):
        here = slice(k, k + chunk)
        stress = [of.at(rows[here], angles[here], some) for of, rows, some in known]
        whole = np.concatenate([np.zeros_like(stress[0][:, :1]), *stress], axis=1)
        middle = 0.5 * (whole.min(axis=1) + whole.max(axis=1))
        apart = von_mises(whole - middle[:, None]).max(axis=1)
        score[here] = apart + MEAN_STRESS_SENSITIVITY * signed_von_mises(middle)
    return score.reshape(len(points), turns)


def _nearest(known: StressPoints, points: Floats) -> Ints:
    """Return the numbers of the known points that are nearest to points (P, 3)."""
    return np.asarray(KDTree(known.points).query(points)[1], dtype=np.int64)


def signed_von_mises(stress: Floats) -> Floats:
    """Return the von Mises stress (...) of stresses (..., 6), with the sign of the principal stress
    of largest magnitude.

    The largest and the smallest principal stress sum to 2 p - 2 sqrt(J2 / 3) cos(lode - 2 pi / 3),
    and the sign of this sum is the sign of the larger one in magnitude. In pure shear both are
    equal in magnitude and the sign is ambiguous. It is positive here, so that alternating torsion
    has only half its range; the critical plane registers the full range. Source of the invariants:
    Chen, Han, Plasticity for Structural Engineers (1988), 2.2.
    """
    size = von_mises(stress)
    xx, yy, zz, yz, xz, xy = np.moveaxis(stress, -1, 0)
    p = (xx + yy + zz) / 3.0
    a, b, c = xx - p, yy - p, zz - p
    third = a * b * c + 2.0 * yz * xz * xy - a * yz**2 - b * xz**2 - c * xy**2
    with np.errstate(divide="ignore", invalid="ignore"):
        cosine = np.nan_to_num(13.5 * third / size**3)  # 3 sqrt(3) / 2 J3 / J2^(3/2)
    lode = np.arccos(np.clip(cosine, -1.0, 1.0)) / 3.0
    both = 2.0 * p - 2.0 / 3.0 * size * np.cos(lode - 2.0 * np.pi / 3.0)
    return np.asarray(np.where(both < -MIN_STRESS_SUM * size, -size, size))
