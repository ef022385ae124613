"""Measurements of what we claim; `python -m benchmarks` runs them all.

Numeric libraries have one thread, as in `pinstress run`, where nothing else is said.
"""

from pinstress.processes.threads import hold_threads

hold_threads()
