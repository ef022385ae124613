#!/bin/sh
# Installs the browser that the tests with the mark "browser" drive, or names what installs it.
# make test-browser runs it.
set -eu

there() { command -v chromium >/dev/null && command -v chromedriver >/dev/null; }

there && exit 0
install="apt-get install --no-install-recommends chromium chromium-driver"
if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    apt-get update -qq || printf 'test-browser: apt-get update failed; trying with the old lists\n' >&2
    printf 'test-browser: %s\n' "$install"
    # shellcheck disable=SC2086  # words of a command
    DEBIAN_FRONTEND=noninteractive $install -qq </dev/null >/dev/null ||
        printf 'test-browser: apt-get install failed\n' >&2
fi
there || {
    printf 'test-browser: Chromium or its driver is missing (commands chromium, chromedriver). On Debian:\n' >&2
    printf 'test-browser: sudo %s\n' "$install" >&2
    exit 1
}
