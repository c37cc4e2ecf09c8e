#!/bin/sh
# Uses crumble as others do. consume.sh CASE WORK_DIR: builds the example in one of the ways below and runs it.
#   install                    the build tree's installation goes to WORK_DIR/prefix; the other cases need it first
#   find_package_c[_static], find_package_cpp, pkg_config[_static], subdirectory
# The environment names CRUMBLE (source tree), BUILD (its build tree), CMAKE, CC, CXX, BUILD_TYPE, GENERATOR,
# LAUNCHER (of the compiler, may be empty). Exit code 77: what the case needs is not installed.
set -eu
case_name=$1
work=$2
prefix=$work/prefix
examples=$CRUMBLE/examples
here=$CRUMBLE/tests/consumers

build_and_run() { # project directory, CMake arguments
  project=$1
  shift
  rm -rf "${work:?}/$case_name"
  "$CMAKE" -S "$here/$project" -B "$work/$case_name" -G "$GENERATOR" -DCMAKE_BUILD_TYPE="$BUILD_TYPE" -DEXAMPLES="$examples" \
    -DCMAKE_C_COMPILER="$CC" -DCMAKE_CXX_COMPILER="$CXX" "$@"
  "$CMAKE" --build "$work/$case_name" --target break_tofu
  run "$work/$case_name/break_tofu"
}

run() { # program: it must press and break
  "$1" | tee "$work/$case_name.txt"
  grep -q 'depth 15.0 mm  force  *[0-9.]* N' "$work/$case_name.txt"
  if grep -q '^0 springs cut' "$work/$case_name.txt"; then exit 1; fi
}

compile_c() { # output, pkg-config and compiler flags
  output=$1
  shift
  "$CC" -std=c99 -pedantic -Wall -Werror "$examples/c/break_tofu.c" -o "$output" "$@"
}

find_pkg_config() {
  command -v pkg-config || exit 77
  PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name crumble.pc)")
  export PKG_CONFIG_PATH
}

case $case_name in
  install)
    # moved after it was made: nothing may remember where it was
    rm -rf "$work"
    for component in crumble_Runtime crumble_Development; do
      "$CMAKE" --install "$BUILD" --prefix "$work/before" --component $component
    done
    mv "$work/before" "$prefix"
    ;;
  find_package_c) build_and_run find_package_c -DCMAKE_PREFIX_PATH="$prefix" ;;
  find_package_c_static) build_and_run find_package_c -DCMAKE_PREFIX_PATH="$prefix" -DSTATIC=ON ;;
  find_package_cpp) build_and_run find_package_cpp -DCMAKE_PREFIX_PATH="$prefix" ;;
  subdirectory)
    # compiles the library again, which is cheap only for a compiler cache that has seen the same flags
    [ -n "$LAUNCHER" ] || exit 77
    build_and_run subdirectory -DCRUMBLE="$CRUMBLE" -DCRUMBLE_WARNINGS_AS_ERRORS=ON \
      -DCMAKE_C_COMPILER_LAUNCHER="$LAUNCHER" -DCMAKE_CXX_COMPILER_LAUNCHER="$LAUNCHER"
    ;;
  pkg_config)
    find_pkg_config
    # shellcheck disable=SC2046 # flags are words
    compile_c "$work/pkg_config" $(pkg-config --cflags --libs crumble)
    LD_LIBRARY_PATH=$(pkg-config --variable=libdir crumble)
    export LD_LIBRARY_PATH
    run "$work/pkg_config"
    ;;
  pkg_config_static)
    find_pkg_config
    # the archive of ours alone: there are none of FCL and libccd
    # shellcheck disable=SC2046
    compile_c "$work/pkg_config_static" $(pkg-config --static --cflags --libs crumble | sed 's/-lcrumble/-l:libcrumble.a/')
    run "$work/pkg_config_static"
    ;;
  *)
    echo "unknown case $case_name" >&2
    exit 2
    ;;
esac
