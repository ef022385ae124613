"""The paths by which references are looked for lead to keys: a misspelt one would check nothing."""

from __future__ import annotations

from collections.abc import Iterator
from typing import get_args

import pytest
from pydantic import BaseModel

import pinstress
from pinstress.study.reading import names
from tests.conftest import ROOT


def tables(annotation: object) -> Iterator[type[BaseModel]]:
    """All tables that an annotation names, of lists, of tables by name and of alternatives."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for part in get_args(annotation):
        yield from tables(part)


def leads_somewhere(table: type[BaseModel], path: str) -> bool:
    here = {table}
    for key in path.split("."):
        fields = [x.model_fields[key] for x in here if key in x.model_fields]
        if not fields:
            return False
        here = {found for field in fields for found in tables(field.annotation)}
    return True


def test_every_path_of_references_leads_to_a_key(monkeypatch: pytest.MonkeyPatch) -> None:
    walked: set[tuple[type[BaseModel], str]] = set()
    named = names._named

    def noted(node: object, path: str, key: str) -> Iterator[tuple[str, str]]:
        if isinstance(node, BaseModel) and key in ("", "mechanism"):
            walked.add((type(node), path))
        return named(node, path, key)

    monkeypatch.setattr(names, "_named", noted)
    for path in sorted((ROOT / "studies").glob("*.toml")):
        pinstress.load_study(path)
    assert len({table for table, _ in walked}) >= 3  # a study, its mechanism in a plane, in space
    assert len(walked) >= 30
    assert [(t.__name__, path) for t, path in walked if not leads_somewhere(t, path)] == []
    assert not leads_somewhere(next(t for t, path in walked if path == "pin.material"), "pin.metal")
