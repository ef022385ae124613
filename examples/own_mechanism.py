"""A mechanism defined in Python, without a study file: a pump jack at 12 strokes a minute.

Lengths in m, masses in kg, inertias in kg m², forces in N; points as complex numbers x + iy.
"""

import numpy as np

import loads
from loads import GROUND, Body, Connection, Joint

START = np.pi / 3  # crank angle in the drawn position
O2, O4, CRANK, PITMAN, ARM, FRONT = 0j, 1.5 + 2j, 0.5, 2.0, 1.5, 1.8
A = O2 + CRANK * np.exp(1j * START)
way = O4 - A  # B is at PITMAN from A and ARM from O4, left of the line from A to O4
along = (PITMAN**2 - ARM**2 + abs(way) ** 2) / (2 * abs(way))
B = A + way / abs(way) * (along + 1j * np.sqrt(PITMAN**2 - along**2))
HEAD = O4 + FRONT / ARM * (O4 - B)  # attachment of the rods


def xy(point: complex) -> tuple[float, float]:
    return float(point.real), float(point.imag)


crank = Body("crank", 600.0, xy(-0.6 * A), 80.0)  # mostly the counterweight
pitman = Body("pitman", 90.0, xy((A + B) / 2), 30.0)
beam = Body("beam", 500.0, xy((HEAD + B) / 2), 450.0)
joints = (
    Joint("O2", xy(O2), (Connection("O2", "crank"),), GROUND),
    Joint("A", xy(A), (Connection("A", "pitman"),), "crank"),
    Joint("B", xy(B), (Connection("B", "pitman"),), "beam"),
    Joint("O4", xy(O4), (Connection("O4", "beam"),), GROUND),
)
turn, gravity = loads.Turn("crank", "crank", START), (0.0, -9.81)
jack = loads.Linkage((crank, pitman, beam), joints, ("crank",), turns=(turn,), gravity=gravity)
times = np.linspace(0.0, 5.0, 361)
motion = loads.move(jack, [loads.ConstantDrive(START, START + 2 * np.pi, 5.0)], times)
found = loads.motion_reactions("stroke", motion, [loads.Applied("beam", xy(HEAD), (0, -8000))])
for name, force in zip(found.reactions.connections, found.reactions.magnitudes.T, strict=True):
    print(f"joint {name:2}: {force.max():7.0f} N at {times[force.argmax()]:.2f} s")
print(f"torque of the crank: {found.drive.min():.0f} to {found.drive.max():.0f} N m")
