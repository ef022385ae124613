"""The conventions and exclusions that apply to all pins of the page, each stated once."""

from __future__ import annotations

from reports.data.results import Results
from reports.format.drawing.svg import INK_COLOUR, text
from reports.format.words import BEYOND_YIELD, VERDICT_MEANINGS
from reports.page.joint import BANDS_NOTE, FOUNDATION_NOTE, LUGS_NOTE, RANGE_NOTE
from reports.page.places import CONTACT_EDGES_NOTE, HARDENED_NOTE, PLACES_NOTE, SECTION_NOTE
from reports.page.stress_panel import LOAD_COLOUR
from reports.tables.strength.hand_checks import HAND_CHECKS_NOTE

DRAWING_NOTE = (
    "To scale; lengths and diameters (⌀ outer / bore) in {length}. Blue: bearing bands; black "
    "hatching: clamped; grey: free. Red dots: the surface's largest stress; a red line across: the "
    "section that governs instead."
)
LUGS_NOTE_OF_DRAWING = (
    "Brown hatching: lugs; yellow: bushings. To scale, so that a clearance is seldom visible. Blue "
    "strips at the pin: load per length of its lugs, its part in the plane of the drawing, on the "
    "side of the pin that carries; the largest is named. Beside it the lug with the largest force, "
    "as seen against z: the pressure around the bore on the ring that carries most."
)
LOADS_NOTE = (
    "Blue arrows: the force of each link on the pin in the worst case at its governing instant; a "
    "ring with a dot points towards the viewer, with a cross away. The plane of the drawing is "
    "that of the largest force, or of x and z where the pin has cuts; the angle at its upward axis "
    "counts from x."
)
CURVES_NOTE = (
    "Below, in {stress}, the largest von Mises stress of the surface over the circumference "
    "(without excluded zones and what lugs press on), and the largest of each section. The red dot "
    "is the maximum; the dotted line the stress that the required factor permits."
)
ZONES_NOTE = (
    "Numbered red rings: stress singularities, filled where one governs; red stripes: the excluded "
    "zones about them, inside which stress is not evaluated, because it depends only on the mesh. "
    "Where one governs (singular), the stress has no maximum: the results are those outside the "
    "zones. Their size is a convention, so a range over half and twice the excluded distance is "
    "given in place of an error. Stress grows like distance^(−exponent); the exponent is given as "
    "measured on the meshes / theoretical. The strength C is the coefficient of the von Mises "
    "stress C · distance^(−exponent) along the free surface, with the theoretical exponent. Notch "
    "stress intensity factors are in singular_zones.csv."
)
CUTS_NOTE = "Cuts in the view with x upwards, from which their angles count; dashed: hidden edges."
SOLIDS_NOTE = "Dashed green boxes: local solids about cuts."
TABLES_NOTE = (
    "Tables are for the governing instant; forces and moments of each body on the pin in world "
    "axes; places in pin axes. At a clamped band the clamp reacts the load."
)
SIGNS_NOTE = (
    "Axes of a pin: z along it, from left to right; x and y across, so that x, y and z are "
    "right-handed. Shear and bending moment are positive as drawn: on the part's end at larger z, "
    "shear acts along x, and the moment turns about y, from z towards x."
)


def reading_parts(results: Results) -> dict[str, str]:
    """Return the notes by heading, only those that apply to some pin of the results."""
    units, rows = results.units, results.pins
    words = {"length": units.length, "stress": units.stress}
    joints = [row.joint for row in rows if row.joint is not None]
    contacts = [row.places.contact for row in rows if row.places and row.places.contact]
    sections = any(row.places and row.places.section for row in rows)
    notes = {
        "Drawing": [
            DRAWING_NOTE.format(**words),
            LUGS_NOTE_OF_DRAWING * any(s.lugs for s in results.shapes),
            CUTS_NOTE * any(s.cuts for s in results.shapes),
            SOLIDS_NOTE * any(s.solids for s in results.shapes),
        ],
        "Loads": [LOADS_NOTE, TABLES_NOTE],
        "Stress along the pin": [CURVES_NOTE.format(**words)] if rows else [],
        "Beyond yield": [VERDICT_MEANINGS[BEYOND_YIELD].capitalize() * any(r.yields for r in rows)],
        "Singularities": [ZONES_NOTE * any(row.singular_at for row in rows)],
        "Places": [
            (PLACES_NOTE if contacts else SECTION_NOTE) * bool(sections or contacts),
            CONTACT_EDGES_NOTE * any(c.edges for c in contacts),
            HARDENED_NOTE * any(row.places and row.places.hardened for row in rows),
        ],
        "Lugs": [
            BANDS_NOTE * any(joint.bands for joint in joints),
            LUGS_NOTE * any(joint.lugs for joint in joints),
            FOUNDATION_NOTE * any(joint.model == "foundation" for joint in joints),
            RANGE_NOTE * any(joint.range for joint in joints),
        ],
        "Hand checks": [HAND_CHECKS_NOTE * any(row.hand_checks for row in rows)],
    }
    said = {heading: " ".join(filter(None, parts)) for heading, parts in notes.items()}
    return {heading: note for heading, note in said.items() if note}


def signs() -> str:
    """Return an SVG of the axes of a pin, and of a part of the pin under positive shear
    and moment.
    """
    ink = f'fill="none" stroke="{INK_COLOUR}" stroke-width="1.3"'
    load = f'fill="none" stroke="{LOAD_COLOUR}" stroke-width="2" marker-end="url(#sign)"'
    return "".join(
        [
            '<svg class="signs" viewBox="0 0 360 96" role="img" font-size="12" '
            'xmlns="http://www.w3.org/2000/svg" font-family="sans-serif">'
            "<title>Axes of a pin, and positive shear and bending moment</title>"
            '<defs><marker id="sign" viewBox="0 0 8 8" refX="6" refY="4" markerWidth="4.5" '
            f'markerHeight="4.5" orient="auto"><path d="M0,0L8,4L0,8Z" fill="{LOAD_COLOUR}"/>'
            "</marker></defs>",
            f'<path d="M30,20V70H80M26,27L30,19L34,27M73,66L81,70L73,74" {ink}/>',
            f'<circle cx="30" cy="70" r="5" fill="#fff" stroke="{INK_COLOUR}"/>'
            f'<circle cx="30" cy="70" r="1.5" fill="{INK_COLOUR}"/>',
            text(30.0, 14.0, "x"), text(89.0, 74.0, "z"), text(16.0, 74.0, "y"),
            f'<rect x="170" y="30" width="80" height="36" fill="#ececec" '
            f'stroke="{INK_COLOUR}"/>',
            f'<path d="M258,66V32" {load}/><path d="M162,30V64" {load}/>',
            f'<path d="M272,66A26,26 0 0 0 272,30" {load}/>'
            f'<path d="M148,66A26,26 0 0 1 148,30" {load}/>',
            text(262.0, 84.0, "V"), text(296.0, 52.0, "M"), text(160.0, 84.0, "V"),
            text(124.0, 52.0, "M"),
            "</svg>",
        ]
    )  # fmt: skip
