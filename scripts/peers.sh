#!/bin/sh
# Installs the other programs that the tests with the mark "peers" run, or names what installs them.
# make test-peers runs it.
set -eu

command -v ccx >/dev/null && exit 0
install="apt-get install --no-install-recommends calculix-ccx"
if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    apt-get update -qq || printf 'test-peers: apt-get update failed; trying with the old lists\n' >&2
    printf 'test-peers: %s\n' "$install"
    # shellcheck disable=SC2086  # words of a command
    DEBIAN_FRONTEND=noninteractive $install -qq </dev/null >/dev/null ||
        printf 'test-peers: apt-get install failed\n' >&2
fi
command -v ccx >/dev/null || {
    printf 'test-peers: CalculiX is not installed (no command ccx). On Debian and Ubuntu:\n' >&2
    printf 'test-peers: sudo %s\n' "$install" >&2
    exit 1
}
