# shellcheck shell=bash disable=SC2034
# Sourced by apps/demo.sh, tests/run.sh and .ci/run: what they share.
#
# Needs bash and a Debian or Ubuntu (22.04 or newer, 12 or newer) for installing; on
# other systems install the packages by hand, the rest is the same.

set -Eeuo pipefail

hoist_root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
hoist_build=$hoist_root/build/release

# Everything that the programs and the tests need to be built and run.
hoist_packages=(
  cmake g++ ninja-build pkg-config
  libpcl-dev libopencv-dev libeigen3-dev
  nlohmann-json3-dev libcli11-dev libfmt-dev libyaml-cpp-dev libsqlite3-dev
  libegl-dev libx11-dev libgl1-mesa-dri
  libembree-dev libassimp-dev zlib1g-dev sweethome3d-furniture
)
hoist_test_packages=(libgtest-dev python3 python3-numpy xvfb xdotool)

# fail MESSAGE...: the reason, then the end.
fail() {
  printf '%s: %s\n' "$(basename -- "$0")" "$*" >&2
  exit 1
}

# Whatever fails without a message of its own: say where.
trap 'printf "%s: line %s failed: %s\n" "$(basename -- "$0")" "$LINENO" "$BASH_COMMAND" >&2' ERR

installed() {
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# install_packages NAME...: those that are missing, after saying so.
install_packages() {
  local name missing=() as_root=()
  command -v apt-get >/dev/null ||
    fail "not a Debian or Ubuntu system: install the equivalents of: $*, then run the cmake commands of README.md"
  for name in "$@"; do
    installed "$name" || missing+=("$name")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
      fail "needs the packages ${missing[*]}: run as root or install sudo"
    as_root=(sudo)
  fi
  echo "Installing system packages: ${missing[*]}"
  "${as_root[@]}" apt-get -qq update ||
    fail "apt-get update failed; its reason is above"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get -qq -o Dpkg::Use-Pty=0 install -y --no-install-recommends \
    "${missing[@]}" >/dev/null || fail "apt-get install failed; its reason is above"
}

# How many compilers at once: PCL's headers take up to 1.5 GB each.
parallel_jobs() {
  local cores memory
  cores=$(nproc)
  memory=$(awk '/^MemAvailable/ { print int($2 / 1500000) }' /proc/meminfo)
  [ "$memory" -ge 1 ] || memory=1
  echo $((cores < memory ? cores : memory))
}

# configure OPTION...: the release preset with these cache variables.
configure() {
  local log
  log=$(mktemp)
  (cd "$hoist_root" && cmake --preset release "$@") >"$log" 2>&1 || {
    cat "$log" >&2
    rm -f "$log"
    fail "cmake could not configure; its reason is above"
  }
  rm -f "$log"
}

# build TARGET...: all targets if none is named.
build() {
  cmake --build "$hoist_build" --parallel "$(parallel_jobs)" ${1:+--target "$@"} ||
    fail "the build failed; the compiler's reason is above"
}

# hand_over PATH...: what root made under sudo belongs to who called.
hand_over() {
  if [ "$(id -u)" -eq 0 ] && [ -n "${SUDO_UID:-}" ]; then
    chown -R "$SUDO_UID:${SUDO_GID:-$SUDO_UID}" "$@"
  fi
}
