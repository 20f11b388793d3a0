"""Long runs of small seas: memory does not grow, and the balances of energy close.
Usage: soak.py PROGRAM tank SECONDS | case3 SUBSTEPS. Prints a line of what was measured; ends with 1 where a bound is missed:
memory within 1 % between a third of the run and its end (buffers of sorts find their size before), what no work explains below 1 % of the energy that was put in per 1,000 s.
Step `soak` of ci/verify. SPDX-License-Identifier: Apache-2.0"""
import os
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "src/python"))
sys.dont_write_bytecode = True

import numpy as np

import spindrift

TANK = [ROOT / "inputs/validation/wave_tank/small_tank.toml", "sea.particles.spacing_m=0.1", "time.window_s=0.05", "output.history_every=20"]
# The air as coarse as in the ladder's cheapest resolved rung (inputs/studies/case3_ladder.toml), windows of 0.1 s.
CASE3 = [ROOT / "inputs/leble_barakos/case3_demo.toml", 'without=["sea.fields", "aero.flow.blades"]', "sea.particles.spacing_m=5.0", "time.window_s=0.1", "start.air_steps=30",
         "aero.grid.cells_round=28", "aero.grid.cells_layers=4", "aero.grid.cells_span=8", "aero.grid.first_cell_chords=8e-3", "aero.flow.viscous=none",
         "aero.flow.cfl_max=100.0", "aero.flow.max_pseudo_steps=3", "output.history_every=10", "output.expected=[]"]


def resident(process):
    """[bytes]"""
    try:
        return 1024 * int(next(line for line in pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines() if line.startswith("VmRSS")).split()[1])
    except (OSError, StopIteration):
        return 0


def run(program, scene, end_s, folder):
    """The run, and (seconds since its start, resident memory) while it went."""
    words = [program, "run", str(scene[0]), "--out", str(folder), "--no-report", "--quiet", *(w for text in [*scene[1:], f"time.end_s={end_s:g}"] for w in ("--set", text))]
    environment = dict(os.environ) | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_WAIT_POLICY": "passive"}
    begin, seen = time.monotonic(), []
    with subprocess.Popen(words, env=environment) as process:
        while process.poll() is None:
            if now := resident(process):
                seen.append((time.monotonic() - begin, now))
            time.sleep(0.25)
    if process.returncode != 0:
        sys.exit(f"soak: the run ended with {process.returncode}")
    return spindrift.open(folder), np.array(seen)


def water(result):
    """Energy that nothing explains over that put in by solids and the start [-], per 1,000 s."""
    change = lambda *names: sum(result[f"sea.{n}_J"] - result[f"sea.{n}_J"][0] for n in names)
    made = change("kinetic_energy", "potential_energy", "compression_energy") - change("work_of_solids") + change("dissipated", "absorbed", "left")
    put_in = np.abs(np.diff(result["sea.work_of_solids_J"])).sum() + np.ptp(result["sea.kinetic_energy_J"])
    return abs(made[-1]) / put_in * 1000.0 / max(result.time[-1], 1000.0)


def bodies(result):
    works = [n for n in result.columns if n.startswith("energy.") and n.endswith("work_J")]
    put_in = sum(np.abs(np.diff(result[n])).sum() for n in works)
    return abs(result["energy.steps_J"][-1]) / put_in * 1000.0 / max(result.time[-1], 1000.0)


def main():
    program, kind, much = str(pathlib.Path(sys.argv[1]).resolve()), sys.argv[2], float(sys.argv[3])
    with tempfile.TemporaryDirectory(prefix="spindrift_soak_") as folder:
        if kind == "tank":
            result, seen = run(program, TANK, much, pathlib.Path(folder) / "run")
        else:   # as many windows as make so many substeps
            short, _ = run(program, CASE3, 2.0, pathlib.Path(folder) / "short")
            result, seen = run(program, CASE3, np.ceil(much * 2.0 / short.summary["counts"]["steps"]), pathlib.Path(folder) / "run")
        settled = seen[seen[:, 0] > seen[-1, 0] / 3.0]
        first, last = settled[0, 1], settled[-5:, 1].max()
        shares = {"water": water(result)} | ({"bodies": bodies(result)} if "energy.steps_J" in result.columns else {})
        lost = result["sea.mass_kg"][-1] / result["sea.mass_kg"][0] - 1.0
        print(f"soak: {kind}, {result.time[-1]:g} s, {result.summary['counts']['steps']} steps: memory {1e-6 * first:.1f} -> {1e-6 * last:.1f} MB; unexplained per 1,000 s "
              + ", ".join(f"{name} {100.0 * share:.2g} %" for name, share in shares.items()) + f" of the energy put in; water {100.0 * lost:+.2g} %", flush=True)
        sys.exit(0 if last < 1.01 * first and all(share < 0.01 for share in shares.values()) else 1)


if __name__ == "__main__":
    main()
