"""Limits of control groups as the kernel writes them, below a folder that stands for the root."""

from __future__ import annotations

from pathlib import Path

import pytest

from pinbase.processes import free_memory
from pinbase.processes.free_memory import free_in_groups
from tests.support.each import each

MB = 2**20
UNLIMITED = 9223372036854771712  # what the first version says when there is no limit
BOX = "/docker/3f9a"


def machine(root: Path, groups: str, files: dict[str, object]) -> Path:
    """A root with /proc/self/cgroup and files below /sys/fs/cgroup."""
    (root / "proc" / "self").mkdir(parents=True)
    (root / "proc" / "self" / "cgroup").write_text(groups)
    for name, content in files.items():
        path = root / "sys" / "fs" / "cgroup" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"{content}\n")
    return root


@each(
    ("groups", "files", "free"),
    [
        # the second version, with the group's own path
        (
            "0::/job/step\n",
            {"job/step/memory.max": 512 * MB, "job/step/memory.current": 112 * MB},
            400,
        ),
        # the page cache of this group is given up first
        (
            "0::/job\n",
            {
                "job/memory.max": 512 * MB,
                "job/memory.current": 500 * MB,
                "job/memory.stat": f"anon 1\nfile {400 * MB}\ninactive_file {388 * MB}",
            },
            400,
        ),
        # a parent allows less than the group itself does; the top has no such file
        (
            "0::/batch/job\n",
            {
                "batch/memory.max": 300 * MB,
                "batch/memory.current": 200 * MB,
                "batch/job/memory.max": "max",
                "batch/job/memory.high": 900 * MB,
                "batch/job/memory.current": 100 * MB,
            },
            100,
        ),
        # above memory.high the kernel slows a process down to nothing
        (
            "0::/job\n",
            {"job/memory.max": "max", "job/memory.high": 70 * MB, "job/memory.current": 30 * MB},
            40,
        ),
        # a container with a namespace of its own sees itself at the top
        ("0::/\n", {"memory.max": 64 * MB, "memory.current": 14 * MB}, 50),
        # and one without has the host's path, but only its own group mounted
        (f"0::{BOX}\n", {"memory.max": 64 * MB, "memory.current": 24 * MB}, 40),
        # a process outside the namespace it looks from
        (f"0::/../..{BOX}\n", {"memory.max": 64 * MB, "memory.current": 24 * MB}, 40),
        # more is used already than a limit that was lowered
        ("0::/job\n", {"job/memory.max": MB, "job/memory.current": 2 * MB}, 0),
        # the first version, alone or beside the second
        (
            f"7:cpu,memory:{BOX}\n1:name=systemd:/\n0::/\n",
            {
                f"memory{BOX}/memory.limit_in_bytes": 256 * MB,
                f"memory{BOX}/memory.usage_in_bytes": 156 * MB,
                f"memory{BOX}/memory.stat": f"inactive_file 1\ntotal_inactive_file {20 * MB}",
                "memory/memory.limit_in_bytes": UNLIMITED,
                "memory/memory.usage_in_bytes": 9 * MB,
            },
            120,
        ),
        (
            f"4:memory:{BOX}\n",
            {"memory/memory.limit_in_bytes": 96 * MB, "memory/memory.usage_in_bytes": 90 * MB},
            6,
        ),
    ],
)
def test_the_tightest_group_counts(
    tmp_path: Path, groups: str, files: dict[str, object], free: float
) -> None:
    assert free_in_groups(machine(tmp_path, groups, files)) == free


@each("groups", ["", "0::/job\n", "3:cpu:/job\n", "3:memory:/job\n", "nonsense"])
def test_without_a_limit_it_is_infinite(tmp_path: Path, groups: str) -> None:
    files: dict[str, object] = {
        "job/memory.max": "max",
        "job/memory.current": 5,
        "memory/job/memory.limit_in_bytes": UNLIMITED,
        "memory/job/memory.usage_in_bytes": 5,
    }
    assert free_in_groups(machine(tmp_path, groups, files)) == float("inf")
    assert free_in_groups(tmp_path / "nowhere") == float("inf")


@pytest.mark.linux
def test_a_container_is_allowed_what_it_has_not_what_the_machine_has(tmp_path: Path) -> None:
    machine(tmp_path, "0::/\n", {"memory.max": 1500 * MB, "memory.current": 500 * MB})
    (tmp_path / "proc" / "meminfo").write_text("MemTotal: 1 kB\nMemAvailable: 67108864 kB\n")
    assert free_memory.free_memory(tmp_path) == 1000.0
    assert free_memory.free_memory(machine(tmp_path / "bare", "", {})) == 4096.0
    (tmp_path / "proc" / "meminfo").write_text("MemTotal: 1 kB\nMemAvailable: 204800 kB\n")
    assert free_memory.free_memory(tmp_path) == 200.0
