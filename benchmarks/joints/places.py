"""The places where stress is read, compared with other results.

These are the landing gear's pins on finer cells and meshes than those of rows, clevises by contact
in three dimensions, and pins drawn at random, on whose surface another reader must not find more
stress than their row has.
"""

from __future__ import annotations

import math
from dataclasses import replace

from benchmarks import ROOT
from benchmarks.joints.joint import EYE, FORCE, NAMES, SHARE, STEEL, TRUTH, D, shank_tilt
from benchmarks.joints.named_pins import named_pins
from benchmarks.joints.random_pins import Checked, check, pin_trials
from benchmarks.timing import table
from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.solve.solve import solve_in_lugs
from fea.support.lugs.lug import Lug
from fea.support.support import PinProblem
from geometry import Pin, Segment

PSI = 6894.757
PINS, SEED = 40, 7
MAX_GAP = 0.003  # m, between neighbouring lugs of the landing gear
# Surface (lower and upper value) and section of the landing gear's pins at landing, ksi, on 16
# rings of each band and four meshes, by an independent prototype (dense cells, the stress of the
# surface from the imposed traction). Neighbouring lugs touch: the gaps of the study are closed.
GEAR: dict[str, tuple[tuple[float, float], float]] = {
    "E": ((186.5, 186.5), 149.3),
    "J": ((144.0, 147.0), 148.1),
    "A": ((108.3, 108.3), 104.0),
    "G": ((56.8, 56.8), 37.7),
    "D": ((54.6, 54.6), 31.3),
    "F": ((11.0, 12.5), 14.46),
    "H": ((10.6, 10.6), 10.2),
    "C": ((0.45, 0.5), 0.765),
}


def places(pins: int = PINS) -> str:
    """Return the four tables. pins: number of pins drawn at random."""
    return "\n\n".join((_gear(), named_pins(), _clevises(), _random(pins)))


def _gear() -> str:
    import pinstress
    from pinstress.analysis.plan import prepare

    rows = []
    study = pinstress.load_study(str(ROOT / "studies" / "landing_gear.toml"))
    for task in prepare(study).tasks:
        if task.pin.name not in GEAR or not isinstance(task.pin, Pin):
            continue
        cases = tuple(case for case in task.loads if case.case == "landing")
        pin = _without_gaps(task.pin)
        given = PinProblem(pin, task.material, task.lugs, cases, {}, task.ranges)
        (found,) = solve_in_lugs(given, Requirement())
        (low, high), section = GEAR[task.pin.name]
        span = f"{low:g}" if low == high else f"{low:g} to {high:g}"
        ours = _numbers(found.peak, 1e3 * PSI, 4)
        rows.append((task.pin.name, ours[0], span, ours[1], f"{section:g}", *ours[2:]))
    head = ("pin", "surface [ksi]", "finer", "section [ksi]", "finer", "row [ksi]", "beneath [ksi]")
    return table(head, sorted(rows))


def _without_gaps(pin: Pin) -> Pin:
    """Return a pin whose neighbouring lugs touch: each takes half of the gap next to it."""
    segments = list(pin.segments)
    for k, gap in enumerate(pin.segments):
        if gap.length < MAX_GAP:
            for beside in (k - 1, k + 1):
                longer = segments[beside].length + 0.5 * gap.length
                segments[beside] = replace(segments[beside], length=longer)
    return replace(pin, segments=tuple(s for s in segments if s.length >= MAX_GAP))


def _numbers(peak: Maximum, unit: float, digits: int) -> tuple[str, str, str, str]:
    """Return surface, section, row and stress beneath contact as text, with errors."""
    found = peak.places
    assert found is not None
    assert found.section is not None
    assert found.contact is not None
    surface, section, below = found.surface, found.section, found.contact
    numbers = (
        (surface.max_von_mises, surface.error_estimate),
        (section.max_von_mises, section.error_estimate),
        (peak.max_von_mises or 0.0, peak.error_estimate or 0.0),
        (below.beneath, below.beneath_error),
    )
    a, b, c, d = (f"{x / unit:.{digits}g} ±{100.0 * e / x:.1f} %" for x, e in numbers)
    return a, b, c, d


def _clevises() -> str:
    """Return the table of the clevises whose largest stress is in the tension fibre at mid-span, on
    the free side of the inner lug.

    On stubby pins the largest stress is elsewhere.
    """
    rows = []
    for inner, outer, gap, clearance, _, fibre in (x for x in TRUTH if x[0] >= D * 1e3):
        peak = clevis_row(inner, outer, gap, clearance)
        surface, section, _, below = _numbers(peak, 1e6, 4)
        about = f"{inner:g} / {outer:g}+{outer:g}, gap {gap:g}", f"{clearance:g}"
        rows.append((*about, surface, f"{fibre:.1f}", section, below))
    head = ("lugs [mm]", "clearance [mm]", "surface [MPa]", "3D, mid-span [MPa]", "section [MPa]")
    return table((*head, "beneath [MPa]"), rows)


def clevis_row(inner: float, outer: float, gap: float, clearance: float) -> Maximum:
    """Return the maximum of a clevis of benchmarks/joints/joint.py, lengths in mm, whose outer lugs
    tilt with their shanks.
    """
    over, apart = Segment(0.002, D), Segment(gap / 1e3, D)
    left, middle, right = (
        Segment(t / 1e3, D, connection=name)
        for t, name in zip((outer, inner, outer), NAMES, strict=True)
    )
    pin = Pin("P", (over, left, apart, middle, apart, right, over))
    shank = shank_tilt(outer / 1e3)
    tilts = shank, math.inf, shank
    lugs = tuple(
        Lug(name, EYE, STEEL, clearance / 1e3, tilt=tilt)
        for name, tilt in zip(NAMES, tilts, strict=True)
    )
    along = FORCE * SHARE[None, :, None] * [[[1.0, 0.0, 0.0]]]
    given = PinProblem(pin, STEEL, lugs, (PinLoads("pull", NAMES, along),))
    (found,) = solve_in_lugs(given, Requirement())
    return found.peak


def _random(pins: int) -> str:
    """Return the number of pins that break the rule, and a table of these pins."""
    found: list[tuple[str, Checked]] = []
    failed: list[str] = []
    for trial in pin_trials(pins, SEED):
        try:
            found.append((trial.name, check(trial)))
        except Exception as error:  # unsolved pins are listed, not hidden
            failed.append(f"{trial.name}: {error}")
    rows = [
        (name, f"{x.row / 1e6:.1f}", f"{x.error / 1e6:.1f}", f"{x.read / 1e6:.1f}", f"{x.z:.5f}")
        for name, x in found
        if x.violates
    ]
    known = sum(x.verdict == "converged" for _, x in found)
    by_section = sum(x.governs == "section" for _, x in found)
    told = f"{len(found)} pins, {known} of them converged, {by_section} governed by a section: "
    told += f"{len(rows)} of them have more stress on their surface than their row and its error."
    if failed:
        told += "\n\nNot solved: " + "; ".join(failed)
    head = ("pin", "row [MPa]", "error [MPa]", "found on the surface [MPa]", "at z [m]")
    return f"{told}\n\n{table(head, rows)}" if rows else told
