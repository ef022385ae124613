"""Loads: from a mechanism and its motion, or from a table, to the forces on every pin.

Everything here is in SI units. This room imports nothing else of ours.
"""

from loads.drive import CosineDrive
from loads.forces import Applied, Dynamics, motion_reactions, static_reactions
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
    UnreachableError,
)
from loads.mobility import Mobility, mobility
from loads.motion import Motion, energy, move
from loads.reactions import Reactions, TableError, given_reactions, read_reactions
from loads.spatial_leg import Contact, LegDynamics, LegMotion, SpatialLeg, leg_dynamics

__all__ = [
    "GROUND",
    "Applied",
    "Body",
    "Connection",
    "Contact",
    "CosineDrive",
    "Dynamics",
    "Joint",
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
    "TableError",
    "UnreachableError",
    "energy",
    "given_reactions",
    "impulse_force",
    "leg_dynamics",
    "mobility",
    "motion_reactions",
    "move",
    "read_reactions",
    "static_reactions",
]
