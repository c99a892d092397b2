#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Debian's Slurm on loopback, without a system service: one node of two slots.
# usage: slurm.sh FOLDER COMMAND [ARGUMENT...]
# Starts munged, slurmctld and slurmd with key, configuration, sockets and logs in FOLDER, runs the command with SLURM_CONF
# set, and stops them. Exit code: the command's, or 77 where the machine lacks the daemons or does not let them run.
set -eu
folder=$(realpath "$1")
shift
PATH=$PATH:/usr/sbin:/sbin
for tool in munged slurmctld slurmd sbatch; do
  command -v "$tool" > /dev/null || { echo "skipped: no $tool; Debian: apt-get install slurmctld slurmd slurm-client munge"; exit 77; }
done
port=$((20000 + $$ % 20000))
host=$(hostname -s)
user=$(id -un)
mkdir -p "$folder/state" "$folder/spool"
chmod 711 "$folder" # munged wants its socket reachable, and the folder not writable for others
head -c 1024 /dev/urandom > "$folder/munge.key"
chmod 400 "$folder/munge.key"
cat > "$folder/slurm.conf" << END
ClusterName=loopback
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CredType=cred/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
SlurmdParameters=config_overrides
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 Boards=1 SocketsPerBoard=1 CoresPerSocket=2 ThreadsPerCore=1 RealMemory=2000 State=UNKNOWN
PartitionName=test Nodes=$host Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF="$folder/slurm.conf"
pids=
# called by trap
# shellcheck disable=SC2317
stop() {
  test -z "$pids" || scancel --user="$user" > /dev/null 2>&1 || true # SLURM_CONF names this controller and no other
  for pid in $pids; do kill "$pid" 2> /dev/null || true; done
  for pid in $pids; do wait "$pid" 2> /dev/null || true; done
}
trap stop EXIT
trap 'exit 1' INT TERM HUP
give_up() {
  echo "skipped: Slurm does not run here: $1"
  tail -n 3 "$folder"/*.log
  exit 77
}
munged --foreground --key-file="$folder/munge.key" --socket="$folder/munge.socket" --pid-file="$folder/munge.pid" \
  --seed-file="$folder/munge.seed" --log-file="$folder/munged.log" > "$folder/munged.out.log" 2>&1 &
pids="$!"
tries=0
until test -S "$folder/munge.socket"; do
  tries=$((tries + 1))
  test $tries -le 50 || give_up "munged has no socket"
  sleep 0.2
done
slurmctld -D -c > "$folder/slurmctld.out.log" 2>&1 &
pids="$! $pids"
slurmd -D -N "$host" > "$folder/slurmd.out.log" 2>&1 &
pids="$! $pids"
tries=0
until sinfo --noheader --states=idle --format=%D 2> /dev/null | grep -q 1; do
  tries=$((tries + 1))
  test $tries -le 100 || give_up "the node is not idle after 20 s"
  sleep 0.2
done
code=0
"$@" || code=$?
exit $code
