"""Records of drops for the results, in SI units."""

from __future__ import annotations

from dataclasses import fields

import numpy as np

from loads import impulse_force
from loads.landing import Landing, spin_up_drag
from pinbase.arrays import Floats
from pinstress.study.model.cases import CaseLoads
from pinstress.study.reading.file import Study
from pinstress.study.schema.landing import DropCase
from reports.data.drop import PEAK_QUANTITIES, DropPeak, DropRecord

STROKE_SAMPLES = 101  # number of strokes at which the force is drawn


def drop_record(study: Study, name: str, loads: CaseLoads) -> DropRecord:
    """Return the record of a case of kind drop."""
    case, landing, times = study.table.case[name], loads.landing, loads.reactions.times
    assert isinstance(case, DropCase)
    assert landing is not None
    assert times is not None
    leg, h, peaks = landing.drop, landing.at(times), landing.peaks
    strokes, closing, opening = _over_stroke(landing)
    return DropRecord(
        case=name,
        clause=loads.note,
        velocity=leg.velocity,
        weight=leg.weight,
        lift=leg.lift,
        time=times,
        stroke=h.forces.stroke,
        deflection=np.maximum(h.deflection, 0.0),
        sink_velocity=h.sink_velocity,
        vertical=h.forces.vertical,
        drag=h.forces.drag,
        strut=h.forces.along,
        leg_drag=h.forces.on_leg,
        energies={f.name: getattr(h.energies, f.name) for f in fields(h.energies)},
        peaks={
            key: DropPeak(words, peaks[key].value, peaks[key].time, dimension)
            for key, (words, dimension) in PEAK_QUANTITIES.items()
        },
        load_factor=landing.load_factor,
        imbalance=float(np.abs(h.energies.imbalance).max()),
        impulse_time=case.impulse_time,
        impulse_force=impulse_force(leg.mass, leg.velocity, case.impulse_time),
        equal_impulse_time=landing.equal_impulse_time,
        spin_up=_spin_up(landing),
        strokes=strokes,
        closing=closing,
        opening=opening,
    )


def _spin_up(landing: Landing) -> float | None:
    wheel, peak = landing.drop.wheel, landing.peaks["vertical"]
    if wheel is None:
        return None
    return spin_up_drag(wheel.inertia, wheel.radius, wheel.speed, peak.value, peak.time)


def _over_stroke(landing: Landing) -> tuple[Floats, Floats, Floats]:
    """Return strokes (P,) m and the vertical forces (P,) N while the strut first closes and then
    opens.

    The force is NaN at strokes that the strut does not reach.
    """
    spans = [span for span in landing.spans if span.mode.strut]
    most = landing.peaks["stroke"].value
    strokes = np.linspace(0.0, most, STROKE_SAMPLES)
    nothing = np.full(STROKE_SAMPLES, np.nan)
    if not most:
        return strokes, nothing, nothing
    turn = landing.peaks["stroke"].time
    begin = spans[0].first
    end = min((t for t in landing.events("extended") if t > turn), default=landing.drop.duration)
    branches = []
    for first, last in ((begin, turn), (turn, end)):
        h = landing.at(np.linspace(first, last, 2001)).forces
        order = np.argsort(h.stroke, kind="stable")
        branches.append(
            np.interp(strokes, h.stroke[order], h.vertical[order], left=np.nan, right=np.nan)
        )
    return strokes, branches[0], branches[1]
