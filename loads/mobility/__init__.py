"""Mobility and redundancy of a linkage; positions in which it cannot follow its drives."""
