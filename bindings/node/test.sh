#!/bin/sh
# Tests the Node binding: test.sh LIBRARY EXPECTED WORK. LIBRARY is libcrumble, EXPECTED what examples/c/same_force.c
# prints, WORK an empty folder, the only place that is written to. Exit 0: passed, 77: what it needs is not there, else
# failed. koffi comes from NODE_PATH if it is found there, else from npm ci.
set -eu
library=$(realpath "$1") expected=$(realpath "$2") work=$(realpath "$3")
cd "$(dirname "$0")"
api=$(realpath ../../capi/api.json)

skip() { echo "SKIPPED: $1"; exit 77; }
for program in node python3; do
  command -v "$program" > /dev/null || skip "no $program"
done
node -e 'process.exit(parseInt(process.versions.node) < 18 ? 1 : 0)' || skip "node $(node --version) is older than 18"

export TMPDIR="$work/tmp" PYTHONDONTWRITEBYTECODE=1 CRUMBLE_LIBRARY="$library" CRUMBLE_API_JSON="$api"
mkdir -p "$TMPDIR" "$work/node"

# What is generated is what api.json says today.
python3 generate.py "$work/generated"
cmp "$work/generated/native.js" native.js
cmp "$work/generated/native.d.ts" native.d.ts

cp -R package.json package-lock.json index.js index.d.ts native.js native.d.ts lib tests examples "$work/node"
cd "$work/node"
if node -e 'require("koffi")' 2> /dev/null; then
  echo "koffi of NODE_PATH"
else
  command -v npm > /dev/null || skip "no npm, and no koffi in NODE_PATH"
  # Scripts are not needed: what koffi is made of comes as a package of its own.
  npm ci --ignore-scripts --no-audit --no-fund --no-update-notifier --cache "$work/npm" --fetch-retries 1 \
    > "$work/npm.log" 2>&1 || {
    cat "$work/npm.log"
    unreachable='E(NOTFOUND|AI_AGAIN|CONNREFUSED|CONNRESET|TIMEDOUT|NETUNREACH|HOSTUNREACH|NEEDAUTH|40[13]|5[0-9][0-9])'
    stranger='SELF_SIGNED_[A-Z_]*|DEPTH_ZERO_[A-Z_]*|UNABLE_TO_[A-Z_]*|CERT_[A-Z_]*' # somebody in between
    if grep -Eq "code (ERR_SOCKET_TIMEOUT|$unreachable|$stranger)\$" "$work/npm.log"; then skip "npm does not reach its registry"; fi
    exit 1
  }
fi
node --version

# The program as users start it, not npm, which writes a log to the home folder.
node --expose-gc --test
node examples/same_force.mjs > "$work/same_force.txt"
cmp "$work/same_force.txt" "$expected"
node examples/break_tofu.mjs > "$work/break_tofu.txt"
grep -q "127 springs cut" "$work/break_tofu.txt"
echo "passed"
