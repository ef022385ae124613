"""All independent errors of a study are reported together, and nothing that only follows from them.

The reference is the study with each mistake alone: two mistakes must give the errors of both.
"""

from __future__ import annotations

import random
import re
from itertools import combinations
from pathlib import Path

import pytest

import pinstress
from pinstress.study.model.load import load_study
from pinstress.study.reading.errors import InputError
from tests.conftest import ROOT
from tests.fuzz.mutate import line_removed, renamed, retyped, scaled
from tests.support.described import describe
from tests.support.each import each, sampled

BUCKET = (ROOT / "studies" / "bucket.toml").read_text(encoding="utf-8")
MISTAKES = {  # of one kind each: what is replaced, by what, and the message
    "unknown key": ('fixed_in = "bucket"', 'fixed_inn = "bucket"', "unknown key 'fixed_inn'"),
    "wrong type": ("duration = 4", 'duration = "4 in"', "'4 in' is not a time"),
    "out of range": ("samples = 121", "samples = 1", "must be at least 2"),
    "unknown material": ('= "42CrMo4"', '= "42CrMo5"', "no material '42CrMo5'"),
    "unknown body": ('K = "bucket"', 'K = "buckett"', "no body 'buckett'"),
    "unknown joint": ('["W", "X"]', '["W", "V"]', "no joint 'V'"),
    "unknown origin": ('"Y", distance = 0.6', '"U", distance = 0.6', "no joint 'U'"),
    "no inertia": ('inertia = { value = "1.6 kg m^2", provenance = "assumed" }\n', "",
                   "body link: a body without inertia"),
    "no mass": ('mass = { value = "55 kg", provenance = "assumed" }\n', "",
                "body rod: give one of weight, mass or bar"),
    "joint without bodies": ('{ Y = "rocker" }', "{}", "connections: must have at least 1 entry"),
    "unknown surface": ('"right cheek"]', '"right cheeks"]', "no surface 'right cheeks'"),
    "unit": ('"650 MPa"', '"650 Mpa"', "unknown unit 'Mpa'"),
    "misspelt property": ("poisson_ratio", "poison_ratio", "did you mean 'poisson_ratio'?"),
    "no coupling": ('position_of = "cylinder"', 'position_of = "cilinder"', "'cilinder'"),
    "twice": ("[mechanism.point.tip]", '[mechanism.gear.g]\nbodies = ["rocker", "rocker"]\n'
              'joints = ["Y", "X"]\nteeth = [10, 10]\n[mechanism.point.tip]', "twice"),
    "title": ("title = ", "titel = ", "did you mean 'title'?"),
    "no units": ('units = "m-N-s"\n', "", "units: is missing"),
}  # fmt: skip


def errors(path: Path, *mistakes: str) -> set[str]:
    """The messages about the study with these mistakes, without file and line."""
    text = BUCKET
    for name in mistakes:
        old, new, _ = MISTAKES[name]
        assert text.count(old) >= 1, name
        text = text.replace(old, new, 1)
    return errors_of(path, text)


def errors_of(path: Path, text: str) -> set[str]:
    path.write_text(text, encoding="utf-8")
    try:
        describe(load_study(path))
    except InputError as error:
        lines = error.lines
    else:
        return set()
    assert all(line.startswith(str(path)) for line in lines)
    return {re.sub(r"^:\d+|^: ", "", line.removeprefix(str(path))) for line in lines}


REQUIREMENT = """
[[require]]
pins = ["Q"]
cases = ["digg"]
check = "sheer"
level = "limt"
factor = 0
"""


def test_all_mistakes_of_a_requirement_and_of_a_segment(tmp_path: Path) -> None:
    """Names of pins and cases came only after check and factor were right, and a bore only after
    the other errors of its pin.
    """
    segment = '{ length = "120 mm", diameter = "80 mm", connection = "Z"'
    assert segment in BUCKET
    wrong = segment.replace('"Z"', '"Z9", bore = "90 mm"')
    found = errors_of(tmp_path / "study.toml", BUCKET.replace(segment, wrong) + REQUIREMENT)
    for text in ("no pin 'Q'", "no case 'digg'", "require[1].check: must be ", "[1].level: must be",
                 "require[1].factor: must be greater than 0", "profile[2].bore: must be less",
                 "connection 'Z9' is not in the mechanism"):  # fmt: skip
        assert sum(text in line for line in found) == 1, text
    assert len(found) == 7


@pytest.mark.parametrize("key", ["check", "factor"])
def test_what_stands_for_a_wrong_requirement_is_not_wrong(tmp_path: Path, key: str) -> None:
    """The check that stands for a wrong one is neither required twice nor at another level."""
    one = '[[require]]\ncheck = "rupture"\nlevel = "ultimate"\nfactor = 1.5\n'
    two = '[[require]]\ncheck = "yield"\nfactor = 1.5\n'
    wrong = re.sub(rf"^{key} = .*$", f'{key} = "x"', one, flags=re.MULTILINE)
    (line,) = errors_of(tmp_path / "study.toml", BUCKET + wrong + two)
    assert f"require[1].{key}" in line


ONE_PIN = (ROOT / "studies" / "one_pin.toml").read_text(encoding="utf-8")
CLEVIS = (ROOT / "studies" / "clevis.toml").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("profile", "wrong", "named"),
    [
        ("fillet = 0.4", "fillet = 3", "the fillet between segments 1 and 2"),  # no such shape
        ("length = 2.0", "length = -2.0", "profile[2].length: must be positive"),
    ],
)
def test_a_clamp_of_a_wrong_profile(profile: str, wrong: str, named: str, tmp_path: Path) -> None:
    """Clamps were looked up on the shape of the pin, so after what is wrong with it."""
    clamps = '[case.landing]\nclamp = { B = ["roof"] }'
    text = ONE_PIN.replace(profile, wrong).replace('["start"]', '["strat", "segment 2", "B"]')
    found = errors_of(tmp_path / "study.toml", text.replace("[case.landing]", clamps))
    for part in ("pin.B.clamp[1]: no surface 'strat'; did you mean 'start'?", named,
                 "case.landing.clamp.B[1]: no surface 'roof'"):  # fmt: skip
        assert sum(part in line for line in found) == 1, part
    assert len(found) == 3


def test_a_fit_beside_other_mistakes(tmp_path: Path) -> None:
    """Fits were looked up with the lugs, so after all that is wrong with pins; and where defaults
    gave them, the line of a lug was named.
    """
    text = CLEVIS.replace("clearance = 0.05", 'fit = "X7/f7"').replace("length = 20", "length = 0")
    text = text.replace('{ tilt = "guided" }', '{ fit = "H7/f3" }')
    found = errors_of(tmp_path / "study.toml", text)
    for part in ("lug_defaults.fit: deviation X is not included", "length: must be positive",
                 "pin.P.lug.EYE.fit: f3 is not included: the grades"):  # fmt: skip
        assert sum(part in line for line in found) == 1, part
    assert len(found) == 3


def test_a_table_of_forces_beside_other_mistakes(tmp_path: Path) -> None:
    """Tables were read after the content of the study was right; without a pin's connections what
    they name is not known to be wrong.
    """
    more = '\n[case.more]\nkind = "given"\ntable = "gone.csv"\n'
    gone = "gone.csv: no such file"
    found = errors_of(tmp_path / "study.toml", (ONE_PIN + more).replace('["start"]', '["strat"]'))
    assert any(gone in line for line in found), found
    assert len(found) == 2
    found = errors_of(tmp_path / "study.toml", (ONE_PIN + more).replace("profile =", "profil ="))
    assert not any(gone in line for line in found), found


def test_six_mistakes_of_different_kinds(tmp_path: Path) -> None:
    """Schema, references, masses, joints and shapes: one round instead of four."""
    six = ("unknown key", "wrong type", "unknown material", "unknown joint", "no inertia",
           "joint without bodies")  # fmt: skip
    messages = errors(tmp_path / "bucket.toml", *six)
    assert len(messages) == len(six), messages
    for name in six:
        assert any(MISTAKES[name][2] in message for message in messages), name


@each("name", list(MISTAKES))
def test_a_mistake_alone_is_one_error(name: str, tmp_path: Path) -> None:
    (message,) = errors(tmp_path / "bucket.toml", name)
    assert MISTAKES[name][2] in message


def test_two_mistakes_give_the_errors_of_both(tmp_path: Path) -> None:
    path = tmp_path / "bucket.toml"
    alone = {name: errors(path, name) for name in MISTAKES}
    for one, other in combinations(MISTAKES, 2):
        assert errors(path, one, other) == alone[one] | alone[other], (one, other)


@pytest.mark.parametrize("seed", sampled(range(400), 20))
def test_several_mutations_end_without_a_traceback(seed: int, tmp_path: Path) -> None:
    """Whatever remains of the study can be looked at."""
    rng = random.Random(seed)
    text = BUCKET
    for _ in range(rng.randint(2, 8)):
        text = rng.choice((line_removed, renamed, retyped, scaled))(text, rng)
    errors_of(tmp_path / "bucket.toml", text)


def test_run_and_check_report_the_same(tmp_path: Path) -> None:
    """Also where reading the file alone finds nothing: masses, shapes and tables."""
    path = tmp_path / "bucket.toml"
    text = BUCKET + '\n[case.more]\nkind = "given"\ntable = "gone.csv"\n'
    for name in ("no inertia", "unknown surface"):
        text = text.replace(*MISTAKES[name][:2], 1)
    path.write_text(text, encoding="utf-8")
    lines = []
    for command in (describe, pinstress.prepare):
        with pytest.raises(InputError) as error:
            command(load_study(path))
        lines.append(set(error.value.lines))
    assert lines[0] == lines[1]
    assert len(lines[0]) == 3
