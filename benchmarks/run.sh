#!/usr/bin/env bash
# benchmarks/run.sh - sets up, builds and runs the micro-benchmarks; --json FILE keeps the figures.
# SPDX-License-Identifier: Apache-2.0
set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../scripts/setup.sh"

usage() {
    cat <<'TEXT'
usage: benchmarks/run.sh [--json FILE] [--benchmark_...] [SCENE [ENVIRONMENT]]

Measures every stage and every kernel on each instruction set that this CPU has, on one thread;
items_per_second is what to compare. Other options are Google Benchmark's own, for example

  --benchmark_filter='shade|texture.*/avx2'
  --benchmark_repetitions=9 --benchmark_report_aggregates_only=true

Without SCENE it takes the showcase under the sky. SCENE needs a texture.
TEXT
}

arguments=()
while (($# > 0)); do
    case "$1" in
        -h | --help)
            usage
            exit 0
            ;;
        --json)
            if (($# < 2)); then
                usage >&2
                exit 64
            fi
            arguments+=("--benchmark_out=$2" --benchmark_out_format=json)
            shift
            ;;
        *) arguments+=("$1") ;;
    esac
    shift
done

install_packages build bench
build bench obscura_micro
exec "$OBSCURA_ROOT/build/bench/bin/obscura_micro" "${arguments[@]}"
