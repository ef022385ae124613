"""The keys of a study file, with their units."""
