"""A folder is claimed before anything is computed, so that a second run into it is refused at
once.
"""

from __future__ import annotations

from pathlib import Path
from typing import NoReturn

import pytest

from pinstress.cli import chart, reliability, run
from pinstress.cli.commands import commands
from pinstress.cli.output_folder import replacing
from pinstress.study.reading.errors import InputError
from tests.conftest import ROOT

ARM, CLEVIS = (str(ROOT / "studies" / f"{name}.toml") for name in ("lifting_arm", "clevis"))
FIRST_COMPUTED = {
    "run": (run, "prepare", [CLEVIS]),
    "loads": (run, "loads_only", [ARM]),
    "reliability": (reliability, "prepare", [ARM]),
    "chart": (chart, "plan_chart", [CLEVIS, "--pin", "P", "--case", "pull"]),
}


class _Refused(Exception):
    pass


@pytest.mark.parametrize("name", FIRST_COMPUTED)
def test_a_second_run_is_refused_while_the_first_prepares(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    module, function, arguments = FIRST_COMPUTED[name]

    def second(*_: object, **__: object) -> NoReturn:
        with pytest.raises(InputError, match="another run is writing"), replacing(tmp_path / "out"):
            raise AssertionError("must not get here")
        raise _Refused

    monkeypatch.setattr(module, function, second)
    with pytest.raises(_Refused):
        commands.main([name, *arguments, "--out", str(tmp_path / "out")], standalone_mode=False)
    assert not list(tmp_path.iterdir())
