"""`pinstress materials`: the materials that a study may name, with the source of every value."""

from __future__ import annotations

import json
from pathlib import Path

import click

from pinstress.study.reading.errors import InputError
from pinstress.study.reading.materials import StoredMaterial, library, read_materials
from pinstress.study.schema.shown import as_text, in_toml, near

COLUMNS = {"youngs_modulus": "E", "yield_strength": "yield", "ultimate_strength": "ultimate"}


def materials(name: str | None, file: Path | None, as_json: bool) -> None:
    """Print the materials of the library and of a file, or the values of one of them.

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
    """Return a line for every material, and one that explains the incomplete ones."""
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
    lines = [f'[material."{stored.name}"]  # {stored.file}']
    for key, value in stored.values.items():
        own = stored.table[key]
        source = own.get("note", "") if isinstance(own, dict) else ""
        lines.append(f"{key} = {in_toml(value)}  # {source or stored.source}")
    lines += [f"# {key}: missing, {stored.source} does not state it" for key in stored.missing]
    return lines
