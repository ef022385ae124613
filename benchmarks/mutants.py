"""Mutation testing of formulas: `make mutants`, or `python -m benchmarks.mutants FILE`.

One operator, comparison, sign or number of a file is changed at a time; the tests of the file must
then fail. Nothing is written to the tree: a forked process, in which pytest and the numeric
libraries are loaded already, imports the changed module in place of the file. mutmut works in a
similar way, but changes neither tables of numbers nor properties, in which many of these formulas
are.

Changes that no test detects because the file means the same are in SAME with the reason; any other
such change ends the command with status 1. With --record the rows of the tested files replace those
in docs/measured.
"""

from __future__ import annotations

import ast
import copy
import importlib.util
import os
import random
import re
import signal
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.machinery import ModuleSpec
from types import ModuleType

import numpy as np  # loaded once for all
import pytest
import scipy.optimize
import scipy.sparse.linalg
import skfem

from benchmarks.record import FOLDER, record

LOADED = (np, scipy, skfem)
PRINTED = ("tests/assess/clauses/test_work_of_every_check.py",)  # of every clause and hand check
FILES = {
    "fea/beam/stress_concentration.py": ("tests/fea/beam/test_notch.py",
                                         "tests/fea/beam/test_beam_stress.py"),
    "assess/strength/hand_checks.py": ("tests/assess/strength/test_hand_checks.py", *PRINTED),
    "fea/beam/timoshenko.py": ("tests/fea/beam/test_stepped_beam.py",
                                "tests/fea/beam/test_line_load.py",
                                "tests/fea/support/contact/test_slip.py",
                                "tests/fea/beam/test_beam_stress.py"),
    "fea/solid/assembly.py": ("tests/fea/solid/test_elasticity.py",),
    "fea/singular/williams.py": ("tests/fea/singular/test_corner.py",
                                 "tests/fea/singular/test_singular_interval.py",
                                 "tests/fea/singular/test_corner_determinant.py"),
    "fea/core/tractions.py": ("tests/fea/core/test_bearing_pressure.py",
                               "tests/fea/core/test_fading_shear.py",
                               "tests/fea/harmonic/test_harmonic.py"),
    "assess/opinion/cantilever.py": ("tests/assess/opinion/test_distributed_load.py",
                                     "tests/assess/opinion/test_beam_check.py"),
    "loads/forces/inverse_dynamics.py": (
        "tests/loads/forces/test_energy.py", "tests/loads/motion/test_four_bar.py",
        "tests/loads/motion/test_slider_crank.py", "tests/loads/forces/test_reactions.py",
        "tests/loads/forces/test_structures.py"),
    "loads/forces/force_balance.py": (
        "tests/loads/forces/test_energy.py", "tests/loads/motion/test_four_bar.py",
        "tests/loads/motion/test_slider_crank.py", "tests/loads/forces/test_reactions.py",
        "tests/loads/forces/test_structures.py"),
    "loads/forces/power_balance.py": (
        "tests/loads/forces/test_energy.py", "tests/loads/motion/test_slider_crank.py"),
    "fea/beam/round_section.py": ("tests/fea/beam/test_stepped_beam.py",
                                  "tests/fea/beam/test_beam_stress.py",
                                  "tests/assess/strength/test_strength.py"),
    "fea/beam/plastic_interaction.py": ("tests/fea/beam/test_plastic_use.py",
                                        "tests/assess/plastic/test_hinge.py",
                                        "tests/silent/test_limit_load_bounds.py"),
    "fea/singular/lug_edge.py": ("tests/fea/singular/test_lug_edge.py",),
    "fea/support/contact/edge_peak.py": ("tests/fea/support/contact/test_edge_peak.py",),
    "fea/support/contact/flexibility.py": ("tests/fea/support/contact/test_bushing.py",
                                           "tests/fea/support/contact/test_joint_flexibility.py"),
    "fea/support/foundation/plane_contact.py": (
        "tests/fea/support/foundation/test_plane_contact.py",),
    "fea/support/lugs/fit.py": ("tests/fea/support/lugs/test_fit.py",
                                "tests/silent/test_ranges_of_press_fits.py"),
    "fea/support/lugs/thermal.py": ("tests/fea/support/lugs/test_thermal.py",),
    "fea/lug/lug_load.py": ("tests/fea/lug/test_lug_load.py", "tests/fea/lug/test_lug_stress.py",
                            "tests/fea/lug/test_shank_bending.py"),
    "fea/lug/shank_bending.py": ("tests/fea/lug/test_shank_bending.py",),
    "fea/lug/through_thickness.py": ("tests/fea/lug/test_eye_stress.py",
                                     "tests/fea/lug/test_lug_stress.py"),
    "assess/clauses/affdl_joint.py": ("tests/assess/clauses/test_affdl.py", *PRINTED),
    "assess/clauses/affdl_lugs.py": ("tests/assess/clauses/test_affdl.py",
                                     "tests/assess/clauses/test_melcon_hoblit.py"),
    "assess/clauses/aisc_d5.py": ("tests/assess/clauses/test_aisc_d5.py", *PRINTED),
    "assess/clauses/bth1.py": ("tests/assess/clauses/test_bth1.py", *PRINTED),
    "assess/clauses/cozzone.py": ("tests/assess/clauses/test_cozzone.py", *PRINTED),
    "assess/clauses/ekvall.py": ("tests/assess/clauses/test_ekvall.py",
                                 "tests/assess/clauses/test_melcon_hoblit.py", *PRINTED),
    "assess/clauses/eurocode_sections.py": (
        "tests/assess/clauses/test_eurocode_sections.py", *PRINTED),
    "assess/clauses/melcon_hoblit.py": (
        "tests/assess/clauses/test_melcon_hoblit.py", *PRINTED),
    "assess/strength/eurocode_pins.py": ("tests/assess/strength/test_strength.py",),
    "assess/fatigue/critical_plane.py": ("tests/assess/fatigue/test_fatigue.py",),
    "assess/fatigue/fkm.py": ("tests/assess/fatigue/test_fatigue.py",
                              "tests/silent/test_fatigue_history.py"),
    "assess/fatigue/sn_curve.py": ("tests/assess/fatigue/test_fatigue.py",
                                   "tests/silent/test_fatigue_history.py"),
    "loads/landing/drop.py": ("tests/loads/landing/test_landing.py",),
    "loads/landing/strut.py": ("tests/loads/landing/test_landing.py",
                               "tests/loads/landing/test_through.py"),
    "loads/landing/tyre.py": ("tests/loads/landing/test_landing.py",),
    "loads/linkage/gears.py": ("tests/loads/linkage/test_gears.py",),
    "loads/space/pose.py": ("tests/loads/space/test_pose.py",
                            "tests/loads/space/test_equations.py"),
    "loads/space/stiffness.py": ("tests/loads/space/test_stiffness.py",),
    "loads/landing/impulse.py": ("tests/loads/forces/test_reactions.py",),
}  # fmt: skip
ARITHMETIC = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
              ast.Pow: ast.Mult, ast.MatMult: ast.Mult}  # fmt: skip
COMPARISON = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt,
              ast.Eq: ast.NotEq, ast.NotEq: ast.Eq}  # fmt: skip
# Changes of a line that do not change the result, with the reason; no test could detect them.
SAME = {
    ("return (tuple(Traction(b.name, 0.0, ABOUT_Z * b.radius, _NO_TRACTION) for b in bands),)",
     "0.0 → 1.0"): "the middle from which a slope of zero is counted",
    ("return root if root.real < 1.0 else 1.0 + 0.0j", "root.real < 1.0 → root.real <= 1.0"):
        "an eigenvalue of exactly 1 is what the other branch returns",
    ("return _root(lambda x: math.sin(x) - q * x, math.pi / 2.0, math.pi + 1e-9)", "2.0 → 2.2"):
        "a wider bracket about the only root",
    ("return float(brentq(function, low, high, xtol=1e-15, rtol=1e-15))",
     "1e-15 → 1.1000000000000001e-15"): "both tolerances are round-off",
    ("return 1.0 + 0.0j", "1.0 + 0j → 1.0 - 0j"):
        "the sign of an imaginary part of zero",
    ("return exponent if exponent > EXPONENT_ROUND_OFF else 0.0",
     "exponent > EXPONENT_ROUND_OFF → exponent >= EXPONENT_ROUND_OFF"):
        "an exponent of exactly the round-off is none either way",
    ("return np.asarray(z[np.r_[True, np.diff(z) > 1e-12 * pin.length]])",
     "1e-12 → 1.1000000000000002e-12"): "both distances are round-off",
    ("yield from np.linspace(z, z + s.length, math.ceil(change / MAX_CONE_CHANGE) + 1)[",
     "1 → 2"): "a cone has one cell more than is required",
    ('_UNIT_MATERIAL = Material("any", 1.0, 0.0)', "1.0 → 1.1"):
        "the beam is statically determinate: no material has an effect",
    ("return float(brentq(lambda L: _h(L, share, RIGHT_ANGLE), 1.2, 2.0, xtol=1e-12)) - 1.0",
     "1.2 → 1.32"): "a narrower bracket about the same root, which is from 1.5 to 2",
    ("return slider.name, along * (1.0 if slider.moving == side.body else -1.0)",
     "along * (1.0 if slider.moving == side.body else -1.0) → "
     "along / (1.0 if slider.moving == side.body else -1.0)"): "the factor is 1 or -1",
    ("unit = [(Traction(name, 0.0, self.pushed, NO_SLOPE),) for name in self.rings]",
     "0.0 → 1.0"): "the middle from which a slope of zero is counted",
    ("body = HarmonicBody(eye, Section(eye_mesh(eye, across)), lug.material, pivot=0.5)",
     "0.5 → 0.55"): "when rows are exchanged in a factorisation; the solution is the same",
    ("pulled = np.where(size > 0.0, np.maximum(-along, 0.0) / np.where(size > 0.0, size, 1.0), "
     "0.0)",
     "1.0 → 1.1"): "where the force is zero, the quotient is not used",
    ("return np.where(size > 0.0, np.maximum(along, 0.0) / np.where(size > 0.0, size, 1.0), 1.0)",
     "1.0 → 1.1"): "where the force is zero, the quotient is not used",
    ("FRAME_ROTATIONS = np.array(list(product((0.0, 1.0, -1.0), repeat=3)))  # about the axes of a "
     "frame",
     "1.0 → 1.1"): "steps of a search, each of which is followed by a step of half its size",
    ("frames = grid.reshape(-1, 3, 3)[_starts(grid, rank(grid.reshape(-1, 3, 3)))]", "1 → 2"):
        "NumPy finds a length that is any negative number",
    ("for a in np.radians(np.arange(0.0, 90.0 + 0.5 * PLANE_STEP, PLANE_STEP)):",
     "90.0 → 99.00000000000001"): "planes beyond the equator, which are those opposite to them",
    ("count = 8 * round(360.0 * np.sin(a) / PLANE_STEP / 8.0) or 1", "1 → 2"):
        "the plane at the pole twice",
    ("return max(every, key=lambda p: (life.damage(p.equivalent).sum(), "
     "p.equivalent.max(initial=0)))",
     "0 → 1"): "below 1 Pa the first plane is taken, and the planes come in order, the worst first",
    ("n, fu = hardening_exponent(material, ultimate_strain), material.ultimate_strength or 0.0",
     "0.0 → 1.0"): "without an ultimate strength the exponent before it has raised the error",
    ("fu, f_0 = material.ultimate_strength or 0.0, trapezoid_stress(material, ultimate_strain)",
     "0.0 → 1.0"): "without an ultimate strength the stress after it raises the error",
    ("return 1 if float(forces(d, y, replace(mode, wheel=0)).drag) >= 0.0 else -1",
     "0.0 → 1.0"): "where a wheel breaks away the drag is that of its grip, beyond a newton",
    ("direction = (holding_force > high) - (holding_force < low)",
     "holding_force < low → holding_force <= low"): "a force exactly at the limit holds or not",
}  # fmt: skip
OFF = 1.1  # factor by which a number is changed
MOST = 40  # largest number of mutants of a file, drawn at random
PATIENCE = 10.0  # time limit over the time of the tests without a change


@dataclass(frozen=True)
class Mutant:
    """A changed module. change: in words."""

    line: int
    change: str
    tree: ast.Module


def mutants(source: str) -> Iterator[Mutant]:
    """Yield every single change of a module."""
    tree = ast.parse(source)
    nodes = list(ast.walk(tree))
    for place, node in enumerate(nodes):
        changed = _changed(node)
        if changed is None:
            continue
        other = copy.deepcopy(tree)
        target = list(ast.walk(other))[place]
        for name, value in ast.iter_fields(changed):
            setattr(target, name, value)
        target.__class__ = changed.__class__
        words = f"{ast.unparse(node)} → {ast.unparse(changed)}"
        yield Mutant(getattr(node, "lineno", 0), " ".join(words.split()), other)


def _changed(node: ast.AST) -> ast.expr | None:
    match node:
        case ast.BinOp(left, op, right) if type(op) in ARITHMETIC:
            if isinstance(right, ast.Constant) and isinstance(right.value, str):
                return None
            return ast.BinOp(left, ARITHMETIC[type(op)](), right)
        case ast.Compare(left, [op], right) if type(op) in COMPARISON:
            return ast.Compare(left, [COMPARISON[type(op)]()], right)
        case ast.BoolOp(op, values):
            return ast.BoolOp(ast.Or() if isinstance(op, ast.And) else ast.And(), values)
        case ast.UnaryOp(ast.USub(), operand):
            return ast.UnaryOp(ast.UAdd(), operand)
        case ast.Constant(bool() | str() | None):
            return None
        case ast.Constant(int() as value):
            return ast.Constant(value + 1)
        case ast.Constant(float() as value):
            return ast.Constant(value * OFF if value else 1.0)
    return None


class _Instead:
    """An import finder and loader that loads a changed module in place of its file."""

    def __init__(self, name: str, path: str, tree: ast.Module) -> None:
        self.name, self.path, self.tree = name, path, tree

    def find_spec(self, name: str, *_: object) -> ModuleSpec | None:
        if name != self.name:
            return None
        return importlib.util.spec_from_file_location(name, self.path, loader=self)  # type: ignore[arg-type]

    def create_module(self, _: ModuleSpec) -> None:
        return None

    def exec_module(self, module: ModuleType) -> None:
        exec(compile(ast.fix_missing_locations(self.tree), self.path, "exec"), module.__dict__)


def survives(path: str, tree: ast.Module, tests: Sequence[str], limit: float) -> bool:
    """Return whether all tests pass with a changed module; they fail if they take longer than the
    limit, s.
    """
    child = os.fork()
    if not child:
        os.setsid()  # a group with the processes that it starts, which is killed together
        sys.meta_path.insert(0, _Instead(path[:-3].replace("/", "."), path, tree))
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 1)
        os.dup2(nowhere, 2)
        plain = ["-q", "-x", "-p", "no:cacheprovider", "-p", "no:cov"]
        os._exit(int(pytest.main([*plain, "-m", "not slow and not peers", *tests])))
    end = time.monotonic() + limit
    while time.monotonic() < end:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return os.waitstatus_to_exitcode(status) == 0
        time.sleep(0.02)
    os.killpg(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return False


def examined(path: str, most: int) -> tuple[list[str], bool]:
    """Return the rows of the table for a file, the first for all of it, and whether every survivor
    is explained.

    Raises: SystemExit if the tests fail without a change.
    """
    with open(path, encoding="utf-8") as file:
        source = file.read()
    start = time.monotonic()
    if not survives(path, ast.parse(source), FILES[path], 600.0):
        raise SystemExit(f"{path}: its tests fail without a change")
    limit = PATIENCE * (time.monotonic() - start) + 5.0
    every = list(mutants(source))
    drawn = sorted(random.Random(0).sample(every, min(most, len(every))), key=lambda m: m.line)
    left = [m for m in drawn if survives(path, m.tree, FILES[path], limit)]
    killed = len(drawn) - len(left)
    rows = [f"| `{path}` | {len(every)} | {len(drawn)} | {killed} | {len(left)} | |"]
    reasons = [SAME.get((source.splitlines()[m.line - 1].strip(), m.change)) for m in left]
    for m, why in zip(left, reasons, strict=True):
        change = m.change.replace("|", "\\|")
        rows.append(f"| … line {m.line}: `{change}` | | | | | {why or '**not explained**'} |")
    return rows, None not in reasons


def recorded() -> dict[str, list[str]]:
    """Return the rows of every file in the recorded table."""
    path, out = FOLDER / "mutants.md", dict[str, list[str]]()
    for row in path.read_text(encoding="utf-8").splitlines() if path.is_file() else ():
        if first := re.match(r"\| `([\w/]+\.py)` \|", row):
            out[first[1]] = [row]
        elif row.startswith("| … ") and out:
            out[next(reversed(out))].append(row)
    return out


def table(rows: dict[str, list[str]]) -> str:
    """Return the table of all files, in their order."""
    lines = ["| file | changes | tried | noticed | left | because |", "| --- |" + 5 * " --- |"]
    return "\n".join(lines + [row for path in FILES for row in rows.get(path, ())])


def main(arguments: list[str]) -> int:
    """Print the table of all files or the named ones; --record keeps it, --most=N tests N mutants
    of each.
    """
    named = [a for a in arguments if not a.startswith("--")]
    most = next((int(a[7:]) for a in arguments if a.startswith("--most=")), MOST)
    rows, explained = dict[str, list[str]](), True
    for path in named or FILES:
        rows[path], all_of_it = examined(path, most)
        explained = explained and all_of_it
        print("\n".join(rows[path]), flush=True)
        if "--record" in arguments:
            command = f"python -m benchmarks.mutants --most={most}"
            record("mutants", table(recorded() | rows), command)
    return 0 if explained else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
