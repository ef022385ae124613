"""The output of `pinstress fits` and `pinstress materials`: limits and clearance of a fit, and the
materials that a study may name, each value with its source.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from pathlib import Path

import click

from pinbase.errors import ArgumentError
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.materials import StoredMaterial, library, read_materials
from pinstress.study.schema.iso286 import fit_of
from pinstress.study.schema.shown import as_text, near
from pinstress.study.schema.units import UNIT_SYSTEMS, split, to_si

COLUMNS = {"youngs_modulus": "E", "yield_strength": "yield", "ultimate_strength": "ultimate"}
MICROMETRE = 1e-6


def fits(size: str, classes: str, as_json: bool) -> None:
    """Print the limits of a fit in the unit of its nominal size.

    size: the nominal size as a text, in mm by default.

    Raises: InputError.
    """
    try:
        nominal = to_si(size, "length", UNIT_SYSTEMS["mm-N-s"])
        fit = fit_of(classes, nominal)
    except ArgumentError as error:
        raise InputError(str(error), code=error.code) from None
    number, unit = split(size) or (nominal, "m")
    unit = unit or "mm"
    one = to_si(f"1 {unit}", "length", UNIT_SYSTEMS["mm-N-s"])
    whole = all(math.isclose(x, round(x), abs_tol=1e-6) for x in _micrometres(fit.clearance))
    digits = max(0, math.ceil(math.log10(one / MICROMETRE) - 1e-9)) + (not whole)
    names = ("hole", "shaft", "clearance")
    starts = (nominal, nominal, 0.0)
    ranges = (fit.hole, fit.shaft, fit.clearance)
    limits = {
        name: [round((start + x) / one, digits) for x in both]
        for name, start, both in zip(names, starts, ranges, strict=True)
    }
    if as_json:
        document = {"size": number, "unit": unit, "fit": classes, "kind": fit.kind}
        click.echo(json.dumps(document | limits))
        return
    click.echo(f"{classes} at {number:g} {unit}: {fit.kind} fit (ISO 286-1)")
    hole, shaft = (part.strip() for part in classes.split("/"))
    heads = (f"hole {hole}", f"shaft {shaft}", "clearance")
    texts = [" to ".join(f"{x:.{digits}f}" for x in limits[name]) + f" {unit}" for name in names]
    wide = max(map(len, texts))
    for head, text, both in zip(heads, texts, ranges, strict=True):
        low, high = _micrometres(both)
        click.echo(f"  {head:<10} {text:<{wide}}  ({low:g} to {high:g} µm)")


def _micrometres(lengths: Iterable[float]) -> list[float]:
    return [round(x / MICROMETRE, 3) for x in lengths]


def materials(name: str | None, file: Path | None, as_json: bool) -> None:
    """Print the materials of the library and of a file, or the values of one material.

    Raises: InputError for a file that cannot be read or has values that no study can use, and for
    an unknown name.
    """
    given = {} if file is None else read_materials(file)
    for stored in given.values():
        if not stored.missing:
            stored.require_valid()
    known = {**library(), **given}
    if name is not None and name not in known:
        text = f"no material {as_text(name)}; {near(name, known)}"
        raise InputError(text, code="unknown-material")
    chosen = known.values() if name is None else [known[name]]
    if as_json:
        rows = [
            {"name": x.name, "from": x.file, "source": x.source, "missing": x.missing, **x.table}
            for x in chosen
        ]
        click.echo(json.dumps(rows if name is None else rows[0]))
    elif name is None:
        click.echo("\n".join(_list([*chosen])))
    else:
        click.echo("\n".join(_values(known[name])))


def _list(stored: list[StoredMaterial]) -> list[str]:
    """Return a line for every material, and a line that explains the incomplete ones."""
    rows = [["material", *COLUMNS.values(), "source"]]
    for x in stored:
        name = f"{x.name} *" if x.missing else x.name
        rows.append([name, *(str(x.values.get(key, "-")) for key in COLUMNS), x.source])
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    lines = ["  ".join(t.ljust(w) for t, w in zip(r, widths, strict=True)).rstrip() for r in rows]
    if any(x.missing for x in stored):
        lines.append(
            "* To be defined in the study: the source lacks youngs_modulus or poisson_ratio."
        )
    return lines


def _values(stored: StoredMaterial) -> list[str]:
    """Return a material as a study would write it, each value with its source."""
    import tomlkit

    lines = [f"[{tomlkit.key(['material', stored.name]).as_string()}]  # {stored.file}"]
    document = _line(stored.source)
    for key, value in stored.values.items():
        own, written = stored.table[key], tomlkit.inline_table()
        source = own.get("note", "") if isinstance(own, dict) else ""
        written[key] = value
        lines.append(f"{written.as_string()[1:-1]}  # {_line(str(source)) or document}")
    lines += [f"# {key}: missing, {document} does not state it" for key in stored.missing]
    return lines


def _line(text: str) -> str:
    """Return a text in one line, as a comment needs it."""
    return " ".join(text.split())
