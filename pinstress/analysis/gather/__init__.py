"""Results of an analysis, gathered for reports."""
