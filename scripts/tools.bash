# shellcheck shell=bash
# What the scripts share: the cargo profile and the program it leaves, Python packages at their pinned versions, Debian
# packages, the page's npm packages. Whoever reads this has `set -euo pipefail`; the working directory may be any.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck disable=SC2034 # for who reads this
page=$root/crates/view/page

# Programs, tests, lints and documentation use one profile, so that nothing is compiled twice.
profile=${PONTOON_PROFILE:-quick}
case $profile in
  dev | test) built=debug ;;
  bench) built=release ;;
  *) built=$profile ;;
esac
built=$(cd "$root" && realpath -ms -- "${CARGO_TARGET_DIR:-target}")/$built

# Sets PONTOON to the program under trial: the one that PONTOON names, else the one that this builds.
program() {
  if [ -z "${PONTOON:-}" ]; then
    # of the whole workspace, as tests and lints are: a build of one package takes its libraries with other features, anew
    (cd "$root" && cargo build --profile "$profile" --locked --workspace --bin pontoon) || return
    PONTOON=$built/pontoon
  fi
  PONTOON=$(realpath -- "$PONTOON") || return
  export PONTOON
}

# Builds the extension of the Python package and puts it into the package, for tests that import it from there.
python_extension() {
  (cd "$root" && cargo build --profile "$profile" --locked --workspace --lib) || return
  local file=$built/lib_engine.so
  [ -f "$file" ] || file=$built/lib_engine.dylib
  # a file in its place at once: a process that has the old one open keeps it
  cp "$file" "$root/crates/python/pontoon/_engine.abi3.so.new" &&
    mv "$root/crates/python/pontoon/_engine.abi3.so.new" "$root/crates/python/pontoon/_engine.abi3.so"
}

# Installs Python packages into a venv of the repository, at the versions of scripts/pins.txt, and sets `python` to its
# Python:
#   python_packages .venv polars pandas
python_packages() {
  local venv=$root/$1 pins=() name pin
  python=$venv/bin/python
  for name in "${@:2}"; do
    pin=$(grep -E "^$name==" "$root/scripts/pins.txt") || { echo "scripts/pins.txt has no $name" >&2 && return 1; }
    pins+=("$pin")
  done
  "$python" -c '
import sys
from importlib.metadata import version
sys.exit(any(version(name) != pin for name, pin in (word.split("==") for word in sys.argv[1:])))' "${pins[@]}" \
    2>/dev/null && return
  # a venv that was made without Debian's python3-venv has no pip: it is made again
  "$python" -m pip --version >/dev/null 2>&1 || python3 -m venv --clear "$venv" || return
  "$python" -m pip install --quiet --disable-pip-version-check "${pins[@]}"
}

# Installs Debian packages; takes root or sudo.
debian_packages() {
  local as_root=()
  [ "$(id -u)" = 0 ] || as_root=(sudo)
  "${as_root[@]}" apt-get update -qq &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@"
}

# Installs Node where it is missing, and the npm packages that the page's lock file pins.
page_packages() {
  local missing=()
  command -v node >/dev/null || missing+=(nodejs)
  command -v npm >/dev/null || missing+=(npm)
  [ "${#missing[@]}" = 0 ] || debian_packages "${missing[@]}" || return
  # a copy of the lock file says what is installed
  cmp -s "$page/package-lock.json" "$page/node_modules/.installed" && return
  (cd "$page" && npm ci --ignore-scripts --no-audit --no-fund) || return
  cp "$page/package-lock.json" "$page/node_modules/.installed"
}
