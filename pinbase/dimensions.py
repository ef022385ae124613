"""Dimensions of fields in SI, as annotations, by which pinbase.records.in_units converts them."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

Length = Annotated[float, "length"]
Stress = Annotated[float, "stress"]
Force = Annotated[float, "force"]
Moment = Annotated[float, "moment"]
Energy = Annotated[float, "energy"]
Time = Annotated[float, "time"]
Velocity = Annotated[float, "velocity"]
Acceleration = Annotated[float, "acceleration"]
Point = tuple[Length, Length, Length]

Lengths = Annotated[Floats, "length"]
Stresses = Annotated[Floats, "stress"]
Forces = Annotated[Floats, "force"]
Moments = Annotated[Floats, "moment"]
Energies = Annotated[Floats, "energy"]
Powers = Annotated[Floats, "power"]
Times = Annotated[Floats, "time"]
Velocities = Annotated[Floats, "velocity"]
Accelerations = Annotated[Floats, "acceleration"]
