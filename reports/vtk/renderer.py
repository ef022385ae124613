"""Test of off-screen drawing by VTK, in another process, since VTK crashes where it cannot draw."""

from __future__ import annotations

import os
import subprocess
import sys

WINDOW_VARIABLE = "VTK_DEFAULT_OPENGL_WINDOW"
OFF_SCREEN_WINDOWS = ("vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow")
PROBE_TIMEOUT = 120
PROBE_CODE = """
import pyvista
plotter = pyvista.Plotter(off_screen=True, window_size=(32, 32))
plotter.add_mesh(pyvista.Sphere(), color="red")
picture = plotter.screenshot(return_img=True)
assert picture.min() < picture.max(), "the picture is empty"
print(plotter.render_window.GetClassName())
"""


def renderer_problem() -> str | None:
    """Return the reason why no pictures can be drawn; None if they can.

    The name of the renderer that works is kept in the environment of this process, so call this
    function before drawing.
    """
    problems = []
    for window in _candidates():
        problem = _try(window)
        if problem is None:
            if window:
                os.environ[WINDOW_VARIABLE] = window
            return None
        problems.append(f"{window or 'default'}: {problem}")
    return "VTK finds no renderer (" + "; ".join(problems) + ")"


def _candidates() -> tuple[str, ...]:
    chosen = os.environ.get(WINDOW_VARIABLE, "")
    # Without a display, VTK's default prints errors about the X server before it falls back.
    display = sys.platform != "linux" or bool(os.environ.get("DISPLAY"))
    first = (chosen,) if chosen or display else ()
    return first + tuple(window for window in OFF_SCREEN_WINDOWS if window != chosen)


def _try(window: str) -> str | None:
    environment = {key: value for key, value in os.environ.items() if key != WINDOW_VARIABLE}
    if window:
        environment[WINDOW_VARIABLE] = window
    try:
        done = subprocess.run(
            [sys.executable, "-P", "-c", PROBE_CODE],  # imports nothing from the current folder
            cwd="/",  # and reads no settings there, as matplotlib would
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=PROBE_TIMEOUT,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return f"no answer in {PROBE_TIMEOUT} s"
    except OSError as error:
        return str(error)
    if done.returncode < 0:
        return f"ends with signal {-done.returncode}"
    if done.returncode:
        return (done.stderr.strip().splitlines() or ["fails"])[-1]
    # VTK falls back, with warnings, if it cannot make a window of this kind.
    last_words = done.stdout.split()[-1:]
    return None if not window or last_words == [window] else "cannot be made"
