"""Measurements of what we claim; `python -m benchmarks` runs them all.

Folders are subjects: `pins` (models of free pins), `joints` (pins in lugs), `cuts`, `solids` (other
programs on the same mesh), `motion`, `space` (linkages in space), `runs` (whole commands),
`evidence` (predictions compared with measured and printed numbers), `failures` (the gallery).

Unless stated otherwise, numeric libraries have one thread, as in `pinstress run`.
"""

from pathlib import Path

from pinbase.processes.threads import hold_threads

hold_threads()
ROOT = Path(__file__).parent.parent
