"""Safety factors of landing gear pins over sink speed and impulse time."""

import numpy as np

import pinstress

study = pinstress.load_study(pinstress.shipped_studies()["landing_gear"])
results = pinstress.run(study, pins=["A", "B", "H"], cases=["landing"])

first = results.landing[0]
stated = np.array(first.pulses) == first.nominal_pulse
force = first.force[stated]
print(f"landing force {force.min():,.0f} to {force.max():,.0f} {results.units.force}")
for pin in results.landing:
    times, speeds = np.unique(pin.impulse_time), np.unique(pin.velocity_change)
    print(f"\npin {pin.pin} ({pin.verdict}): factor of safety against yield, by impulse time")
    print("sink speed " + "".join(f"{time:8.3f} s" for time in times))
    for speed in speeds:
        row = pin.safety_factor[(pin.velocity_change == speed) & stated]
        print(f"{speed / 12:5.0f} ft/s " + "".join(f"{factor:10.2f}" for factor in row))
    factors = pin.safety_factor[stated]
    print(f"pin {pin.pin} yields in {int((factors < 1.0).sum())} of {factors.size} landings")
