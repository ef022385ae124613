"""Where a key stands in a study file: on the line that an editor shows."""

from __future__ import annotations

import os
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import tomlkit
from hypothesis import given, settings
from hypothesis import strategies as st

from pinbase.keys import key_part
from pinstress import InputError, load_study
from pinstress.study.reading.file import parse_study
from pinstress.study.reading.toml_lines import Place, lines_of, places
from tests.conftest import ROOT
from tests.support.each import each

STUDIES = sorted((ROOT / "studies").glob("**/*.toml"))
MARK = "MARK{}KRAM"

KEYS = st.one_of(
    st.sampled_from(["a", "b", "-1", "3.14", "x y", "a.b", 'q"', "[c]", "#", "é\n", "", "value"]),
    st.text(st.characters(exclude_categories=["Cs"]), max_size=4),
)
TEXTS = st.one_of(
    st.sampled_from(["", '"', "'''", "\\", "#", "[x]\ny = 1\n", "}", "a\r\nb", '"""', "é\n\n"]),
    st.text(st.characters(exclude_categories=["Cs"]), max_size=6),
)
LEAVES = st.one_of(TEXTS, st.integers(-9, 9), st.floats(allow_nan=False), st.datetimes())
VALUES = st.recursive(
    LEAVES,
    lambda inner: st.one_of(
        st.lists(inner, max_size=3),
        st.dictionaries(KEYS, inner, max_size=3),
        st.lists(st.dictionaries(KEYS, inner, min_size=1, max_size=3), min_size=1, max_size=3),
    ),
    max_leaves=12,
)


class Writer:
    """A tree as a tomlkit item: strings end in marks of their own, and the forms are drawn."""

    def __init__(self, data: st.DataObject) -> None:
        self.data = data
        self.marks = 0

    def flip(self) -> bool:
        return self.data.draw(st.booleans())

    def filled(self, table: Any, value: dict[str, Any], inline: bool) -> Any:
        for key, inner in sorted(value.items(), key=lambda kv: isinstance(kv[1], dict | list)):
            plain = not isinstance(inner, dict | list)
            parts = [key, "dotted"] if plain and not inline and self.flip() else [key]
            table.append(tomlkit.key(parts), self.item(inner, inline))
            if not inline and self.flip():
                table.add(tomlkit.comment("[not.a.header] \"'''"))
        return table

    def item(self, value: Any, inline: bool) -> Any:
        if isinstance(value, dict):
            if inline or self.flip():
                return self.filled(tomlkit.inline_table(), value, inline=True)
            return self.filled(tomlkit.table(), value, inline=False)
        if isinstance(value, list):
            of_tables = bool(value) and all(isinstance(v, dict) for v in value)
            if of_tables and not inline and self.flip():
                tables = tomlkit.aot()
                for inner in value:
                    tables.append(self.filled(tomlkit.table(), inner, inline=False))
                return tables
            array = tomlkit.array()
            for inner in value:
                array.append(self.item(inner, True))
            return array.multiline(self.flip())
        if isinstance(value, str):
            self.marks += 1
            marked = MARK.format(self.marks) + value
            return tomlkit.string(marked, multiline=self.flip())
        return value


def everything(node: Any, place: Place = ()) -> Iterator[tuple[Place, Any]]:
    """All that a document contains, with its place."""
    if place:
        yield place, node
    if isinstance(node, dict | list):
        for key, value in node.items() if isinstance(node, dict) else enumerate(node):
            yield from everything(value, (*place, key))


@settings(deadline=None)
@given(tree=st.dictionaries(KEYS, VALUES, max_size=4), data=st.data())
def test_a_marked_value_is_found_on_its_line(tree: dict[str, Any], data: st.DataObject) -> None:
    text = tomlkit.dumps(Writer(data).filled(tomlkit.document(), tree, inline=False))
    read, found = dict(everything(tomllib.loads(text))), places(text)
    assert set(found) == set(read)
    for place, value in read.items():
        if isinstance(value, str):
            mark = value[: value.index("KRAM") + 4]
            assert found[place] == text.count("\n", 0, text.index(mark)) + 1


@each("study", STUDIES)
def test_every_key_of_a_study_is_found_as_messages_spell_it(study: Path) -> None:
    text = study.read_text()
    found = places(text)
    assert set(found) == {place for place, _ in everything(tomllib.loads(text))}
    spelled = [
        "".join(f"[{p + 1}]" if isinstance(p, int) else f".{key_part(p)}" for p in place)[1:]
        for place in found
    ]
    assert lines_of(text, [f"{key}: is wrong" for key in spelled]) == list(found.values())


TEXT = (
    """\
title = "all forms"   # [a]
"quoted.key" = 1
dotted."x y".z = '''
[a]
b = 2''''
list = [   # one
  1.5,
  { in = 07:30:00, "it" = [
    "]", 2] },
]

[pin.B.clamp]   # before its table
value = 1
[pin.B]
fillet = { value = [
  1,
  2], provenance = "given" }
[[pin.B.profile]]
length = 1
[[pin.B.profile]]
[[pin.B.profile.hole]]
z = """
    + '"""a""""'
    + """
[[pin.B.profile.hole]]
[pin.B.profile.hole.deep]
x = 1
[drive]   # it's
law = 1
[[load]]
law = 1
"""
)


@each(
    ("message", "line"),
    [
        ("title: is wrong", 1),
        ('"quoted.key": is wrong', 2),
        ("dotted: is wrong", 3),
        ('dotted."x y".z: is wrong', 3),
        ("list: is wrong", 6),
        ("list[1]: is wrong", 7),
        ("list[2].it[1]: is wrong", 9),
        ("list[2].gone[1]: is wrong", 8),
        ("pin: is wrong", 12),
        ("pin.B: is wrong", 14),
        ("pin.B.clamp: is wrong", 12),
        ("pin.B.length: is missing", 14),
        ("pin.B.fillet[2]: is wrong", 17),
        ("pin.B.profile[2]: is wrong", 20),
        ("pin.B.profile[2].hole[1].z: is wrong", 22),
        ("pin.B.profile[2].hole[2].deep.x.y: is wrong", 25),
        ("pin.B.profile[1].hole[1]: is wrong", 18),
        ("pin.B.profile[1]: unknown key 'length'; did you mean 'lenght'?", 19),
        ("pin.B in case.C: is wrong", 14),
        ("unknown key 'drive'; did you mean 'drives'?", 26),
        ("drive[1].law: is wrong", 27),
        ("load.law: is wrong", 29),
        ("pins.B: is wrong", None),
        ("there is no [mechanism]", None),
    ],
)
def test_a_message_has_the_line_of_its_key(message: str, line: int | None) -> None:
    assert lines_of(TEXT, [message]) == [line]


ONE_PIN = (ROOT / "studies" / "one_pin.toml").read_text()


@each(
    ("old", "new", "message"),
    [
        ("diameter = 4.0", "diameter = -4.0", "pin.B.profile[1].diameter: "),
        ("diameter = 4.0", "diametre = 4.0", "pin.B.profile[1]: unknown key 'diametre'"),
        ("tolerance = ", "tolerancy = ", "analysis: unknown key 'tolerancy'"),
        ('"AISI 4340"\nclamp', '"AISI"\nclamp', "pin.B.material: no material 'AISI'"),
        ('kind = "given"', 'kind = "gven"', "case.landing.kind: "),
        ("tolerance = 0.05", "tolerance = [", "not valid TOML: "),
        ("poisson_ratio = 0.30", "poisson_ratio = ", "not valid TOML: "),
        ('["start"]', '["strat"]', "pin.B.clamp[1]: no surface 'strat'; did you mean 'start'?"),
        ("fillet = 0.4", "fillet = 1.1", "pin B: the fillet"),
        ('["start"]', '["B"]', "case.landing: every load on pin B is at a clamped band"),
    ],
)
def test_a_mistake_is_told_with_its_line(tmp_path: Path, old: str, new: str, message: str) -> None:
    from pinstress.analysis.plan import prepare

    assert ONE_PIN.count(old) == 1
    text = ONE_PIN.replace(old, new)
    (path := tmp_path / "study.toml").write_text(text)
    with pytest.raises(InputError) as caught:
        prepare(load_study(path))
    place, _, told = str(caught.value).partition(": ")
    assert told.startswith(message)
    line = int(place.removeprefix(f"{path}:"))
    where = {"every load": "[case.landing]", "the fillet": "diameter = 4.0"}
    wanted = next((v for k, v in where.items() if k in message), new.split("\n")[0].strip())
    assert wanted in text.splitlines()[line - 1]


def test_all_mistakes_are_told_in_the_order_of_the_file(tmp_path: Path) -> None:
    text = ONE_PIN.replace("diameter = ", "diameter = -").replace("0.30", "0.7")
    text = text.replace("required_safety_factor = 10", "fos = 10\nlimit = 9")
    (path := tmp_path / "study.toml").write_text(text)
    with pytest.raises(InputError) as caught:
        load_study(path)
    first, *told = str(caught.value).splitlines()
    lines = [int(each.removeprefix(f"{path}:").partition(":")[0]) for each in told]
    assert first == f"{path}: {len(told)} errors"
    assert lines == sorted(lines)
    signs = ("diameter = -", "0.7", "fos =", "limit =")
    wrong = [i for i, x in enumerate(text.splitlines(), 1) if any(sign in x for sign in signs)]
    assert lines == wrong


def test_a_mistake_is_told_without_any_heavy_library(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(ONE_PIN.replace("0.30", "0.7"))
    code = (
        "import sys; from pinstress.cli.commands import run_command_line as run; "
        "status = run(['check', 'study.toml']); heavy = {'gmsh', 'pyvista', 'matplotlib', 'scipy', "
        "'meshio', 'rich', 'tomlkit'} & set(sys.modules); print(status, sorted(heavy))"
    )
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path, env=environment
    )
    assert done.stdout == "2 []\n"
    assert done.stderr.startswith('Error: study.toml:10: material."AISI 4340".poisson_ratio: ')


@each(
    ("old", "new", "key"),
    [
        ('"given"', '"givn"', 'case."3. wind".kind'),
        ("{ B = [", "{ C = [", 'case."3. wind".forces'),
        ("{ B = [", '{ "B.1" = 3.0, B = [', 'case."3. wind".forces."B.1"'),
    ],
)
def test_messages_quote_the_keys_that_toml_needs_quoted(old: str, new: str, key: str) -> None:
    """The dots of unquoted names read as tables."""
    text = ONE_PIN.replace("[case.landing]", '[case."3. wind"]').replace(old, new)
    line = next(i for i, x in enumerate(text.splitlines(), 1) if new in x)
    with pytest.raises(InputError) as caught:
        parse_study(Path("study.toml"), text)
    assert any(told.startswith(f"study.toml:{line}: {key}") for told in caught.value.lines)
