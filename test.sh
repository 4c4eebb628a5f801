#!/usr/bin/env bash
# test.sh - sets up what is missing, builds, runs every test; arguments go to ctest (-L gltf).
# SPDX-License-Identifier: Apache-2.0
set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/scripts/setup.sh"

install_packages build test python
if [[ -f "$OBSCURA_ROOT/build/release/build.ninja" ]]; then
    reconfigure release OBSCURA_ISAS all  # run.sh leaves out those of other CPUs
fi
build release
ctest --test-dir "$OBSCURA_ROOT/build/release" -j "$(nproc)" --output-on-failure "$@"
# Tests that could not run here say so, though their room has passed.
grep '^\[  SKIPPED \] [^ ]* (' "$OBSCURA_ROOT/build/release/Testing/Temporary/LastTest.log" || true
