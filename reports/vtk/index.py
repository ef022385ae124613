"""The origin of the VTU files of a run: in their field data, and in a list next to them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reports.data.results import Results
from reports.data.row import PinResult
from reports.format.numbers import finite
from reports.vtk.writer import add_field_data


def identify_files(results: Results, files: Mapping[str, PinResult], directory: Path) -> None:
    """Add its origin to every VTU and VTM file of a run, and list the files in index.json.

    files: rows by the names of their files without suffix; names whose file does not exist are
    ignored.
    directory: the folder with these files.
    Raises: OSError.
    """
    rows = {name: row for name, row in files.items() if (directory / f"{name}.vtu").is_file()}
    for name, row in rows.items():
        folder, origin = directory / name, origin_data(results, row)
        beside = sorted(folder.glob("*.vtu")) if folder.is_dir() else []
        own = (directory / f"{name}{end}" for end in (".vtu", ".limit-load.vtu", ".vtm"))
        for path in (*filter(Path.is_file, own), *beside):
            add_field_data(path, origin)
    content = {
        **_run(results),
        "versions": results.versions,
        "units": asdict(results.units),
        "files": {f"{name}.vtu": _judged(row) for name, row in rows.items()},
    }
    text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False)
    (directory / "index.json").write_text(text + "\n", encoding="utf-8")


def origin_data(results: Results, row: PinResult) -> dict[str, NDArray[np.float64]]:
    """Return the study, versions, units, pin, case, factor and verdict of a row as field data.

    A text is the name of an array with the number 1, because meshio opens no file with texts.
    """
    known = {
        **_run(results),
        **_judged(row),
        **{f"version of {name}": version for name, version in results.versions.items()},
        **{f"unit of {quantity}": unit for quantity, unit in asdict(results.units).items()},
    }
    return {
        f"{key}: {value}" if isinstance(value, str) else key: np.array(
            [1.0 if isinstance(value, str) else value]
        )
        for key, value in known.items()
        if value is not None
    }


def _run(results: Results) -> dict[str, str]:
    return {
        "title": results.title,
        "study": results.study,
        "study_sha256": results.study_sha256,
    }


def _judged(row: PinResult) -> dict[str, Any]:
    return {
        "pin": row.pin,
        "case": row.case,
        "max_von_mises": finite(row.max_von_mises),
        "safety_factor": finite(row.safety_factor),
        "required_safety_factor": row.required,
        "verdict": row.verdict,
        "outcome": row.outcome,
    }
