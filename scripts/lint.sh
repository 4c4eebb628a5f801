#!/usr/bin/env bash
# scripts/lint.sh - clang-format and clang-tidy over the tree: lint.sh [format] [tidy], or both.
# SPDX-License-Identifier: Apache-2.0
set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$OBSCURA_ROOT"

# The first of these programs that is installed.
first_program() {
    local program
    for program in "$@"; do
        if command -v "$program"; then return 0; fi
    done
    stop "none of these is installed: $*"
}

# Other versions of clang-format lay out the same text differently, so only 14 has a say.
check_format() {
    local program files
    program="$(first_program clang-format-14 clang-format)"
    if [[ "$("$program" --version)" != *"version 14."* ]]; then
        say "format is not checked: that needs clang-format 14, as in Debian 12"
        return 0
    fi
    mapfile -d '' files < <(find src tests benchmarks include examples python -type f \( -name '*.h' -o -name '*.cpp' \) \
        -print0 | sort -z)
    "$program" --dry-run --Werror "${files[@]}" || stop "run $program -i on the files above"
    say "format: ${#files[@]} files are as .clang-format wants them"
}

# The stages are compiled once per instruction set; one of the entries is enough.
write_tidy_database() {
    mkdir -p build/clang/tidy
    awk '
        /^\{/ { entry = ""; file = "" }
        { entry = entry $0 "\n" }
        /^ *"file":/ { file = $0 }
        /^\}/ {
            if (file ~ /\/src\// && !(file in seen)) {
                seen[file] = 1
                sub(/,?\n$/, "", entry)
                printf "%s%s", separator, entry
                separator = ",\n"
            }
        }
        BEGIN { print "[" }
        END { print "\n]" }
    ' build/clang/compile_commands.json >build/clang/tidy/compile_commands.json
}

check_tidy() {
    local program files
    program="$(first_program clang-tidy-14 clang-tidy)"
    if [[ ! -f build/clang/build.ninja ]]; then configure clang; fi
    write_tidy_database
    mapfile -t files < <(sed -n 's/^ *"file": "\(.*\)",\{0,1\}$/\1/p' \
        build/clang/tidy/compile_commands.json)
    ((${#files[@]} > 0)) || stop "build/clang lists no source files"
    if ! printf '%s\0' "${files[@]}" |
        xargs -0 -n 1 -P "$(build_jobs)" "$program" -p build/clang/tidy --quiet 2>&1 |
        sed -u -e '/warnings\{0,1\} generated\.$/d' >&2; then
        stop "clang-tidy found what .clang-tidy forbids"
    fi
    say "tidy: ${#files[@]} source files pass"
}

if (($# == 0)); then set -- format tidy; fi
for check in "$@"; do
    case "$check" in
        format) check_format ;;
        tidy) check_tidy ;;
        *) stop "lint.sh knows the checks format and tidy, not $check" ;;
    esac
done
