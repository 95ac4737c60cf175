#!/usr/bin/env bash
# others.sh MAKE_IFC_MODELS SOURCE_DIR WORK_DIR: models that this project writes, read by
# programs that other people wrote (npm packages). Exit code 77: they are not to be had.
set -euo pipefail

make_models=$1 source_dir=$2 work=$3

skip() {
  echo "skipped: $*"
  exit 77
}

command -v node >/dev/null || skip "node is not installed"
command -v npm >/dev/null || skip "npm is not installed"
major=$(node -p 'process.versions.node.split(".")[0]')
[ "$major" -ge 18 ] || skip "node is older than 18"

mkdir -p "$work/models"
cp "$source_dir/package.json" "$source_dir/package-lock.json" "$source_dir/verify.mjs" "$work"
cd "$work"
if ! cmp -s package-lock.json node_modules/.installed; then
  timeout 300 npm ci --ignore-scripts --no-audit --no-fund --loglevel=error --fetch-retries=1 >npm.log 2>&1 ||
    skip "the npm packages cannot be installed: $(tail -n 1 npm.log)"
  cp package-lock.json node_modules/.installed
fi
"$make_models" models
node verify.mjs models
