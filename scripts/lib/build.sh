# shellcheck shell=bash
# Configuring and building with little to read: one line each on success, everything on failure. Sourced by the scripts.

# timed WHAT COMMAND...: prints "WHAT ... 12 s".
timed() {
  local start=$SECONDS
  "${@:2}" || return
  echo "$1: $((SECONDS - start)) s"
}

# configure FOLDER OPTION...
configure() {
  mkdir -p "$1"
  cmake -S . -B "$1" -G Ninja "${@:2}" >"$1/configure.log" 2>&1 || {
    cat "$1/configure.log" >&2
    return 1
  }
}

# build FOLDER [TARGET]: on a terminal ninja keeps one line up to date, elsewhere it says only what goes wrong.
build() {
  local quiet=()
  [[ -t 1 ]] || quiet=(--quiet)
  timed "built $*" ninja -C "$1" "${quiet[@]}" "${@:2}"
}

# All C++ as clang-format would write it. Not the C header and its clients: their comment columns are set by hand.
check_format() {
  find include src capi apps tests bench examples -name '*.[ch]pp' -print0 2>/dev/null |
    xargs -0 clang-format --dry-run --Werror
}
