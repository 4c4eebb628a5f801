#!/usr/bin/env bash
# benchmarks/versus_cycles.sh - Obscura beside Blender Cycles: speed, and time to equal error.
# SPDX-License-Identifier: Apache-2.0
set -euo pipefail

usage() {
    cat <<'TEXT'
usage: benchmarks/versus_cycles.sh [options] SCENE...

Renders each glTF file with Obscura and with Blender Cycles: same camera, environment, size, samples
and bounces, both on every core, in turns. Prints samples per second of each and how long each
takes to the same error. docs/performance.md says what the columns mean.

  --env FILE             environment of every scene (the project's sky)
  --view NAME            whole, close or both (both); the views are those of obscura bench
  --eye, --target, --up X,Y,Z, --fov DEG   one view placed by hand, as in obscura render
  --size WxH             picture that is timed (1280x720)
  --spp N                samples per pixel (64)
  --depth N              most bounces (8)
  --repeat N             pairs of renderings; medians count (3)
  --error-size WxH       picture whose error is measured (192x108)
  --error-seeds N        pictures whose errors are averaged (as many as --repeat); dozens of them
                         where rare samples decide, such as the sun in small mirrors
  --reference-samples N  samples per pixel of the references (16384); 0 leaves the error out
  --json FILE            write all figures
  --keep DIR             keep the pictures and Blender's log there
  --obscura BIN          the program (build/release/bin/obscura)
  --blender BIN          Blender 2.93 or later with numpy (blender)

Exit code: 0 done, 64 usage, 69 Blender or its numpy is missing, 70 a rendering failed.
TEXT
}

refuse() {
    printf 'versus_cycles.sh: %s\n' "$*" >&2
    usage >&2
    exit 64
}

here="$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)"
declare -A option=(
    [env]="$here/../assets/environments/sky.hdr" [view]=both [size]=1280x720 [spp]=64 [depth]=8
    [repeat]=3 [error-size]=192x108 [error-seeds]=0 [reference-samples]=16384 [json]='' [keep]=''
    [obscura]="$here/../build/release/bin/obscura" [blender]=blender
)
camera=()
scenes=()
while (($# > 0)); do
    case "$1" in
        -h | --help)
            usage
            exit 0
            ;;
        --eye | --target | --up | --fov)
            (($# > 1)) || refuse "$1 needs a value"
            camera+=("$1=$2")
            shift
            ;;
        --)
            shift
            scenes+=("$@")
            break
            ;;
        --*)
            [[ -n "${option[${1#--}]+known}" ]] || refuse "unknown option $1"
            (($# > 1)) || refuse "$1 needs a value"
            option[${1#--}]="$2"
            shift
            ;;
        -*) refuse "unknown option $1" ;;
        *) scenes+=("$1") ;;
    esac
    shift
done
((${#scenes[@]} > 0)) || refuse "give a glTF file"
for name in size error-size; do
    [[ "${option[$name]}" =~ ^[1-9][0-9]*x[1-9][0-9]*$ ]] || refuse "--$name is WxH"
done
for name in spp depth repeat; do
    [[ "${option[$name]}" =~ ^[1-9][0-9]*$ ]] || refuse "--$name is a number from 1"
done
for name in error-seeds reference-samples; do
    [[ "${option[$name]}" =~ ^[0-9]+$ ]] || refuse "--$name is a number"
done
((option[error-seeds] > 0)) || option[error-seeds]="${option[repeat]}"
[[ "${option[view]}" =~ ^(whole|close|both)$ ]] || refuse "--view is whole, close or both"
for file in "${option[env]}" "${scenes[@]}"; do
    [[ -r "$file" ]] || refuse "$file cannot be read"
done
[[ -x "${option[obscura]}" ]] ||
    refuse "${option[obscura]} is not there: build it with ./run.sh, or give --obscura"
if ! command -v "${option[blender]}" >/dev/null; then
    printf 'versus_cycles.sh: %s is not there. On Debian: %s; elsewhere give --blender\n' \
        "${option[blender]}" 'apt-get install --no-install-recommends blender python3-numpy' >&2
    exit 69
fi

work="${option[keep]}"
if [[ -z "$work" ]]; then
    work="$(mktemp -d)"
    trap 'rm -rf -- "$work"' EXIT
fi
mkdir -p -- "$work"
settings=()
for name in "${!option[@]}"; do
    case "$name" in
        blender | keep) ;;
        *) settings+=("--$name=${option[$name]}") ;;
    esac
done

# Blender talks a lot on standard output: descriptor 3 is the way past its log.
code=0
"${option[blender]}" -b --factory-startup --python-exit-code 70 -P "$here/versus_cycles.py" -- \
    "${settings[@]}" --work="$work" "${camera[@]/#--/--camera=--}" -- "${scenes[@]}" \
    3>&1 >"$work/blender.log" 2>&1 </dev/null || code=$?
if ((code != 0)); then
    tail -n 20 -- "$work/blender.log" >&2
    printf 'versus_cycles.sh: Blender ended with exit code %d\n' "$code" >&2
    if ((code != 69)); then code=70; fi
fi
exit "$code"
