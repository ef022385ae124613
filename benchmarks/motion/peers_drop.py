"""The drop of a leg compared with exudyn: two masses, a gas spring with oil, and a tyre."""

from __future__ import annotations

import numpy as np

from benchmarks.timing import table
from loads.landing import Drop, GasSpring, Oil, PowerTyre, Strut, land
from pinbase.arrays import Floats

MISSING = (
    "exudyn is not installed: .venv/bin/pip install --require-hashes -r requirements-bench.lock"
)
GAS = GasSpring(8e5, 0.003, 0.008, 1.2, 1.01e5)
OIL = Oil(860.0, 0.006, 2.2e-4, 0.9, 1.2e-4)
TYRE = PowerTyre(1.2e6, 1.25)
LEG = Drop(1050.0, 60.0, 3.05, TYRE, Strut(GAS, 0.34, OIL), lift=0.9, duration=0.4)
STOP, DAMPING = 1e10, 1e6  # N/m and N s/m of exudyn's stop; ours is rigid
STEPS = (4_000, 16_000)


def peers_drop() -> str:
    """Return the table of the largest forces and strokes by both, and the largest differences over
    time.
    """
    try:
        import exudyn  # noqa: F401
    except ModuleNotFoundError:
        return MISSING
    found = land(LEG)
    rows: list[tuple[object, ...]] = []
    for steps in STEPS:
        times, theirs = _exudyn(steps)
        history = found.at(times)
        f = history.forces
        ours = np.stack([f.vertical, f.along, f.stroke], axis=1)
        for k, name in enumerate(("ground force, N", "strut force, N", "stroke, m")):
            largest = float(np.abs(ours[:, k]).max())
            off = float(np.abs(ours[:, k] - theirs[:, k]).max()) / largest
            rows.append((steps, name, largest, float(np.abs(theirs[:, k]).max()), f"{off:.1e}"))
    head = ("exudyn's steps", "quantity", "ours", "exudyn", "largest difference")
    return table(head, rows)


def _strut(_s: object, _t: float, _n: int, stroke: float, speed: float, *_: float) -> float:
    gas = max(stroke, 0.0)
    pressure = (GAS.pressure + GAS.ambient) * (
        GAS.volume / (GAS.volume - GAS.area * gas)
    ) ** GAS.exponent
    orifice = OIL.orifice if speed > 0.0 else OIL.rebound or OIL.orifice
    oil = OIL.density * OIL.area**3 / (2.0 * (OIL.discharge * orifice) ** 2) * speed * abs(speed)
    stop = STOP * stroke + DAMPING * speed if stroke < 0.0 else 0.0
    return float((pressure - GAS.ambient) * GAS.area + stop + oil)


def _tyre(_s: object, _t: float, _n: int, way: float, _v: float, *_: float) -> float:
    return float(TYRE.coefficient * max(way, 0.0) ** TYRE.exponent)


def _exudyn(steps: int) -> tuple[Floats, Floats]:
    """Return times (T,), s, and at these the ground force, the strut force and the
    stroke, (T, 3).
    """
    import exudyn as exu
    import exudyn.itemInterface as item

    container = exu.SystemContainer()
    system = container.AddSystem()
    earth = system.AddNode(item.NodePointGround())
    markers = [system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=earth, coordinate=0))]
    lifted = LEG.lift * LEG.weight
    held = (
        LEG.sprung * LEG.gravity * LEG.lift - lifted
    )  # the strut's initial force, without the tyre
    begin = (
        held - float(GAS.force(np.zeros(1))[0])
    ) / STOP  # initial equilibrium, so that the stop does not vibrate
    for mass, lift, at in ((LEG.unsprung, 0.0, 0.0), (LEG.sprung, lifted, begin)):
        node = system.AddNode(
            item.Node1D(
                referenceCoordinates=[0.0],
                initialCoordinates=[at],
                initialVelocities=[LEG.velocity],
            )
        )
        system.AddObject(item.ObjectMass1D(physicsMass=mass, nodeNumber=node))
        marker = system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
        system.AddLoad(item.LoadCoordinate(markerNumber=marker, load=mass * LEG.gravity - lift))
        markers.append(marker)
    sensors = []
    for pair, law in ((markers[:2], _tyre), (markers[1:], _strut)):
        spring = system.AddObject(
            item.ObjectConnectorCoordinateSpringDamper(
                markerNumbers=pair, springForceUserFunction=law
            )
        )
        for what in (exu.OutputVariableType.Force, exu.OutputVariableType.Displacement):
            sensor = item.SensorObject(
                objectNumber=spring, storeInternal=True, outputVariableType=what
            )
            sensors.append(system.AddSensor(sensor))
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = LEG.duration / 400
    settings.timeIntegration.endTime = LEG.duration
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.9
    settings.timeIntegration.newton.useModifiedNewton = False
    system.Assemble()
    system.SolveDynamic(settings)
    stored = [np.asarray(system.GetSensorStoredData(s)) for s in sensors]
    columns = (stored[0][:, 1], stored[2][:, 1], stored[3][:, 1])
    return stored[0][:, 0], np.stack(columns, axis=1)
