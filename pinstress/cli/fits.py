"""`pinstress fits`: limits of hole and shaft, and the clearance between them."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable

import click

from pinbase.errors import ArgumentError
from pinstress.study.model.iso286 import fit_of
from pinstress.study.reading.errors import InputError
from pinstress.study.schema.units import UNIT_SYSTEMS, split, to_si

MICROMETRE = 1e-6


def fits(size: str, classes: str, as_json: bool) -> None:
    """Print the limits of a fit in the unit of its nominal size, which is a text; mm by default.

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
