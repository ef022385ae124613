"""Reading of force tables: 200,000 instants of six components, in the formats that
programs write.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import xlsxwriter
from pyarrow import parquet

from benchmarks.timing import table
from loads import Layout, read_reactions
from loads.tables import open_table

ROWS, RUNS = 200_000, 3
COMPONENTS = ("fx", "fy", "fz", "mx", "my", "mz")
NAMES = ("t", *COMPONENTS)
COLUMNS = {"time": "t"} | {f"B.{c}": c for c in COMPONENTS}


def force_tables() -> str:
    """Return the table of the processor time of each format, and its ratio to NumPy's for the same
    numbers as text.
    """
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        files = _written(folder)
        least = _least(lambda: np.loadtxt(folder / "comma.csv", delimiter=",", skiprows=1))
        rows: list[tuple[object, ...]] = [("numpy.loadtxt", least, 1.0)]
        for name, path in files.items():
            layout = Layout("case", {} if "row per" in name else COLUMNS)
            cost = _least(lambda p=path, x=layout: read_reactions(p, x, lambda *_: 1.0, {"B"}))  # type: ignore[misc]
            rows.append((name, cost, cost / least))
    return table(("200,000 rows", "processor s", "ratio"), rows)


def _least(work: Callable[[], object]) -> float:
    """Return the least processor time of some runs, s, each of which reads the file again."""
    costs = []
    for _ in range(RUNS):
        open_table._open.cache_clear()
        start = time.process_time()
        work()
        costs.append(time.process_time() - start)
    return min(costs)


def _written(folder: Path) -> dict[str, Path]:
    """Write the same table in all formats; return the files by a description."""
    times = np.arange(ROWS) * 1e-3
    values = np.column_stack([times, *(1e3 * np.sin(times * (k + 1)) for k in range(6))])
    comma = folder / "comma.csv"
    np.savetxt(comma, values, fmt="%.9g", delimiter=",", header=",".join(NAMES), comments="")
    text = comma.read_text()
    forms: dict[str, tuple[str, str | bytes]] = {
        "semicolons, decimal commas": ("german.csv", text.replace(",", ";").replace(".", ",")),
        "blanks": ("blank.txt", text.replace(",", " ")),
        "tabs, UTF-16": ("utf16.tab", text.replace(",", "\t").encode("utf-16")),
        "a comment every 1,000 rows": ("comments.csv", _with_comments(text)),
        "a row per connection": ("long.csv", _by_rows(text)),
    }
    paths = {"commas": comma}
    for name, (file, content) in forms.items():
        paths[name] = folder / file
        paths[name].write_bytes(content if isinstance(content, bytes) else content.encode())
    paths["Parquet"] = folder / "t.parquet"
    columns = dict(zip(NAMES, values.T, strict=True))
    parquet.write_table(pa.table(columns), paths["Parquet"])
    paths["workbook"] = folder / "t.xlsx"
    with xlsxwriter.Workbook(paths["workbook"], {"constant_memory": True}) as book:
        sheet = book.add_worksheet()
        sheet.write_row(0, 0, NAMES)
        for k, row in enumerate(values.tolist(), 1):
            sheet.write_row(k, 0, row)
    return paths


def _with_comments(text: str) -> str:
    lines = text.split("\n")
    return "\n".join(f"# {k}\n{line}" if k % 1000 == 500 else line for k, line in enumerate(lines))


def _by_rows(text: str) -> str:
    head, *lines = text.rstrip("\n").split("\n")
    return "\n".join([f"connection,{head.replace('t,', 'time,', 1)}", *(f"B,{x}" for x in lines)])
