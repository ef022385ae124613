"""No two files define a public class of one name."""

from __future__ import annotations

import re
from collections import defaultdict

from tests.conftest import ROOT

PACKAGES = ("pinstress", "pinbase", "loads", "geometry", "fea", "assess", "reports")
PUBLIC_CLASS = re.compile(r"^class ([^\W_]\w*)", re.MULTILINE)


def test_public_classes_have_their_own_names() -> None:
    defined = defaultdict(set)
    for package in PACKAGES:
        for path in (ROOT / package).rglob("*.py"):
            for name in PUBLIC_CLASS.findall(path.read_text(encoding="utf-8")):
                defined[name].add(path.relative_to(ROOT).as_posix())
    assert len(defined) > 100
    assert {name: sorted(files) for name, files in defined.items() if len(files) > 1} == {}
