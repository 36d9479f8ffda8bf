# A real slurmctld with two nodes on this host gives the same SQLite content as a local run.
. "$(dirname "$0")/lib.sh"
for program in slurmctld slurmd sbatch scontrol squeue; do
  PATH=$PATH:/usr/sbin command -v $program >/dev/null || { echo "$program (package slurm-wlm) is missing"; exit 77; }
done
[[ $(id -u) == 0 ]] || { echo "slurmctld and slurmd need root here"; exit 77; }
export PATH=$PATH:/usr/sbin
host=$(hostname -s)
mkdir -p cluster/state cluster/spool-n1 cluster/spool-n2
port=$((20000 + $$ % 20000))
cat >cluster/slurm.conf <<CONF
ClusterName=rubble
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmUser=root
SlurmdUser=root
AuthType=auth/none
CredType=cred/none
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
MailProg=/bin/true
SchedulerParameters=sched_interval=1,batch_sched_delay=1
SlurmdParameters=config_overrides
StateSaveLocation=$work/cluster/state
SlurmctldPidFile=$work/cluster/slurmctld.pid
SlurmdPidFile=$work/cluster/slurmd-%n.pid
SlurmdSpoolDir=$work/cluster/spool-%n
SlurmctldLogFile=$work/cluster/slurmctld.log
SlurmdLogFile=$work/cluster/slurmd-%n.log
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=1
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=1
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$work/cluster/slurm.conf
clean_up() { scontrol shutdown >/dev/null 2>&1; sleep 1; }
slurmctld -f "$SLURM_CONF" -c
slurmd -f "$SLURM_CONF" -c -N n1
slurmd -f "$SLURM_CONF" -c -N n2
for _ in $(seq 60); do
  [[ $(sinfo -h -o '%D %t' 2>/dev/null) == '2 idle' ]] && break
  sleep 0.5
done
[[ $(sinfo -h -o '%D %t' 2>/dev/null) == '2 idle' ]] ||
  { echo "slurm does not start here: $(tail -3 cluster/*.log)"; exit 77; }

small_scenario small.yaml
printf 'scenarios: [small.yaml]\nseeds: 1-6\nset: {time_limit_s: 60, robot.levelling: [true, false]}\n' >sweep.yaml
"$rubble" batch sweep.yaml --out local --workers 2 >/dev/null || fail "the local run ended with $?"
"$rubble" batch merge local --out local.sqlite >/dev/null || fail "merge ended with $?"
"$rubble" batch sweep.yaml --out cluster-out --slurm --shards 4 --slurm-option=--time=10 >submitted.txt ||
  fail "submitting ended with $?: $(cat submitted.txt)"
for _ in $(seq 300); do
  [[ -z $(squeue -h) ]] && break
  sleep 1
done
[[ -z $(squeue -h) ]] || fail "the jobs do not end: $(squeue)"
[[ -s cluster-out/results.sqlite ]] || fail "nothing was merged: $(cat cluster-out/slurm/*.log)"
python3 - <<'PY' || fail "the cluster's results differ from the local ones"
import sqlite3, sys
dump = lambda f: list(sqlite3.connect(f).execute('select * from runs order by run_id'))
a, b = dump('local.sqlite'), dump('cluster-out/results.sqlite')
sys.exit(0 if a == b and len(a) == 12 else 1)
PY
[[ -s cluster-out/report.html ]] || fail "no report of the cluster's run"
for node in n1 n2; do
  grep -qi 'launching batch job' cluster/slurmd-$node.log || fail "$node got no job: $(tail -3 cluster/slurmd-$node.log)"
done
expect_exit 2 '--slurm' "$rubble" batch sweep.yaml --slurm --shard 1/2
finish
