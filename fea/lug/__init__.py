"""The stress of lugs in their plane."""
