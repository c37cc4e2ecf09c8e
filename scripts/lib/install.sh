# shellcheck shell=bash disable=SC2034
# Debian packages that the project needs, and a way to have them. Sourced by scripts/demo, scripts/test and scripts/lint.

# The library, the command line, and the pictures that it draws off screen.
build_packages=(g++ cmake ninja-build pkg-config libeigen3-dev libhwy-dev libccd-dev libfcl-dev nlohmann-json3-dev
  libboost-dev libcli11-dev libepoxy-dev libegl1 libgl1-mesa-dri libstb-dev libtinygltf-dev libpugixml-dev gnuplot-nox)
# Beside these: test and benchmark frameworks, libraries that results are compared with, a second compiler and its
# formatter.
test_packages=(ccache libgtest-dev libbenchmark-dev libbullet-dev libassimp-dev clang clang-format)
# For the bindings and their tests, and for what guards the ABI. Where one is missing its tests are skipped.
binding_packages=(abigail-tools python3-clang python3-numpy cargo rustc mono-mcs luajit)
lint_packages=(clang-tidy)
# For the kernels of other processors: a compiler and something that runs what it makes.
aarch64_packages=(g++-aarch64-linux-gnu qemu-user)
wasm_packages=(emscripten nodejs)

# What a system without apt-get has to provide. Ends the script.
explain_and_stop() {
  cat >&2 <<TEXT
This is not a Debian system: there is no apt-get to install packages with. Install what these Debian packages hold:
  ${build_packages[*]}
and for the tests and benchmarks:
  ${test_packages[*]}
Then (without the second list add -DCRUMBLE_BUILD_TESTS=OFF -DCRUMBLE_BUILD_BENCH=OFF to the first line):
  cmake -S . -B build/release -G Ninja -DCMAKE_BUILD_TYPE=Release
  cmake --build build/release
  ctest --test-dir build/release
  build/release/apps/crumble/crumble run tofu_cube --out out/tofu_cube
TEXT
  exit 2
}

is_installed() {
  [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

# need_packages NAME...: installs those that are missing. Says nothing when none is.
need_packages() {
  { command -v apt-get && command -v dpkg-query; } >/dev/null || explain_and_stop
  local name missing=() as_root=()
  for name in "$@"; do
    is_installed "$name" || missing+=("$name")
  done
  ((${#missing[@]})) || return 0
  if ((EUID)); then
    command -v sudo >/dev/null || {
      echo "Neither root nor sudo; as root run: apt-get install --no-install-recommends ${missing[*]}" >&2
      exit 2
    }
    as_root=(sudo)
  fi
  echo "installing ${missing[*]}"
  local log
  log=$(mktemp)
  # apt's lists are fetched only when those at hand, if any, do not lead to the packages
  install_now >"$log" 2>&1 </dev/null || { apt_get update && install_now; } >"$log" 2>&1 </dev/null || {
    cat "$log" >&2
    exit 1
  }
  rm "$log"
}

# Node and npm: what is there, wherever it came from, since Debian's npm does not go with every other Node; else Debian's.
need_node() {
  command -v node >/dev/null || need_packages nodejs npm
}

# These two see the variables of need_packages.
apt_get() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300 "$@"
}

install_now() {
  apt_get install --yes --no-install-recommends "${missing[@]}"
}
