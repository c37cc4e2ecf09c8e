#!/bin/sh
# compare.sh LIBRARY HEADERS BASELINE: whether the library has the ABI of the baseline: symbols, parameters, and the
# layout of every struct, as the debug information of the C API tells them. Any difference is a failure: abidiff answers
# 4 for a parameter that changed as well as for a field that was appended. Exit code 77: no abidiff.
set -eu
command -v abidw >/dev/null && command -v abidiff >/dev/null || {
  echo "abigail-tools is not installed"
  exit 77
}
here=$(mktemp -d)
trap 'rm -r "$here"' EXIT
"$(dirname "$0")/describe.sh" "$1" "$2" "$here/now.abi"
if ! grep -q '<class-decl name=.crumble_sim_def' "$here/now.abi" && ! grep -q 'name=.crumble_sim_step' "$here/now.abi"; then
  echo "$1 tells nothing of its types: was it built without debug information?"
  exit 1
fi
abidiff "$3" "$here/now.abi"
