#!/bin/sh
# Makes .venv with everything pinstress needs, and installs or names what the system lacks.
# make runs it when .venv/.ready is missing or older than what it depends on.
# PYTHON=/path/to/python chooses the interpreter.
set -eu
cd "$(dirname "$0")/.."

say() { printf 'setup: %s\n' "$1"; }
complain() { printf 'setup: %s\n' "$@" >&2; }
fail() {
    complain "$@"
    exit 1
}

# --- the interpreter ----------------------------------------------------------------------

# The locked packages have wheels for these; for others they would have to be compiled.
usable() {
    "$1" -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] <= (3, 14))' 2>/dev/null
}

[ "$(uname -sm)" = "Linux x86_64" ] ||
    fail "the locked packages have wheels for Linux on x86_64; this is $(uname -sm)."

python=
for candidate in ${PYTHON:-python3 python3.14 python3.13 python3.12 python3.11}; do
    if usable "$candidate"; then
        python=$candidate
        break
    fi
done
[ -n "$python" ] ||
    fail "found no Python 3.11, 3.12, 3.13 or 3.14 as ${PYTHON:-python3 or python3.11 to python3.14}." \
        "Debian 12, Ubuntu 24.04: apt-get install python3 python3-venv" \
        "One that is elsewhere: make setup PYTHON=/path/to/python"
say "$("$python" -c 'import platform, sys; print("Python", platform.python_version(), sys.executable)')"

# --- what the system must bring -----------------------------------------------------------

# "lacking run" prints the Debian packages without which pinstress does not run, "lacking
# pictures" the word renderer if VTK has nothing to draw with. The dynamic loader is asked, not
# the package manager: what counts is whether the wheels find the library.
lacking() {
    "$python" - "$1" <<'END'
import ctypes
import importlib.util
import sys

GMSH = {
    "libGL.so.1": "libgl1",
    "libGLU.so.1": "libglu1-mesa",
    "libX11.so.6": "libx11-6",
    "libXcursor.so.1": "libxcursor1",
    "libXext.so.6": "libxext6",
    "libXfixes.so.3": "libxfixes3",
    "libXft.so.2": "libxft2",
    "libXinerama.so.1": "libxinerama1",
    "libXrender.so.1": "libxrender1",
    "libfontconfig.so.1": "libfontconfig1",
    "libgomp.so.1": "libgomp1",
}


def loads(library):
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


if sys.argv[1] == "run":
    if not all(importlib.util.find_spec(module) for module in ("venv", "ensurepip")):
        print("python{}.{}-venv".format(*sys.version_info))
    for library, package in GMSH.items():
        if not loads(library):
            print(package)
elif not any(map(loads, ("libOSMesa.so.8", "libEGL_mesa.so.0", "libEGL_nvidia.so.0"))):
    print("renderer")
END
}

# Newer Debian and Ubuntu have no libosmesa6.
renderer() {
    if apt-cache show libosmesa6 >/dev/null 2>&1; then
        echo libosmesa6
    else
        echo libegl1 libgl1-mesa-dri
    fi
}

packages() {
    # shellcheck disable=SC2046,SC2086  # one line from many words
    echo $run $([ -z "$pictures" ] || renderer)
}

run=$(lacking run)
pictures=$(lacking pictures)

if [ -n "$run$pictures" ] && [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    apt-get update -qq || complain "apt-get update failed; trying with the old lists"
    say "apt-get install $(packages)"
    # shellcheck disable=SC2046  # a list of names
    DEBIAN_FRONTEND=noninteractive apt-get install -qq --no-install-recommends $(packages) \
        </dev/null >/dev/null || complain "apt-get install failed"
    run=$(lacking run)
    pictures=$(lacking pictures)
fi
if [ -n "$run" ]; then
    fail "the system lacks packages without which pinstress does not run. On Debian and Ubuntu:" \
        "sudo apt-get install --no-install-recommends $(packages)"
elif [ -n "$pictures" ]; then
    complain "nothing to draw with off-screen: reports will lack their pictures. To have them:" \
        "sudo apt-get install --no-install-recommends $(packages)"
fi

# --- .venv --------------------------------------------------------------------------------

# .venv/.ready holds what .venv was made from. It is written last and removed first, so that an
# interrupted run leaves a .venv that the next one throws away.
from=$(
    sha256sum <requirements.lock
    "$python" -c 'import sys; print(sys.version, sys.executable)'
    pwd
)
if [ "$(cat .venv/.ready 2>/dev/null)" = "$from" ]; then
    rm .venv/.ready
else
    rm -rf .venv
    say "making .venv with the packages of requirements.lock (1.4 GB, takes minutes)"
    "$python" -m venv .venv
    # The lock file is complete. If pip resolved again what it needs, an older one (before 23.3) would
    # look at the newest release that fits "coverage[toml]>=7.10" and refuse it for want of a hash.
    .venv/bin/python -m pip install --quiet --disable-pip-version-check --no-input \
        --only-binary :all: --no-deps --require-hashes --requirement requirements.lock
fi
say "installing pinstress into .venv"
.venv/bin/python -m pip install --quiet --disable-pip-version-check --no-input \
    --no-deps --no-build-isolation --editable .
.venv/bin/python -m pip check >/dev/null ||
    fail "$(.venv/bin/python -m pip check)" "requirements.lock is behind pyproject.toml: make lock"
# Half a second of every start where Python may not write what it has compiled.
.venv/bin/python -m compileall -q geometry loads fea pinstress reports
printf '%s\n' "$from" >.venv/.ready
say "ready"
