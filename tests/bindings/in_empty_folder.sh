#!/bin/sh
# in_empty_folder.sh FOLDER COMMAND... : COMMAND... FOLDER, with FOLDER made empty first.
set -eu
folder=$1
shift
rm -rf "$folder"
mkdir -p "$folder"
exec "$@" "$folder"
