#!/bin/sh
# luajit.sh LIBRARY EXPECTED FOLDER: same_force in Lua, which reads the header itself, as C parsers of scripting languages
# do: without directives and CRUMBLE_API nothing is left that they do not know.
set -eu
command -v luajit >/dev/null && command -v cc >/dev/null || {
  echo "luajit or a C compiler is not installed"
  exit 77
}
here=$(dirname "$0")
printf '#define __attribute__(x)\n#include "crumble/crumble.h"\n' |
  cc -E -P -I "$here/../../capi/include" -U__GNUC__ - | sed '/typedef.*__int\|^typedef .* u\{0,1\}int[0-9a-z_]*_t;$/d' >"$3/crumble.cdef"
CDEF=$3/crumble.cdef CRUMBLE_LIBRARY=$1 luajit "$here/same_force.lua" | cmp - "$2"
