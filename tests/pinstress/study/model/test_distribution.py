"""The distribution of a case that states none: bearing pressure, and said where it matters."""

from __future__ import annotations

import pinstress
from tests.support.described import describe
from tests.support.each import each
from tests.support.programs.command_line import QUICK

STATED = 'distribution = "uniform"'
SENTENCE = "Case landing states no distribution"
SILENT = QUICK.replace(STATED, "")
LUGS = "\n[pin.B.lug.B]\n[pin.B.lug.root]\n"


def test_it_is_that_of_bearing_pressure_and_an_assumption_of_the_results() -> None:
    silent, cosine, uniform = (
        pinstress.run(pinstress.study_from(text))
        for text in (SILENT, QUICK.replace(STATED, 'distribution = "cosine"'), QUICK)
    )
    stress = [results["B", "landing"].max_von_mises for results in (silent, cosine, uniform)]
    assert stress[0] == stress[1] != stress[2]
    assert [SENTENCE in " ".join(r.assumptions) for r in (silent, cosine, uniform)] == [1, 0, 0]


@each(
    ("text", "says"),
    [
        (SILENT, True),
        (QUICK, False),
        (QUICK.replace(STATED, 'distribution = "cosine"'), False),
        (SILENT.replace("[0.0, -988.86]", "[0.0, 0.0, -988.86]"), False),  # along the pin
        (SILENT.replace('clamp = ["start"]', "") + LUGS, False),
    ],
)
def test_check_says_it_once(text: str, says: bool) -> None:
    summary, *_ = describe(pinstress.study_from(text))
    assert summary.count(SENTENCE) == says
