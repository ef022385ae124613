"""The smallest diameters that reach a factor of safety."""
