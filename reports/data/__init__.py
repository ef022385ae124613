"""What a run found, as plain data in the study's own units."""
