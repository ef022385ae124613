"""docs/measured/publications.md is what its command records, without the stresses (minutes)."""

from __future__ import annotations

from benchmarks.publications import HEAD, PAGE, mechanics


def test_the_page_is_up_to_date() -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert HEAD in text
    for part in mechanics():
        assert part.rstrip() in text, "run: python -m benchmarks publications --record"
