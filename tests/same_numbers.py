"""Whether two checkouts give the same numbers: every study that ships, in each of its commands.

    python -m tests.same_numbers solve FOLDER [STUDY ...]    # the checkout that is imported
    python -m tests.same_numbers compare BEFORE AFTER

The guard of a change that must not change results: `solve` in the old checkout and in the new one,
then `compare`. Numbers agree to 1e-9 of themselves or of the largest number of their column or
list; text agrees to the letter but for the time and the program's version. A key that is renamed
is told in RENAMED and then counts as the same.
"""

from __future__ import annotations

import csv
import json
import math
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
TOLERANCE = 1e-9
COMMANDS: dict[str, tuple[str, ...]] = {  # those beside `run`, by study
    "one_pin": ("size",),
    "clevis": ("size", "--least-weight"),
    "lifting_arm": ("sweep",),
    "grenier2008": ("loads",),
}
RENAMED: dict[str, str] = {}  # key before -> key after, in results.json and in headings of CSV
VOLATILE = {"created", "date", "seconds", "duration", "version", "memory", "processor_seconds",
            "sweep", "but_count"}  # fmt: skip


def solve(folder: Path, names: list[str]) -> None:
    """Results of every study in `folder`, one process each, and the time that each took."""
    studies = sorted((ROOT / "studies").glob("*.toml")) + sorted(
        (ROOT / "studies" / "charted").glob("*.toml")
    )
    seconds = {}
    for study in studies:
        if names and study.stem not in names:
            continue
        for name, command in [("run", ("run",)), ("other", COMMANDS.get(study.stem))]:
            if command is None:
                continue
            out = folder / f"{study.stem}-{name}"
            out.mkdir(parents=True, exist_ok=True)
            where = ["sized.toml"] if command[0] == "size" else ["."]
            words = [command[0], str(study), *command[1:], "--out", *where]
            start = time.perf_counter()
            done = subprocess.run(
                [sys.executable, "-m", "pinstress", *words],
                cwd=out, capture_output=True, text=True, check=False,
                env=os.environ | {"PINSTRESS_CACHE": "off", "PYTHONPATH": str(ROOT)},
            )  # fmt: skip
            seconds[out.name] = time.perf_counter() - start
            (out / "terminal.txt").write_text(done.stdout + done.stderr, encoding="utf-8")
            (out / "status.txt").write_text(f"{done.returncode}\n", encoding="utf-8")
            print(f"{out.name}: status {done.returncode}, {seconds[out.name]:.1f} s", flush=True)
    (folder / "seconds.json").write_text(json.dumps(seconds, indent=1), encoding="utf-8")


def leaves(value: object, path: str = "") -> Iterator[tuple[str, object]]:
    """(path, leaf) of everything in a JSON document."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key not in VOLATILE:
                yield from leaves(inner, f"{path}.{RENAMED.get(key, key)}")
    elif isinstance(value, list):
        for index, inner in enumerate(value):
            yield from leaves(inner, f"{path}[{index}]")
    else:
        yield path, value


def same(one: object, other: object, scale: float) -> bool:
    """Whether two leaves agree; `scale`: the largest number beside them."""
    numbers = isinstance(one, int | float) and isinstance(other, int | float)
    if not numbers or isinstance(one, bool) or isinstance(other, bool):
        return one == other
    a, b = float(str(one)), float(str(other))
    return a == b or math.isclose(a, b, rel_tol=TOLERANCE, abs_tol=TOLERANCE * scale)


def number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def table(path: Path) -> dict[str, object]:
    """Cells of a CSV file by line and heading."""
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    return {
        f"[{line}].{RENAMED.get(key, key)}": number(cell)
        for line, row in enumerate(rows[1:])
        for key, cell in zip(rows[0], row, strict=False)
    }


def differences(one: Path, other: Path) -> list[str]:
    """What differs in a file that both folders have."""
    if one.suffix == ".json":
        read = [dict(leaves(json.loads(p.read_text(encoding="utf-8")))) for p in (one, other)]
    elif one.suffix == ".csv":
        read = [table(p) for p in (one, other)]
    elif one.suffix == ".toml":
        return [] if one.read_bytes() == other.read_bytes() else ["another text"]
    else:
        return []
    first, second = read
    told = [f"only before: {k}" for k in first if k not in second]
    told += [f"only after: {k}" for k in second if k not in first]
    largest: dict[str, float] = {}
    for key, value in first.items():
        if isinstance(value, float) and math.isfinite(value):
            column = key.split("].")[-1]
            largest[column] = max(largest.get(column, 0.0), abs(value))
    for key in first.keys() & second.keys():
        if not same(first[key], second[key], largest.get(key.split("].")[-1], 0.0)):
            told.append(f"{key}: {first[key]!r} -> {second[key]!r}")
    return told


def compare(before: Path, after: Path) -> int:
    """Prints the differences and the times; status 1 if there is a difference."""
    status = 0
    files = {
        p.relative_to(folder)
        for folder in (before, after)
        for p in folder.rglob("*.*")
        if p.is_file()
    }
    for name in sorted(files):
        pair = before / name, after / name
        if not all(p.is_file() for p in pair):
            print(f"{name}: only {'before' if pair[0].is_file() else 'after'}")
            status = 1
            continue
        if name.name == "status.txt" and pair[0].read_text() != pair[1].read_text():
            print(f"{name}: {pair[0].read_text().strip()} -> {pair[1].read_text().strip()}")
            status = 1
        if name.name == "seconds.json":
            continue
        if told := differences(*pair):
            status = 1
            print(f"{name}: {len(told)} differences")
            print("".join(f"    {line[:300]}\n" for line in told[:12]), end="")
    times = [json.loads((f / "seconds.json").read_text(encoding="utf-8")) for f in (before, after)]
    for name in times[0].keys() & times[1].keys():
        if times[1][name] > 1.3 * times[0][name] + 1:
            print(f"{name}: {times[0][name]:.1f} s -> {times[1][name]:.1f} s")
    print(f"{len(files)} files compared, {'differences above' if status else 'no difference'}")
    return status


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["solve", folder, *names]:
            solve(Path(folder), names)
        case ["compare", before, after]:
            sys.exit(compare(Path(before), Path(after)))
        case _:
            sys.exit(__doc__)
