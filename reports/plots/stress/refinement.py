"""Plots of the maximum stress and the strain energy of each mesh, as deviations from the finest."""

from __future__ import annotations

from collections.abc import Sequence

from fea.core.peak import Refinement
from reports.data.row import PinResult, Units
from reports.format.file_names import plot_name
from reports.plots.spec import NUMBER_FORMAT, Plot, Spec, headed, labels, level, rows
from reports.plots.theme import dashes

MAXIMUM_HEADING, ENERGY_HEADING = "maximum: deviation [%]", "strain energy: deviation [%]"


def refinement_plot(case: str, pins: Sequence[PinResult], units: Units) -> Plot:
    """Return every pin's maximum and strain energy on its meshes in one case."""
    return _plot(plot_name("refinement", case), case, pins, [pin.pin for pin in pins], units)


def pin_refinement_plot(pin: str, cases: Sequence[PinResult], units: Units) -> Plot:
    """Return one pin's maximum and strain energy on its meshes in every case."""
    names = [*labels(case.case for case in cases).values()]
    return _plot(plot_name("refinement-pin", pin), f"Pin {pin}", cases, names, units)


def _plot(
    name: str, title: str, pins: Sequence[PinResult], called: Sequence[str], units: Units
) -> Plot:
    steps = [
        {"x": step.dofs, "value": step.max_von_mises, "y": off, "energy": step.strain_energy,
         "e": energy_off, "row": _text(label, pin)}
        for label, pin in zip(called, pins, strict=True)
        for step, off, energy_off in zip(pin.history, *_deviations(pin.history), strict=True)
    ]  # fmt: skip
    names = list(dict.fromkeys(_text(*both) for both in zip(called, pins, strict=True)))
    stress, energy = f"maximum [{units.stress}]", f"strain energy [{units.force} {units.length}]"
    panels = [_panel("y", MAXIMUM_HEADING, ("value", stress), names)]
    known = any(step["e"] is not None for step in steps)
    if known:
        panels.append(_panel("e", ENERGY_HEADING, ("energy", energy), names))
    else:
        steps = [{k: v for k, v in step.items() if k not in ("e", "energy")} for step in steps]
    panels[-1]["layer"][1]["encoding"]["x"]["title"] = "unknowns, logarithmic"
    title = f"{title}: mesh refinement of the maximum von Mises stress"
    title += " and of the strain energy" if known else ""
    columns = ["unknowns", stress, MAXIMUM_HEADING, energy, ENERGY_HEADING][: 5 if known else 3]
    return Plot(name, f"{title}, as deviations from the finest mesh", {
        "title": headed(title),
        "usermeta": {"columns": [*columns, "row"]},
        "data": rows(steps),
        "vconcat": panels,
    })  # fmt: skip


def _deviations(history: Sequence[Refinement]) -> tuple[list[float], list[float | None]]:
    """Return the deviations of maximum and strain energy from those of the last mesh, per cent."""
    last = history[-1]
    stress = [100.0 * (step.max_von_mises / last.max_von_mises - 1.0) for step in history]
    energy = [
        100.0 * (step.strain_energy / last.strain_energy - 1.0)
        if step.strain_energy is not None and last.strain_energy
        else None
        for step in history
    ]
    return stress, energy


def _panel(field: str, heading: str, value: tuple[str, str], names: list[str]) -> Spec:
    """Return a panel of deviations.

    value: a field and its title, which the pointer shows.
    """
    key = {"field": "row", "type": "nominal", "sort": None, "title": None}
    ticks = {"format": "~s", "labelOverlap": "greedy", "labelFlush": True, "labelSeparation": 8}
    column, title = value
    lines = {
        "mark": {"type": "line", "point": {"size": 40, "filled": True}},
        "encoding": {
            "x": {"field": "x", "type": "quantitative", "title": None,
                  "scale": {"type": "log", "nice": False}, "axis": ticks},
            "y": {"field": field, "type": "quantitative", "title": None},
            "color": key | {"scale": {"domain": names}},
            "strokeDash": key | {"scale": {"domain": names, "range": dashes(len(names))}},
            "tooltip": [
                {"field": "row", "type": "nominal", "title": "row"},
                {"field": "x", "type": "quantitative", "title": "unknowns", "format": ","},
                {"field": column, "type": "quantitative", "title": title, "format": NUMBER_FORMAT},
                {"field": field, "type": "quantitative", "title": heading, "format": ".3~f"},
            ],
        },
    }  # fmt: skip
    return {"title": heading, "height": 85, "layer": [level(0.0, style="zero"), lines]}


def _text(label: str, pin: PinResult) -> str:
    return label if pin.verdict == "converged" else f"{label}, {pin.verdict}"
