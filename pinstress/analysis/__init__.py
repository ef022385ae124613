"""One analysis, from a study to its results."""
