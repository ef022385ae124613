"""What the VTU files of a run are of, beside them: meshio reads no file that has texts itself."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path

from reports.data.results import PinResult, Results
from reports.format.numbers import finite


def write_index(results: Results, files: Mapping[str, PinResult], directory: Path) -> None:
    """Write index.json: study, versions and units, and pin, case, factor and verdict by file.

    files: rows by the names of their files, of which those that exist are listed.
    directory: with these files.

    Raises: OSError.
    """
    content = {
        "title": results.title,
        "study": results.study,
        "study_sha256": results.study_sha256,
        "versions": results.versions,
        "units": asdict(results.units),
        "files": {
            name: {
                "pin": row.pin,
                "case": row.case,
                "max_von_mises": finite(row.max_von_mises),
                "safety_factor": finite(row.safety_factor),
                "required_safety_factor": row.required,
                "verdict": row.verdict,
                "outcome": row.outcome,
            }
            for name, row in files.items()
            if (directory / name).is_file()
        },
    }
    text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False)
    (directory / "index.json").write_text(text + "\n", encoding="utf-8")
