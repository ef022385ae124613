"""Valid studies drawn at random, by number: each must run, and what does not is judged."""

from __future__ import annotations

import collections
import json
import random
import re
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tests.fuzz import (
    draw_asked,
    draw_cut,
    draw_joint,
    draw_machine,
    draw_mechanism,
    draw_pin,
    draw_space,
)  # fmt: skip
from tests.fuzz.child import MEMORY, MEMORY_OF_CHARTS, End, run
from tests.fuzz.quantity import Tree, write

TOLERANCE = 0.2  # of all studies
OPTIONS = {
    "run": ("--no-cache", "--vtk", "none", "--jobs", "1", "--memory-limit", "2000"),
    "sweep": ("--jobs", "1", "--quiet"),
    "reliability": ("--jobs", "1", "--quiet"),
}
SECONDS = 120  # of processor time

KINDS = ("done", "not all reached", "refused", "numerics", "wrong")  # the first by status

# What a valid study may be refused for, or its numerics fail at, and why that is right. All else
# is a defect.
REASONS = {
    r"dead point at": "the drive would push the linkage past where it can go",
    r"change point at": "two paths cross there",
    r"friction jams": "that much friction leaves no motion, or two",
    r"bushing in lug .* is loose at": "its interference is smaller than what heat takes from it",
    r"reliability needs its yield_strength": "without one there is no factor",
}


@dataclass(frozen=True)
class Study:
    """A drawn study; classes: to which it belongs; command: what it is for."""

    seed: int
    tree: Tree
    classes: frozenset[str]
    command: str = "run"

    def write(self, folder: Path) -> Path:
        """Put it in a folder, in its own spelling of units."""
        return write(self.tree, folder, random.Random(f"spelling {self.seed}"))


@dataclass(frozen=True)
class Result:
    """How a drawn study ended. rows: of its results, each with a verdict."""

    study: Study
    end: End
    rows: tuple[Tree, ...] = ()

    @property
    def kind(self) -> str:
        """The column of the table."""
        if self.end.wrong or self.end.status is None:
            return "wrong"
        return "wrong" if self.end.status < 2 and self._odd else KINDS[self.end.status]

    @property
    def message(self) -> str:
        """What was said, without the study's own names and numbers."""
        if self.kind == "wrong":
            return self.end.wrong or self._odd
        lines = [x for x in self.end.err.splitlines() if not x.startswith(("Warning", "Note"))]
        err = "\n".join(lines)
        said = err.partition("the solution failed: ")[2] or err
        said = re.sub(r"^(\w+ \([-\w]+\)(, |: ))+", "", said.partition("\n")[0])
        said = re.sub(r"Error: |study\.toml(:\d+)?: *|pin [A-Z](: )?", "", said)
        return re.sub(r"[-+]?\d+(\.\d+)?(e[-+]?\d+)?", "#", said)[:120]

    @property
    def judged(self) -> str:
        """Why this end is right; "" for a defect."""
        if self.kind in ("done", "not all reached"):
            return "valid"
        found = (why for sign, why in REASONS.items() if re.search(sign, self.end.err))
        return next(found, "") if self.kind in ("refused", "numerics") else ""

    @property
    def _odd(self) -> str:
        """What is no result of a valid study: all loads here are held or in balance."""
        if self.study.command != "run":
            return ""
        if not self.rows:
            return "no results"
        for row in self.rows:
            if row["verdict"] not in ("converged", "unconverged", "singular"):
                return f"the verdict {row['verdict']}"
            if not 0.0 <= row["max_von_mises"] < 1e13 or not 0.0 <= row["error_estimate"] < 1e13:
                return "a maximum or an error that is no number"
        return ""


def draw(seed: int) -> Study:
    """Of each kind in turn; every second one is asked for more than stress."""
    rng = random.Random(f"study {seed}")
    study, command = KINDS_OF_STUDY[seed % len(KINDS_OF_STUDY)](rng), ["run"]
    tree, classes = study.tree, study.classes
    if seed // len(KINDS_OF_STUDY) % 2:
        tree, more = draw_asked.asked(rng, tree, command)
        classes |= more
    rest = tree.get("analysis", {"limit_load": "never"})
    tree["analysis"] = rest | {"tolerance": TOLERANCE}
    return Study(seed, tree, classes, command[0])


def _head(rng: random.Random) -> Tree:
    return {
        "title": "Drawn at random",
        "units": rng.choice(("in-lbf-s", "mm-N-s", "m-N-s")),
        "material": draw_pin.MATERIALS,
    }


def _with_bronze(rng: random.Random) -> Tree:
    head = _head(rng)
    head["material"] = head["material"] | {"bronze": draw_joint.BRONZE}
    return head


def with_given_loads(rng: random.Random) -> Study:
    """One pin or two, under stated loads in one case or several."""
    classes, pins = {"stated loads"}, {}
    for name in rng.choice(("P", "P", "PQ")):
        shape = draw_pin.profile(rng, rng.choice((1, 1, 2, 3)))
        clamp = draw_pin.clamps(rng, shape)
        clamp = ["start"] if clamp == [] and rng.random() < 0.3 else clamp
        classes |= shape.classes | {_clamped(clamp)}
        names = [f"{name}{i}" for i in range(sum(s.band for s in shape.segments))]
        material = rng.choice(("steel", "steel", "steel", "rubber", "cork"))
        pins[name] = draw_pin.table(shape, clamp, names, material)
    cases = {}
    for name in ("landing", "take-off", "taxi")[: rng.choice((1, 1, 2, 3))]:
        cases[name], kinds = draw_pin.given(rng, pins, name)
        classes |= kinds
    return Study(0, _head(rng) | {"pin": pins, "case": cases}, frozenset(classes))


def _clamped(clamp: list[str]) -> str:
    if not clamp:
        return "balanced"
    return "clamped faces" if {*clamp} <= {"start", "end"} else "clamped segment"


def with_linkage(rng: random.Random) -> Study:
    """A linkage and one or two of its pins."""
    return _on_pins(rng, draw_mechanism.mechanism(rng))


def with_machine(rng: random.Random) -> Study:
    """A machine or a truss and one or two of its pins."""
    return _on_pins(rng, draw_machine.machine(rng))


def in_space(rng: random.Random) -> Study:
    """A linkage in space and one or two of its pins."""
    return _on_pins(rng, draw_space.spatial(rng))


def _on_pins(rng: random.Random, drawn: draw_mechanism.Drawn) -> Study:
    classes, pins = {"linkage", *drawn.classes}, {}
    joints = sorted(name for name, (connections, _) in drawn.joints.items() if connections)
    for joint in rng.sample(joints, min(len(joints), rng.choice((1, 1, 2)))):
        connections, floats = drawn.joints[joint]
        if rng.random() < 0.4 and (len(connections) > 1 or not floats):
            layout = "L" * len(connections)
            layout = layout if floats else f"S{layout}S"
            seat = draw_joint.Seat(rng, joint, layout, connections)
            pins[joint], classes = seat.table, classes | seat.classes
            continue
        shape = draw_pin.profile(rng, len(connections))
        classes |= shape.classes
        clamp = [rng.choice(("start", "end"))]  # links beside each other leave a couple
        pins[joint] = draw_pin.table(shape, clamp, list(connections))
    parts: Tree = {"mechanism": drawn.mechanism, "pin": pins, "case": drawn.cases}
    if "sequence" in classes:
        steps = [{"case": name} | ({} if case["kind"] == "motion" else {"duration": "2 s"})
                 for name, case in drawn.cases.items()]  # fmt: skip
        parts["sequence"] = {"cycle": {"steps": steps * 2}}
    return Study(0, _with_bronze(rng) | parts, frozenset(classes))


def with_joint(rng: random.Random) -> Study:
    """A pin in lugs."""
    pin, forces, classes = draw_joint.joint(rng, "P")
    return _one_pin(rng, pin, forces, classes)


def with_cut(rng: random.Random) -> Study:
    """A pin with a cut or a cone."""
    pin, forces, classes = draw_cut.pin(rng, "P")
    return _one_pin(rng, pin, forces, classes)


def _one_pin(rng: random.Random, pin: Tree, forces: Tree, classes: set[str]) -> Study:
    """One pin in one case or two, the second with part of the forces the other way round."""
    spread = rng.choice(("uniform", "cosine"))
    cases: Tree = {"pull": {"kind": "given", "distribution": spread, "forces": forces}}
    if rng.random() < 0.3:
        back = {name: [f * -0.4 for f in pull] for name, pull in forces.items()}
        cases["push"] = cases["pull"] | {"forces": back}
    return Study(0, _with_bronze(rng) | {"pin": {"P": pin}, "case": cases}, frozenset(classes))


KINDS_OF_STUDY = (
    with_linkage, with_given_loads, with_joint, with_cut, with_machine, with_joint,
    with_given_loads, in_space,
)  # fmt: skip


def ended(seed: int, place: Path) -> Result:
    """Draw a study and run it; it stays in `place` unless all was well."""
    folder = place / f"{seed}"
    folder.mkdir()
    study = draw(seed)
    study.write(folder)
    command = [study.command, "study.toml", *OPTIONS[study.command]]
    memory = MEMORY_OF_CHARTS if study.command == "reliability" else MEMORY
    end, results = run(folder, command, SECONDS, memory), folder / "out" / "study" / "results.json"
    rows = json.loads(results.read_text())["pins"] if results.is_file() else []
    found = Result(study, end, tuple(rows))
    shutil.rmtree(folder / "out", ignore_errors=True)
    if found.judged:
        shutil.rmtree(folder)
        for ending in (".out", ".err"):
            folder.with_suffix(ending).unlink()
    return found


def classes_table(results: list[Result]) -> Iterator[tuple[str | int, ...]]:
    """By class: how many there were, how they ended, and how many are defects."""
    names = sorted({name for r in results for name in r.study.classes})
    for name in ["all", *names]:
        of = [r for r in results if name == "all" or name in r.study.classes]
        kinds = collections.Counter(r.kind for r in of)
        yield (name, len(of), *(kinds[k] for k in KINDS), sum(not r.judged for r in of))


def reasons_table(results: list[Result]) -> Iterator[tuple[str | int, ...]]:
    """What was said by those that have no result: how often, by which first, and the judgement."""
    said: dict[tuple[str, str, str], list[int]] = {}
    for r in results:
        if r.judged != "valid":
            said.setdefault((r.kind, r.message, r.judged), []).append(r.study.seed)
    for (kind, message, judged), seeds in sorted(said.items(), key=lambda x: -len(x[1])):
        yield (kind, len(seeds), ", ".join(map(str, seeds[:8])), judged or "DEFECT", message)
