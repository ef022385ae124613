"""The linkage in MuJoCo: every body moves freely in the plane, every connection is a constraint.

MuJoCo gives the accelerations and constraint forces of a state (mj_forward); scipy integrates them
in time. In effect, MuJoCo's constraints are critically damped springs: the motion lags by an amount
that depends on their time constant, and the error of the forces decreases with its square. MuJoCo's
own integrators would hold the drive still within a step, which costs more accuracy. Where
connections share a force, MuJoCo's own rule distributes it over all of them, so that only their
sums can be compared.
"""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.motion.peers import Case, Code, Found
from loads import GROUND, Body, Linkage, Turn
from loads.linkage.parts import Point
from pinbase.arrays import Floats

HARDNESS = 0.9999  # the largest that MuJoCo allows


def solve(case: Case, steps: int) -> Found:
    """Return forces and drive; `steps` time constants of the constraints fit between two
    instants.
    """
    constant = case.times[0] / steps
    model = _model(case.linkage, constant)
    data = mujoco.MjData(model)
    drive, count = model.equality("drive").id, model.nv

    def forward(time: float, state: Floats) -> Floats:
        value, rate, second = case.drive(time)
        # The target at which the constraint's spring and damper follow a moving drive.
        model.eq_data[drive, 0] = value + 2.0 * constant * rate + constant**2 * second
        data.qpos[:], data.qvel[:] = state[:count], state[count:]
        mujoco.mj_forward(model, data)
        return np.concatenate([data.qvel, data.qacc])

    course = solve_ivp(
        forward,
        (0.0, case.times[-1]),
        np.zeros(2 * count),
        method="DOP853",
        t_eval=case.times,
        rtol=1e-9,
        atol=1e-11,
    )
    rows = []
    for time, state in zip(case.times, course.y.T, strict=True):
        forward(time, state)
        rows.append(data.efc_force.copy())
    found = np.array(rows)
    # Each connection has three rows, the third (out of the plane) idle; the last row is the drive.
    on_body = found[:, :-1].reshape(len(rows), -1, 3)[..., :2]
    return Found(-on_body, found[:, -1])


def _model(linkage: Linkage, constant: float) -> Any:
    """Return the compiled model, whose coordinates are zero in the drawn position."""
    spec = mujoco.MjSpec()
    spec.option.gravity = [*linkage.gravity, 0.0]
    spec.option.tolerance = 0.0
    # Otherwise the constraints' time constant would be at least two of MuJoCo's own time steps.
    spec.option.disableflags = mujoco.mjtDisableBit.mjDSBL_REFSAFE
    bodies = {GROUND: spec.worldbody}
    for item in linkage.items:
        _add_body(linkage, item, bodies)
    constraint = {
        "solref": [-1.0 / constant**2, -2.0 / constant],  # stiffness and damping per inertia
        "solimp": [HARDNESS, HARDNESS, 1.0, 0.5, 1.0],
    }
    for joint, c in linkage.connections:
        anchor = np.subtract(joint.at, _centre(linkage, c.body))
        spec.add_equality(
            type=mujoco.mjtEq.mjEQ_CONNECT,
            objtype=mujoco.mjtObj.mjOBJ_BODY,
            name=c.name,
            name1=bodies[c.body].name,
            name2=bodies[linkage.carrier(joint)].name,
            **constraint,
        ).data[:2] = anchor
    (drive,) = linkage.drives
    turned, base = (drive.body, drive.base) if isinstance(drive, Turn) else (None, GROUND)
    spec.add_equality(
        type=mujoco.mjtEq.mjEQ_JOINT,
        objtype=mujoco.mjtObj.mjOBJ_JOINT,
        name="drive",
        name1=drive.name if turned is None else _angle(turned),
        name2="" if base == GROUND else _angle(base),
        **constraint,
    ).data[1] = 1.0
    return spec.compile()


def _add_body(linkage: Linkage, item: Body, bodies: dict[str, Any]) -> None:
    """Add a body that moves freely on the ground (without rotation for a particle), or slides on
    its base.
    """
    if item.name in bodies:
        return
    slider = next((s for s in linkage.sliders if s.moving == item.name), None)
    base = GROUND if slider is None else slider.base
    if base != GROUND:
        _add_body(linkage, linkage.items[linkage.index[base]], bodies)
    place = np.subtract(item.centre, _centre(linkage, base))
    body = bodies[base].add_body(name=item.name, pos=[*place, 0.0])
    bodies[item.name] = body
    body.explicitinertial = True
    body.mass = item.mass
    body.inertia = [item.inertia or 1.0] * 3  # a particle has no joint in which to turn
    body.ipos, body.iquat = [0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]
    slide, hinge = mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE
    if slider is not None:
        body.add_joint(name=slider.name, type=slide, axis=[*slider.axis, 0.0])
        return
    body.add_joint(name=f"x of {item.name}", type=slide, axis=[1.0, 0.0, 0.0])
    body.add_joint(name=f"y of {item.name}", type=slide, axis=[0.0, 1.0, 0.0])
    if item.inertia is not None:
        body.add_joint(name=_angle(item.name), type=hinge, axis=[0.0, 0.0, 1.0])


def _centre(linkage: Linkage, item: str) -> Point:
    return (0.0, 0.0) if item == GROUND else linkage.items[linkage.index[item]].centre


def _angle(item: str) -> str:
    return f"angle of {item}"


MUJOCO = Code("MuJoCo", solve, (10, 20, 40), shares=False)
