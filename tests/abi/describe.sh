#!/bin/sh
# describe.sh LIBRARY HEADERS OUT: the library's ABI as text: what the public header declares, and nothing else. The types
# come from libcrumble.debug beside the library.
set -eu
abidw --headers-dir "$2" --debug-info-dir "$(dirname "$1")" --out-file "$3" \
  --drop-private-types --exported-interfaces-only --no-corpus-path --no-comp-dir-path --short-locs --no-show-locs \
  --no-elf-needed --no-write-default-sizes "$1"
