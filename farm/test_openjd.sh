#!/usr/bin/env bash
# farm/test_openjd.sh - the Open Job Description template renders parts and merges them.
# SPDX-License-Identifier: Apache-2.0
set -euo pipefail
# shellcheck source=farm/testing.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/testing.sh"

need obscura python3
if ! python3 -c 'import jsonschema, yaml' 2>/dev/null; then
    say "SKIPPED: Python's jsonschema or yaml is not installed (packages:" \
        "$(listed_packages farm | tr '\n' ' '))"
    exit 0
fi
openjd="$OBSCURA_ROOT/farm/openjd"
run() {
    python3 "$openjd/run_template.py" "$openjd/render.template.yaml" "$@"
}

obscura render "${picture[@]}" --quiet -o whole.exr
run Scene="${picture[0]}" Output=shot.exr Parts=3 Options="${picture[*]:1} --quiet" | tee log
[[ "$(grep -c '^Render .*: progress 100 %' log)" == 3 ]] ||
    stop 'openjd: not every task told its progress'
cmp shot.exr whole.exr || stop 'openjd: the merged file differs from that of the unbroken run'
compgen -G 'shot.exr.*' && stop 'openjd: parts are left'

# What goes wrong is told in the manager's own words.
if run Scene=/nowhere.glb Output=lost.exr Parts=1 >log 2>&1; then
    stop 'openjd: a missing scene was taken'
fi
grep -q '^run_template.py: Render: exit code 66: .*/nowhere.glb' log ||
    stop "openjd: the failure is not told: $(cat log)"
say 'openjd: 3 parts, merged to the bits of the unbroken run'
