"""Definitions that all rooms share: errors, array types, dimensions of numbers, child processes.

This package imports nothing else of ours.
"""
