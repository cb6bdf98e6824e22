#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fits a whole library of materials on a cluster: slurm_batch.sh MEASUREMENTS LIBRARY [TASKS]
#
# MEASUREMENTS is a folder, or a list with an argument of `burnish fit` a line. LIBRARY is a folder that all nodes see.
# With Slurm this submits a job array and waits for it. Without it the same tasks run here, as processes side by side.
# All processes that start `burnish batch --resume` in one folder share the work. BURNISH names the program.
set -euo pipefail
burnish=${BURNISH:-burnish}
list=$1 library=$2 tasks=${3:-2}

# Every task gets these options. The first call writes LIBRARY/batch.slurm and fits nothing.
options=(--budget 2700 --threads 1 --memory 1G)
"$burnish" batch "$list" -o "$library" "${options[@]}" --slurm --tasks "$tasks"

status=0  # 1 where a material could not be fitted; all other materials are there
if command -v sbatch > /dev/null; then
  sbatch --wait "$library/batch.slurm" || status=$?
else
  echo "no sbatch here: $tasks processes take its place"
  waited=()
  for ((task = 0; task < tasks; ++task)); do
    "$burnish" batch "$list" -o "$library" "${options[@]}" --resume > "$library/task-$task.log" 2>&1 &
    waited+=($!)
  done
  for process in "${waited[@]}"; do wait "$process" || status=$?; done
fi

# The table is SQLite, which Python reads without a package. It prints the worst materials first.
python3 - "$library/library.sqlite" << 'PYTHON'
import sqlite3
import sys
rows = sqlite3.connect(sys.argv[1]).execute("SELECT name, bytes, psnr, reason FROM materials ORDER BY psnr LIMIT 10")
for name, size, psnr, reason in rows:
    print(f"{name}: {reason}" if reason else f"{name}: {size} bytes, {psnr:.1f} dB")
PYTHON
exit $status
