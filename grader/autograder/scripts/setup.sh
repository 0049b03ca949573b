#!/usr/bin/env bash
# Runs once, when Gradescope builds the image: a Python of its own, packages from the wheels beside this file.
# ROOT is /autograder there; a test gives another.
set -euo pipefail
ROOT="${ROOT:-/autograder}"
SOURCE="$ROOT/source"
VERSION="$(cat "$SOURCE/python-version")"
PYTHON="$(command -v "python$VERSION" || true)"

if [ -z "$PYTHON" ] || ! "$PYTHON" -c 'import venv, ensurepip' >/dev/null 2>&1; then
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends "python$VERSION" "python$VERSION-venv"
    PYTHON="$(command -v "python$VERSION")"
fi

"$PYTHON" -m venv "$ROOT/venv"
"$ROOT/venv/bin/python" -m pip install --quiet --no-index --no-deps --no-cache-dir \
    --disable-pip-version-check "$SOURCE"/wheels/*.whl
"$ROOT/venv/bin/python" -m compileall -q "$SOURCE/lib"  # runs write no bytecode
chmod 600 "$SOURCE/truth.json"
