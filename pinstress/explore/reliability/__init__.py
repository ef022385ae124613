"""Probability of failure and the distribution of the factor of safety."""
