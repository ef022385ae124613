"""Dynamics of a study's spatial leg, and the loads on the pin at its hinge."""

from __future__ import annotations

import numpy as np

from loads import ArgumentError, LegDynamics, LegMotion, Reactions, SpatialLeg, leg_dynamics
from pinbase.arrays import Floats
from pinstress.study.model.mechanism.drives import DRIVE_LAWS
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import LegCase

LEG_AXES = "x = z'' (up), y = x'' (right), z = y'' (ahead, along the hinge)"


def instants(study: Study, case: LegCase) -> Floats:
    """Return the samples of a case, (T,) s."""
    assert study.table.spatial_leg is not None
    return np.linspace(0.0, study.table.spatial_leg.fold.duration, case.samples)


def dynamics(study: Study, times: Floats) -> LegDynamics:
    """Return the leg's dynamics at times (T,) s.

    Raises: InputError.
    """
    table = study.table.spatial_leg
    assert table is not None
    if len(table.leg_inertia) not in (3, 6):
        raise study.error(
            "spatial_leg.leg_inertia: give 3 moments, [xx, yy, zz], or 6, [xx, yy, zz, xy, xz, yz]",
            code="bad-shape",
        )
    xx, yy, zz, xy, xz, yz = (*table.leg_inertia, 0.0, 0.0, 0.0)[:6]
    fold = DRIVE_LAWS[table.fold.law](table.fold.start, table.fold.end, table.fold.duration)
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
    except ArgumentError as error:
        raise study.error(f"spatial_leg: {error}", code=error.code) from None
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
    return leg_dynamics(leg, motion)


def hinge_reactions(study: Study, case: str, times: Floats, leg: LegDynamics) -> Reactions:
    """Return the load of the leg on the pin at its hinge: force, and moment across the axis.

    The pin is fixed in the aircraft with its axis along y''; the moment about the axis is the
    actuator's.
    """
    table = study.table.spatial_leg
    assert table is not None
    cyclic = [2, 0, 1]
    moments = leg.M_B[:, None, cyclic].copy()
    moments[..., 2] = 0.0
    return Reactions(
        case=case,
        times=times,
        connections=(table.connection,),
        bodies=("leg",),
        forces=leg.F_B[:, None, cyclic],
        moments=moments,
        turn=np.zeros((len(times), 1)),
    )
