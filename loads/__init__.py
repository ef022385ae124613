"""Loads: from a mechanism and its motion, or from a table, to the forces on every pin.

All quantities are in SI units. Of the other packages here, it imports only `pinbase`.
"""

from loads.forces.acting import Applied, ForceLaw, Load, Spring
from loads.forces.corners import Varying
from loads.forces.curve import ForceTable
from loads.forces.holding import locked
from loads.forces.inverse_dynamics import Dynamics, motion_reactions
from loads.forces.measures import Clock, Distance, Measure, Position
from loads.forces.over_time import (
    Effort,
    OverTime,
    PeakForces,
    over_time,
    require_possible,
)
from loads.forces.power_balance import energy, ledger
from loads.forces.reactions import Reactions, given_reactions, read_reactions, tabled_reactions
from loads.landing.impulse import impulse_force
from loads.linkage.drives import (
    ConstantDrive,
    CosineDrive,
    CycloidalDrive,
    Law,
    StateDrive,
    TableDrive,
)
from loads.linkage.friction import JammingError
from loads.linkage.gears import gear_pair, rack_and_pinion
from loads.linkage.linkage import Linkage, LinkageError
from loads.linkage.parts import (
    GROUND,
    Body,
    Connection,
    Gear,
    Joint,
    Parallel,
    Rack,
    Sharing,
    Slider,
    Teeth,
    Turn,
)
from loads.motion.four_bar import Lever
from loads.motion.mobility import mobility
from loads.motion.motion import Course, Motion, at_rest, move
from loads.motion.refine import Resolved, resolved
from loads.motion.singular_positions import MotionBlocked
from loads.tables.csv_table import TableError, read_table
from loads.tables.force_columns import JointAxes, Layout
from loads.tables.force_table import jump_times, table_cases
from loads.tables.grid import FileReading
from loads.tables.regular_file import MB, FileError, read_regular, require_regular
from loads.tables.sent_files import noted_files, on_disk, sent_files
from pinbase.errors import ArgumentError, CodedError
