#!/bin/sh
# api.sh LIBRARY OUT: whether capi/api.json is what scripts/make-api makes of header and library now, and whether the raw
# layer of each binding is what its generator makes of api.json.
set -eu
root=$(dirname "$0")/../..
/usr/bin/python3 -c 'import clang.cindex; clang.cindex.Index.create()' 2>/dev/null || {
  echo "python3-clang is not installed"
  exit 77
}
"$root/scripts/make-api" "$1" "$2"
diff "$2" "$root/capi/api.json" || {
  echo "capi/api.json is not of this header: run scripts/make-bindings"
  exit 1
}
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
mkdir "$copy/capi"
cp -r "$root/bindings" "$copy"
cp "$root/capi/api.json" "$copy/capi"
for generator in "$copy"/bindings/*/generate.py; do
  (cd "$copy" && /usr/bin/python3 "$generator") >/dev/null
done
find "$copy/bindings" -name __pycache__ -prune -exec rm -r {} +
diff -r "$copy/bindings" "$root/bindings" --exclude __pycache__ --exclude target --exclude node_modules
