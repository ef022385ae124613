"""Definitions that all rooms share: errors, array types, dimensions of numbers, child processes.

It imports no other package of this project.
"""
