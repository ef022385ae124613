"""The maxima of the harmonic model on one mesh at every instant, each treated as a load case.

Many loads of a pin that take the same mesh are superposed together: the points of the maxima are
found for all at once. The stresses there are then computed instant by instant in the same order of
operations, so that none depends on which other instants are solved with it.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np

from fea.core.mesh_result import MeshMaximum, Point, ZoneMaximum
from fea.core.pin_loads import PinLoads
from fea.core.zone import DISTANCE_VARIATIONS, Zone
from fea.harmonic.evaluate import MAX_PLACES, MIN_SPACING, REFINE_ABOVE, SERIES_REMAINDER_RATIO
from fea.harmonic.near_singularities import CORNER_ELEMENT_SIZES, growth, places_of
from fea.harmonic.section_solution import HarmonicSolution
from fea.harmonic.superposition import Circumference
from pinbase.arrays import Floats, Ints, Mask


@dataclass(frozen=True)
class EachCrest:
    """The largest stress (T,), Pa, at each instant, its point (T,) and its angle (T,), rad."""

    value: Floats
    point: Ints
    angle: Floats


def crest_of_each(around: Circumference, among: Mask) -> EachCrest:
    """The largest stress at each instant over the points of a mask (S,)."""
    reached, point = around.each(among)
    value, angle = around.crests(point, np.arange(around.count))
    return EachCrest(np.where(reached > 0.0, value, 0.0), point, angle)


class EachOnMesh:
    """The maxima at each of T instants on one mesh.

    zones: the zones of the problem.
    acting: those of them that the loads make singular.
    """

    def __init__(
        self,
        solution: HarmonicSolution,
        zones: tuple[Zone, ...],
        loads: PinLoads,
        acting: Collection[Zone],
    ) -> None:
        self.solution, self.zones, self._acting, self._loads = solution, zones, acting, loads
        self.fields = solution.fields
        self.around = Circumference(self.fields, loads)
        self._among = self.fields.outside(acting)
        self.top = crest_of_each(self.around, self._among)

    def results(self) -> list[MeshMaximum]:
        """The maximum at each instant, without places of high stress."""
        zones = [self._inside(zone) for zone in self.zones]
        of_instants = [tuple(of[k] for of in zones) for k in range(len(self._loads))]
        left_out = self._left_out()
        results = [
            MeshMaximum(
                self.fields.unknowns, value, 0, at, inside, left_out=left,
                quiet=self.solution.quiet, energy=self.fields.energy,
            )
            for value, at, inside, left in zip(
                self.top.value.tolist(), self._locations(), of_instants, left_out.tolist(),
                strict=True,
            )
        ]  # fmt: skip
        if not any(result.governed for result in results):
            return results
        low, high = self._intervals()
        every = zip(results, low, high, strict=True)
        return [replace(x, interval=(a, b)) if x.governed else x for x, a, b in every]

    def _locations(self) -> list[Point]:
        (r, z), angle = self.fields.points[self.top.point].T, self.top.angle
        x, y = r * np.cos(angle), r * np.sin(angle)
        return list(zip(x.tolist(), y.tolist(), z.tolist(), strict=True))

    def _intervals(self) -> tuple[list[float], list[float]]:
        """The least and the largest maximum (T,), Pa, with half and twice the excluded distance."""
        maxima = np.stack(
            [
                crest_of_each(
                    self.around, self.fields.outside([zone.varied(times) for zone in self._acting])
                ).value
                for times in DISTANCE_VARIATIONS
            ]
        )
        return maxima.min(axis=0).tolist(), maxima.max(axis=0).tolist()

    def _inside(self, zone: Zone) -> list[ZoneMaximum]:
        """The largest stress in a zone at each instant; the growth of stress is not measured."""
        _, within, felt = places_of(self.fields, zone)
        far, far_point = self.around.each(felt)
        near, near_point = self.around.each(within & ~felt, far)
        point = np.where(near > far, near_point, far_point)
        angle = self.around.largest_over_angle(point, np.arange(len(point)))[1]
        x, y = zone.r * np.cos(angle), zone.r * np.sin(angle)
        acts = zone in self._acting
        every = zip(*(a.tolist() for a in (near, far, x, y)), strict=True)
        return [ZoneMaximum(m, f, (a, b, zone.z), acts=acts) for m, f, a, b in every]

    def _left_out(self) -> Floats:
        """The errors (T,), Pa, from truncating the series of a bearing pressure."""
        if self._loads.distribution != "cosine" or self.around.highest != self._loads.terms:
            return np.zeros(len(self._loads))
        instants = np.arange(len(self._loads))
        return SERIES_REMAINDER_RATIO * self.around.highest_harmonic_at(self.top.point, instants)

    def with_growth(self, result: MeshMaximum, k: int) -> MeshMaximum:
        """The result of one instant, with the growth of stress measured in the zones that govern.

        k: number of the instant.
        """
        around, nu = self.around.of_instant(k), self.solution.nu
        measured = []
        every = zip(self.zones, self.solution.close, result.singularities, strict=True)
        for zone, close, inside in every:
            if inside in result.governed and zone.measured and close == CORNER_ELEMENT_SIZES[-1]:
                distance = places_of(self.fields, zone)[0]
                exponent, strength = growth(self.fields, around, zone, distance, 0, nu)
                inside = replace(inside, exponent=exponent, strength=strength)
            measured.append(inside)
        return replace(result, singularities=tuple(measured))

    def high_places(self, some: Ints) -> list[tuple[tuple[float, float], ...]]:
        """The points (r, z), m, at which stress is nearly the maximum, at each of some instants.

        They are those of fea.harmonic.evaluate.high_places: the highest first, well apart.
        some: numbers of the instants.
        """
        points, out = self.fields.points, [list[Floats]() for _ in some]
        rows, least = np.flatnonzero(self._among), REFINE_ABOVE * self.top.value[some]
        highest = self.top.point[some]
        for one in np.unique(highest):
            now = np.flatnonzero(highest == one)
            apart = np.hypot(*(points[rows] - points[one]).T) > MIN_SPACING * points[rows, 0]
            i, t = self._above(rows[apart], some[now], least[now])
            value, _ = self.around.largest_over_angle(i, some[now][t])
            order = np.argsort(-value, kind="stable")
            for k in now:
                out[k].append(points[one])
            for pair in order[value[order] >= least[now][t[order]]]:
                places, at = out[now[t[pair]]], points[i[pair]]
                if len(places) < MAX_PLACES and all(
                    np.hypot(*(at - other)) > MIN_SPACING * at[0] for other in places
                ):
                    places.append(at)
        return [tuple((float(r), float(z)) for r, z in places) for places in out]

    def _above(self, rows: Ints, instants: Ints, least: Floats) -> tuple[Ints, Ints]:
        """The pairs of points and instants (by position) whose stress may reach `least`, Pa."""
        reach = self.around.reach(rows, instants) >= least
        rows, reach = rows[some := reach.any(axis=1)], reach[some]
        reach &= self.around.bound(rows, instants) >= least
        i, t = np.nonzero(reach)
        return rows[i], t
