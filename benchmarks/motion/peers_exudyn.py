"""The linkage in exudyn: planar bodies and joints, integrated in time by the generalised alpha
method.

Drives are constraints on position (index 3). Connections that share a force are springs, as the
sharing rule states; they are so stiff that their deflection is of the size of the error in time,
and decreases with it.
"""

from __future__ import annotations

import exudyn as exu
import exudyn.itemInterface as item
import numpy as np

from benchmarks.motion.peers import Case, Code, Found
from loads import GROUND, Body, Slider, Turn
from loads.linkage.parts import Point
from pinbase.arrays import Floats

STEPS = (40, 80, 160)
SPRING = 1e9  # N/m for the first of these; four times as stiff with every halving of the step


def solve(case: Case, steps: int) -> Found:
    """Return forces and drive, with `steps` time steps from one instant to the next."""
    model = _Model(case, SPRING * (steps / STEPS[0]) ** 2)
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = case.times[0]
    course = settings.timeIntegration
    course.endTime = case.times[-1]
    course.numberOfSteps = steps * len(case.times)
    course.generalizedAlpha.spectralRadius = 0.5  # damps the transient at the start
    course.newton.useModifiedNewton = False
    course.newton.relativeTolerance = 1e-8  # the least that round-off in the stiff springs allows
    model.system.Assemble()
    model.system.SolveDynamic(settings)
    forces = np.stack([model.stored(sensor) for sensor in model.connections], axis=1)
    return Found(-forces[..., :2], -model.stored(model.drive)[:, 0])


class _Model:
    """An exudyn system.

    connections, drive: sensors of the forces on the body of the first marker.
    """

    def __init__(self, case: Case, spring: float) -> None:
        self.case, linkage = case, case.linkage
        self._container = exu.SystemContainer()  # owns the system
        self.system = self._container.AddSystem()
        self._object = {GROUND: self.system.AddObject(item.ObjectGround())}
        self._centre: dict[str, Point] = {GROUND: (0.0, 0.0)}
        self._node: dict[str, int] = {}
        self.drive = -1
        for body in linkage.items:
            self._add_body(body)
        stiffness = {
            name: spring * part
            for share in linkage.sharing
            for name, part in zip(share.connections, share.stiffness, strict=True)
        }
        self.connections = [
            self._add_connection(c.body, linkage.carrier(j), j.at, stiffness.get(c.name))
            for j, c in linkage.connections
        ]
        for slider in linkage.sliders:
            self._add_slider(slider)
        for turn in linkage.turns:
            self._add_turn(turn)

    def stored(self, sensor: int) -> Floats:
        """Return the rows (T, ...) of a sensor at the instants of the case."""
        rows = np.asarray(self.system.GetSensorStoredData(sensor))
        chosen = [int(np.abs(rows[:, 0] - t).argmin()) for t in self.case.times]
        np.testing.assert_allclose(rows[chosen, 0], self.case.times)
        return rows[chosen, 1:]

    def _add_body(self, body: Body) -> None:
        if body.inertia is None:
            node = self.system.AddNode(item.NodePoint2D(referenceCoordinates=[*body.centre]))
            added = item.ObjectMassPoint2D(mass=body.mass, nodeNumber=node)
        else:
            node = self.system.AddNode(
                item.NodeRigidBody2D(referenceCoordinates=[*body.centre, 0.0])
            )
            added = item.ObjectRigidBody2D(mass=body.mass, inertia=body.inertia, nodeNumber=node)
        self._node[body.name] = node
        self._centre[body.name] = body.centre
        self._object[body.name] = number = self.system.AddObject(added)
        marker = self.system.AddMarker(item.MarkerBodyMass(bodyNumber=number))
        weight = [*self.case.linkage.gravity, 0.0]
        self.system.AddLoad(item.LoadMassProportional(markerNumber=marker, loadVector=weight))

    def _arm(self, body: str, at: Point) -> list[float]:
        x, y = self._centre[body]
        return [at[0] - x, at[1] - y, 0.0]

    def _add_connection(self, body: str, carrier: str, at: Point, spring: float | None) -> int:
        markers = [
            self.system.AddMarker(
                item.MarkerBodyPosition(bodyNumber=self._object[b], localPosition=self._arm(b, at))
            )
            for b in (body, carrier)
        ]
        return self._force(
            item.ObjectJointRevolute2D(markerNumbers=markers)
            if spring is None
            else item.ObjectConnectorCartesianSpringDamper(
                markerNumbers=markers, stiffness=[spring, spring, 0.0]
            ),
            exu.OutputVariableType.Force,
        )

    def _add_slider(self, slider: Slider) -> None:
        """Add a joint whose first axis is that of the slider: free, or moved by the drive."""
        x, y = slider.axis
        markers = []
        for body, at in ((slider.base, slider.start), (slider.moving, slider.end)):
            frame = np.eye(4)
            frame[:2, :2] = [[x, -y], [y, x]]
            frame[:3, 3] = self._arm(body, at)
            markers.append(
                self.system.AddMarker(
                    item.MarkerBodyRigid(bodyNumber=self._object[body], localHT=frame)
                )
            )
        driven = slider.name in self.case.linkage.driven

        def offset(_system: object, time: float, _number: int, _given: object) -> list[float]:
            along = slider.drawn + self.case.drive(time)[0] if driven else 0.0
            return [along, 0.0, 0.0, 0.0, 0.0, 0.0]

        sensor = self._force(
            item.ObjectJointGeneric(
                markerNumbers=markers,
                constrainedAxes=[int(driven), 1, 0, 0, 0, 1],
                offsetUserFunction=offset,
            ),
            exu.OutputVariableType.ForceLocal,
        )
        if driven:
            self.drive = sensor

    def _add_turn(self, turn: Turn) -> None:
        """Add a constraint on the angles of the bodies if a drive moves them."""
        if turn.name not in self.case.linkage.driven:
            return
        ground = self.system.AddNode(item.NodePointGround())
        markers = [
            self.system.AddMarker(
                item.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0)
                if body == GROUND
                else item.MarkerNodeCoordinate(nodeNumber=self._node[body], coordinate=2)
            )
            for body in (turn.base, turn.body)
        ]

        def offset(_system: object, time: float, _number: int, _given: float) -> float:
            return self.case.drive(time)[0]

        self.drive = self._force(
            item.ObjectConnectorCoordinate(markerNumbers=markers, offsetUserFunction=offset),
            exu.OutputVariableType.Force,
        )

    def _force(self, connector: object, kind: object) -> int:
        """Add a connector; return the sensor of its force."""
        number = self.system.AddObject(connector)
        return int(
            self.system.AddSensor(
                item.SensorObject(
                    objectNumber=number,
                    outputVariableType=kind,
                    storeInternal=True,
                    writeToFile=False,
                )
            )
        )


EXUDYN = Code("exudyn", solve, STEPS, shares=True)
