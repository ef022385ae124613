"""The lugs of a pin: their eyes, fits, links, axial seats and variations."""
