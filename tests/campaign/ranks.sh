#!/bin/bash
# ranks.sh PLUMB PLUMB_CAMPAIGN_MPI CAMPAIGN.toml: one process, and 1, 2 and 4 ranks, give the same bytes; a job that loses a
# rank goes on from its last result. Exit code 77 where there is no mpirun.
set -eu
plumb=$1 over_ranks=$2 campaign=$3
command -v mpirun > /dev/null || { echo "no mpirun"; exit 77; }
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# Ranks that wait give way: there may be more of them than cores.
export OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_btl_base_warn_component_unused=0
where=$(mktemp -d)
trap 'rm -rf "$where"' EXIT
"$plumb" campaign "$campaign" --out "$where/alone.json" > "$where/alone.txt"
for ranks in 1 2 4; do
  mpirun -n $ranks "$over_ranks" "$campaign" --out "$where/$ranks.json" > "$where/$ranks.txt"
  cmp "$where/alone.json" "$where/$ranks.json"
  cmp <(sed "s|$where/alone|FILE|g" "$where/alone.txt") <(sed "s|$where/$ranks|FILE|g" "$where/$ranks.txt")
  echo "$ranks ranks: the same bytes"
done
# Two threads on each of two ranks.
mpirun -n 2 "$over_ranks" "$campaign" --threads 2 --out "$where/threads.json" > /dev/null
cmp "$where/alone.json" "$where/threads.json"
# A rank dies in the middle of a job that writes after every batch; mpirun ends the job.
many=40000
mpirun -n 2 "$over_ranks" "$campaign" --scenarios $many --every 0 --out "$where/lost.json" > /dev/null 2>&1 &
job=$!
for _ in $(seq 600); do
  [ -s "$where/lost.json" ] && break
  sleep 0.1
done
victim=$(ps -eo pid,args | grep -F "$where/lost.json" | grep -F "$over_ranks" | grep -vE 'mpirun|grep' | tail -1 | awk '{print $1}')
if [ -n "$victim" ]; then kill -9 "$victim"; fi
if wait $job; then echo "the job ended before a rank could be taken from it"; else echo "lost a rank"; fi
grep -q '"done": ' "$where/lost.json"
done_before=$(grep '"done": ' "$where/lost.json")
mpirun -n 1 "$over_ranks" "$campaign" --scenarios $many --resume --threads 2 --out "$where/lost.json" > /dev/null
"$plumb" campaign "$campaign" --scenarios $many --threads 2 --out "$where/whole.json" > /dev/null
cmp "$where/whole.json" "$where/lost.json"
echo "gone on from$done_before: the same bytes as in one go"
