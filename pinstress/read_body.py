"""A pin's shape read from its file; CAD files in a process of their own.

OpenCASCADE ends its process over some damaged files, and never ends over others.
"""

from __future__ import annotations

import resource
from functools import partial

from geometry import GeometryError
from geometry.body_file import BodyFile
from geometry.solid_body import SolidBody
from pinstress.workers import Died, Job, Tell, processes, side_by_side

LONGEST = 30  # s of processor time; a sound pin takes about one


def read_body(file: BodyFile) -> SolidBody:
    """What the file holds, with its bands measured.

    Where other threads run (a notebook) there can be no second process, and a file that makes
    OpenCASCADE crash ends this one.

    Raises: GeometryError, MeshError as SolidBody; GeometryError for a CAD file that cannot be read
    to its end.
    """
    if file.meshed or processes(2) == 1:
        return SolidBody(file)
    (made,) = side_by_side([Job(f"pin {file.name}", partial(_read, file))], 2)
    if isinstance(made, Died):
        raise GeometryError(
            f"pin {file.name}: {file.path.name} is damaged, or has very small faces or edges: "
            f"gmsh did not get to its end ({made.reason}); repair it and export it anew, or mesh "
            "it elsewhere and give the mesh"
        )
    return made


def _read(file: BodyFile, _: Tell) -> SolidBody:
    most = resource.getrlimit(resource.RLIMIT_CPU)[1]
    resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, most))
    return SolidBody(file)
