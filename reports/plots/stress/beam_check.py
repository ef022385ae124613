"""Plots of a cantilever pin compared with beam theory."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from assess.opinion.records import COMPARISON_WINDOW, BeamCheck
from reports.data.row import Units
from reports.format.file_names import plot_name
from reports.format.numbers import engineering, short
from reports.plots.spec import Abscissa, Panel, Plot, Spec, bands, curves

HEADROOM_FACTOR = 1.25  # upper end over the beam's peak; higher values are cut off


def beam_plots(check: BeamCheck, units: Units) -> Iterator[Plot]:
    """Yield the shear and moment diagrams, and the axial stress of beam and solid along the pin."""
    z = Abscissa(f"z from the root [{units.length}]", check.z)
    force = f"{engineering(check.force)} {units.force}"
    title = f"Pin {check.pin}, {check.case}: cantilever under {force}"
    loaded = bands([check.band])
    panels = [
        Panel(f"shear [{units.force}]", {"": check.shear}, (loaded,)),
        Panel(f"moment [{units.force}·{units.length}]", {"": check.moment}, (loaded,)),
    ]
    caption = f"{title}: shear force and bending moment; shaded: loaded band"
    yield Plot(plot_name("beam-diagrams"), caption, curves(title, z, panels))
    caption = (
        f"{title}: axial stress on the tension side, by beam theory and finite elements; light "
        "shade: loaded band, blue: compared range, 30 to 80 % of the loaded length"
    )
    spec = curves(title, z, [_stress(check, units, loaded)])
    yield Plot(plot_name("beam-stress"), caption + _cut_off(check, units), spec)


def _stress(check: BeamCheck, units: Units, loaded: Spec) -> Panel:
    length = float(check.z[-1])
    return Panel(
        f"axial stress, tension side [{units.stress}]",
        {
            "beam theory": check.beam_axial_stress,
            "finite elements, load on the surface": check.fea_axial_stress,
            "finite elements, load on the axis": check.fea_axial_stress_axis_load,
        },
        (loaded, bands([(COMPARISON_WINDOW[0] * length, COMPARISON_WINDOW[1] * length)], "band")),
        scale={"domain": list(_limits(check))},
        height=260.0,
    )


def _limits(check: BeamCheck) -> tuple[float, float]:
    solid = np.concatenate([check.fea_axial_stress, check.fea_axial_stress_axis_load])
    peak = float(np.max(check.beam_axial_stress))
    low = min(0.0, float(np.min(solid)), float(np.min(check.beam_axial_stress)))
    top = min(float(np.max(solid)), HEADROOM_FACTOR * peak)
    return max(low, -HEADROOM_FACTOR * peak) - 0.05 * peak, max(top, peak) + 0.05 * peak


def _cut_off(check: BeamCheck, units: Units) -> str:
    solid = np.maximum(check.fea_axial_stress, check.fea_axial_stress_axis_load)
    worst = int(np.argmax(solid))
    if solid[worst] <= _limits(check)[1]:
        return ""
    return (
        f"; the peak of the finite elements, {engineering(float(solid[worst]))} {units.stress} at "
        f"z = {short(float(check.z[worst]))} {units.length}, is cut off"
    )
