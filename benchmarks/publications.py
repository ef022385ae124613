"""Every published number compared with ours, which are computed from the studies."""

from __future__ import annotations

import csv
from typing import Any

import numpy as np

from benchmarks import ROOT
from pinstress import load_study, run
from pinstress.analysis.gather.gather import loads_only
from reports.data.results import Results
from reports.format.files import markdown
from reports.format.numbers import engineering, ratio
from reports.tables.published import published_reactions, published_values_table

STUDIES = ROOT / "studies"
PAGE = ROOT / "docs" / "measured" / "publications.md"
HEAD = "Ratios are ours / published.\n"
UNKNOWNS = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y", "T2")


def publications() -> str:
    """Return all tables as Markdown, including the stresses, which take minutes."""
    return page(run(load_study(STUDIES / "grenier2008.toml"))).rstrip()


def page(stresses: Results) -> str:
    """Return the tables. stresses: the results of the whole run of grenier2008.toml."""
    parts = [HEAD, grenier_peaks(stresses), *mechanics()]
    return "\n".join(part.rstrip() + "\n" for part in parts)


def mechanics() -> list[str]:
    """Return the parts that need no stresses."""
    return [grenier(), bowman(), four_bar(), leg()]


def grenier_peaks(results: Results) -> str:
    """Return maximum von Mises stress and safety factor by pin and case."""
    rows = [
        [
            p.pin,
            p.case,
            engineering(p.published_max_von_mises),
            engineering(p.max_von_mises),
            engineering(ratio(p.max_von_mises, p.published_max_von_mises), 3),
            engineering(p.published_safety_factor),
            engineering(p.safety_factor),
            p.verdict,
        ]
        for p in results.pins
    ]
    head = (
        *("pin", "case", "published [psi]", "ours [psi]", "ratio"),
        *("published factor", "our factor", "verdict"),
    )
    table = markdown.table(head, rows, (False, False, True, True, True, True, True, False))
    return (
        f"## Landing-gear pins: {results.published_source}\n\n{table}\n\n"
        "These peaks are at sharp corners and clamp edges, where no maximum exists; "
        "[](grenier2008.md) explains the ratios pin by pin.\n"
    )


def grenier() -> str:
    """Return the reactions in landing and the motion of pin F."""
    results = loads_only(load_study(STUDIES / "grenier2008.toml"))
    rows = [
        [r.connection, *(engineering(x, 7) for x in (r.published, r.ours)), f"{r.ratio:.6f}"]
        for r in published_reactions(results)
    ]
    forces = markdown.table(
        ("connection", "published [lbf]", "ours [lbf]", "ratio"), rows, (False, True, True, True)
    )
    check = results.motion_check
    assert check is not None
    moved = markdown.table(
        ("time [s]", "speed, published [in/s]", "ours", "acceleration, published [in/s²]", "ours "),
        [[f"{t:g}", *(engineering(x, 5) for x in (v, ov, a, oa))] for t, v, a, ov, oa in
         check.published],
        (True,) * 5,
    )  # fmt: skip
    return (
        "### Reactions in landing (table 4)\n\n"
        f"{forces}\n\nThe linkage is reconstructed from the printed forces. Only J3, the weight "
        "of a body that the lost drawings would show, depends on a small difference.\n\n"
        f"### Motion of pin F (appendix A-5)\n\n{moved}\n"
    )


def bowman() -> str:
    """Return the snapshot, and the printed system of equations with its errors corrected one by
    one.
    """
    results = loads_only(load_study(STUDIES / "bowman2019.toml"))
    retract = next(m for m in results.motion if m.case == "retract")
    (drive,) = (d for d in results.drive if d.time is not None)
    closed = 10.0 ** np.ceil(np.log10(max(retract.ledger.violation, 1e-12)))
    return (
        f"## Four-bar landing gear: {results.published_source}\n\n"
        f"{_published(results)}\n\n"
        "### The printed system, corrected step by step\n\n"
        f"{markdown.table(('correction', *UNKNOWNS), _corrected(results), (False, *[True] * 9))}"
        "\n\nForces in lbf, the torque in lbf in. The last row is ours, from geometry and the "
        "crank's motion. Over the whole motion powers balance to "
        f"{closed:.0e}; torque mean {engineering(drive.mean)}, RMS "
        f"{engineering(drive.rms)} lbf in. The publication notes that its snapshot and its "
        "sweep disagree; the program of the sweep uses r32y for r14x and does not divide A12 by "
        "12.\n"
    )


def _table(study: str, name: str) -> list[dict[str, str]]:
    path = STUDIES / study / name
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))


def _published(results: Results) -> str:
    return published_values_table(results).grid(results.units).markdown()


def _corrected(results: Results) -> list[list[str]]:
    table = _table("bowman2019", "printed_system.csv")
    A = np.array([[float(r[u]) for u in UNKNOWNS] for r in table])
    b = np.array([float(r["right"]) for r in table])

    def row(name: str, values: Any) -> list[str]:
        return [name, *(f"{v:.2f}" for v in values)]

    rows = [row("as printed", np.linalg.solve(A, b))]
    for r in _table("bowman2019", "corrections.csv"):
        i, value = int(r["row"]) - 1, float(r["right_value"])
        if r["column"] == "right":
            b[i] = value
        else:
            A[i, UNKNOWNS.index(r["column"])] = value
        place = "right-hand side" if r["column"] == "right" else r["column"]
        rows.append(row(f"row {r['row']}, {place}: {r['error']}", np.linalg.solve(A, b)))
    ours = {v.name + v.quantity[-1]: v.ours for v in results.published if "force" in v.quantity}
    torque = next(v.ours for v in results.published if v.quantity == "drive_torque")
    return [*rows, row("ours", [*(ours[u] for u in UNKNOWNS[:-1]), torque])]


def four_bar() -> str:
    """Return the printed solution, and the forces that follow from the crank's motion alone."""
    results = loads_only(load_study(STUDIES / "matrix_four_bar.toml"))
    return (
        f"## Four-bar by the matrix method: {results.published_source}\n\n"
        "`printed` uses the printed inertia forces and couples (d'Alembert); `motion` only the "
        f"geometry and the crank's motion.\n\n{_published(results)}\n"
    )


def leg() -> str:
    """Return the incorrect terms of the publication, which has no numbers."""
    errors = _table("kuleuven2014", "errors.csv")
    rows = [[r["equation"], r["quantity"], r["why"]] for r in errors]
    table = markdown.table(("equation", "quantity", "reason"), rows, (False,) * 3)
    return (
        "## Leg in space with a spinning wheel: KU Leuven (2014)\n\n"
        "The publication has no numbers. These of its terms are incorrect; "
        "`studies/kuleuven2014/errors.csv` has each with its correction, which is tested against "
        "numerical differentiation of the motion "
        f"(`tests/validation/test_kuleuven2014.py`).\n\n{table}\n"
    )
