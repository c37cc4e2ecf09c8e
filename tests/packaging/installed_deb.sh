#!/bin/sh
# installed_deb.sh PACKAGES WORK: unpacks the .deb files of the folder PACKAGES into WORK and uses them as a developer
# would who has installed them: a C program through pkg-config and through CMake, with the shared library and the
# archive, and the command. Nothing is installed on this machine.
set -eu
packages=$(cd "$1" && pwd)
mkdir -p "$2"
work=$(cd "$2" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
source=$here/../..
root=$work/root
triplet=$(dpkg-architecture -qDEB_HOST_MULTIARCH)

rm -rf "$root"
for name in libcrumble0.1 libcrumble-dev crumble-tools libcrumble-doc; do
  package=$(find "$packages" -maxdepth 1 -name "${name}_*.deb")
  [ -f "$package" ] || { echo "not exactly one package $name in $packages" >&2; exit 1; }
  dpkg -x "$package" "$root"
done

# shellcheck disable=SC2012
depends() { dpkg-deb --field "$(ls "$packages/$1"_*.deb)" Depends; }
depends libcrumble0.1 | grep -q 'libfcl0\.7'
depends libcrumble-dev | grep -q 'libcrumble0\.1 (= '
depends crumble-tools | grep -q 'libepoxy0'
if depends crumble-tools | grep -q bullet; then echo "crumble-tools took a library of the builder's" >&2; exit 1; fi

export PKG_CONFIG_PATH="$root/usr/lib/$triplet/pkgconfig"
export LD_LIBRARY_PATH="$root/usr/lib/$triplet"

# shellcheck disable=SC2046 # flags are words
cc -std=c99 -pedantic -Wall -Werror "$source/examples/c/break_tofu.c" -o "$work/pkg_config" \
  $(pkg-config --cflags --libs crumble)
"$work/pkg_config" >"$work/pkg_config.txt"
grep -q 'depth 15.0 mm  force  *[0-9.]* N' "$work/pkg_config.txt"
grep -q '^[1-9][0-9]* springs cut' "$work/pkg_config.txt"

for static in OFF ON; do
  rm -rf "$work/find_package_$static"
  cmake -S "$source/tests/consumers/find_package_c" -B "$work/find_package_$static" -DCMAKE_PREFIX_PATH="$root/usr" \
    -DEXAMPLES="$source/examples" -DSTATIC=$static -G "Unix Makefiles" >"$work/cmake.log"
  cmake --build "$work/find_package_$static" >>"$work/cmake.log"
  grep -rq "$root/usr/lib/$triplet/libcrumble\." "$work/find_package_$static/CMakeFiles/break_tofu.dir" # not another one
  "$work/find_package_$static/break_tofu" | cmp - "$work/pkg_config.txt"
done

# the command has the same version, and presses till springs break
"$root/usr/bin/crumble" --version | grep "^crumble $(pkg-config --modversion crumble),"
"$root/usr/bin/crumble" run tofu_cube --device press:10 --json >"$work/run.json"
grep -q '"cuts": *[1-9]' "$work/run.json"
[ -s "$root/usr/share/man/man1/crumble.1.gz" ]

# the examples that come with the documents are a project of its own, for the C++ library too
documents=$root/usr/share/doc/libcrumble-dev
[ -f "$documents/docs/capi.md" ]
rm -rf "$work/examples"
cmake -S "$documents/examples" -B "$work/examples" -DCMAKE_PREFIX_PATH="$root/usr" >>"$work/cmake.log"
cmake --build "$work/examples" --target break_tofu_cpp embed_engine_c >>"$work/cmake.log"
"$work/examples/break_tofu_cpp" | cmp - "$work/pkg_config.txt"
"$work/examples/embed_engine_c" | grep -q ' [1-9][0-9]* cuts$'
echo "the packages can be used"
