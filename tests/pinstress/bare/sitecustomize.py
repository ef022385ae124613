"""Makes a Python on Linux as poor as those of other systems; imported at its start from PYTHONPATH,
also in the processes that it starts.
"""

import importlib.abc
import os
import signal
import sys
from typing import Any

BLOCKED = {
    *("resource", "fcntl", "pwd", "grp", "termios", "tty", "pty", "syslog"),
    *("cvxopt", "pymetis", "pypardiso"),
}
OF_OS = [
    *("fork", "forkpty", "geteuid", "sched_getaffinity", "killpg", "setsid", "mkfifo", "fchdir"),
    *("O_NOFOLLOW", "O_DIRECTORY", "O_NONBLOCK", "O_NOCTTY", "O_CLOEXEC", "O_PATH", "statvfs"),
]
OF_SIGNAL = [
    *("SIGALRM", "SIGHUP", "SIGPIPE", "SIGXCPU", "SIGKILL", "alarm", "setitimer"),
    *("pthread_sigmask", "sigwait", "set_wakeup_fd"),
]


class Blocked(importlib.abc.MetaPathFinder):
    def find_spec(self, name: str, *_: object) -> None:
        if name.partition(".")[0] in BLOCKED:
            raise ImportError(f"{name} is not on this system", name=name)


def as_on_windows(rename: Any) -> Any:
    def refuses(source: str, target: str) -> None:
        if os.path.lexists(target):
            raise FileExistsError(17, "File exists", str(source), None, str(target))
        rename(source, target)

    return refuses


sys.meta_path.insert(0, Blocked())
for blocked in BLOCKED:
    sys.modules.pop(blocked, None)
for name in OF_OS:
    delattr(os, name)
for name in OF_SIGNAL:
    delattr(signal, name)
os.rename = as_on_windows(os.rename)
