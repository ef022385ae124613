"""The content of the PDF as plain data: texts, tables and drawings of the page, in its order."""

from __future__ import annotations

import json
import re
from dataclasses import asdict, replace
from typing import Any

from reports.data.changes import command
from reports.data.decision import largest_factor, worst_first
from reports.data.envelope import EnvelopeCell, detailed_rows
from reports.data.results import Provenance, Results
from reports.data.row import PinResult
from reports.format.file_names import plot_name
from reports.format.words import headline
from reports.page.joint import joint_part
from reports.page.lets_go import lets_go_parts
from reports.page.places import places_part
from reports.tables.column import Table, grid_of, texts
from reports.tables.published import published_maxima
from reports.tables.strength.changes import REMEDIES_NOTE, change_notes, changes_table
from reports.tables.strength.envelope import ENVELOPE_NOTE, cell_text, matrix
from reports.tables.strength.fatigue import fatigue_sentence, shown_fatigue
from reports.tables.strength.margins import governing_table, not_made_words
from reports.tables.strength.safety_factors import reading, shown_factors
from reports.tables.strength.sensitivities import SENSITIVITIES_NOTE as SENSITIVE
from reports.tables.strength.sensitivities import shown_sensitivities
from reports.text.loads_summary import load_parts
from reports.text.method import METHOD_NOTE
from reports.text.pin_sentence import drawing_caption, pin_sentence

Content = dict[str, Any]
# Style of the drawing of the linkage: the light colours of reports/templates/linkage.css
PAPER_STYLE = (
    "text{font-family:'Libertinus Serif';font-size:14px}.force{font-size:12.5px;fill:#5a6068}"
    ".b{font-weight:700}.link{fill:none;stroke:#a5a8ac;stroke-linecap:round}.body{fill:#ececee}"
    ".slide{fill:none;stroke:#5a6068;stroke-width:2;stroke-dasharray:6 4}"
    ".pitch,.lever{fill:none;stroke:#5a6068;stroke-width:1.2}.lever{stroke-dasharray:3 3}"
    ".joint{fill:#fff;stroke:#5a6068;stroke-width:1.4}"
    ".ground{fill:none;stroke:#1d1f23;stroke-width:1.4}.load{fill:none;stroke:#1d1f23;"
    "stroke-width:3.5}.head{fill:#1d1f23}.pin circle,.hf{stroke:#fff;stroke-width:1.5}"
    ".pin path{fill:none;stroke-width:2.4}.pin .h{fill:#fff;stroke-width:2.4}"
    ".fails circle,.yields circle{fill:#a8211b}.pin .k{stroke:#fff}.safe .h,.below-yield .h,"
    ".safe path,.below-yield path{stroke:#14663c}.depends .h,.not-decided .h,.not-decided path"
    "{stroke:#7a5200}.pin .hf{fill:#7a5200;stroke:none}"
    ".axis,.triad{fill:none;stroke:#5a6068;stroke-width:1}.axis{stroke-dasharray:9 2.5 2 2.5}"
    ".barrel{fill:none;stroke:#5a6068;stroke-width:5;stroke-linecap:round}.mass{fill:#5a6068}"
    ".load.end{fill:#fff;stroke-width:2.4}path.load.end{fill:none}.view text,text.letter"
    "{font-size:11px;text-anchor:middle}text.letter{fill:#5a6068}"
    "text.view-title{font-size:12px;fill:#5a6068}"
)
CURVE_STYLE = (  # as in reports/templates/overview.css
    "text{font-family:'Libertinus Serif';font-size:12px;fill:#5a6068}polyline,path{fill:none}"
    "polyline{stroke:#0b5cad;stroke-width:2}.lug{stroke:#a8211b;stroke-width:1.5}"
    ".frame{stroke:#b5bac1}.limit{stroke:#1d1f23;stroke-dasharray:3 3}"
)
PINS_PER_MATRIX = 12  # pins of the matrix of cases
MAX_DIMENSIONS = 5  # of a pin's sensitivities


def document(
    results: Results, drawings: dict[str, str], overview: Content | None = None
) -> Content:
    """Return the content of report.typ.

    drawings: of the pins, as SVG. overview: reports.page.overview.
    """
    everything, results = results, detailed_rows(results)
    content = {
        "title": results.title,
        "study": results.study,
        "sha256": results.study_sha256,
        "versions": dict(sorted(results.versions.items())),
        "block": results.title_block,
        "headline": headline(everything),
        "overview": overview and _on_paper(overview),
        "units": results.units,
        "factors": _factors(results),
        "reading": reading(shown_factors(results)),
        "envelope": _envelope(everything),
        "margins": _margins(results),
        "changes": _changes(results),
        "sensitivities": _sensitivities(results),
        "fatigue": _fatigue(results),
        "maxima": grid_of(published_maxima(results), results.units),
        "published_source": results.published_source,
        "pins": [_pin(results, name, drawings) for name in drawings],
        "loads": load_parts(results),
        "provenance": grid_of(_provenance(results), results.units),
        "assumptions": results.assumptions,
        "method": METHOD_NOTE,
    }
    plain: Content = json.loads(json.dumps(content, default=asdict))
    return plain


def _on_paper(overview: Content) -> Content:
    """Return the first screen with drawings that contain their style."""
    drawings = {
        "linkage": _styled(overview["linkage"], PAPER_STYLE),
        "curve": _styled(overview["curve"], CURVE_STYLE),
    }
    content: Content = json.loads(
        json.dumps({**overview, **drawings}, ensure_ascii=False).replace("✕", "×")
    )
    return content


def _styled(drawing: str | None, style: str) -> str | None:
    """Return an SVG drawing without hyperlinks and with its style."""
    if not drawing:
        return None
    plain = re.sub(r"</?a\b[^>]*>", "", drawing)
    return plain.replace(">", f"><style>{style}</style>", 1)


def _factors(results: Results) -> Content | None:
    if not results.pins:
        return None
    grid = shown_factors(results, without=("verdict", "model")).grid(results.units)
    return asdict(grid) | {"outcomes": [pin.outcome for pin in worst_first(results)]}


def _envelope(results: Results) -> Content | None:
    """Return the utilisations of pins in cases, in blocks that fit the width of the paper."""
    utilisations = matrix(results)
    if utilisations is None:
        return None
    blocks = []
    for first in range(0, len(utilisations.pins), PINS_PER_MATRIX):
        part = slice(first, first + PINS_PER_MATRIX)
        rows = [
            [row.case, *(_used(row.cells.get(pin)) for pin in utilisations.pins[part])]
            for row in (*utilisations.rows, *utilisations.quiet)
        ]
        blocks.append({"head": ["case", *utilisations.pins[part]], "body": rows})
    return {"reading": ENVELOPE_NOTE, "note": utilisations.note, "blocks": blocks}


def _used(cell: EnvelopeCell | None) -> Content | None:
    if cell is None:
        return None
    return {"text": cell_text(cell), "outcome": cell.outcome, "governs": cell.governs}


def _margins(results: Results) -> Content | None:
    grid = grid_of(governing_table(results), results.units)
    return None if grid is None else {"grid": grid, "notes": not_made_words(results)}


def _fatigue(results: Results) -> Content | None:
    if results.fatigue is None:
        return None
    grid, notes = grid_of(shown_fatigue(results), results.units), results.fatigue.left_out
    said = fatigue_sentence(results.fatigue)
    return {"sentence": said, "grid": grid, "notes": notes}


def _changes(results: Results) -> Content | None:
    if not results.changes:
        return None
    notes = [REMEDIES_NOTE, *change_notes(results)]
    size = command(results.changes, results.study, largest_factor(results.pins))
    grid = changes_table(results).grid(results.units)
    return {"grid": grid, "notes": notes, "command": size or None}


def _sensitivities(results: Results) -> Content | None:
    """Return the sensitivities of each pin in its worst case to the dimensions that matter most."""
    worst: dict[str, str] = {}
    for pin in worst_first(results):
        worst.setdefault(pin.pin, pin.case)
    governing = tuple(x for x in results.sensitivities if worst.get(x.pin) == x.case)
    of_worst = replace(results, sensitivities=governing)
    grid = grid_of(shown_sensitivities(of_worst, MAX_DIMENSIONS), results.units)
    if grid is None:
        return None
    return {"grid": grid, "introduction": f"{SENSITIVE} Each pin is in its worst case."}


def _pin(results: Results, name: str, drawings: dict[str, str]) -> Content:
    shape = next(s for s in results.shapes if s.pin == name)
    zoned = any(p.singular_at for p in results.pins if p.pin == name)
    return {
        "pin": name,
        "lets_go": lets_go_parts(results).get(name),
        "drawing": drawings[name],
        "caption": drawing_caption(shape, results.units, zoned),
        "refinement": plot_name("refinement-pin", name),
        "cases": [_case(p, results) for p in results.pins if p.pin == name],
    }


def _case(pin: PinResult, results: Results) -> Content:
    joint = joint_part(pin, results.units)
    return {
        "case": pin.case,
        "outcome": pin.outcome,
        "sentence": pin_sentence(pin, results.units),
        "model": pin.why,
        "held": pin.held,
        "plot": plot_name("surface", pin.case, pin.pin),
        "places": places_part(pin, results.units),
        "bands": joint and joint.bands,
        "lugs": joint and joint.lugs,
    }


def _provenance(results: Results) -> Table[Provenance]:
    return Table("provenance", texts("input=key value source=kind note"), results.provenance)
