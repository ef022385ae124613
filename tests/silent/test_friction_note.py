"""The note on friction between pin and lug called its effect small, "noticed: never".

Independent: CalculiX, three-dimensional contact with friction 0.1, 0.2 and 0.3: the stress of a
clevis at mid-span falls by 15, 21 and 24 %. The pages state these figures, and that it is the safe
side of a load that grows, not of a cycle; so does every result of a pin in lugs.
"""

from __future__ import annotations

import re

import pytest

from tests.conftest import ROOT
from tests.support.programs.once import Shipped


def page(name: str) -> str:
    return " ".join((ROOT / "docs" / name).read_text(encoding="utf-8").split())


def test_the_pages_state_how_much_and_on_which_side() -> None:
    text = page("lugs.md")
    assert "24 %" in text
    assert "0.1, 0.2 and 0.3" in text
    for side in (text, page("limits.md")):
        assert "not of a cycle" in side
    assert "not of a cycle ([](lugs.md#friction))" in page("limits.md")
    assert "no contact stiffness to choose, no penalty and no search" in page("lugs.md")


@pytest.mark.slow
def test_results_of_pins_in_lugs_say_so(shipped: Shipped) -> None:
    page = (shipped("clevis") / "report.html").read_text(encoding="utf-8")
    listed = page.split('id="assumptions"')[1].split("</details>")[0]
    (said,) = re.findall(r"[^<>]+without friction[^<>]+", listed)
    assert "the safe side while a load grows, not in a cycle" in said
