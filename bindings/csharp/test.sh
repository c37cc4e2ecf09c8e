#!/usr/bin/env bash
# test.sh LIBRARY EXPECTED WORK: all tests of the C# binding with mono, against the library file LIBRARY. EXPECTED is what
# examples/c/same_force.c prints; WORK is an empty folder to write to. 0 passed, 77 mono missing, else failed.
set -euo pipefail
library=$(realpath "$1") expected=$(realpath "$2") work=$(realpath "$3")
cd "$(dirname "${BASH_SOURCE[0]}")"

for tool in mcs mono; do
  command -v "$tool" >/dev/null || { echo "SKIPPED: no $tool"; exit 77; }
done
export CRUMBLE_LIBRARY=$library
compile=(mcs -langversion:7 -warnaserror -warn:4 -nowarn:1591)
fail() { echo "FAILED: $*"; exit 1; }

# as a library, with and without spans; examples and tests beside it
"${compile[@]}" -unsafe -target:library -out:"$work/plain.dll" unity/Runtime/*.cs
"${compile[@]}" -unsafe -target:library -define:CRUMBLE_SPAN -out:"$work/Crumble.dll" unity/Runtime/*.cs
for example in examples/*.cs; do
  "${compile[@]}" -r:"$work/Crumble.dll" -out:"$work/$(basename "$example" .cs).exe" "$example"
done
# in one assembly, since tests look at what is internal
"${compile[@]}" -unsafe -define:CRUMBLE_SPAN -out:"$work/Tests.exe" unity/Runtime/*.cs unity/Samples~/*/*.cs tests/*.cs tests/unity/*.cs
# as Unity compiles it
"${compile[@]}" -unsafe -define:UNITY_5_3_OR_NEWER -target:library -out:"$work/unity.dll" unity/Runtime/*.cs

mono "$work/SameForce.exe" >"$work/same_force.txt"
cmp "$expected" "$work/same_force.txt" || fail "SameForce prints something else"
mono "$work/BreakTofu.exe" >"$work/break_tofu.txt"
cuts=$(sed -n 's/^cuts //p' "$expected")
[[ $(tail -n 1 "$work/break_tofu.txt") == "$cuts springs cut" ]] || fail "BreakTofu cuts other springs"
mono "$work/StepCost.exe" 20000

mono "$work/Tests.exe" "$work"

# a library that is not there, or another one, is told in words
said() { CRUMBLE_LIBRARY=$1 mono "$work/SameForce.exe" 2>&1 || true; }
[[ $(said "$work/none.so") == *"crumble: cannot load $work/none.so"* ]] || fail "no word about a missing library"
[[ $(said "$(command -v mono)") == *"crumble: cannot load "* ]] || fail "no word about another file"

# what is generated is what is committed, and the generator takes functions that are not there yet
if command -v python3 >/dev/null; then
  mkdir "$work/generated" "$work/grown"
  python3 generate.py ../../capi/api.json "$work/generated"
  cmp "$work/generated/Native.cs" unity/Runtime/Native.cs || fail "Native.cs: run bindings/csharp/generate.py"
  cmp "$work/generated/Definitions.cs" unity/Runtime/Definitions.cs || fail "Definitions.cs: run bindings/csharp/generate.py"
  cmp "$work/generated/LayoutTable.cs" tests/LayoutTable.cs || fail "LayoutTable.cs: run bindings/csharp/generate.py"
  python3 tests/grow_api.py ../../capi/api.json >"$work/grown.json"
  python3 generate.py "$work/grown.json" "$work/grown"
  hand_written=$(ls unity/Runtime/*.cs | grep -v -e Native.cs -e Definitions.cs)
  "${compile[@]}" -unsafe -target:library -out:"$work/grown.dll" $hand_written "$work"/grown/{Native,Definitions}.cs
else
  echo "NOT TESTED: the generator, no python3"
fi
