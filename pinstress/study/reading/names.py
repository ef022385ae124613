"""Names that a study refers to: each must exist."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from functools import partial

from pinstress.study.reading.errors import Wrong
from pinstress.study.reading.materials import library
from pinstress.study.schema.shown import as_text, near


def known_name(where: str, what: str, name: str, names: Collection[str]) -> Iterator[Wrong]:
    """Yield an error unless a name exists; `what` it is of, and `where` it is named."""
    if name not in names:
        if what == "material":
            names = [*names, *library()]
        code = f"unknown-{what.split()[-1]}"
        hint = partial(near, name, names)
        yield Wrong(f"{where}: no {what} {as_text(name)}; ", hint, code=code, name=name)


def two_bodies(
    where: str, pair: tuple[str, str] | None, bodies: Mapping[str, object]
) -> Iterator[Wrong]:
    """Yield errors unless the two bodies at the key `where` exist and differ."""
    for body in pair or ():
        yield from known_name(f"{where}.bodies", "body", body, bodies)
    if pair is not None and pair[0] == pair[1]:
        text = f"{where}.bodies: {as_text(pair[0])} twice; name two different bodies"
        yield Wrong(text, code="same-body")
