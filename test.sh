#!/usr/bin/env bash
# test.sh - sets up what is missing, builds, runs every test; arguments go to ctest (-R gltf).
# SPDX-License-Identifier: Apache-2.0
set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/scripts/setup.sh"

install_packages build test
build release
exec ctest --test-dir "$OBSCURA_ROOT/build/release" -j "$(nproc)" --output-on-failure "$@"
