#!/usr/bin/env bash
# scripts/inject_faults.sh - lets system calls of a small rendering fail, one in each run.
# SPDX-License-Identifier: Apache-2.0
set -euo pipefail

usage() {
    cat <<'TEXT'
usage: scripts/inject_faults.sh [--obscura BIN] [--every N] [--scene FILE]

Renders over an existing picture again and again, with layers, a PNG and a checkpoint. In each run
one system call fails (strace): every call for files and memory from the first look at the scene on,
or every Nth of them. Then both pictures must be whole, the old ones or the new ones, the exit code
must be one of the contract, and the result line must be there. Prints each run that breaks this.

BIN is the program (build/release/bin/obscura), FILE the scene (the demo scene).
Exit code: 0 all held, 1 some did not, 64 usage, 69 there is no strace or it may not trace.
TEXT
}

refuse() {
    printf 'inject_faults.sh: %s\n' "$*" >&2
    usage >&2
    exit 64
}

root="$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)"
obscura="$root/build/release/bin/obscura"
scene="$root/assets/cornell/cornell.gltf"
every=1
while (($# > 0)); do
    case "$1" in
        -h | --help)
            usage
            exit 0
            ;;
        --obscura | --scene | --every)
            (($# > 1)) || refuse "$1 takes a value"
            declare "${1#--}=$2"
            shift 2
            ;;
        *) refuse "there is no option $1" ;;
    esac
done
[[ "$every" =~ ^[1-9][0-9]*$ ]] || refuse "--every takes a number from 1"
[[ -x "$obscura" ]] || refuse "there is no program $obscura; give --obscura"
[[ -r "$scene" ]] || refuse "there is no scene $scene"
obscura="$(realpath -- "$obscura")"
scene="$(realpath -- "$scene")"
strace -o /dev/null true 2>/dev/null || {
    echo "inject_faults.sh: there is no strace that may trace" >&2
    exit 69
}

folder="$(mktemp -d)"
trap 'rm -rf -- "$folder"' EXIT
cd "$folder"
mkdir tmp
export TMPDIR="$folder/tmp"

command_with_seed() {
    printf '%s\0' "$obscura" render "$scene" --size 48x32 --spp 16 --threads 2 --seed "$1" --quiet \
        --aov normal,crypto_object --checkpoint --checkpoint-interval 0.05 -o a.exr -o a.png
}
mapfile -d '' -t old < <(command_with_seed 1)
mapfile -d '' -t new < <(command_with_seed 2)
keep() { cp a.exr "$1.exr" && cp a.png "$1.png"; }
"${new[@]}" && keep new
"${old[@]}" && keep old

# Which calls there are, and how many before the program looks at the scene: those are the loader's.
calls=(openat read pread64 write pwrite64 writev lseek close fstat newfstatat rename renameat
    renameat2 unlink unlinkat fsync fdatasync ftruncate fallocate mkdir access readlink getdents64
    mmap)  # brk returns no errors but the old address, which strace cannot make it do
known="$(IFS=,; printf '%s' "${calls[*]/#/?}")"  # ?: those that this machine does not have
strace -f -o calls.log -e "trace=$known" "${new[@]}"
begin="$(grep -n -m 1 -F "$scene" calls.log | cut -d : -f 1)"
main="$(head -n 1 calls.log | cut -d ' ' -f 1)"

# The counts that strace injects by are those of each thread.
calls_of() { awk -v call="$1" -v lines="$2" -v main="$main" '
    NR > lines + 0 && lines != "" { exit }
    lines != "" && $1 != main { next }
    index($2, call "(") == 1 && ++count[$1] > most { most = count[$1] }
    END { print most + 0 }' calls.log; }

runs=0
broken=0
complain() {
    broken=$((broken + 1))
    printf '%s of call %s: %s (exit code %s)\n' "$1" "$2" "$4" "$3"
}

# The header has the number of warnings, such as of a checkpoint that was not written, and a
# fingerprint of what could be read once more: the bytes after these names may differ.
may_differ() { grep -abo -e 'obscura:warnings' -e 'obscura:fingerprint' "new.$1" | cut -d : -f 1; }
is_new() {
    cmp -s "$1" "new.$2" && return
    [[ -f "$1" && "$(stat -c %s "$1")" == "$(stat -c %s "new.$2")" ]] || return 1
    { cmp -l "$1" "new.$2" || true; } | awk -v from="$(may_differ "$2")" '
        BEGIN { count = split(from, first, "\n") }
        { fits = 0
          for (i = 1; i <= count; ++i)
              fits = fits || ($1 > first[i] + 0 && $1 <= first[i] + 64)
          bad = bad || !fits }
        END { exit bad }'
}
is_one_of() { cmp -s "$1" "old.$2" || is_new "$1" "$2"; }

try() {
    local fault="$1" number="$2" code=0
    cp old.exr a.exr
    cp old.png a.png
    rm -f a.exr.checkpoint* ./*.part tmp/*
    timeout 60 strace -f --seccomp-bpf -o injected.log -e "trace=${fault%%:*}" \
        -e "inject=$fault:when=$number" "${new[@]}" 2>messages || code=$?
    runs=$((runs + 1))
    case "$code" in
        0)
            if ! is_new a.exr exr || ! is_new a.png png; then
                complain "$fault" "$number" "$code" "success without the new pictures"
            fi
            ;;
        33 | 6[4-9] | 7[0-8]) ;;
        *) complain "$fault" "$number" "$code" "no exit code of the contract: $(tail -n 1 messages)" ;;
    esac
    is_one_of a.exr exr || complain "$fault" "$number" "$code" "a.exr is torn"
    is_one_of a.png png || complain "$fault" "$number" "$code" "a.png is torn"
    ((code == 0)) || grep -q '^RESULT code=' messages || grep -q 'write(2.*INJECTED' injected.log ||
        complain "$fault" "$number" "$code" "no result line"
}

for call in "${calls[@]}"; do
    first=$(($(calls_of "$call" "$begin") + 1))
    last="$(calls_of "$call" "")"
    errors=(EIO)
    case "$call" in
        write | pwrite64 | writev | ftruncate | fallocate | fsync) errors+=(ENOSPC) ;;
        openat | rename* | unlink* | mkdir) errors+=(EACCES) ;;
        mmap) errors=(ENOMEM) ;;
    esac
    for ((number = first; number <= last; number += every)); do
        for error in "${errors[@]}"; do
            try "$call:error=$error" "$number"
        done
    done
done
printf '%s runs, %s broke the contract\n' "$runs" "$broken"
((broken == 0))
