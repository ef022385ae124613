"""Write the test files by the programs that write such files: `python write_files.py FOLDER`.

Needs exudyn, mujoco, openpyxl, pandas, pyarrow, xlsxwriter and LibreOffice (`soffice`), none of
which the tests need. The table is a load that jumps at 10 ms; the pendulum of exudyn and MuJoCo is
a point mass of 2 kg on a massless rod of 0.5 m, released from the horizontal at 9.81 m/s^2.
"""

from __future__ import annotations

import math
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd

TIMES = [0.0, 5.0, 10.0, 10.0, 15.0, 20.0]  # ms
COLUMNS = {  # kN, and N m
    "Fx_E": [0.0, 0.25, 0.5, -1.5, -0.75, 0.125],
    "Fy_E": [1.0, 1.5, 2.25, 4.0, 3.5, 1.0625],
    "Fz_E": [0.0, 0.0, -0.125, 0.5, 0.25, 0.0],
    "Mz_E": [0.0, 12.5, 25.0, -40.0, -20.0, 1.5],
}
UNITS = ["ms", "kN", "kN", "kN", "N m"]
MASS, LENGTH, GRAVITY = 2.0, 0.5, 9.81


def frame(units: bool = False) -> pd.DataFrame:
    """The table, with units as a second level of the header if asked."""
    table = pd.DataFrame({"t": TIMES, **COLUMNS})
    if units:
        table.columns = pd.MultiIndex.from_tuples(zip(table.columns, UNITS, strict=True))
    return table


def by_pandas(folder: Path) -> None:
    """Texts, a workbook and Parquet."""
    (folder / "pandas_blank.txt").write_text(frame().to_string(index=False) + "\n")
    german = {"sep": ";", "decimal": ",", "index": False}
    frame(True).to_csv(folder / "pandas_german.csv", encoding="utf-8-sig", **german)
    frame().to_csv(folder / "pandas_utf16.tab", sep="\t", index=False, encoding="utf-16")
    frame().to_excel(folder / "pandas.xlsx", sheet_name="run 12", index=False, engine="xlsxwriter")
    frame().to_parquet(folder / "pandas.parquet", index=False)


def by_openpyxl(folder: Path) -> None:
    """A workbook with a title, a row of units and a second sheet."""
    from openpyxl import Workbook

    book = Workbook()
    sheet = book.active
    sheet.title = "forces"
    for texts in (["rig 3, run 12"], ["t", *COLUMNS], [f"[{unit}]" for unit in UNITS]):
        sheet.append(texts)
    for numbers in zip(TIMES, *COLUMNS.values(), strict=True):
        sheet.append(list(numbers))
    book.create_sheet("notes").append(["by a test"])
    book.save(folder / "openpyxl.xlsx")


def by_libreoffice(folder: Path) -> None:
    """A workbook, and a text with semicolons, from the text with decimal commas."""
    with tempfile.TemporaryDirectory() as scratch:
        source = Path(scratch) / "libreoffice.csv"
        shutil.copy(folder / "pandas_german.csv", source)
        read = "--infilter=CSV:59,34,76,1,,1031,false,true"
        for kind in ("xlsx", "csv:Text - txt - csv (StarCalc):59,34,76,1,,1031,false,true"):
            out = Path(scratch) / "out"
            command = ["soffice", "--headless", read, "--convert-to", kind, "--outdir", out, source]
            subprocess.run(command, check=True, capture_output=True)
        shutil.copy(out / "libreoffice.xlsx", folder)
        shutil.copy(out / "libreoffice.csv", folder)


def by_exudyn(folder: Path) -> None:
    """The sensor of a spherical joint."""
    import exudyn as exu
    import exudyn.utilities as use

    system = exu.SystemContainer().AddSystem()
    inertia = use.InertiaCuboid(MASS / 1e-9, [1e-3] * 3)
    body = system.CreateRigidBody(
        inertia=inertia, referencePosition=[LENGTH, 0.0, 0.0], gravity=[0.0, -GRAVITY, 0.0]
    )
    ground = system.CreateGround()
    joint = system.CreateSphericalJoint(
        itemNumbers=[ground, body], position=[0.0, 0.0, 0.0], show=False
    )
    name = folder / "exudyn_joint.txt"
    system.AddSensor(
        use.SensorObject(
            objectNumber=joint[0] if isinstance(joint, list) else joint,
            fileName=str(name),
            outputVariableType=exu.OutputVariableType.Force,
        )
    )
    system.Assemble()
    settings = exu.SimulationSettings()
    # With 20,000 steps the forces are 1 % off: rounding grows as the step falls, in index 3.
    settings.timeIntegration.numberOfSteps = 2_000
    settings.timeIntegration.endTime = 0.4
    settings.solution.sensors.writePeriod = 0.02
    settings.solution.file.write = False
    settings.timeIntegration.verboseMode = 0
    system.SolveDynamic(settings)


def by_mujoco(folder: Path) -> None:
    """Force and torque sensors at the hinge, written by NumPy with a header as a comment."""
    import mujoco

    small = 1e-4
    model = mujoco.MjModel.from_xml_string(f"""
      <mujoco><option gravity="0 {-GRAVITY} 0" timestep="2e-5" integrator="RK4"/>
      <worldbody><body name="rod"><joint type="hinge" axis="0 0 1"/><site name="pin"/>
      <inertial pos="{LENGTH} 0 0" mass="{MASS}" diaginertia="{small**2} {small**2} {small**2}"/>
      </body></worldbody>
      <sensor><force site="pin"/><torque site="pin"/></sensor></mujoco>""")
    data = mujoco.MjData(model)
    rows = []
    for step in range(20_001):
        mujoco.mj_forward(model, data)
        if step % 1000 == 0:
            rows.append([data.time, *data.sensordata, math.degrees(data.qpos[0])])
        mujoco.mj_step(model, data)
    header = "MuJoCo, pendulum\ntime fx fy fz tx ty tz angle"
    np.savetxt(folder / "mujoco_hinge.txt", rows, fmt="%.10e", header=header)


def main() -> None:
    """Write all files to the folder that is named."""
    folder = Path(sys.argv[1])
    for write in (by_pandas, by_openpyxl, by_libreoffice, by_exudyn, by_mujoco):
        write(folder)


if __name__ == "__main__":
    main()
