"""Sweeps: many designs of a study with varied numbers, sampled, solved and written as one table."""
