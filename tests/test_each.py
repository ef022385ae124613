"""Cases in a loop are run all, and told all that fail."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.each import each, in_turn, sampled


def test_all_failures_are_reported_together() -> None:
    seen = []

    @each(("a", "b"), [(1, 1), (1, 2), (3, 3), (4, 5)])
    def compared(a: int, b: int) -> None:
        seen.append(a)
        assert a == b

    with pytest.raises(ExceptionGroup, match="2 of 4 cases failed: a=1, b=2; a=4, b=5") as caught:
        compared()
    assert seen == [1, 1, 3, 4]
    assert [error.__notes__ for error in caught.value.exceptions] == [
        ["case 1: a=1, b=2"],
        ["case 3: a=4, b=5"],
    ]


def test_what_raises_nothing_is_a_failure_too() -> None:
    @each("text", ["1", "x"])
    def refused(text: str) -> None:
        with pytest.raises(ValueError, match="invalid literal"):
            int(text)

    with pytest.raises(BaseExceptionGroup, match="1 of 2 cases failed: text='1'"):
        refused()


@each("name", ["a", "b"])
@each("times", [1, 2])
def test_every_case_has_its_own_folder_output_and_patches(
    name: str,
    times: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert not list(tmp_path.iterdir())
    (tmp_path / name).touch()
    assert not hasattr(pytest, "patched")
    monkeypatch.setattr(pytest, "patched", times, raising=False)
    print(name * times)
    assert capsys.readouterr().out == f"{name * times}\n"


def test_a_sample_is_fixed_and_the_others_are_long() -> None:
    kept, *others = sampled([(1, "a"), (2, "b"), (3, "c")], every=3)
    assert kept == (1, "a")
    assert [(case.values, [m.name for m in case.marks]) for case in others] == [
        ((2, "b"), ["long"]),
        ((3, "c"), ["long"]),
    ]


def test_a_sample_may_begin_later() -> None:
    assert sampled("abc", every=2, first=1)[1] == "b"
    assert [hasattr(case, "marks") for case in sampled("abc", every=2, first=1)] == [
        True,
        False,
        True,
    ]


def test_tests_take_cases_in_turn() -> None:
    """Each runs one in CI, and all of them together run every one."""
    turn = in_turn("seed", (4, 6, 9))

    def run_in_ci() -> list[int]:
        @turn
        def decorated(seed: int) -> None:
            assert seed

        (mark,) = decorated.pytestmark  # type: ignore[attr-defined]
        return [case for case in mark.args[1] if not hasattr(case, "marks")]

    assert [run_in_ci() for _ in range(4)] == [[4], [6], [9], [4]]


def test_a_loop_over_nothing_is_refused() -> None:
    with pytest.raises(ValueError, match="no cases of a"):
        each("a", [])
