"""Checks a study may ask for: a cantilever beside beam theory, a motion beside a closed form."""

from __future__ import annotations

import numpy as np

from fea.beam_check import beam_check as compare_with_beam
from fea.material import Material
from geometry import Pin
from loads import GROUND, Lever, Linkage, Slider
from pinstress.build import CaseLoads
from pinstress.published import Published
from pinstress.schema import MotionCheckTable
from pinstress.study import Study
from pinstress.tasks import Task
from reports import results as plain


def require_cantilever(study: Study, task: Task, case: str) -> None:
    """Raises: InputError if the pin of the beam check is no cantilever with one load."""
    loads = next(c for c in task.loads if c.case == case)
    turned = isinstance(task.pin, Pin)
    if not turned or task.clamps != ("start",) or len(loads.surfaces) != 1 or loads.moments.any():
        raise study.error(
            f"beam_check: pin {task.pin.name} must be a plain profile, clamped at "
            "its start face alone and loaded on one band, by forces alone, to be a cantilever"
        )


def beam_check(study: Study, task: Task, material: Material) -> plain.BeamCheck:
    """The beam check of a pin at the instant of its largest force."""
    check, pin = study.table.beam_check, task.pin
    assert check is not None
    assert isinstance(pin, Pin)
    loads = next(c for c in task.loads if c.case == check.case)
    (band,) = loads.surfaces
    forces = loads.forces[:, 0, :2]
    plane = forces[np.linalg.norm(forces, axis=1).argmax()]
    found = compare_with_beam(
        pin, material, band, (float(plane[0]), float(plane[1])), check.axis_bore
    )
    unit = study.system.factor
    surface, axis = found.difference(found.surface_load), found.difference(found.axis_load)
    z0, z1 = pin.band(band).z0, pin.band(band).z1
    return plain.BeamCheck(
        pin=pin.name,
        case=check.case,
        connection=band,
        force=found.force / unit("force"),
        diameter=2.0 * pin.band(band).radius / unit("length"),
        axis_bore=check.axis_bore / unit("length"),
        band=(z0 / unit("length"), z1 / unit("length")),
        z=found.beam.z / unit("length"),
        shear=found.beam.shear / unit("force"),
        moment=found.beam.moment / unit("moment"),
        beam_axial_stress=found.beam.stress / unit("stress"),
        fea_axial_stress=found.surface_load / unit("stress"),
        fea_axial_stress_axis_load=found.axis_load / unit("stress"),
        rms=surface.rms,
        rms_axis_load=axis.rms,
        expected_offset=-found.surface_term / unit("stress"),
        expected_offset_axis_load=-found.axis_term / unit("stress"),
        rms_beyond_offset=found.difference(found.surface_load + found.surface_term).rms,
        rms_axis_load_beyond_offset=found.difference(found.axis_load + found.axis_term).rms,
        largest=surface.largest,
        largest_axis_load=axis.largest,
        largest_anywhere=surface.largest_anywhere,
        largest_at=surface.largest_at / unit("length"),
    )


def motion_check(
    study: Study, loads: dict[str, CaseLoads], published: Published
) -> plain.MotionCheck | None:
    """A joint's speed and acceleration beside the closed form; None when not asked for."""
    check = study.table.motion_check
    case = loads.get(check.case) if check else None
    if check is None or case is None:
        return None
    if case.dynamics is None or case.reactions.times is None:
        raise study.error(f"motion_check.case: {check.case!r} is not a motion")
    motion, unit = case.dynamics.motion, study.system.factor
    lever, radius = _lever(study, check, motion.linkage)
    _, v, a = motion.joint(check.joint)
    driven = (motion.drives[:, 0], motion.speeds[:, 0], motion.rates[:, 0])
    closed_v, closed_a = lever.point(radius, *driven)
    speed, acceleration = np.linalg.norm(v, axis=1), np.linalg.norm(a, axis=1)
    rows = []
    for t, their_v, their_a in published.motion:
        k = int(np.abs(motion.times / unit("time") - t).argmin())
        ours = (speed[k] / unit("velocity"), acceleration[k] / unit("acceleration"))
        rows.append((t, their_v, their_a, float(ours[0]), float(ours[1])))
    return plain.MotionCheck(
        joint=check.joint,
        case=check.case,
        time=motion.times / unit("time"),
        speed=speed / unit("velocity"),
        acceleration=acceleration / unit("acceleration"),
        closed_form_speed=closed_v / unit("velocity"),
        closed_form_acceleration=closed_a / unit("acceleration"),
        published=tuple(rows),
    )


def _lever(study: Study, check: MotionCheckTable, linkage: Linkage) -> tuple[Lever, float]:
    pivot, joint = linkage.joint(check.pivot), linkage.joint(check.joint)
    if pivot.fixed_in != GROUND:
        raise study.error(f"motion_check.pivot: {check.pivot} is not fixed in the ground")
    slider = linkage.drives[0]
    if len(linkage.drives) != 1 or not isinstance(slider, Slider):
        raise study.error("motion_check: it needs one drive, of a slider")

    def distance(at: tuple[float, float]) -> float:
        return float(np.hypot(at[0] - pivot.at[0], at[1] - pivot.at[1]))

    return Lever(distance(slider.start), distance(slider.end)), distance(joint.at)
