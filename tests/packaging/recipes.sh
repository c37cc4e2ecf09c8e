#!/bin/sh
# recipes.sh SOURCE BUILD WORK VERSION CMAKE: what can be said of the recipes in packaging/ without building anything.
# The files that Debian's packages take are those that the build tree BUILD installs, no more and no fewer; versions
# agree; files are of their form. Exit code 77: dpkg or Python is not here.
set -eu
source=$1
build=$2
work=$3
version=$4
cmake=$5
debian=$source/packaging/debian
{ command -v dpkg-parsechangelog && command -v perl && command -v python3; } >/dev/null || exit 77
fail() { echo "$1" >&2; exit 1; }

abi=${version%.*}
[ "$(dpkg-parsechangelog -l "$debian/changelog" -S Version | sed 's/-.*//')" = "$version" ] ||
  fail "packaging/debian/changelog is not of version $version"
perl -MDpkg::Control::Info -e 'print "$_->{Package}\n" for Dpkg::Control::Info->new($ARGV[0])->get_packages()' \
  "$debian/control" | grep -qx "libcrumble$abi" || fail "packaging/debian/control has no package libcrumble$abi"
grep -q "^libcrumble.so.$abi libcrumble$abi " "$debian/libcrumble$abi.symbols"
grep -q "(symver)CRUMBLE_$abi " "$debian/libcrumble$abi.symbols"
head -n 1 "$debian/rules" | grep -qx '#!/usr/bin/make -f'
make -n -f "$debian/rules" build >/dev/null || fail "packaging/debian/rules is no makefile"

# Installed files against the patterns of *.install, where the build tree's libdir stands for that of Debian.
rm -rf "$work"
mkdir -p "$work"
"$cmake" --install "$build" --prefix "$work/usr" >"$work/log"
cd "$work"
libdir=$(dirname "$(find usr -name libcrumble.so)")
sed "s|usr/lib/\*/|$libdir/|" "$debian"/*.install >patterns
find usr ! -type d | sort >installed
while read -r pattern; do
  for path in $pattern; do
    [ -e "$path" ] || fail "no installed file fits $pattern of packaging/debian/*.install"
    find "$path" ! -type d
  done
done <patterns >taken.unsorted
sort taken.unsorted >taken
[ -z "$(uniq -d taken)" ] || fail "in two packages: $(uniq -d taken)"
diff installed taken || fail "packages take other files than are installed"
while read -r path; do [ -e "$source/$path" ] || fail "no $path for packaging/debian/*.docs or *.examples"; done <<LIST
$(cat "$debian"/*.docs "$debian"/*.examples)
LIST

# The others.
python3 - "$source/packaging" "$version" <<'PYTHON'
import ast, json, pathlib, sys
packaging, version = pathlib.Path(sys.argv[1]), sys.argv[2]
port = json.loads((packaging / "vcpkg/vcpkg.json").read_text())
assert port["version"] == version, "vcpkg.json is not of version " + version
for recipe in packaging.glob("conan/**/*.py"):
    ast.parse(recipe.read_text(), str(recipe))
PYTHON
echo "packaging: recipes agree with version $version and with what is installed"
