#!/bin/sh
# test.sh LIBRARY EXPECTED WORK: all tests of the Python binding against that library file. EXPECTED is what
# examples/c/same_force.c prints; nothing is written outside of WORK. Exit code 77: Python 3.9 or NumPy is missing.
set -eu
library=$(realpath "$1") expected=$(realpath "$2") work=$(realpath "$3")
here=$(cd "$(dirname "$0")" && pwd)
unset PYTHONPATH PYTHONHOME
export CRUMBLE_LIBRARY="$library" CRUMBLE_TEST_WORK="$work" PYTHONDONTWRITEBYTECODE=1 MPLCONFIGDIR="$work/matplotlib"
skip() { echo "SKIPPED: $1 is missing"; exit 77; }
has() { "$python" -c "import $1" 2>/dev/null; }
fits() { "$1" -c 'import sys; sys.exit(sys.version_info < (3, 9))' 2>/dev/null; }
# The system's Python has the packages of the system, where the first in PATH is another.
python=${PYTHON:-python3}
[ -n "${PYTHON:-}" ] || has numpy || python=/usr/bin/python3
fits "$python" || skip "Python 3.9 or newer ($python)"
has numpy || skip "NumPy ($python)"
export PYTHONPATH="$here"

# What looks at the package itself: its type hints, and the package as pip installs it (from a copy, since a build
# leaves files beside the sources).
check_package() {
  if has mypy; then
    (cd "$here" && "$python" -m mypy --cache-dir=/dev/null crumble tests/hints.py)
  else
    echo "not tested: type hints (no mypy)"
  fi
  if has pip && has setuptools; then
    mkdir "$work/source"
    cp -R "$here/pyproject.toml" "$here/crumble" "$work/source/"
    "$python" -m pip install --quiet --no-index --no-build-isolation --no-deps --no-cache-dir --no-compile \
      --disable-pip-version-check --root-user-action=ignore --target "$work/site" "$work/source"
    test -f "$work/site/crumble/py.typed"
    (cd "$work" && PYTHONPATH="$work/site" "$python" "$here/examples/same_force.py") >"$work/installed.txt"
    cmp "$work/installed.txt" "$expected"
    (cd "$work" && PYTHONPATH="$work/site" "$python" -c 'import crumble; print("installed:", crumble.__file__)')
  else
    echo "not tested: installation (no pip or no setuptools)"
  fi
}

(set -e; check_package) >"$work/package.txt" 2>&1 & # beside the tests, which often wait
package=$!
trap 'kill $package 2>/dev/null || :' EXIT

"$python" -W error -m unittest discover -s "$here/tests" -t "$here/tests"

"$python" "$here/examples/same_force.py" >"$work/same_force.txt"
cmp "$work/same_force.txt" "$expected"
"$python" "$here/examples/break_tofu.py" | grep -q 'springs cut'
"$python" "$here/examples/live_surface.py" "$work/surface"
grep -q '^f ' "$work/surface.obj"
if has matplotlib; then
  "$python" "$here/examples/plot_press.py" "$work/press.png"
  test -s "$work/press.png" && test -s "$work/surface.png"
else
  echo "not tested: plot_press.py (no matplotlib)"
fi

result=0
wait $package || result=1
cat "$work/package.txt"
[ $result = 0 ] || exit 1
echo "passed"
