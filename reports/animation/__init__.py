"""Pages with animated linkages."""
