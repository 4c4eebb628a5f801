# farm/testing.sh - what the tests of launchers share: a picture in parts, compared with a whole one.
# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# To be sourced.
# shellcheck source=scripts/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../scripts/setup.sh"

PATH="$OBSCURA_ROOT/build/release/bin:$PATH"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit

# A picture with layers, ids and a catcher, made in seconds.
picture=("$OBSCURA_ROOT/assets/showcase/showcase.gltf" --size 320x180 --spp 64 --catcher ground
    --aov 'normal,crypto_object,diffuse_direct')

# need PROGRAM... - ends the test, and says so, where one is not installed.
need() {
    local program
    for program in "$@"; do
        command -v "$program" >/dev/null && continue
        say "SKIPPED: $program is not installed (packages: $(listed_packages farm | tr '\n' ' '))"
        exit 0
    done
}

# expect_whole PARTS WHAT - merges shot.exr's parts and compares the file with the unbroken run's.
expect_whole() {
    [[ -f whole.exr ]] || obscura render "${picture[@]}" --quiet -o whole.exr
    obscura merge shot.exr.*-of-"$1".film --quiet
    cmp shot.exr whole.exr || stop "$2: the merged file differs from that of the unbroken run"
    rm -f shot.exr shot.exr.*.film
    say "$2: $1 parts, merged to the bits of the unbroken run"
}
