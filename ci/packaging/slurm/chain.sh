#!/bin/bash
#SBATCH --job-name=spindrift --nodes=1 --ntasks-per-node=2 --cpus-per-task=1 --time=01:00:00 --signal=USR1@120
# A run longer than the limit of a job, as a chain of jobs:  sbatch chain.sh SCENE.toml RUN_FOLDER
# Two minutes before its limit a job is told to stop; it saves a checkpoint, ends with exit code 5, and this script submits itself again. Any other
# exit code ends the chain: 0 the run is at its end, 2 to 4 it cannot go on (log.txt in the run's folder says why).
set -u
scene=$1 folder=$2
export OMP_NUM_THREADS=$SLURM_CPUS_PER_TASK
srun --cpus-per-task="$SLURM_CPUS_PER_TASK" ${SPINDRIFT_SRUN:-} "${SPINDRIFT:-spindrift}" run "$scene" --out "$folder" --restart
code=$?
if [ $code -eq 5 ]; then
  script=$(scontrol show job "$SLURM_JOB_ID" | sed -n 's/^ *Command=\([^ ]*\).*/\1/p')
  sbatch --dependency=afterany:"$SLURM_JOB_ID" "$script" "$scene" "$folder"
fi
exit $code
