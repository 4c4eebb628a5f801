#!/usr/bin/env bash
# benchmarks/cost_of.sh - what options of `obscura render` cost: time with them and without, in turns.
# SPDX-License-Identifier: Apache-2.0
set -euo pipefail

usage() {
    cat <<'TEXT'
usage: benchmarks/cost_of.sh [--repeat N] [--obscura BIN] SCENE [OPTION...] -- OPTION...

Renders SCENE with the first options, then with all of them, N times in turns (5), and prints the
seconds of each pair, of the clock and of all cores, their ratios, and the medians of these. For
example, layers and passes:

  benchmarks/cost_of.sh shot.glb --size 1280x720 --spp 64 -- --aov albedo,normal,depth
  benchmarks/cost_of.sh shot.glb --size 1280x720 --spp 256 -- --time-limit 1000000

BIN is the program (build/release/bin/obscura). Exit code: 0 done, 64 usage, 70 a rendering failed.
TEXT
}

refuse() {
    printf 'cost_of.sh: %s\n' "$*" >&2
    usage >&2
    exit 64
}

here="$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)"
obscura="$here/../build/release/bin/obscura"
repeat=5
while (($# > 0)); do
    case "$1" in
        -h | --help)
            usage
            exit 0
            ;;
        --repeat)
            repeat="${2:-}"
            shift 2 || refuse "--repeat takes a number"
            ;;
        --obscura)
            obscura="${2:-}"
            shift 2 || refuse "--obscura takes a program"
            ;;
        *) break ;;
    esac
done
[[ "$repeat" =~ ^[1-9][0-9]*$ ]] || refuse "--repeat takes a number from 1"
[[ -x "$obscura" ]] || refuse "there is no program $obscura; give --obscura"
(($# > 0)) || refuse "a scene is missing"

scene="$1"
shift
always=()
while (($# > 0)) && [[ "$1" != -- ]]; do
    always+=("$1")
    shift
done
(($# > 1)) || refuse "the options to be measured are missing; they come after --"
shift

folder="$(mktemp -d)"
trap 'rm -rf -- "$folder"' EXIT

# Prints the seconds that a rendering takes: by the clock, and of all cores.
seconds_with() {
    local TIMEFORMAT='%R %U %S'
    if ! { time "$obscura" render "$scene" "${always[@]}" "$@" --quiet -o "$folder/picture.exr" \
        2>"$folder/log"; } 2>"$folder/time"; then
        cat "$folder/log" >&2
        exit 70
    fi
    awk '{print $1, $2 + $3}' "$folder/time"
}

for ((i = 0; i < repeat; ++i)); do
    without="$(seconds_with)"
    with="$(seconds_with "$@")"
    printf '%s %s\n' "$without" "$with"
done | awk '
    function median(values, count,    i, j, swap) {
        for (i = 2; i <= count; ++i)
            for (j = i; j > 1 && values[j - 1] > values[j]; --j) {
                swap = values[j]; values[j] = values[j - 1]; values[j - 1] = swap
            }
        return count % 2 ? values[(count + 1) / 2] : (values[count / 2] + values[count / 2 + 1]) / 2
    }
    NR == 1 { print "clock: without  with  ratio   cores: without  with  ratio" }
    {
        clock[NR] = $3 / $1; cores[NR] = $4 / $2
        printf "%14.2f %5.2f %6.3f %16.2f %5.2f %6.3f\n", $1, $3, clock[NR], $2, $4, cores[NR]
        fflush()
    }
    END {
        if (NR == 0) exit
        printf "medians of the ratios: %.3f by the clock, %.3f of all cores\n",
               median(clock, NR), median(cores, NR)
    }'
