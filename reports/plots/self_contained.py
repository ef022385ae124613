"""Checks that plots and drawings are self-contained: they open no address and no file."""

from __future__ import annotations

import re
from typing import Any
from xml.parsers import expat

from pinbase.errors import Damaged

ADDRESS_KEYS = {"url", "href"}  # keys of Vega-Lite for data, pictures and links
IMAGE_MARK = "image"
EXTERNAL_REFERENCE_PATTERN = re.compile(
    r"url\(\s*['\"]?\s*(?!#)[^\s'\"]|@import|image-set\(|src\(", re.IGNORECASE
)
FORBIDDEN_ELEMENTS = {"image", "feimage", "script", "foreignobject", "iframe", "audio", "video"}


def require_no_address(spec: Any, name: str) -> None:
    """Check that a specification of Vega-Lite has no address and no picture.

    Raises: Damaged if it has.
    """
    waiting = [spec]
    while waiting:
        node = waiting.pop()
        if isinstance(node, dict):
            if address_keys := sorted(ADDRESS_KEYS & {str(key).lower() for key in node}):
                raise Damaged(
                    f"{name} has an address ({address_keys[0]}), which no plot of pinstress has"
                )
            mark = node.get("mark")
            if IMAGE_MARK in (mark, mark.get("type") if isinstance(mark, dict) else None):
                raise Damaged(f"{name} has a picture in it, which no plot of pinstress has")
            waiting += node.values()
        elif isinstance(node, list):
            waiting += node


def require_self_contained(svg: str, name: str) -> None:
    """Check that a text is an SVG that refers only to its own parts.

    Raises: Damaged if it is not.
    """
    inside: list[str] = []

    def start(element: str, attributes: dict[str, str]) -> None:
        inside.append(element.rpartition(":")[2].lower())
        if inside[-1] in FORBIDDEN_ELEMENTS:
            raise Damaged(f"{name} has an element {element}, which no drawing of pinstress has")
        for key, value in attributes.items():
            link = key.rpartition(":")[2].lower() in ("href", "src")
            styled = not key.lower().startswith("aria-")  # aria attributes are words
            if (link and not value.startswith("#")) or (
                styled and EXTERNAL_REFERENCE_PATTERN.search(value)
            ):
                raise Damaged(f"{name} refers to {value[:60]!r}, outside of itself")

    def text(content: str) -> None:
        if inside[-1] == "style" and EXTERNAL_REFERENCE_PATTERN.search(content):
            raise Damaged(f"{name} refers to something outside of itself")

    def doctype(*_: object) -> None:
        raise Damaged(f"{name} declares a document type, as no drawing of pinstress does")

    def instruction(target: str, _: str) -> None:
        raise Damaged(f"{name} has an instruction {target[:60]!r}, as no drawing of pinstress has")

    parser = expat.ParserCreate()
    parser.buffer_text = True
    parser.StartElementHandler, parser.CharacterDataHandler = start, text
    parser.EndElementHandler = lambda _: inside.pop()
    parser.StartDoctypeDeclHandler, parser.ProcessingInstructionHandler = doctype, instruction
    try:
        parser.Parse(svg.encode(), True)
    except (expat.ExpatError, UnicodeEncodeError) as error:
        raise Damaged(f"{name} is no drawing ({error})") from None
