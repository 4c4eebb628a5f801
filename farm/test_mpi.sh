#!/usr/bin/env bash
# farm/test_mpi.sh - mpirun starts the parts of a picture, as they are merged to the same bits.
# SPDX-License-Identifier: Apache-2.0
set -euo pipefail
# shellcheck source=farm/testing.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/testing.sh"

need obscura mpirun
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
mpirun -n 4 --oversubscribe obscura render "${picture[@]}" --quiet -o shot.exr --part auto
expect_whole 4 'mpirun'
mpirun -n 3 --oversubscribe obscura render "${picture[@]}" --quiet -o shot.exr --part auto \
    --part-by samples
expect_whole 3 'mpirun, parts of samples'
