"""Pictures of pins coloured by von Mises stress; call renderer_problem() first."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pinbase.dimensions import Floats
from reports.data.fields import Field
from reports.data.row import Units
from reports.format.drawing.camera import VIEW_ANGLE, View
from reports.format.numbers import engineering
from reports.vtk.writer import VTK_CELL_TYPES

if TYPE_CHECKING:
    import pyvista

WINDOW_SIZE = (1200, 800)
SUBDIVISIONS = 3  # of each quadratic triangle, so that pins look round
FEATURE_ANGLE = 30.0  # degrees; an edge is drawn between faces at a larger angle
INK_COLOUR = "#222222"
PRESSED_COLOUR = "#b4b4b4"


def render_pin(
    field: Field, path_png: Path, units: Units, title: str, top: float | None = None
) -> None:
    """Draw the surface of a pin with its von Mises stress and mark the largest: a PNG of 1200x800.

    top: the stress at the end of the colour scale if it exceeds the largest stress, so that
    pictures can be compared.
    """
    import pyvista

    plotter = pyvista.Plotter(off_screen=True, window_size=list(WINDOW_SIZE))
    try:
        _draw(plotter, field, units, title, top)
        plotter.screenshot(path_png)
    finally:
        plotter.close()


def show_pin(field: Field, units: Units, title: str) -> None:
    """Show the picture of a pin in a window until it is closed; this needs a display."""
    import pyvista

    plotter: Any = pyvista.Plotter(window_size=list(WINDOW_SIZE), title=title)
    _draw(plotter, field, units, title)
    plotter.add_axes()
    plotter.show()


def _draw(plotter: Any, field: Field, units: Units, title: str, top: float | None = None) -> None:
    peak = int(np.argmax(field.von_mises))
    largest, place, label = float(field.von_mises[peak]), field.points[peak], "max"
    if field.outside is not None:  # inside, stress depends on the mesh and the contact cells
        largest, place = field.outside[0], np.asarray(field.outside[1])
        label = "max outside excluded zones" if field.pressed is None else "max of the surface"
    top = max(largest, top or 0.0)
    power = _power(top)
    # VTK's font has no superscript digits.
    unit = units.stress if power == 0 else f"10^{power} {units.stress}"
    name = f"von Mises [{unit}]"
    surface = _surface(field, name, 10.0**power)
    view = View.of(field.points, place)
    plotter.set_background("white")
    _add_surface(plotter, surface, name, top / 10.0**power)
    label = f"{label} {engineering(largest / 10.0**power)} {unit}"
    _mark(plotter, place, view.above(field.points, place), label)
    plotter.add_text(
        _drawable(title), position=(24, WINDOW_SIZE[1] - 48), font_size=13, color=INK_COLOUR
    )
    # A separate text, because the title of the bar would overlap its labels.
    text = name if field.pressed is None else f"{name}; grey: pressed by lugs"
    plotter.add_text(
        text, position=(0.2 * WINDOW_SIZE[0], 0.1 * WINDOW_SIZE[1]), font_size=10, color=INK_COLOUR
    )
    plotter.camera_position = view.camera
    plotter.camera.view_angle = VIEW_ANGLE
    plotter.reset_camera_clipping_range()
    plotter.enable_anti_aliasing("ssaa")


def _power(largest: float) -> int:
    """Return the power of ten, a multiple of three, that scales a stress of a million or more;
    otherwise 0.
    """
    return 0 if not 1e6 <= largest < np.inf else 3 * (int(np.floor(np.log10(largest))) // 3)


def _drawable(text: str) -> str:
    # VTK would take text between two dollar signs for TeX.
    return text.replace("$", "")


def _surface(field: Field, name: str, scale: float) -> pyvista.PolyData:
    import pyvista
    from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter

    kind = np.full(len(field.cells), VTK_CELL_TYPES[field.cell_type], dtype=np.uint8)
    counts = np.full((len(field.cells), 1), field.cells.shape[1])
    cells = np.hstack([counts, field.cells]).ravel()
    grid = pyvista.UnstructuredGrid(cells, kind, np.asarray(field.points, dtype=float))
    shown = field.von_mises / scale
    grid.point_data[name] = (
        shown if field.pressed is None else np.where(field.pressed, np.nan, shown)
    )
    # VTK's own filter, because the arguments of pyvista's extract_surface change between versions.
    skin = vtkDataSetSurfaceFilter()
    skin.SetInputData(grid)
    skin.SetNonlinearSubdivisionLevel(SUBDIVISIONS)
    skin.Update()
    surface: Any = pyvista.wrap(skin.GetOutput())
    return surface.compute_normals(  # type: ignore[no-any-return]
        cell_normals=False, split_vertices=True, feature_angle=FEATURE_ANGLE
    )


def _add_surface(
    plotter: pyvista.Plotter, surface: pyvista.PolyData, name: str, largest: float
) -> None:
    bar: Any = {
        "title": "",
        "vertical": False,
        "position_x": 0.2,
        "position_y": 0.02,
        "height": 0.08,
        "width": 0.6,
        "n_labels": 6,
        "fmt": _bar_format(largest),
        "color": INK_COLOUR,
        "label_font_size": 18,
        "unconstrained_font_size": True,
    }
    plotter.add_mesh(
        surface,
        scalars=name,
        # Between the nodes, quadratic interpolation may fall below zero.
        clim=(0.0, largest or 1.0),
        cmap="viridis",
        nan_color=PRESSED_COLOUR,
        smooth_shading=True,
        scalar_bar_args=bar,
        specular=0.15,
        ambient=0.25,
    )
    edges = surface.extract_feature_edges(
        feature_angle=FEATURE_ANGLE,
        boundary_edges=True,
        manifold_edges=False,
        non_manifold_edges=False,
    )
    if edges.n_points:
        plotter.add_mesh(edges, color=INK_COLOUR, line_width=1.5)


def _bar_format(largest: float) -> str:
    if largest <= 0.0:
        return "%.1f"
    return f"%.{max(0, 2 - int(np.floor(np.log10(largest))))}f"


def _mark(plotter: pyvista.Plotter, place: Floats, text_at: Floats, text: str) -> None:
    plotter.add_lines(np.asarray([place, text_at]), color=INK_COLOUR, width=1)
    plotter.add_points(
        np.asarray([place]), color="red", point_size=12, render_points_as_spheres=True
    )
    plotter.add_point_labels(
        np.asarray([text_at]),
        [text],
        font_size=18,
        text_color=INK_COLOUR,
        shape_color="white",
        shape_opacity=0.85,
        margin=4,
        show_points=False,
        justification_horizontal="center",
        always_visible=True,
    )
