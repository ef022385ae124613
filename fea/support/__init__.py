"""The pin in its lugs: frictionless contact, in place of clamps and prescribed pressures."""
