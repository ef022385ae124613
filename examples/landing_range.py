"""Safety factors of landing gear pins over sink speed and impulse time."""

import numpy as np

import pinstress

study = pinstress.load_study(pinstress.shipped_studies()["landing_gear"])
results = pinstress.run(study, pins=["A", "B", "H"], cases=["landing"])

force = results.landing[0].force
print(f"landing force {force.min():,.0f} to {force.max():,.0f} {results.units.force}")
for pin in results.landing:
    times, speeds = np.unique(pin.impulse_time), np.unique(pin.velocity_change)
    print(f"\npin {pin.pin} ({pin.verdict}): factor of safety against yield, by impulse time")
    print("sink speed " + "".join(f"{time:8.3f} s" for time in times))
    for speed in speeds:
        as_stated = np.array(pin.pulses) == pin.nominal_pulse
        row = pin.safety_factor[(pin.velocity_change == speed) & as_stated]
        print(f"{speed / 12:5.0f} ft/s " + "".join(f"{factor:10.2f}" for factor in row))
    yields = int((pin.safety_factor < 1.0).sum())
    print(f"pin {pin.pin} yields in {yields} of {pin.safety_factor.size} landings")
