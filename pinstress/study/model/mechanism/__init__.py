"""From a study's mechanism to the linkage, its drives and the forces on it."""
