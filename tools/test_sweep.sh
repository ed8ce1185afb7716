#!/usr/bin/env bash
# Test that a sweep of stability_map gives the same bytes whoever runs it: one
# job, two jobs, one that is interrupted and goes on, and a Slurm array on a
# single-node Slurm of its own on the loopback, where Slurm is installed.
# Also that stability_map refuses what it can't do.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${BUILD:-build}
stability_map=$build/stability_map
make -s stability_map B="$build"

tmp=$(mktemp -d)
pids=()
cleanup() {
  [ ${#pids[@]} = 0 ] || kill "${pids[@]}" 2>/dev/null || true
  wait 2>/dev/null || true
  rm -rf "$tmp"
}
trap cleanup EXIT
passed=0 failed=0 why=""
ok() {  # ends a case
  if [ -z "$why" ]; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1)) && echo "FAIL $1:$why"
  fi
  why=""
}

join() {  # all maps of the cells in DIR, as DIR.joined
  BUILD=$build lab/charts/stability.sh tiny "$1" limits table growth oscillator \
    >"$1.joined"
}
start() {  # a sweep in DIR: its list
  mkdir -p "$1"
  "$stability_map" --tiny --list >"$1/list"
}
cells() {  # by make: DIR OPTION...
  make --no-print-directory "${@:2}" cells B="$build" EFFORT=tiny SWEEP="$1"
}
same() {  # the joined maps of DIR are those of one job
  join "$1" && cmp "$tmp/one.joined" "$1.joined" || why+=" $1 has other bytes;"
}

# ------------------------------------------------------------------------ make
start "$tmp/one" && cells "$tmp/one" -j1 >"$tmp/log"
total=$(wc -l <"$tmp/one/list")
join "$tmp/one" || why+=" can't be joined;"
grep -q "^$total/$total cells\$" "$tmp/log" || why+=" no progress is shown;"
for map in limits table growth oscillator; do
  grep -q "^# map $map: " "$tmp/one.joined" || why+=" no map $map;"
done
ok "one job"

start "$tmp/two" && cells "$tmp/two" -j2 >"$tmp/log"
same "$tmp/two"
ok "two jobs"

# Interrupted: some cells are there, one is half a file that was not committed.
start "$tmp/half"
head -n $((total / 2)) "$tmp/half/list" | cut -d' ' -f1 | while read -r cell; do
  "$stability_map" --tiny --cell "$cell" --out "$tmp/half/$cell.csv"
done
last=$(tail -n 1 "$tmp/half/list" | cut -d' ' -f1)
echo "method" >"$tmp/half/$last.csv.part"
touch "$tmp/interrupted"
cells "$tmp/half" -j2 >"$tmp/log"
same "$tmp/half"
anew=$(find "$tmp/half" -name '*.csv' -newer "$tmp/interrupted" | wc -l)
[ "$anew" = $((total - total / 2)) ] || why+=" $anew cells were run anew;"
ok "interrupted and continued"

# A real interrupt, at whatever moment: what is there is whole.
start "$tmp/cut"
env --default-signal timeout -s INT 0.3 make --no-print-directory -j2 cells B="$build" \
  EFFORT=tiny SWEEP="$tmp/cut" >"$tmp/log" 2>&1 || true
cells "$tmp/cut" -j2 >"$tmp/log"
same "$tmp/cut"
ok "cut off and continued"

# ------------------------------------------------------------------- bad input
refuses() {  # MESSAGE ARGUMENT...
  local status=0
  "$stability_map" "${@:2}" >"$tmp/said" 2>&1 || status=$?
  [ "$status" = 2 ] || why+=" '${*:2}' ends with $status;"
  grep -qF -- "$1" "$tmp/said" ||
    why+=" '${*:2}' does not say '$1' but '$(cat "$tmp/said")';"
}
refuses "--cell: there is no 'limits-6-plain-verlet'; --list prints all" \
  --cell limits-6-plain-verlet
refuses "--map: there is no 'moon'; there are: limits table growth oscillator" \
  --map moon
refuses "can't be written (No such file or directory)" \
  --tiny --cell oscillator-verlet --out "$tmp/none/x.csv"
refuses "can't be written (a directory)" \
  --tiny --cell oscillator-verlet --out "$tmp"
refuses "--quick excludes --tiny" --list --quick --tiny
refuses "--map" --list --map growth
refuses "--list" # none of the three
refuses "--cell" --list --cell oscillator-verlet
refuses "--nonsense" --list --nonsense
mkdir "$tmp/bad" && cp "$tmp"/one/*.csv "$tmp/bad"
ok "bad options"

for bad in 'method,growth' ''; do  # no whole cell; none
  echo "$bad" >"$tmp/bad/oscillator-rk4.csv"
  [ -n "$bad" ] || rm "$tmp/bad/oscillator-rk4.csv"
  if join "$tmp/bad" 2>"$tmp/said"; then why+=" a bad cell is joined;"; fi
  grep -q "oscillator-rk4.csv:1: is no whole cell, expected 'method,dt omega" \
    "$tmp/said" || why+=" says $(cat "$tmp/said");"
done
ok "a bad cell"

# ----------------------------------------------------------------------- Slurm
sbatch_refuses() {
  local status=0
  SLURM_ARRAY_TASK_ID=1000 bash tools/sweep.sbatch "$tmp/one/list" \
    >"$tmp/said" 2>&1 || status=$?
  [ "$status" = 2 ] && grep -q 'has no line 1000' "$tmp/said" ||
    why+=" a task beyond the list ends with $status: $(cat "$tmp/said");"
}
sbatch_refuses
ok "a task beyond the list"

for tool in slurmctld slurmd munged sbatch; do
  if ! PATH=$PATH:/usr/sbin command -v "$tool" >/dev/null; then
    echo "skipped: no Slurm ($tool is not installed)"
    echo "$passed passed, $failed failed"
    [ "$failed" = 0 ]
    exit
  fi
done

# A cluster of this machine alone: a controller, a node, and munge, by which
# they know each other; all files in $tmp/cluster, all ports on the loopback.
cluster=$tmp/cluster
mkdir -p "$cluster"/{state,spool}
chmod 755 "$tmp" "$cluster"  # munge wants its socket to be reached
port=$((20000 + $$ % 10000))
user=$(id -un) host=$(hostname -s)
export SLURM_CONF=$cluster/slurm.conf PATH=$PATH:/usr/sbin
cat >"$SLURM_CONF" <<EOF
ClusterName=loopback
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 10000))
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$cluster/munge.socket
CredType=cred/munge
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/spool
SlurmctldPidFile=$cluster/slurmctld.pid
SlurmdPidFile=$cluster/slurmd.pid
SlurmctldLogFile=$cluster/slurmctld.log
SlurmdLogFile=$cluster/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc)
PartitionName=all Nodes=ALL Default=YES
EOF
head -c 128 /dev/urandom >"$cluster/munge.key"
chmod 400 "$cluster/munge.key"
serve() {  # COMMAND...: in the background
  "$@" >>"$cluster/$1.out" 2>&1 &
  pids+=($!)
}
serve munged --foreground --force --key-file="$cluster/munge.key" \
  --socket="$cluster/munge.socket" --pid-file="$cluster/munged.pid" \
  --log-file="$cluster/munged.log" --seed-file="$cluster/munged.seed"
for ((k = 0; k < 100; ++k)); do
  [ ! -S "$cluster/munge.socket" ] || break
  sleep 0.1
done
serve slurmctld -D
serve slurmd -D
for ((k = 0; k < 300; ++k)); do
  [ "$(timeout 5 sinfo -h -o %t 2>/dev/null)" != idle ] || break
  sleep 0.2
done
array() {  # LIST: run by the cluster
  timeout 300 sbatch --wait --array="1-$(wc -l <"$1")" \
    --output="$cluster/task-%a.txt" tools/sweep.sbatch "$1" >"$tmp/log" 2>&1 ||
    why+=" sbatch: $(cat "$tmp/log" "$cluster"/task-*.txt);"
  grep -q '^Submitted batch job' "$tmp/log" || why+=" nothing was submitted;"
}
grades() {  # of a class, to OUT
  make -s class DIR="$tmp/clones" HW=hw2 DUE="2026-03-08 09:30 +0000" \
    OUT="$1" "${@:2}"
}
broken=""
if [ "$(timeout 5 sinfo -h -o %t 2>&1)" != idle ]; then
  broken=1
  why+=" the cluster does not come up: $(tail -n 5 "$cluster"/*.log \
    "$cluster"/*.out 2>&1);"
else
  start "$tmp/slurm"
  while read -r cell _; do
    echo "$stability_map --tiny --cell $cell --out $tmp/slurm/$cell.csv"
  done <"$tmp/slurm/list" >"$tmp/slurm.list"
  array "$tmp/slurm.list"
  same "$tmp/slurm"
fi
ok "a Slurm array of $total tasks"

# A class of students, graded here and by the cluster.
if [ -z "$broken" ]; then
  python3 course/kit/synthetic.py "$tmp/clones" 7 &&
    grades "$tmp/here" >"$tmp/log" 2>&1 &&
    grades "$tmp/there" LIST=1 >"$tmp/class.list" && array "$tmp/class.list" &&
    grades "$tmp/there" >"$tmp/said" 2>&1 || why+=" $(cat "$tmp/log");"
  ! grep -q '^1/' "$tmp/said" || why+=" the array left some: $(cat "$tmp/said");"
  diff -r -x kept "$tmp/here" "$tmp/there" || why+=" other bytes;"
  ok "a class as a Slurm array of $(wc -l <"$tmp/class.list") tasks"
fi

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
