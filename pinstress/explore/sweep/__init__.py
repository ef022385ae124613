"""Sweeps of many designs of a study, which are sampled, solved and written as one table."""
