#!/usr/bin/env bash
# install_test.sh BUILD_DIR SOURCE_DIR WORK_DIR
#
# Installs the build and uses it as a stranger does: with find_package and with
# pkg-config. Everything stays inside WORK_DIR.
set -euo pipefail
build=$1 source=$2 work=$3
rm -rf "$work"
mkdir -p "$work"
prefix=$work/prefix

cmake --install "$build" --prefix "$prefix" >"$work/install.log"

echo "find_package(hoist)"
launcher=()
if command -v ccache >/dev/null; then
  launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
cmake -S "$source/consumer" -B "$work/build" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$prefix" "${launcher[@]}" >"$work/configure.log" 2>&1 || {
  cat "$work/configure.log"
  exit 1
}
if grep -q '^VTK_DIR' "$work/build/CMakeCache.txt"; then
  echo "find_package(hoist) went looking for VTK, which only programs may need"
  exit 1
fi
cmake --build "$work/build"
"$work/build/consumer"

echo "pkg-config"
libdir=$(dirname "$(find "$prefix" -name libhoist_data.so)")
export PKG_CONFIG_PATH=$libdir/pkgconfig
read -r -a flags <<<"$(pkg-config --cflags --libs hoist_recognition)"
c++ -std=c++17 -O1 "$source/consumer/main.cpp" "${flags[@]}" \
  -Wl,-rpath,"$libdir" -o "$work/consumer"
"$work/consumer"

echo "all four libraries have a .pc file"
for module in data filters segmentation recognition; do
  pkg-config --exists "hoist_$module"
done

echo "the programs run from where they are installed"
"$prefix/bin/hoist" --version
