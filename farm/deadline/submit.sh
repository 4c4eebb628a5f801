#!/usr/bin/env bash
# farm/deadline/submit.sh - hands a picture to Thinkbox Deadline: a job of parts, one to merge them.
# SPDX-License-Identifier: Apache-2.0
# submit.sh PARTS OUTPUT SCENE [OPTIONS of obscura render...]
# Paths are as the workers see them, and must not hold spaces. Deadline's CommandLine plugin reads
# `Progress: 42%` and fails a task whose exit code is not 0.
set -euo pipefail

if (($# < 3)); then
    sed -n '4,6s/^# //p' "$0" >&2
    exit 64
fi
parts="$1" output="$2" scene="$3"
shift 3
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

# submit FRAMES ARGUMENTS [DEPENDENCY] - submits a job and prints its id.
submit() {
    printf '%s\n' 'Plugin=CommandLine' "Name=${output##*/} ($1)" "Frames=$1" 'ChunkSize=1' \
        ${3:+"JobDependencies=$3"} >"$folder/job.txt"
    printf '%s\n' 'Executable=obscura' "Arguments=$2" 'ShellExecute=False' >"$folder/plugin.txt"
    deadlinecommand "$folder/job.txt" "$folder/plugin.txt" | sed -n 's/^JobID=//p'
}

render="$(submit "1-$parts" \
    "render $scene -o $output $* --part <STARTFRAME>/$parts --farm deadline")"
files=()
for ((part = 1; part <= parts; ++part)); do files+=("$output.$part-of-$parts.film"); done
submit 1 "merge ${files[*]}" "$render"
