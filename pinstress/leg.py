"""From a study's spatial leg to its dynamics and the loads on the pin at its hinge."""

from __future__ import annotations

import numpy as np

from loads import LegDynamics, LegMotion, Reactions, SpatialLeg, leg_dynamics
from loads.linkage import Floats
from pinstress.mechanism import LAWS
from pinstress.schema_cases import LegCase
from pinstress.study import Study

AXES = "x = z'' (up), y = x'' (right), z = y'' (ahead, along the hinge)"


def dynamics(study: Study, case: LegCase) -> tuple[Floats, LegDynamics]:
    """Times (T,) s and the leg's dynamics. Raises: InputError."""
    table = study.table.spatial_leg
    assert table is not None
    if len(table.leg_inertia) not in (3, 6):
        raise study.error("spatial_leg.leg_inertia: give xx, yy, zz, and xy, xz, yz if there are")
    xx, yy, zz, xy, xz, yz = (*table.leg_inertia, 0.0, 0.0, 0.0)[:6]
    fold = LAWS[table.fold.law](table.fold.start, table.fold.end, table.fold.duration)
    times = np.linspace(0.0, fold.duration, case.samples)
    one = np.ones_like(times)
    beta, omega_i, alpha_i = fold(times)
    yaw = table.yaw.start + table.yaw.rate * times
    spin_rate = (table.spin.end - table.spin.start) / fold.duration
    try:
        leg = SpatialLeg(
            l1=table.l1,
            l2=table.l2,
            l3=table.l3,
            l4=table.l4,
            leg_mass=table.leg_mass,
            wheel_mass=table.wheel_mass,
            leg_inertia=np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]),
            wheel_axial=table.wheel_inertia[0],
            wheel_transverse=table.wheel_inertia[1],
            slope=table.slope,
            gravity=table.gravity,
        )
    except ValueError as error:
        raise study.error(f"spatial_leg: {error}") from None
    motion = LegMotion(
        v_v=table.speed.start + table.speed.rate * times,
        a_v=table.speed.rate * one,
        omega_g=yaw,
        alpha_g=table.yaw.rate * one,
        beta=beta,
        omega_i=omega_i,
        alpha_i=alpha_i,
        omega_w=table.spin.start + spin_rate * times,
        alpha_w=spin_rate * one,
        course_rate=yaw if table.course == "yaw" else 0.0 * one,
        heading=table.yaw.start * times + 0.5 * table.yaw.rate * times**2,
    )
    return times, leg_dynamics(leg, motion)


def hinge_reactions(study: Study, case: str, times: Floats, found: LegDynamics) -> Reactions:
    """What the leg does to the pin at its hinge, which is fixed in the aircraft with its axis along
    y'': force, and moment across the axis; the moment about the axis is the actuator's.
    """
    table = study.table.spatial_leg
    assert table is not None
    cyclic = [2, 0, 1]
    moments = found.M_B[:, None, cyclic].copy()
    moments[..., 2] = 0.0
    return Reactions(
        case=case,
        times=times,
        connections=(table.connection,),
        bodies=("leg",),
        forces=found.F_B[:, None, cyclic],
        moments=moments,
        turn=np.zeros((len(times), 1)),
    )
