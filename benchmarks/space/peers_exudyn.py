"""A machine in exudyn: rigid bodies and generic joints, integrated in time.

Drives are constraints on position (index 3) and joints of their own, parallel to the joint that
they move, so that the forces of both can be separated. Rotations are Euler parameters. The
integrator is the generalised alpha method, of second order: forces at two steps are extrapolated to
a step of zero.
"""

from __future__ import annotations

from typing import Any

import exudyn as exu
import exudyn.itemInterface as item
import numpy as np

from benchmarks.space.bodies import Vector
from benchmarks.space.machines import Machine
from benchmarks.space.peer_forces import PeerForces
from loads import CycloidalDrive
from pinbase.arrays import Floats

# Axes that each kind constrains in the frame of its base: three translations, three rotations. The
# axes of a universal joint are x of the base's marker and y of the moving body's.
CONSTRAINED = {
    "revolute": [1, 1, 1, 1, 1, 0],
    "spherical": [1, 1, 1, 0, 0, 0],
    "universal": [1, 1, 1, 0, 0, 1],
    "cylindrical": [1, 1, 0, 1, 1, 0],
    "prismatic": [1, 1, 0, 1, 1, 1],
    "planar": [0, 0, 1, 1, 1, 0],
    "fixed": [1, 1, 1, 1, 1, 1],
    "point-on-line": [1, 1, 0, 0, 0, 0],
}
DRIVEN = {"angle": [0, 0, 0, 0, 0, 1], "travel": [0, 0, 1, 0, 0, 0]}


def solve(machine: Machine, times: Floats, steps: int) -> PeerForces:
    """Return the forces at equally spaced times, with `steps` integration steps from one to the
    next.
    """
    model = _Model(machine)
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = times[0]
    course = settings.timeIntegration
    course.endTime = times[-1]
    course.numberOfSteps = steps * len(times)
    course.generalizedAlpha.spectralRadius = 0.5  # damps the transient at the start
    course.generalizedAlpha.computeInitialAccelerations = True
    course.newton.useModifiedNewton = False
    course.newton.relativeTolerance = 1e-11
    course.newton.absoluteTolerance = 1e-13
    model.system.Assemble()
    model.system.SolveDynamic(settings)
    return model.forces(times)


class _Model:
    """An exudyn system with sensors of every joint and drive."""

    def __init__(self, machine: Machine) -> None:
        self.machine = machine
        self._container = exu.SystemContainer()  # owns the system
        self.system = self._container.AddSystem()
        self._object = {"ground": self.system.AddObject(item.ObjectGround())}
        self._centre: dict[str, Vector] = {"ground": (0.0, 0.0, 0.0)}
        for name in machine["bodies"]:
            self._add_body(name)
        self.joints = [self._add_joint(name) for name in machine["joints"]]
        self.drives = [self._add_drive(name) for name in machine["drives"]]
        for body, at, force in machine["forces"]:
            marker = self._marker(body, at, np.eye(3))
            self.system.AddLoad(item.LoadForceVector(markerNumber=marker, loadVector=[*force]))

    def _add_body(self, name: str) -> None:
        body = self.machine["bodies"][name]
        node = self.system.AddNode(
            item.NodeRigidBodyEP(referenceCoordinates=[*body["centre"], 1.0, 0.0, 0.0, 0.0])
        )
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = body["inertia"]
        number = self.system.AddObject(
            item.ObjectRigidBody(
                mass=body["mass"], inertia=[xx, yy, zz, yz, xz, xy], nodeNumber=node
            )
        )
        self._object[name], self._centre[name] = number, body["centre"]
        marker = self.system.AddMarker(item.MarkerBodyMass(bodyNumber=number))
        self.system.AddLoad(
            item.LoadMassProportional(markerNumber=marker, loadVector=[*self.machine["gravity"]])
        )

    def _marker(self, body: str, at: Vector, frame: Floats) -> int:
        local = np.eye(4)
        local[:3, :3] = frame
        local[:3, 3] = np.subtract(at, self._centre[body])
        return int(
            self.system.AddMarker(
                item.MarkerBodyRigid(bodyNumber=self._object[body], localHT=local)
            )
        )

    def _sensor(self, made: Any, kind: Any) -> int:
        return int(self.system.AddSensor(made(outputVariableType=kind, storeInternal=True,
                                              writeToFile=False)))  # fmt: skip

    def _add_joint(self, name: str) -> dict[str, int]:
        """Add a joint; return its sensors: multipliers, and frames and positions of both its
        markers.
        """
        joint = self.machine["joints"][name]
        frame = joint_frame(joint.get("axis"), joint.get("second_axis"))
        bodies = joint["base"], joint["moving"]
        markers = [self._marker(body, joint["at"], frame) for body in bodies]
        number = self.system.AddObject(
            item.ObjectJointGeneric(
                markerNumbers=markers, constrainedAxes=CONSTRAINED[joint["kind"]]
            )
        )
        kinds = exu.OutputVariableType

        def of_joint(**k: Any) -> Any:
            return item.SensorObject(objectNumber=number, **k)

        sensors = {
            "force": self._sensor(of_joint, kinds.ForceLocal),
            "torque": self._sensor(of_joint, kinds.TorqueLocal),
        }
        for end, marker in zip(("base", "moving"), markers, strict=True):

            def of_marker(at: int = marker, **k: Any) -> Any:
                return item.SensorMarker(markerNumber=at, **k)

            sensors[end] = self._sensor(of_marker, kinds.RotationMatrix)
            sensors[f"{end} point"] = self._sensor(of_marker, kinds.Position)
        return sensors

    def _add_drive(self, name: str) -> int:
        drive = self.machine["drives"][name]
        joint = self.machine["joints"][drive["joint"]]
        frame = joint_frame(joint.get("axis"), joint.get("second_axis"))
        markers = [self._marker(joint[b], joint["at"], frame) for b in ("base", "moving")]
        law = CycloidalDrive(0.0, drive["to"], self.machine["duration"])
        turns = drive["measures"] == "angle"

        def offset(_system: object, time: float, _number: int, _given: object) -> list[float]:
            value = float(law(np.array([time]))[0][0])
            return [0.0, 0.0, 0.0 if turns else value, 0.0, 0.0, value if turns else 0.0]

        number = self.system.AddObject(
            item.ObjectJointGeneric(
                markerNumbers=markers,
                constrainedAxes=DRIVEN[drive["measures"]],
                offsetUserFunction=offset,
            )
        )

        def of_joint(**k: Any) -> Any:
            return item.SensorObject(objectNumber=number, **k)

        kinds = exu.OutputVariableType
        return self._sensor(of_joint, kinds.TorqueLocal if turns else kinds.ForceLocal)

    def _stored(self, sensor: int, times: Floats) -> Floats:
        rows = np.asarray(self.system.GetSensorStoredData(sensor))
        chosen = [int(np.abs(rows[:, 0] - t).argmin()) for t in times]
        np.testing.assert_allclose(rows[chosen, 0], times)
        return rows[chosen, 1:]

    def forces(self, times: Floats) -> PeerForces:
        """Return forces and moments from exudyn's multipliers."""
        wrenches = [
            self._wrench(joint["kind"], sensors, times)
            for joint, sensors in zip(self.machine["joints"].values(), self.joints, strict=True)
        ]
        points, forces, moments = (np.stack(x, axis=1) for x in zip(*wrenches, strict=True))
        # Exudyn's condition of a travel increases with it; that of an angle, x . y, decreases.
        signs = [1.0 if d["measures"] == "angle" else -1.0 for d in self.machine["drives"].values()]
        pairs = zip(signs, self.drives, strict=True)
        drives = np.stack([sign * self._stored(k, times)[:, 2] for sign, k in pairs], axis=1)
        return PeerForces(points, forces, moments, drives)

    def _wrench(
        self, kind: str, sensors: dict[str, int], times: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Return the point of the moving body, and the force and moment on the base there, (T, 3)
        each.
        """
        stored = {name: self._stored(sensor, times) for name, sensor in sensors.items()}
        base, moving = (stored[end].reshape(-1, 3, 3) for end in ("base", "moving"))
        force = np.einsum("tij,tj->ti", base, stored["force"])
        torque = stored["torque"]
        moment = np.zeros_like(force)
        # For the multiplier f of the condition a . b = 0, with a of the base and b of the moving
        # body, the moment on the moving body is -f b x a, and on the base the opposite.
        for row, a, b in _right_angles(kind):
            arm = np.cross(moving[:, :, b], base[:, :, a])
            moment += torque[:, row, None] * arm
        return stored["moving point"], force, moment


def _right_angles(kind: str) -> list[tuple[int, int, int]]:
    """Return rows of torque with the axes of base and moving body that exudyn keeps
    perpendicular.
    """
    match sum(CONSTRAINED[kind][3:]):
        case 3:
            return [(0, 2, 1), (1, 2, 0), (2, 0, 1)]
        case 2:
            return [(0, 2, 0), (1, 2, 1)]
        case 1:
            return [(2, 0, 1)]
    return []


def joint_frame(axis: Vector | None, second: Vector | None) -> Floats:
    """Return the axes of a joint's markers as columns: z along its axis, or x and y for a universal
    joint.
    """
    if axis is None:
        return np.eye(3)
    first = np.array(axis) / np.linalg.norm(axis)
    if second is not None:
        y = np.array(second) / np.linalg.norm(second)
        return np.column_stack([first, y, np.cross(first, y)])
    x = np.cross(np.eye(3)[int(np.abs(first).argmin())], first)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(first, x), first])
