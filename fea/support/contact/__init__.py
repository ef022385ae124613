"""Pins in contact with their lugs: pressures, their error, loads on the pin."""
