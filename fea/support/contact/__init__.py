"""The contact of a pin with its lugs: pressures, their error, and loads on the pin."""
