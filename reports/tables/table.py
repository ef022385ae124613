"""A table as rows of cells: what CSV files and the workbook are written from."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from reports.data.results import Units
from reports.format.files.csv import Cell, write_csv
from reports.format.files.parquet import write_parquet
from reports.format.units import unit_name

MAX_CSV_ROWS = 1_000_000  # rows; a sheet of a spreadsheet has 1,048,576

# What columns are measured in, by their names; tables name the exceptions.
COLUMN_DIMENSIONS = {
    "time": "time",
    "impulse_time": "time",
    **dict.fromkeys(("fx", "fy", "fz", "force", "shear", "friction", "normal"), "force"),
    **dict.fromkeys(("shaking_fx", "shaking_fy"), "force"),
    **dict.fromkeys(("mx", "my", "mz", "moment", "couple", "shaking_moment"), "moment"),
    **dict.fromkeys(("axial_force", "shear_force"), "force"),
    **dict.fromkeys(("work", "kinetic_energy", "potential_energy"), "moment"),
    **dict.fromkeys(("x", "y", "z", "radius", "excluded_radius", "position"), "length"),
    **dict.fromkeys(("vx", "vy", "velocity", "velocity_change"), "velocity"),
    **dict.fromkeys(("speed", "closed_form_speed"), "velocity"),
    **dict.fromkeys(("ax", "ay", "acceleration", "closed_form_acceleration"), "acceleration"),
    **dict.fromkeys(("max_von_mises", "error_estimate", "published_max_von_mises"), "stress"),
    **dict.fromkeys(("max_von_mises_low", "max_von_mises_high"), "stress"),
    **dict.fromkeys(("error_mesh", "error_time", "error_series"), "stress"),
    **dict.fromkeys(("error_model", "error_cells", "error_truncation"), "stress"),
    **dict.fromkeys(("joint_low", "joint_high", "mean_pressure", "max_pressure"), "stress"),
    **dict.fromkeys(("surface", "section", "beneath", "beneath_error"), "stress"),
    **dict.fromkeys(("max_von_mises_same_mesh", "max_von_mises_calculix"), "stress"),
    **dict.fromkeys(("moment_even", "moment_concentrated", "moment_joint"), "moment"),
    **dict.fromkeys(("bending_moment", "bending_moment_calculix", "torque"), "moment"),
    **dict.fromkeys(("clearance", "outer_diameter", "length", "z_start", "z_end"), "length"),
    **dict.fromkeys(("displacement", "permanent_set"), "length"),
    **dict.fromkeys(("reach", "reach_required", "yield_distance"), "length"),
    "contact_angle": "degrees",
    "curvature": "curvature",
    **dict.fromkeys(("line_load", "line_load_calculix"), "force per length"),
    **dict.fromkeys(("stress", "strength", "beam_axial_stress"), "stress"),
    **dict.fromkeys(("von_mises", "signed", "amplitude", "mean_stress"), "stress"),
    **dict.fromkeys(("fea_axial_stress", "fea_axial_stress_axis_load"), "stress"),
    **dict.fromkeys(("power", "power_drives", "power_gravity", "power_applied"), "power"),
    **dict.fromkeys(("power_friction", "kinetic_rate"), "power"),
    **dict.fromkeys(("angle_deg", "degrees"), "degrees"),
    **dict.fromkeys(("stroke", "tyre_deflection"), "length"),
    **dict.fromkeys(("vertical", "drag", "strut_force", "leg_drag"), "force"),
    "sprung_velocity": "velocity",
    **dict.fromkeys(
        (
            *("spring_energy", "tyre_energy", "bending_energy", "oil_energy", "friction_energy"),
            *("stop_energy", "tyre_damping_energy", "slip_energy", "lift_energy"),
            "runway_energy",
        ),
        "moment",
    ),
    "omega": "rate of turn",
    "alpha": "rate of rate of turn",
}


@dataclass(frozen=True)
class Table:
    """name: of its CSV file, without the ending; columns: with as many cells in every row.

    mixed: columns whose unit differs from row to row, as other columns of the row say.
    """

    name: str
    columns: tuple[str, ...]
    rows: Sequence[Sequence[Cell]]
    mixed: tuple[str, ...] = ()

    @staticmethod
    def of(
        name: str, columns: Iterable[str], rows: Iterable[Sequence[Cell]], mixed: Iterable[str] = ()
    ) -> Table:
        """A table from any iterables."""
        return Table(name, tuple(columns), tuple(rows), tuple(mixed))

    def unit(self, column: str, units: Units) -> str:
        """Of a column's numbers; empty for texts, ratios, and what differs from row to row."""
        if column in self.mixed:
            return ""
        return unit_name(COLUMN_DIMENSIONS.get(column, ""), units)

    def write(self, directory: Path) -> Path:
        """Write it into a folder: as CSV, or as Parquet where spreadsheets could not open it."""
        large = len(self.rows) > MAX_CSV_ROWS
        path = directory / f"{self.name}.{'parquet' if large else 'csv'}"
        (write_parquet if large else write_csv)(path, self.columns, self.rows)
        return path
