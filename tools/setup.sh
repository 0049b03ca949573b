#!/bin/sh
# Set up everything that the project needs, once: a Python, the virtual environment, the packages.
# Usage: tools/setup.sh runtime|dev     (called by the Makefile)
set -eu
cd "$(dirname "$0")/.."
kind="${1:-dev}"

say() { printf '%s\n' "$*" >&2; }

suits() { "$1" -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] <= (3, 14))' >/dev/null 2>&1; }

find_python() {
    for candidate in ${PYTHON:-} python3 python3.13 python3.12 python3.11 python3.14 python; do
        if suits "$candidate"; then
            echo "$candidate"
            return
        fi
    done
    say "Python: expected version 3.11 to 3.14 on the PATH, got none. Install one, or name it: make PYTHON=/path/to/python3"
    exit 2
}

# Debian and Ubuntu ship Python without the module that makes virtual environments.
need_venv() {
    if "$1" -c 'import venv, ensurepip' >/dev/null 2>&1; then return; fi
    if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
        say "Installing the system package python3-venv ..."
        apt-get update -qq && apt-get install -y -qq --no-install-recommends python3-venv >/dev/null
    fi
    if ! "$1" -c 'import venv, ensurepip' >/dev/null 2>&1; then
        say "Python: expected the modules venv and ensurepip, got neither. Install them (Debian, Ubuntu: sudo apt-get install python3-venv)."
        exit 2
    fi
}

# The tests run the gradebook on a real server of their own; Debian keeps its programs off the PATH.
need_postgres() {
    if command -v pg_ctl >/dev/null || ls /usr/lib/postgresql/*/bin/pg_ctl >/dev/null 2>&1; then return; fi
    if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
        say "Installing the system package postgresql ..."
        apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends postgresql >/dev/null
    else
        say "PostgreSQL: expected pg_ctl for the tests of the gradebook, got none. Install it (Debian, Ubuntu: sudo apt-get install postgresql)."
        exit 2
    fi
}

# The tests look at the pages in a real browser.
need_chromium() {
    if command -v chromium >/dev/null || command -v chromium-browser >/dev/null || command -v google-chrome >/dev/null; then return; fi
    if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
        say "Installing the system package chromium ..."
        apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends chromium >/dev/null
    else
        say "Chromium: expected a browser for the tests of the pages, got none. Install it (Debian: sudo apt-get install chromium)."
        exit 2
    fi
}

if [ ! -x .venv/bin/python ] || ! suits .venv/bin/python; then
    python="$(find_python)"
    need_venv "$python"
    say "Making .venv with $("$python" --version) ..."
    rm -rf .venv
    "$python" -m venv .venv
fi

case "$kind" in
    runtime) target="." ;;
    dev) target=".[dev]"; need_postgres; need_chromium ;;
    *) say "tools/setup.sh: expected runtime or dev, got '$kind'"; exit 2 ;;
esac
say "Installing vml-course ($kind); the first time takes a minute or two ..."
.venv/bin/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e "$target"
touch ".venv/.$kind"
if [ "$kind" = dev ]; then touch .venv/.runtime; fi
