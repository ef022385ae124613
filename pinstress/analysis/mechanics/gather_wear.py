"""Sliding of links on their pins, the pressure between them, and the product of both over a motion,
in SI units.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from geometry import Band
from loads import Dynamics, Joint, Reactions
from loads.motion.planar_equations import is_particle
from pinbase.arrays import Floats
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.clevis import Ears, bands_of, on_ears
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.reading.file import Study
from reports.data.wear import BandWear


def wear(study: Study, loads: dict[str, CaseLoads]) -> tuple[BandWear, ...]:
    """Return the sliding on every band of the pins with a profile, in every case that is a motion.

    It is evaluated at the instants between which the loads are polynomials, and at the samples.
    """
    moving = {n: c for n, c in loads.items() if c.moving is not None and c.solve is not None}
    return tuple(row for n, c in moving.items() for row in _of_case(n, c, _bands(study)))


def _bands(study: Study) -> dict[str, tuple[str, dict[str, Band]]]:
    """Return for every connection of a pin with a profile the pin and the connection's bands."""
    out = {}
    for name, table in study.table.pin.items():
        if table.geometry is not None:
            continue
        shape = pin_of(study, name)
        for connection in study.connections(name):
            out[connection] = name, bands_of(connection, shape, table.ears)
    return out


def _of_case(
    name: str, case: CaseLoads, bands: dict[str, tuple[str, dict[str, Band]]]
) -> Iterator[BandWear]:
    assert case.moving is not None
    assert case.solve is not None
    dynamics = case.solve(case.moving.instants)
    for k, (joint, connection) in enumerate(dynamics.motion.linkage.connections):
        if connection.name not in bands:
            continue
        pin, on = bands[connection.name]
        references = _references(dynamics, joint, connection.body)
        for at, force in _forces(dynamics.reactions, k, on).items():
            band = on[at]
            pressure = force / (2.0 * band.radius * band.length)
            slides = [
                (against, *sliding(dynamics, connection.body, against, band.radius))
                for against in references
            ]
            row = BandWear(
                name, pin, at, connection.body, joint.fixed_in or "", joint.fixed_in is None,
                float(pressure.max()),
            )  # fmt: skip
            yield _with_sliding(row, slides, pressure, dynamics.motion.times)


def _forces(reactions: Reactions, k: int, on: dict[str, Band]) -> dict[str, Floats]:
    """Return the magnitudes (T,) N of the force across the pin on each band of the k-th
    connection.
    """
    first, last = next(iter(on)), next(reversed(on))
    ears = {first: Ears(last, on[first].middle, on[last].middle)} if len(on) > 1 else {}
    link = reactions.forces[:, [k]], reactions.moments[:, [k]]
    names, forces, _ = on_ears([first], *link, ears)
    return dict(zip(names, np.hypot(forces[..., 0], forces[..., 1]).T, strict=True))


def sliding(dynamics: Dynamics, body: str, against: str, radius: float) -> tuple[float, Floats]:
    """Return the path (m) over which a body slides on a pin that turns with another body, and the
    velocity (T,) m/s.

    radius: of the pin, m.
    """
    motion = dynamics.motion
    angle = motion.angle(body) - motion.angle(against)
    rate = motion.angular_velocity(body) - motion.angular_velocity(against)
    return float(radius * np.abs(np.diff(angle)).sum()), radius * np.abs(rate)


def _references(dynamics: Dynamics, joint: Joint, body: str) -> list[str]:
    """Return the bodies with which a pin may turn: the body in which it is fixed, or, for a
    floating pin, any other link on it. Empty if a rotation is unknown.
    """
    linkage = dynamics.motion.linkage
    particles = {b.name for b in linkage.bodies if is_particle(linkage, b.name)}
    if body in particles:
        return []
    if joint.fixed_in is not None:
        return [] if joint.fixed_in in particles else [joint.fixed_in]
    others = dict.fromkeys(c.body for c in joint.connections if c.body != body)
    return [other for other in others if other not in particles]


def _with_sliding(
    row: BandWear, slides: list[tuple[str, float, Floats]], pressure: Floats, times: Floats
) -> BandWear:
    """Return a row with the largest of the possible slidings."""
    if not slides:
        return row
    against, distance, _ = max(slides, key=lambda slide: slide[1])
    velocity = np.max([speed for _, _, speed in slides], axis=0)
    product = pressure * velocity
    most = int(product.argmax())
    return BandWear(
        row.case, row.pin, row.connection, row.body, against, row.floats, row.mean_pressure,
        float(velocity.max()), distance, float(product[most]), float(times[most]),
    )  # fmt: skip
