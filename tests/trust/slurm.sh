#!/usr/bin/env bash
# The job array of docs/cluster.md on a Slurm of one node, begun here for the purpose: tasks requeued and killed in the middle,
# merged by a dependent job, compared with the run at once. Needs root, slurmctld, slurmd and munged
# (Debian: slurm-wlm, munge). Says in reports/trust/slurm.txt what happened.
#   tests/trust/slurm.sh path/to/rockfall
set -euo pipefail
rockfall=$(realpath "${1:-target/release/rockfall}")
root=$(cd "$(dirname "$0")/../.." && pwd)
releases=8000 shards=8
work=$(mktemp -d /tmp/rockfall_slurm.XXXX)
daemons=()

stop() {
    for daemon in "${daemons[@]}"; do kill "$daemon" 2>/dev/null || true; done
    wait || true
    rm -rf "$work"
}
trap stop EXIT

begin_slurm() {
    mkdir -p "$work"/{munge,spool,state}
    chmod 755 "$work" "$work/munge"
    dd if=/dev/urandom of="$work/munge/key" bs=1024 count=1 status=none
    chmod 400 "$work/munge/key"
    munged --foreground --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munge/pid" \
        --seed-file="$work/munge/seed" --log-file="$work/munge/log" > "$work/munge/out" 2>&1 &
    daemons+=($!)
    export SLURM_CONF="$work/slurm.conf"
    cat > "$SLURM_CONF" <<CONF
ClusterName=one
SlurmctldHost=localhost
SlurmctldPort=16817
SlurmdPort=16818
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
MpiDefault=none
KillWait=5
ReturnToService=2
SchedulerParameters=sched_interval=5,batch_sched_delay=1
NodeName=localhost CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
    sleep 1
    slurmctld -D -c -f "$SLURM_CONF" > "$work/slurmctld.out" 2>&1 & daemons+=($!)
    sleep 2
    slurmd -D -f "$SLURM_CONF" -N localhost > "$work/slurmd.out" 2>&1 & daemons+=($!)
    for _ in $(seq 60); do
        sinfo -h -o %t 2>/dev/null | grep -q idle && return
        sleep 1
    done
    tail "$work"/*.log "$work"/*.out >&2
    exit 1
}

# The scene, and the script of docs/cluster.md as it stands there.
lay_out_study() {
    study="$work/study" && mkdir -p "$study/bin" "$study/terrain" "$study/scenes"
    cp "$root"/terrain/quick_*.stl "$study/terrain/"
    sed -e "s/^count = .*/count = $releases/" -e 's/"\.\.\/terrain/"terrain/' "$root/examples/quick.toml" > "$study/scene.toml"
    awk '/^#!\/bin\/bash/ { on = 1 } on && /^```/ { exit } on' "$root/docs/cluster.md" > "$study/array.sh"
    grep -q SLURM_ARRAY_TASK_ID "$study/array.sh"
    ln -s "$rockfall" "$study/bin/rockfall"
    export PATH="$study/bin:$PATH"
    cd "$study"
}

state_of() { squeue -h -r -j "$1" -o %T 2>/dev/null || true; }
done_of() { grep -o '"done": [0-9]*' "parts/$1/progress.json" 2>/dev/null | grep -o '[0-9]*' || echo 0; }

# Waits until the shard has rows on the disk and its task runs.
reach_middle() {
    for _ in $(seq 600); do
        [ "$(state_of "${id}_$1")" = RUNNING ] && [ "$(done_of "$1")" -gt 0 ] && return
        sleep 0.2
    done
    echo "shard $1 was never seen in its middle" >&2
    exit 1
}

requeue() {
    reach_middle "$1"
    say "task $1: scontrol requeue after $(done_of "$1") releases"
    scontrol requeue "${id}_$1"
}

# A task that dies is FAILED; whoever looks after the array queues it again.
kill_and_requeue() {
    reach_middle "$1"
    say "task $1: SIGKILL after $(done_of "$1") releases"
    kill -KILL "$(pgrep -f -- "--shard $1/$shards --out parts/$1\$" | head -1)"
    for _ in $(seq 50); do
        scontrol show job "${id}_$1" | grep -q JobState=FAILED && break
        sleep 0.2
    done
    say "task $1: $(scontrol show job "${id}_$1" | grep -o 'JobState=[A-Z]*' | head -1), then scontrol requeue"
    scontrol requeue "${id}_$1"
}

# A requeued task waits two minutes for its node to recover; this node has nothing to recover from.
wait_for_array() {
    for _ in $(seq 900); do
        [ -z "$(state_of "$id")" ] && return
        for task in $(squeue -h -r -j "$id" -t PENDING -o %K); do
            scontrol update jobid="${id}_$task" StartTime=now 2>/dev/null || true
        done
        sleep 1
    done
}

# The last word of the merging job, "stuck" if it can never begin.
merge_ends() {
    for _ in $(seq 120); do
        local job
        job=$(scontrol show job "$1")
        grep -q 'Reason=DependencyNeverSatisfied' <<< "$job" && { echo stuck; return; }
        grep -oE 'JobState=(COMPLETED|FAILED|CANCELLED)' <<< "$job" && return
        sleep 1
    done
    echo "still waiting"
}

say_tasks() {
    for task in $(seq $shards); do
        scontrol show job "${id}_$task" | grep -oE 'JobState=[A-Z]*|Restarts=[0-9]*' | tr '\n' ' '
    done | tr -s ' ' '\n' | sort | uniq -c | tr -s ' \n' ' ' | sed 's/^/tasks:/; s/$/\n/' | tee -a "$record"
}

submit() {
    rm -rf parts whole
    id=$(sbatch --parsable --array=1-$shards --cpus-per-task=1 array.sh)
    merge=$(sbatch --parsable --dependency=afterok:"$id" --wrap 'rockfall merge parts/* --out whole')
}

compare() {
    local same=0 file
    while read -r file; do
        cmp "at_once/$file" "whole/$file"
        same=$((same + 1))
    done < <(cd at_once && find . -type f ! -name .lock ! -name report.html ! -name summary.json | sort)
    diff <(sed '/"run": {/,$d' at_once/summary.json) <(sed '/"run": {/,$d' whole/summary.json)
    diff <(cd at_once && find . -type f | sort) <(cd whole && find . -type f | sort)
    say "merged = at once: $same files byte for byte, summary.json up to its clock"
}

say() { echo "$*" | tee -a "$record"; }

begin_slurm
lay_out_study
record="$work/record.txt"
say "Slurm $(slurmctld -V | cut -d' ' -f2), one node of 2 CPUs, $shards shards of $releases releases of examples/quick.toml"
rockfall run scene.toml --quiet --out at_once

say "-- array 1: tasks requeued in the middle"
submit
requeue 1
requeue 2
requeue 5
wait_for_array
say_tasks
say "merging job: $(merge_ends "$merge")"
compare

say "-- array 2: tasks killed in the middle"
submit
kill_and_requeue 3
kill_and_requeue 4
wait_for_array
say_tasks
ended=$(merge_ends "$merge")
say "merging job: $ended"
if [ "$ended" = stuck ]; then
    scancel "$merge"
    say "merging job sent again: $(merge_ends "$(sbatch --parsable --wrap 'rockfall merge parts/* --out whole')")"
fi
compare

mkdir -p "$root/reports/trust"
cp "$record" "$root/reports/trust/slurm.txt"
