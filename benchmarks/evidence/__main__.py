"""Predict every case and write docs/evidence.md with its figure: `make evidence`."""

from __future__ import annotations

from benchmarks.evidence.figure import draw
from benchmarks.evidence.page import PAGE, page
from benchmarks.evidence.predict import everything

comparisons = everything(tell=lambda text: print(text, flush=True))
PAGE.write_text(page(comparisons), encoding="utf-8")
for path in draw(comparisons):
    print(f"written: {path}")
print(f"written: {PAGE}")
