"""Keys with names in quotes."""

from __future__ import annotations

import tomllib
from pathlib import Path

from pinbase.keys import key_part, lug_key, names_in
from pinstress.study.reading.file import parse_study
from pinstress.study.reading.in_python import changed_study, key_parts, single_keys
from reports.data.requirements import keys_in
from tests.support.each import each
from tests.support.programs.command_line import QUICK


@each(
    "name",
    ['a"b', "a b", "a.b, c", "o'ring", 'a, "b".c', "plain", "a\\n", "5\"'", "'\"\\, b.c'"],
)
def test_all_read_a_name_as_it_is_written(name: str, tmp_path: Path) -> None:
    """One with a double quote stands in single ones, which [vary] refused as no key, and one with
    both is escaped as TOML does.
    """
    assert tomllib.loads(f"{key_part(name)} = 1") == {name: 1}
    key = lug_key(name, "L", "shank")
    assert names_in(key) == ["pin", name, "lug", "L", "shank"]
    study = parse_study(tmp_path / "study.toml", QUICK)
    assert key_parts(study, f"{key}[2].width") == ["pin", name, "lug", "L", "shank", 1, "width"]
    assert keys_in(f"{key}, the pin's contact, {key}") == [key, "the pin's contact", key]
    part = key_part(name)
    both = [f"pin.{part}.profile[1].diameter", f"pin.{part}.band.B.z[1]"]
    assert [*single_keys(f"{both[0]} & band.B.z[1]")] == both


def test_a_value_of_a_material_with_a_double_quote_in_its_name_can_be_changed(
    tmp_path: Path,
) -> None:
    text = QUICK.replace('"AISI 4340"', "'1\" bar'")
    renamed = parse_study(tmp_path / "study.toml", text)
    (name,) = renamed.table.material
    changed = changed_study(renamed, {f"material.{key_part(name)}.poisson_ratio": 0.25})
    assert changed.table.material['1" bar'].poisson_ratio == 0.25
