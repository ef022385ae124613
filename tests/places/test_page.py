"""What page, PDF, drawings and views say of surface, section and contact, of made-up rows."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from fea.core.places import (
    BandPressure,
    ContactEdge,
    ContactPlace,
    Places,
    SectionPlace,
    SurfacePlace,
)
from reports.data.results import Results
from reports.data.row import PinResult, Units
from reports.page.drawing_places import place_marks
from reports.page.joint import joint_part
from reports.page.paper import document
from reports.page.pin_drawing import draw_pin
from reports.page.pins_reading import reading_parts
from reports.page.places import places_part
from reports.page.viewer import pin_views
from tests.support.results.html_page import parse
from tests.support.results.made_up_joint import in_lugs, make_joint, surface_in
from tests.support.results.made_up_run import make_results
from tests.support.results.rows import with_values

UNITS = Units("in", "lbf", "psi", "s")
SURFACE = SurfacePlace(1500.0, 15.0, "converged", (0.0, 0.5, 0.25), 1.25)
SECTION = SectionPlace(
    2000.0, 10.0, "converged", 1.75, 0.5, 0.0, 400.0, 123.4, 0.0, plastic_utilisation=0.1234
)
ROUNDED = ContactEdge("left", "end", 17_200.0, 0.226, 0.0012, 300e3, 160e3, 45e3)
SHARP = ContactEdge("middle", "start", 250.0, 0.226, 1e-12, None, None, None)
BAND = BandPressure("left", 987.6, 0.683, ((0.0, 0.5, -80.0, 80.0),))


def contact(*edges: ContactEdge, reach: float | None = 0.02) -> ContactPlace:
    return ContactPlace(
        2500.0, 30.0, (0.0, 0.4, 0.3), None, reach, None if reach is None else 0.31, edges, (BAND,)
    )


def row(results: Results, places: Places, **changes: object) -> Results:
    """The first pin with these places; its yield strength is its factor times its stress."""
    largest = places.section if places.governs == "section" else places.surface
    assert largest is not None
    location = SURFACE.location if places.governs == "surface" else (0.0, 0.5, SECTION.z)
    return in_lugs(
        results, make_joint(), places=places, max_von_mises=largest.max_von_mises,
        error_estimate=largest.error_estimate, safety_factor=118e3 / largest.max_von_mises,
        location=location, required=10.0, max_von_mises_interval=None,
        safety_factor_interval=None, verdict="converged", **changes,
    )  # fmt: skip


@pytest.fixture(scope="module")
def results() -> Results:
    found = make_results()
    return replace(found, pins=found.pins[:1], shapes=found.shapes[:1])


BOTH = Places("section", SURFACE, SECTION, contact(ROUNDED, SHARP))


def first(results: Results) -> PinResult:
    return results.pins[0]


def test_the_three_places_have_their_own_numbers(results: Results) -> None:
    part = places_part(first(row(results, BOTH)), UNITS)
    assert part is not None
    assert part.grid.head[:5] == ["place", "von Mises [psi]", "±", "safety factor", "x [in]"]
    assert part.grid.body == [
        # 118,000 over each stress
        ["surface", "1,500", "15", "78.7", "0", "0.5000", "0.2500", "1.25", "converged"],
        ["section", "2,000", "10", "59.0", "", "", "1.750", "0.5", "converged, governs"],
        ["beneath contact", "2,500", "30", "47.2", "0", "0.4000", "0.3000", "–", ""],
    ]
    section, depth = part.notes
    assert section == (
        "Section at z = 1.750 in: shear force 400.0 lbf, bending moment 123.4 lbf·in; 12 % of its "
        "fully plastic capacity."
    )
    assert depth == (
        "From where lugs press, stress inside the pin exceeds yield to a depth of 0.020 in, and "
        "yield over the required factor 10 to a depth of 0.31 in."
    )


def test_a_section_without_stress_has_no_forces_to_name(results: Results) -> None:
    """It said "Section at z = 0 in: ."."""
    pin = first(row(results, BOTH))
    assert pin.places is not None
    assert pin.places.section is not None
    idle = replace(pin.places.section, max_von_mises=0.0, shear_force=0.0, bending_moment=0.0)
    part = places_part(with_values(pin, places=replace(pin.places, section=idle)), UNITS)
    assert part is not None
    assert not any(note.startswith("Section") for note in part.notes)


def test_a_sharp_edge_has_no_peak(results: Results) -> None:
    part = places_part(first(row(results, BOTH)), UNITS)
    assert part is not None
    assert part.edges is not None
    assert part.edges.head[2:5] == ["K [psi·in^exponent]", "exponent", "yield at [in]"]
    assert part.edges.body == [
        ["left", "end", "17,200", "0.226", "0.0012", "300,000", "45,000", "160,000"],
        ["middle", "start", "250", "0.226", "0", "–", "–", "–"],  # 1e-12 in is none
    ]
    alone = places_part(first(row(results, replace(BOTH, contact=contact(SHARP)))), UNITS)
    assert alone is not None
    assert alone.edges is not None
    assert len(alone.edges.head) == 5


def test_without_a_yield_strength_there_is_no_depth(results: Results) -> None:
    bare = replace(first(row(results, replace(BOTH, contact=contact(reach=None)))))
    part = places_part(with_values(bare, safety_factor=None, required=None), UNITS)
    assert part is not None
    assert [cells[3] for cells in part.grid.body] == ["–", "–", "–"]
    assert len(part.notes) == 1
    assert part.edges is None


def test_prescribed_loads_have_no_contact(results: Results) -> None:
    prescribed = row(results, Places("surface", SURFACE, SECTION))
    part = places_part(first(prescribed), UNITS)
    assert part is not None
    assert [cells[0] for cells in part.grid.body] == ["surface", "section"]
    assert "contact" not in reading_parts(prescribed)["Places"]
    assert "contact" in reading_parts(row(results, BOTH))["Places"]
    assert places_part(first(row(results, Places("surface", SURFACE))), UNITS) is None


def test_the_mean_pressure_has_its_share_of_the_bearing_strength(results: Results) -> None:
    part = joint_part(first(row(results, BOTH)), UNITS)
    assert part is not None
    assert part.bands is not None
    assert part.bands.head[3:5] == ["mean pressure [psi]", "of bearing strength"]
    assert part.bands.body[0][3:5] == ["987.6", "68.3 %"]
    assert part.bands.body[1][4] == "–"
    none = replace(BOTH, contact=replace(contact(), bands=(replace(BAND, bearing_share=None),)))
    bare = joint_part(first(row(results, none)), UNITS)
    assert bare is not None
    assert bare.bands is not None
    assert "of bearing strength" not in bare.bands.head


def test_a_drawing_has_a_line_across_the_section_and_dots_on_the_surface(results: Results) -> None:
    shape = results.shapes[0]
    length = sum(segment[0] for segment in shape.segments)
    for places, kind, count in ((BOTH, "line", 1), (replace(BOTH, governs="surface"), "circle", 2)):
        marks = place_marks(row(results, places), shape.pin, length)
        svg = draw_pin(shape, UNITS, None, places=marks)
        assert svg.count('class="place"') == count
        assert f'<{kind} class="place"' in svg or f"<{kind} " in svg.split('class="place"')[0]
        assert f"max ({first(results).case})" in svg


def test_page_and_pdf_have_the_same_places(results: Results, tmp_path: Path) -> None:
    from reports.page.page import write_page

    shown = row(results, BOTH)
    text = parse(write_page(shown, tmp_path)).text
    assert text.count("Surface, section, contact") == 1
    assert "converged, governs" in text
    assert "From where lugs press, stress inside the pin exceeds yield" in text
    (pin,) = (p for p in document(shown, {"A": "<svg/>"})["pins"] if p["pin"] == "A")
    part = places_part(first(shown), shown.units)
    assert part is not None
    assert pin["cases"][0]["places"]["grid"]["body"] == part.grid.body


def test_a_view_tells_of_the_section_that_governs(results: Results) -> None:
    shown = row(results, BOTH)
    shown = replace(shown, surfaces=(surface_in(first(shown).case),))
    (view,) = pin_views(shown, "A")
    said = "The section at z = 1.750 in governs: 2,000 psi (± 10), safety factor 59.0."
    assert json.loads(str(view.data))["cases"][0]["row"] == said
    by_surface = row(results, replace(BOTH, governs="surface"))
    (view,) = pin_views(replace(by_surface, surfaces=shown.surfaces), "A")
    assert json.loads(str(view.data))["cases"][0]["row"] == ""
