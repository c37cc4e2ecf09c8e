#!/bin/sh
# same_output.sh PROGRAM LIBRARY EXPECTED FOLDER: whether PROGRAM prints EXPECTED.
set -eu
"$1" | cmp - "$3"
