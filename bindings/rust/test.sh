#!/bin/sh
# Tests the Rust binding: test.sh LIBRARY EXPECTED WORK. LIBRARY is libcrumble, EXPECTED what examples/c/same_force.c
# prints, WORK an empty folder, the only place that is written to. Exit 0: passed, 77: Rust is not there, else failed.
# CARGO names another cargo than that of the PATH; the rustc beside it is used.
set -eu
library=$(realpath "$1") expected=$(realpath "$2") work=$(realpath "$3")
cd "$(dirname "$0")"

cargo=${CARGO:-cargo}
for program in "$cargo" cc python3; do
  command -v "$program" > /dev/null || { echo "SKIPPED: no $program"; exit 77; }
done
beside=$(dirname "$(command -v "$cargo")")
if [ -x "$beside/rustc" ]; then export RUSTC="$beside/rustc"; fi
if [ -x "$beside/rustdoc" ]; then export RUSTDOC="$beside/rustdoc"; fi

export CRUMBLE_LIBRARY="$library" CARGO_TARGET_DIR="$work/target" CARGO_HOME="$work/cargo" TMPDIR="$work/tmp"
export PYTHONDONTWRITEBYTECODE=1 RUST_BACKTRACE=0
mkdir -p "$TMPDIR"
"$cargo" --version

# What is generated is what api.json says today; the sizes and offsets in it are compared by the compiler.
python3 generate.py "$work/generated"
for crate in crumble-sys crumble; do
  cmp "$work/generated/$crate/src/generated.rs" "$crate/src/generated.rs"
done

"$cargo" test --offline --locked --tests
mkdir "$work/library" && ln -s "$library" "$work/library/libcrumble.so.0.1" # old cargos do not tell doctests where it is
LD_LIBRARY_PATH="$work/library" "$cargo" test --offline --locked --doc
"$cargo" run --offline --locked --quiet --example same_force > "$work/same_force.txt"
cmp "$work/same_force.txt" "$expected"
"$cargo" run --offline --locked --quiet --example break_tofu > "$work/break_tofu.txt"
grep -q "127 springs cut" "$work/break_tofu.txt"
echo "passed"
