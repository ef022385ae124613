"""Pins drawn at random, written as study files, so that they can be run as a user runs them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from benchmarks.joints.random_pins import STEEL, PinTrial
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.contact.contact_support import profile_of
from fea.support.lugs.lug import Lug
from fea.support.support import PinProblem
from geometry import Pin, Segment


def write_study(trial: PinTrial, folder: Path) -> Path:
    """Write trial.toml and the table of its loads into a folder; return the path of trial.toml.

    Numbers are in SI units, with all their digits.
    """
    given = trial.given
    (loads,) = given.cases
    times = np.zeros(1) if loads.times is None else loads.times
    names = [f"{name}.f{axis}" for name in loads.surfaces for axis in "xy"]
    rows = [",".join((["time"] if loads.times is not None else []) + names)]
    for time, forces in zip(times, loads.forces, strict=True):
        head = [] if loads.times is None else [repr(float(time))]
        rows.append(",".join(head + [repr(float(f)) for f in forces[:, :2].ravel()]))
    (folder / "loads.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    materials = {m.name: m for m in (given.material, *(lug.material for lug in given.lugs))}
    text = [
        f'title = "{trial.name}"',
        'units = "m-N-s"',
        *(_material(m) for m in materials.values()),
        '[case.pull]\nkind = "given"\ntable = "loads.csv"',
        f'[pin.P]\nmaterial = "{given.material.name}"\nprofile = [',
        *(f"  {_segment(segment)}," for segment in profile_of(given.pin).segments),
        "]",
        *(_lug(lug) for lug in given.lugs),
    ]
    path = folder / "trial.toml"
    path.write_text("\n".join(text) + "\n", encoding="utf-8")
    return path


def _material(material: Material) -> str:
    text = f'[material."{material.name}"]\nyoungs_modulus = {material.youngs_modulus!r}\n'
    text += f"poisson_ratio = {material.poisson_ratio!r}\n"
    known = material.yield_strength
    return text if known is None else f"{text}yield_strength = {known!r}\n"


def _segment(segment: Segment) -> str:
    parts = [f"length = {segment.length!r}"]
    for key, (start, end) in (("diameter", segment.diameters), ("bore", segment.bores)):
        parts.append(f"{key} = {start!r}" if start == end else f"{key} = [{start!r}, {end!r}]")
    if segment.fillet:
        parts.append(f"fillet = {segment.fillet!r}")
    if segment.connection:
        parts.append(f'connection = "{segment.connection}"')
    return "{ " + ", ".join(parts) + " }"


def _lug(lug: Lug) -> str:
    tilt = '"guided"' if math.isinf(lug.tilt) else f'"{lug.tilt!r} N m/rad"'
    return (
        f'[pin.P.lug.{lug.connection}]\nmaterial = "{lug.material.name}"\n'
        f"outer_diameter = {lug.outer_diameter!r}\nclearance = {lug.clearance!r}\n"
        f"edge_radius = {lug.edge_radius!r}\ntilt = {tilt}"
    )


def tapered(bore: float) -> PinTrial:
    """Return a pin in two lugs, 20 and 24 mm in diameter, with a cone between them and a chamfer at
    one end.

    The thin end of the cone has a fillet 0.15 d from a lug.
    bore: over the diameter at the thin end; it is wider at the other end.
    """
    d, thick = 0.020, 0.024
    hole = bore * d
    segments = (
        Segment(0.003, d, hole),
        Segment(0.018, d, hole, connection="A"),
        Segment(0.003, d, hole, fillet=0.002),
        Segment(0.006, d, hole, end_diameter=thick, end_bore=1.2 * hole),
        Segment(0.002, thick, 1.2 * hole),
        Segment(0.020, thick, 1.2 * hole, connection="B"),
        Segment(0.003, thick, 1.2 * hole, end_diameter=d),
    )
    lugs = Lug("A", 0.05, STEEL, 2e-5, tilt=2e5), Lug("B", 0.06, STEEL, tilt=5e5)
    loads = PinLoads("pull", ("A", "B"), np.array([[[-20e3, 5e3, 0.0], [20e3, -5e3, 0.0]]]))
    pin = Pin("a cone, hollow" if bore else "a cone", segments)
    return PinTrial(PinProblem(pin, STEEL, lugs, (loads,)))
