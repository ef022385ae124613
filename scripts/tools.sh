#!/bin/sh
# Installs the programs that a target's tests run, or names what installs them:
#   sh scripts/tools.sh TARGET WHAT PACKAGES COMMAND...
set -eu
target=$1 what=$2 packages=$3
shift 3

there() {
    for command in "$@"; do command -v "$command" >/dev/null || return 1; done
}

there "$@" && exit 0
install="apt-get install --no-install-recommends $packages"
if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    apt-get update -qq || printf '%s: apt-get update failed; trying with the old lists\n' "$target" >&2
    printf '%s: %s\n' "$target" "$install"
    # shellcheck disable=SC2086  # words of a command
    DEBIAN_FRONTEND=noninteractive $install -qq </dev/null >/dev/null ||
        printf '%s: apt-get install failed\n' "$target" >&2
fi
there "$@" || {
    printf '%s: %s is missing (commands: %s). On Debian:\n' "$target" "$what" "$*" >&2
    printf '%s: sudo %s\n' "$target" "$install" >&2
    exit 1
}
