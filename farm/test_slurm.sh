#!/usr/bin/env bash
# farm/test_slurm.sh - a Slurm of one machine: an array with a task that is killed, a merge, srun.
# SPDX-License-Identifier: Apache-2.0
set -euo pipefail
# shellcheck source=farm/testing.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/testing.sh"

need obscura munged slurmctld slurmd sbatch srun scontrol runuser
if [[ "$(id -u)" != 0 ]]; then
    say 'SKIPPED: slurmd needs root'
    exit 0
fi

stop_slurm() {
    local pid
    for pid in "$folder"/{slurmd,slurmctld,munged}.pid; do
        if [[ -s "$pid" ]]; then kill "$(cat "$pid")" 2>/dev/null || true; fi
    done
    sleep 1
    rm -rf "$folder"
}
trap stop_slurm EXIT

# Daemons with a configuration of their own: none that is installed is read or changed.
start_slurm() {
    local host
    host="$(hostname -s)"
    chmod 755 "$folder"
    mkdir -p munge state spool
    head -c 1024 /dev/urandom >munge/key
    chown -R munge munge
    chmod 711 munge
    chmod 400 munge/key
    runuser -u munge -- munged --key-file "$folder/munge/key" --socket "$folder/munge/socket" \
        --log-file "$folder/munge/log" --pid-file "$folder/munge/pid" --seed-file "$folder/munge/seed"
    ln -s munge/pid munged.pid
    cat >slurm.conf <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=17817
SlurmdPort=17818
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,bf_interval=1
KillWait=5
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
    printf 'CgroupPlugin=cgroup/v1\n' >cgroup.conf
    export SLURM_CONF="$folder/slurm.conf"
    slurmctld -f "$SLURM_CONF"
    slurmd -f "$SLURM_CONF"
    wait_for 'the node' sinfo_says idle
}

sinfo_says() { sinfo --noheader --format %t | grep -q "^$1"; }
has_ended() { ! squeue --noheader --jobs "$1" 2>/dev/null | grep -q .; }
runs_or_has_ended() { is_running "$1" || has_ended "$1"; }
is_running() { squeue --noheader --states RUNNING --jobs "$1" 2>/dev/null | grep -q .; }

# wait_for WHAT COMMAND... - until the command succeeds, for two minutes at most.
wait_for() {
    local what="$1" i
    shift
    for ((i = 0; i < 1200; ++i)); do
        if "$@"; then return 0; fi
        sleep 0.1
    done
    tail -n 20 ./*.log >&2 || true
    stop "Slurm: waited in vain for $what"
}

start_slurm
scripts="$OBSCURA_ROOT/farm/slurm"

# Task 2 is thrown out as soon as it runs, and comes back. The merge waits for all of them.
job="$(sbatch --parsable --array=1-3 "$scripts/render.sbatch" "${picture[@]}" --quiet -o shot.exr)"
wait_for 'task 2' is_running "${job}_2"
scontrol requeue "${job}_2"
scontrol update jobid="${job}_2" StartTime=now
merge="$(sbatch --parsable --dependency="afterok:$job" "$scripts/merge.sbatch" shot.exr 3)"
wait_for 'the merge' has_ended "$merge"
[[ -f shot.exr ]] || { cat ./*.log >&2; stop 'sbatch: the merge wrote no file'; }
mv shot.exr by_slurm.exr
expect_whole 3 'sbatch --array, a task requeued'
cmp by_slurm.exr whole.exr || stop 'sbatch: the merge under Slurm wrote other bits'

# A task that is killed leaves no file, so that a merge refuses, and is run again. One that had ended
# before the signal came shows nothing: then another is killed.
for _ in 1 2 3 4 5; do
    job="$(sbatch --parsable --array=1-2 "$scripts/render.sbatch" "${picture[@]}" --quiet -o shot.exr)"
    wait_for 'task 1' runs_or_has_ended "${job}_1"
    scancel "${job}_1"
    wait_for 'the rest' has_ended "$job"
    [[ -f shot.exr.1-of-2.film ]] || break
    rm -f shot.exr.*.film
done
if obscura merge shot.exr.*-of-2.film --quiet 2>refused.log; then
    stop 'scancel: a merge without part 1 passed'
fi
grep -q E-PART-SET refused.log || stop "scancel: $(cat refused.log)"
obscura render "${picture[@]}" --quiet -o shot.exr --part 1/2
expect_whole 2 'scancel, part rendered again'

srun --ntasks 2 --overcommit obscura render "${picture[@]}" --quiet -o shot.exr --part auto
expect_whole 2 'srun'

srun --ntasks 2 --overcommit obscura render "${picture[@]}" --quiet -o shot.exr --part auto \
    --part-by samples
expect_whole 2 'srun, parts of samples'
