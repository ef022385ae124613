"""The text and the addresses of a page, and a name that contains a script."""

from __future__ import annotations

import zlib
from base64 import b64decode
from html.parser import HTMLParser
from pathlib import Path

EVIL = '<script>alert("1")</script>&\'='


class Reader(HTMLParser):
    """Collects tags, addresses, anchors, embedded pages and the text that is shown."""

    def __init__(self) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.addresses: list[str] = []
        self.ids: list[str] = []
        self.within: list[str] = []
        self.text = ""
        self.silent = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.silent = tag in ("script", "style")
        for name, value in attrs:
            if name in ("src", "href", "srcset", "data", "xlink:href"):
                self.addresses.append(value or "")
            if name == "data-packed":
                self.within.append(zlib.decompress(b64decode(value or "")).decode())
            if name == "id":
                self.ids.append(value or "")

    def handle_endtag(self, tag: str) -> None:
        self.silent = False

    def handle_data(self, data: str) -> None:
        if not self.silent:
            self.text += data


def parse(path: Path) -> Reader:
    reader = Reader()
    reader.feed(path.read_text(encoding="utf-8"))
    return reader
