#!/usr/bin/env bash
# run.sh - sets up what is missing, builds, runs obscura; by itself it renders the showcase.
# SPDX-License-Identifier: Apache-2.0
set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/scripts/setup.sh"

install_packages build test
# A newer compiler's new warnings must not stop anybody, and what is built here is run here: for one
# instruction set instead of three it takes half the time.
OBSCURA_CONFIGURE=(-DOBSCURA_WERROR=OFF -DOBSCURA_ISAS=native)
build release obscura
obscura="$OBSCURA_ROOT/build/release/bin/obscura"

if (($# > 0)); then
    exec "$obscura" "$@"
fi

"$obscura" render "$OBSCURA_ROOT/assets/showcase/showcase.gltf" \
    --env "$OBSCURA_ROOT/assets/environments/sky.hdr" \
    --size 1280x720 --spp 64 -o showcase.exr -o showcase.png
say "the showcase is in $PWD: showcase.exr (scene-linear) and showcase.png (to look at)"
