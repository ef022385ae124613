"""What all rooms share: errors, types of arrays, dimensions of numbers, child processes.

Imports nothing else of ours.
"""
