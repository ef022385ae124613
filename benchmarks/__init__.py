"""Measurements of what we claim; `python -m benchmarks` runs them all.

Folders are subjects: `pins` (models of free pins), `joints` (pins in lugs), `cuts`, `solids` (other
programs on the same mesh), `motion`, `runs` (whole commands), `failures` (the gallery).
Numeric libraries have one thread, as in `pinstress run`, where nothing else is said.
"""

from pathlib import Path

from pinbase.processes.threads import hold_threads

hold_threads()
ROOT = Path(__file__).parent.parent
