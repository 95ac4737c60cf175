#!/usr/bin/env bash
# bash tests/run.sh [CTEST OPTION...]     e.g.  bash tests/run.sh -R features
#
# Installs the system packages where missing, builds the release with its tests and
# runs them all. Tests on real clouds run where HOIST_REAL_DATA names their folder and
# are skipped elsewhere. Safe to run again.
# shellcheck source=.ci/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../.ci/setup.sh"

install_packages "${hoist_packages[@]}" "${hoist_test_packages[@]}"
echo "Building hoist and its tests in ${hoist_build#"$PWD"/}"
configure -DHOIST_BUILD_APPS=ON -DHOIST_BUILD_TESTS=ON
build all
hand_over "$hoist_root/build"
trap - ERR # ctest says itself what failed
ctest --test-dir "$hoist_build" --output-on-failure --parallel "$(parallel_jobs)" "$@"
