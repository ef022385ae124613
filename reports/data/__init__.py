"""Results of a run as plain data in the study's own units."""
