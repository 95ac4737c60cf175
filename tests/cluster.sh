#!/usr/bin/env bash
# sudo bash tests/cluster.sh [PROGRAM]
#
# hoist batch on a real Slurm: a controller and three nodes on this machine, one of them
# killed in mid-run. The merged results must be those of one process alone, byte for
# byte. Needs root (munge and slurmd do); installs slurm-wlm and munge where missing;
# uses folders and ports of its own and leaves nothing running.
# shellcheck source=.ci/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../.ci/setup.sh"

[ "$(id -u)" -eq 0 ] || fail "must be run as root"
install_packages slurm-wlm munge
hoist=${1:-$hoist_build/apps/hoist}
[ -x "$hoist" ] || fail "no program $hoist: run tests/run.sh first"
hoist=$(realpath "$hoist")

unshare --pid --mount-proc --fork true 2>/dev/null || {
  echo "cluster.sh: skipped: no process namespaces here, and nodes need them"
  exit 0
}

port=$((20000 + RANDOM % 10000)) # of the controller; the nodes' follow
folder=$(mktemp -d)
chmod 755 "$folder"
pids=()
finish() {
  kill -KILL "${pids[@]}" 2>/dev/null || true # unshare lets no other signal through
  wait 2>/dev/null || true
  [ ! -f "$folder/munge/pid" ] || kill "$(cat "$folder/munge/pid")" 2>/dev/null || true
  rm -rf "$folder"
}
trap finish EXIT

# ------------------------------------------------------------------------ the cluster
install -d -o munge -m 755 "$folder/munge"
dd if=/dev/urandom of="$folder/munge/key" bs=1024 count=1 status=none
chown munge "$folder/munge/key"
chmod 400 "$folder/munge/key"
runuser -u munge -- /usr/sbin/munged --key-file="$folder/munge/key" \
  --socket="$folder/munge/socket" --pid-file="$folder/munge/pid" \
  --log-file="$folder/munge/log" --seed-file="$folder/munge/seed"

export SLURM_CONF=$folder/slurm.conf
mkdir "$folder/state"
cat >"$SLURM_CONF" <<CONF
ClusterName=hoist
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=$port
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
ReturnToService=2
SlurmdTimeout=5
SchedulerParameters=batch_sched_delay=1
MaxArraySize=100001
MailProg=/bin/true
StateSaveLocation=$folder/state
SlurmctldPidFile=$folder/slurmctld.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdSpoolDir=$folder/spool.%n
SlurmdPidFile=$folder/slurmd.%n.pid
SlurmdLogFile=$folder/slurmd.%n.log
NodeName=n[1-3] NodeHostname=localhost NodeAddr=127.0.0.1 Port=[$((port + 1))-$((port + 3))] CPUs=2 RealMemory=4000
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
slurmctld -D -c -i >/dev/null 2>&1 &
pids+=($!)
declare -A node_pid
for node in n1 n2 n3; do
  mkdir "$folder/spool.$node"
  # a node is a process namespace: when its first process goes, all its jobs go
  setsid unshare --pid --mount-proc --fork --kill-child slurmd -D -N "$node" \
    >/dev/null 2>&1 &
  node_pid[$node]=$!
  pids+=($!)
  disown # its end is no news
done

# wait_for SECONDS WHAT COMMAND...: until the command succeeds.
wait_for() {
  local end=$((SECONDS + $1)) what=$2
  shift 2
  until "$@" >/dev/null 2>&1; do
    [ $SECONDS -lt $end ] || {
      tail -n 20 "$folder"/slurm*.log >&2
      fail "waited in vain for $what"
    }
    sleep 0.5
  done
}
idle_nodes() { [ "$(sinfo -h -N -t idle -o %N | sort -u | wc -l)" -eq 3 ]; }
wait_for 60 "three idle nodes" idle_nodes
echo "Slurm $(sinfo --version | cut -d' ' -f2) with three nodes"

# ---------------------------------------------------------------------------- the work
mkdir "$folder/in"
scenes=("$hoist_root"/data/samples/scenes/*.pcd)
for i in $(seq -w 0 119); do
  cp -p "${scenes[$((10#$i % ${#scenes[@]}))]}" "$folder/in/$i.pcd"
done
echo "not a cloud" >"$folder/in/bad.pcd"
cd "$folder"
settings=(in --formats "json,csv")
"$hoist" batch "${settings[@]}" --out alone --quiet || [ $? -eq 3 ]

# -------------------------------------------------------------- the array, and the loss
export HOIST=$hoist HOIST_WATCH_SECONDS=1
tool=$hoist_root/apps/cluster/hoist-slurm
start=$SECONDS
"$tool" submit -n 12 -o out -s '--cpus-per-task=1 --mem=600' -- "${settings[@]}"
job=$(cat out/cluster/job)
busy_second_node() {
  [ -n "$(squeue -h -t running -w n2 -o %A)" ] &&
    [ "$(find out/results -name '*.json' | wc -l)" -ge 5 ]
}
wait_for 60 "work on node n2" busy_second_node
records=$(find out/results -name '*.json' | wc -l)
kill -KILL "${node_pid[n2]}"
echo "node n2 killed with $(squeue -h -t running -w n2 -o %A | wc -l) tasks, after $records of 121 records"
lost_node() { sinfo -h -N -n n2 -o %t | grep -q down; }
wait_for 90 "Slurm to see the loss" lost_node
# Slurm waits two minutes before it starts a lost task again; not here
while sleep 2; do
  scontrol update JobId="$job" StartTime=now || true
done >/dev/null 2>&1 &
nudge=$!
pids+=("$nudge")
disown
"$tool" watch -o out
kill -KILL "$nudge"
code=0
"$tool" merge -o out || code=$?
[ "$code" -eq 3 ] || fail "the merge ended with $code, not with 3 (one file is quarantined)"
echo "all shards done and merged after $((SECONDS - start)) s"

# ------------------------------------------------------------------------- the verdict
[ -z "$(find out -maxdepth 1 -name '.run-*')" ] || fail "unfinished files are left"
rm -rf out/cluster
diff -r alone out || fail "the cluster's results differ from those of one process"
echo "identical: $(find out -type f | wc -l) files"
