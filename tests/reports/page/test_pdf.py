"""What the PDF says is what the page says; names of all kinds stay text."""

from __future__ import annotations

from dataclasses import replace

from reports.data.decision import worst_first
from reports.data.envelope import governing_cases
from reports.data.results import Results, TitleBlock
from reports.data.sensitivities import PinSensitivities, Sensitivity
from reports.page.overview import overview_part
from reports.page.paper import MAX_DIMENSIONS, PINS_PER_MATRIX, document
from reports.pdf.typeset import shown_plots, typeset
from reports.plots.all import all_plots
from tests.support.results.rows import with_values

EVIL = '#panic("no") $x$ *b* _i_ \\ `c` <a> @b // /* [ ] { }'


def test_rows_are_those_of_the_decision_worst_first(results: Results) -> None:
    found = document(results, {})["factors"]
    assert found["outcomes"] == [pin.outcome for pin in worst_first(results)]
    at = found["head"].index("pin")
    assert [row[at] for row in found["body"]] == [pin.pin for pin in worst_first(results)]


def test_every_pin_shows_its_stress_and_its_meshes(results: Results) -> None:
    drawings = {shape.pin: "<svg/>" for shape in results.shapes}
    content = document(results, drawings)
    assert [pin["pin"] for pin in content["pins"]] == list(drawings)
    assert len(shown_plots(content)) == len(drawings) + sum(
        pin.pin in drawings for pin in results.pins
    )


def test_every_case_and_pin_is_in_the_matrix_with_those_that_govern(results: Results) -> None:
    pins = tuple(
        with_values(row, pin=f"{row.pin}{k}")
        for k in range(PINS_PER_MATRIX)
        for row in results.pins
    )
    found = document(replace(results, pins=pins), {})["envelope"]
    shown = {
        (pin, row[0]): cell
        for block in found["blocks"]
        for row in block["body"]
        for pin, cell in zip(block["head"][1:], row[1:], strict=True)
        if cell
    }
    assert set(shown) == {(row.pin, row.case) for row in pins}
    assert {key[0]: key[1] for key, cell in shown.items() if cell["governs"]} == governing_cases(
        replace(results, pins=pins)
    )
    assert max(len(block["head"]) for block in found["blocks"]) == PINS_PER_MATRIX + 1


def test_names_are_not_typesetting(results: Results) -> None:
    block = TitleBlock(revision=EVIL, date="2026-03-31", prepared=EVIL)
    evil = replace(results, title=EVIL, assumptions=(EVIL,), title_block=block)
    svg = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 10 10"><title>x</title></svg>'
    content = document(evil, {shape.pin: svg for shape in evil.shapes})
    plots = {k: v for k, v in all_plots(evil).items() if k in shown_plots(content)}
    once = typeset(content, plots)
    assert once == typeset(content, plots)
    assert once.startswith(b"%PDF-")


def test_the_first_page_has_what_the_first_screen_shows(results: Results) -> None:
    """Also the key of the bars, the marks of the outcomes and the curve of the worst pin."""
    row = with_values(
        results.pins[0], verdict="converged", singular_at=(), safety_factor_interval=None,
        joint=None, required=2.0, safety_factor=1.1, decided=False,
    )  # fmt: skip
    failing = replace(results, pins=(row,), required_safety_factor=2.0)
    screen = overview_part(failing, {}, "")
    content = document(failing, {}, screen)
    shown = content["overview"]
    assert shown["legend"].startswith("Mark: factor and error.")
    assert shown["lines"][0]["mark"] == "×"
    assert "<style>" in shown["curve"]
    assert screen["curve"].count("<text") == 5
    pdf = typeset(content, {})
    for part in ("curve", "legend"):
        without = {**content, "overview": {**shown, part: None if part == "curve" else ""}}
        assert typeset(without, {}) != pdf


def test_a_pin_in_two_cases_has_one_column_of_requirements(results: Results) -> None:
    """Columns for each case left cells of requirements that are not checked no room."""
    pins = tuple(with_values(results.pins[0], case=case) for case in ("retract", "landing"))
    alone = replace(results, pins=pins)
    content = document(alone, {}, overview_part(alone, {}, ""))
    screen = content["overview"]
    assert (len(screen["lines"]), screen["pins"]) == (2, [pins[0].pin])
    row = {"check": "shear", "level": "ultimate", "case": "", "required": "1.5", "title": ""}
    checked = row | {"needs": [], "cells": [["✓", "safe", "met"]]}
    matrix = [checked, row | {"needs": ["shear_strength"], "cells": [["", "", ""]]}]
    pdf = typeset({**content, "overview": {**screen, "matrix": matrix}}, {})
    assert pdf.startswith(b"%PDF-")


def test_characters_that_no_font_has_are_shown_by_number(results: Results) -> None:
    """UA-1 forbids them, and the whole run was lost."""
    svg = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><text y="9">{}</text></svg>'

    def made(title: str) -> bytes:
        named = replace(results, title=title)
        content = document(named, {shape.pin: svg.format(title) for shape in named.shapes})
        plots = {k: v for k, v in all_plots(named).items() if k in shown_plots(content)}
        return typeset(content, plots)

    assert made("Bolzen 销 é ש 😀") == made("Bolzen U+9500 é ש U+1F600")


def test_sensitivities_are_few_and_of_worst_cases(results: Results) -> None:
    row = worst_first(results)[0]
    lengths = [
        Sensitivity(f"pin.{row.pin}.profile[{k + 1}].diameter", "length", 1.0, 0.1, -(9.0 - k),
                    0.1, 2.0)
        for k in range(8)
    ]  # fmt: skip
    found = [
        PinSensitivities(row.pin, case, 10.0, 2.0, tuple(lengths)) for case in (row.case, "other")
    ]
    content = document(replace(results, sensitivities=tuple(found)), {})["sensitivities"]
    body = content["grid"]["body"]
    assert [cells[1] for cells in body] == [row.case] * MAX_DIMENSIONS
    assert body[0][2] == lengths[0].key
    assert document(replace(results, sensitivities=()), {})["sensitivities"] is None
