"""Results of the mechanics of a case, gathered for reports."""
