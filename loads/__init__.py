"""Loads: from a mechanism and its motion, or from a table, to the forces on every pin.

Everything here is in SI units. This room imports nothing else of ours.
"""

from loads.drive import (
    ConstantDrive,
    CosineDrive,
    CycloidalDrive,
    Law,
    StateDrive,
    TableDrive,
)
from loads.energy import Energy, Ledger, energy, ledger
from loads.forces import Applied, Dynamics, motion_reactions, static_reactions
from loads.friction import JammingError
from loads.impasse import Impasse
from loads.impulse import impulse_force
from loads.lever import Lever
from loads.linkage import (
    GROUND,
    Body,
    Connection,
    Joint,
    Linkage,
    LinkageError,
    Sharing,
    Slider,
    Turn,
)
from loads.mobility import Mobility, mobility
from loads.motion import Motion, at_rest, move
from loads.reactions import Reactions, given_reactions, read_reactions
from loads.spatial_leg import Contact, LegDynamics, LegMotion, SpatialLeg, leg_dynamics
from loads.table import TableError, read_table

__all__ = [
    "GROUND",
    "Applied",
    "Body",
    "Connection",
    "ConstantDrive",
    "Contact",
    "CosineDrive",
    "CycloidalDrive",
    "Dynamics",
    "Energy",
    "Impasse",
    "JammingError",
    "Joint",
    "Law",
    "Ledger",
    "LegDynamics",
    "LegMotion",
    "Lever",
    "Linkage",
    "LinkageError",
    "Mobility",
    "Motion",
    "Reactions",
    "Sharing",
    "Slider",
    "SpatialLeg",
    "StateDrive",
    "TableDrive",
    "TableError",
    "Turn",
    "at_rest",
    "energy",
    "given_reactions",
    "impulse_force",
    "ledger",
    "leg_dynamics",
    "mobility",
    "motion_reactions",
    "move",
    "read_reactions",
    "read_table",
    "static_reactions",
]
