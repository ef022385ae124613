"""The cost of `pinstress loads` for linkages of a hundred bodies: processor time, memory, size of
the report.
"""

from __future__ import annotations

import os
import random
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.motion.scissor import HIGH, LOW, SPAN, lift
from benchmarks.space.many_bodies import SPAN as TIME
from benchmarks.space.many_bodies import SWING, train
from benchmarks.timing import table

STAGES, FOUR_BARS = 50, 51  # of 103 bodies
INSTANTS = (201, 20_001)
HEAD = """title = "Linkage"
units = "m-N-s"
[case.move]
kind = "motion"
samples = INSTANTS
[mechanism]
"""


def linkages() -> str:
    """Return the table of a scissor lift, a chain of four-bars and a chain of four-bars in space,
    by the number of instants.
    """
    studies = {
        "lift": lift_study(STAGES),
        "four-bars": chain_study(FOUR_BARS),
        "four-bars in space": space_study(STAGES),
    }
    rows = [(name, *_row(text, n)) for name, text in studies.items() for n in INSTANTS]
    return table(("linkage", "instants", "processor, s", "memory, MB", "report, MB"), rows)


def lift_study(stages: int) -> str:
    """Return the study of a scissor lift with 2 stages + 3 bodies; its number of instants is to be
    filled in.
    """
    linkage = lift(stages)
    names = {joint.at: joint.name for joint in linkage.joints}
    parts = [
        "gravity = [0, -9.81]",
        f'[mechanism.drive]\nslider = "drive"\nlaw = "cycloidal"\nstart = {LOW}\nend = {HIGH}\n'
        f"duration = {SPAN}",
    ]
    parts += [
        f'[mechanism.slider.{s.name}]\nbodies = ["{s.base}", "{s.moving}"]\ndirection = [1, 0]\n'
        f'joints = ["{names[s.start]}", "{names[s.end]}"]'
        for s in linkage.sliders
    ]
    for joint in linkage.joints:
        turning = {c.name: c.body for c in joint.connections}
        parts.append(_joint(joint.name, joint.at, joint.fixed_in or "", turning))
    parts += [_body(b.name, b.mass, b.centre, b.inertia or 0.0) for b in linkage.bodies]
    return HEAD + "\n".join(parts)


def chain_study(four_bars: int, seed: int = 1) -> str:
    """Return the study of nearly equal four-bars in a row, each driven by the rocker of the one
    before.
    """
    rng = random.Random(seed)

    def near(x: float, y: float) -> tuple[float, float]:
        return x + rng.uniform(-0.02, 0.02), y + rng.uniform(-0.02, 0.02)

    ground = [near(2.0 * k, 0.0) for k in range(four_bars + 1)]
    tips = [near(x + 0.5, y + 0.87) for x, y in ground]
    parts = [
        "gravity = [0, -9.81]",
        '[mechanism.drive]\nbody = "r0"\nline = ["O0", "A0"]\nlaw = "cycloidal"\n'
        'start = "60 deg"\nend = "110 deg"\nduration = 4.0',
    ]
    for k, (foot, tip) in enumerate(zip(ground, tips, strict=True)):
        couplers = [f"c{j}" for j in (k - 1, k) if 0 <= j < four_bars]
        parts += [
            _joint(f"O{k}", foot, "ground", {f"O{k}": f"r{k}"}),
            _joint(f"A{k}", tip, f"r{k}", {f"A{k}{name}": name for name in couplers}),
            _body(f"r{k}", 5.0, _middle(foot, tip), 0.4),
        ]
        if k < four_bars:
            parts.append(_body(f"c{k}", 8.0, _middle(tip, tips[k + 1]), 2.7))
    return HEAD + "\n".join(parts)


def space_study(stages: int) -> str:
    """Return the study of four-bars in space, each driven by the rocker of the one before."""
    linkage = train(stages)
    parts = [
        "dimension = 3",
        f"gravity = {[*linkage.gravity]}",
        f'[mechanism.drive]\njoint = "{linkage.joints[0].name}"\nlaw = "cycloidal"\n'
        f'start = "0 deg"\nend = "{SWING} rad"\nduration = {TIME}',
    ]
    for joint in linkage.joints:
        axes = (("axis", joint.axis), ("second_axis", joint.second_axis))
        parts += [
            f'[mechanism.joint.{joint.name}]\nat = {[*joint.at]}\nkind = "{joint.kind}"',
            *(f"{key} = {[*axis]}" for key, axis in axes if axis is not None),
            f'fixed_in = "{joint.base}"\nconnections = {{ {joint.name} = "{joint.moving}" }}',
        ]
    for body in linkage.bodies:
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = body.inertia
        parts.append(
            f"[mechanism.body.{body.name}]\nmass = {body.mass}\ncentre = {[*body.centre]}\n"
            f"inertia = {[xx, yy, zz, xy, xz, yz]}"
        )
    return HEAD + "\n".join(parts)


def _middle(a: tuple[float, float], b: tuple[float, float]) -> tuple[float, float]:
    return (a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0


def _joint(name: str, at: tuple[float, float], fixed_in: str, turning: dict[str, str]) -> str:
    connections = ", ".join(f'{key} = "{body}"' for key, body in turning.items())
    place = [float(x) for x in at]
    return (
        f'[mechanism.joint.{name}]\nat = {place}\nfixed_in = "{fixed_in}"\n'
        f"connections = {{ {connections} }}"
    )


def _body(name: str, mass: float, centre: tuple[float, float], inertia: float) -> str:
    place = [float(x) for x in centre]
    return f"[mechanism.body.{name}]\nmass = {mass}\ncentre = {place}\ninertia = {inertia}"


def _row(text: str, instants: int) -> tuple[str, float, str, float]:
    with tempfile.TemporaryDirectory() as folder:
        study, out = Path(folder, "linkage.toml"), Path(folder, "out")
        study.write_text(text.replace("INSTANTS", str(instants)))
        command = [sys.executable, "-m", "pinstress", "loads", str(study), "--out", str(out)]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, used = os.wait4(process.pid, 0)
        if status:
            raise RuntimeError(f"pinstress loads ended with status {status}")
        report = (out / "report.html").stat().st_size / 1e6
    return f"{instants:,}", used.ru_utime + used.ru_stime, f"{used.ru_maxrss / 1024:.0f}", report
