#!/usr/bin/env bash
# bash apps/demo.sh [FILE...] [OPTION...]
#
# Installs the system packages where missing, builds the release and recognises the
# shipped sample scenes, or the given files, into hoist-demo/. Arguments go to
# `hoist recognize`. Safe to run again.
# shellcheck source=.ci/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../.ci/setup.sh"

output=$hoist_root/hoist-demo
inputs=("$@")
named=false
for argument in "$@"; do
  [ ! -f "$argument" ] || named=true
done
if [ "$named" = false ]; then
  inputs+=("$hoist_root"/data/samples/scenes/*.pcd)
fi

install_packages "${hoist_packages[@]}"
echo "Building hoist in ${hoist_build#"$PWD"/}"
configure -DHOIST_BUILD_APPS=ON
build hoist hoist_viewer
"$hoist_build/apps/hoist" recognize "${inputs[@]}" -o "$output"
hand_over "$hoist_root/build" "$output"
echo "The overlays (PNG) and the results (JSON) are in $output"
