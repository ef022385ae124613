"""The outline of half a pin's longitudinal section, edge by edge, each with its surface's name."""

from __future__ import annotations

from dataclasses import dataclass

from geometry.shape.pin import Pin, Segment

RZ = tuple[float, float]


@dataclass(frozen=True)
class Edge:
    """A straight edge from (r, z) to (r, z), m; `name` of the surface, None on the axis."""

    name: str | None
    start: RZ
    end: RZ


@dataclass(frozen=True)
class Arc(Edge):
    """A quarter circle about `centre`, of `radius` (m)."""

    centre: RZ = (0.0, 0.0)
    radius: float = 0.0


@dataclass(frozen=True)
class Corner:
    """A sharp inner corner at (r, z), m, where stress is unbounded."""

    r: float
    z: float


def meridian(pin: Pin) -> tuple[Edge, ...]:
    """The closed outline, counter-clockwise in (r, z), from the start face on."""
    first, last = pin.segments[0], pin.segments[-1]
    edges: list[Edge] = [Edge("start", (first.bore / 2, 0.0), (first.diameter / 2, 0.0))]
    edges += _outside(pin)
    z = pin.length
    edges.append(Edge("end", (last.diameter / 2, z), (last.bore / 2, z)))
    edges += _inside(pin)
    return tuple(e for e in edges if e.start != e.end)


def _outside(pin: Pin) -> list[Edge]:
    edges: list[Edge] = []
    for i, (segment, band) in enumerate(zip(pin.segments, pin.bands, strict=True)):
        r = band.radius
        edges.append(Edge(band.name, (r, band.z0), (r, band.z1)))
        if i + 1 == len(pin.segments):
            break
        edges += _shoulder(pin, i, segment, pin.segments[i + 1])
    return edges


def _shoulder(pin: Pin, i: int, left: Segment, right: Segment) -> list[Edge]:
    """The corner between two segments: fillet at the thinner shaft, then the shoulder face."""
    if left.diameter == right.diameter:
        return []
    rho, z = pin.fillet_at(i), pin.stations[i + 1]
    thin, thick = sorted((left.diameter / 2, right.diameter / 2))
    rises = right.diameter > left.diameter
    z_tangent = pin.bands[i].z1 if rises else pin.bands[i + 1].z0
    on_shaft, on_face, rim = (thin, z_tangent), (thin + rho, z), (thick, z)
    if rho == abs(left.diameter - right.diameter) / 2:  # the fillet takes the whole shoulder
        on_face = rim
    fillet: list[Edge] = []
    if rho > 0.0:
        ends = (on_shaft, on_face) if rises else (on_face, on_shaft)
        fillet = [Arc(f"fillet {i + 1}", *ends, centre=(thin + rho, z_tangent), radius=rho)]
    face = Edge(f"shoulder {i + 1}", *((on_face, rim) if rises else (rim, on_face)))
    return [*fillet, face] if rises else [face, *fillet]


def _inside(pin: Pin) -> list[Edge]:
    """Back along the bores, or the axis where there is none; from the end to the start."""
    edges: list[Edge] = []
    for i in reversed(range(len(pin.segments))):
        r = pin.segments[i].bore / 2
        name = f"bore {pin.labels[i]}" if r else None
        edges.append(Edge(name, (r, pin.stations[i + 1]), (r, pin.stations[i])))
        if i and pin.segments[i - 1].bore != pin.segments[i].bore:
            z = pin.stations[i]
            edges.append(Edge(f"bore step {i}", (r, z), (pin.segments[i - 1].bore / 2, z)))
    return edges


def sharp_corners(pin: Pin) -> tuple[Corner, ...]:
    """Inner corners without a fillet, on the shaft and in bores."""
    corners = []
    for i, z in enumerate(pin.stations[1:-1]):
        left, right = pin.segments[i], pin.segments[i + 1]
        if left.diameter != right.diameter and pin.fillet_at(i) == 0.0:
            corners.append(Corner(min(left.diameter, right.diameter) / 2, z))
        if left.bore != right.bore:
            corners.append(Corner(max(left.bore, right.bore) / 2, z))
    return tuple(corners)
