# Shell functions of ./elamin and tests/run: Debian packages, configuration, build. Sourced, with $root set to the repository.
build=$root/build/release
mkdir -p "$build"

say() { echo "elamin: $*" >&2; }

# packages KIND…: their names, from the list of packages.
packages() {
  for kind; do sed -n "s/^$kind  *\([^ ]*\).*/\1/p" "$root/.setup/packages"; done
}

# missing NAME…: those of them that are not installed.
missing() {
  for name; do
    case $(dpkg-query -W -f '${db:Status-Status} ' "$name" 2>/dev/null) in installed\ *|*\ installed\ *) ;; *) echo "$name" ;; esac
  done
}

apt() { DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=600 "$@" </dev/null 9>&-; }

# install_packages KIND…: installs the missing ones as root; anyone else is told what to type.
install_packages() {
  if ! command -v dpkg-query >/dev/null; then
    say "this is not Debian: install what $root/.setup/packages lists by hand"
    return
  fi
  absent=$(missing $(packages "$@") | tr '\n' ' ')
  [ -n "$absent" ] || return 0
  if [ "$(id -u)" != 0 ]; then
    say "these Debian packages are missing: $absent"
    say "install them with: sudo apt-get install --no-install-recommends $absent"
    exit 1
  fi
  say "installing Debian packages: $absent"
  apt install --no-install-recommends $absent >"$build/apt.log" 2>&1 ||
    { apt update && apt install --no-install-recommends $absent; } >"$build/apt.log" 2>&1 ||
    { cat "$build/apt.log" >&2; say "these packages could not be installed: $absent"; exit 1; }
}

# quietly COMMAND…: its output is shown only where it fails.
quietly() {
  "$@" >"$build/build.log" 2>&1 </dev/null 9>&- || { cat "$build/build.log" >&2; say "the build failed"; exit 1; }
}

# cached LINE: whether the configuration says so.
cached() { grep -qx "$1" "$build/CMakeCache.txt" 2>/dev/null; }

# configure ON|OFF: with or without the tests and the Python module; nothing is done where it is so already. OFF leaves ON as it is.
configure() {
  if [ -f "$build/build.ninja" ] && grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$build/CMakeCache.txt"; then
    [ "$1" = OFF ] || { cached "ELAMIN_TESTS:[A-Z]*=ON" && cached "ELAMIN_PYTHON:[A-Z]*=ON" && cached "PETSC_FOUND:INTERNAL=1"; } ||
      (cd "$root" && quietly cmake --preset release -DELAMIN_TESTS=ON -DELAMIN_PYTHON=ON)
  else
    (cd "$root" && quietly cmake --preset release --fresh "-DELAMIN_TESTS=$1" "-DELAMIN_PYTHON=$1")
  fi
}
