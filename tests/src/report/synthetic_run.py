"""A run directory such as `spindrift run` leaves, made of formulas: a floating turbine that settles under thrust.
Used by report_test.py. By hand: synthetic_run.py DIR. SPDX-License-Identifier: Apache-2.0"""
import gzip
import json
import pathlib
import sys

import numpy as np

SCENE = """# The scene as run, every default spelled out.

[time]
end_s = 150.0  # s; End of the run.
window_s = 0.1  # s; Coupling window.
integrator = "rk4"  # rk4 | euler; Integrator of the bodies.

[environment]
water_depth_m = 20.6  # m; Depth.

[aero]
model = "prescribed"  # none | prescribed; How the rotor is loaded.
thrust_N = 1.5e6  # N; Constant thrust.

[sea]
model = "morison"  # none | morison; Hydrodynamic model of the sea.

[bodies.platform]
mass_kg = 4223938.0  # kg; Mass.

[[bodies.platform.cylinders]]
name = "float_1"

[bodies.rotor]
mass_kg = 227962.0  # kg; Mass.

[joints.bearing]
type = "revolute"
bodies = ["platform", "rotor"]

[moorings.line_1]
model = "spring_damper"

[moorings.line_2]
model = "spring_damper"
"""


def columns(t):
    """{name: values} of an ordinary run."""
    decay = 1 - np.exp(-t / 9.0) * np.cos(2 * np.pi * t / 14.0)
    out = {"time_s": t, "platform.x_m": 0.215 * decay, "platform.y_m": 1e-15 * np.sin(t),
           "platform.z_m": -0.6 * (1 - np.exp(-t / 5.0) * np.cos(2 * np.pi * t / 4.7)), "platform.roll_deg": 0 * t,
           "platform.pitch_deg": 5.2 * decay + 0.05 * np.sin(2 * np.pi * 0.44 * t), "platform.yaw_deg": 0 * t}
    step = t[1] - t[0] if len(t) > 1 else 1.0
    rate = lambda x: np.gradient(x, step) if len(t) > 1 else 0 * t
    for axis in "xyz":
        out[f"platform.v{axis}_m_s"] = rate(out[f"platform.{axis}_m"])
    for axis in "xyz":
        out[f"platform.a{axis}_m_s2"] = rate(out[f"platform.v{axis}_m_s"])
    out |= {"rotor.x_m": out["platform.x_m"] + 10.0 * np.sin(np.radians(out["platform.pitch_deg"])), "rotor.z_m": out["platform.z_m"]}
    for source, force, moment in (("gravity", (0, 0, -4.1e7), (0, 0, 0)), ("sea", (-2e4, 0, 4.3e7), (0, -1.4e8, 0)),
                                  ("moorings", (-1.48e6, 0, -2e6), (0, 1e7, 0)), ("rotor", (1.5e6, 0, 0), (0, 1.7e8, 0))):
        wobble = 1 + 0.05 * np.exp(-t / 20.0) * np.sin(2 * np.pi * t / 14.0)
        for axis, f, m in zip("xyz", force, moment):
            out[f"platform.{source}.f{axis}_N"] = f * wobble
            out[f"platform.{source}.m{axis}_N_m"] = m * wobble
    out |= {"rotor.thrust_N": 1.5e6 + 4e4 * np.cos(2 * np.pi * 0.44 * t), "rotor.torque_N_m": 1e7 + 0 * t, "rotor.power_W": 9.2e6 + 0 * t,
            "rotor.azimuth_deg": (52.8 * t) % 360.0, "rotor.rpm": 8.8 + 0 * t}
    out |= {"line_1.tension_N": 8e5 * decay + 1e5, "line_2.tension_N": 7.9e5 * decay + 1.1e5, "coupling.iterations": 1.0 + (t > 3)}
    return out


def summary(t, names, **changes):
    return {"format": "spindrift-summary-1", "title": "Floating 10-MW turbine, case 1", "scene": "inputs/case1.toml", "exit_code": 0,
            "exit_reason": "reached the end at 150 s", "numerical_trouble": [], "warnings": 1,
            "time": {"start_s": 0.0, "end_s": float(t[-1]) if len(t) else 0.0, "window_s": 0.1}, "restarts": 0,
            "counts": {"windows": len(t), "steps": 2 * len(t)}, "wall_seconds": 0.62, "core_seconds": 1.24, "real_time_factor": 242.0,
            "parts": [{"name": "bodies", "seconds": 0.3, "core_seconds": 0.3, "calls": 12000},
                      {"name": "sea", "seconds": 0.2, "core_seconds": 0.2, "calls": 12000},
                      {"name": "moorings", "seconds": 0.05, "core_seconds": 0.05, "calls": 12000},
                      {"name": "io", "seconds": 0.01, "core_seconds": 0.01, "calls": 1500}],
            "efficiency": [{"name": "load balance", "value": 0.94, "meaning": "mean over greatest busy time of the threads"},
                           {"name": "overhead", "value": 0.02, "meaning": "share of the runtime itself"}],
            "machine": {"host": "machine", "processor": "A processor", "ranks": 1, "threads_per_rank": 2},
            "build": {"version": "0.1.0", "commit": "0123456789ab", "compiler": "GNU 12.2.0", "flags": "-O3"},
            "rows": len(t), "ranges": {"last_28_s": {"from_s": 122.0, "to_s": 150.0}},
            "columns": [{"name": n, "unit": "", "meaning": ""} for n in names], "statistics": {}} | changes


LOG = """2026-11-21 02:50:00.001 info     reading inputs/case1.toml
2026-11-21 02:50:00.010 warning  platform: drag coefficient 1.2 is above what Morison's equation was measured for
2026-11-21 02:50:00.700 info     done
"""

TRACE = {"traceEvents": [{"ph": "X", "name": "sea/force/12", "ts": 0, "dur": 3000, "pid": 0, "tid": 0},
                         {"ph": "X", "name": "sea/force/13", "ts": 3000, "dur": 1000, "pid": 0, "tid": 0},
                         {"ph": "X", "name": "bodies/step", "ts": 4000, "dur": 500, "pid": 0, "tid": 0},
                         {"ph": "M", "name": "thread_name", "pid": 0, "tid": 0}]}


def write(folder, table=None, rows=1501, scene=SCENE, log=LOG, trace=None, with_summary=True, **changes):
    """Makes the directory; table: {name: values}, None for columns() of `rows` rows."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    table = columns(0.1 * np.arange(rows)) if table is None else table
    with open(folder / "history.csv", "w") as file:
        file.write(",".join(table) + "\n")
        if len(table["time_s"]):
            np.savetxt(file, np.column_stack(list(table.values())), fmt="%.10g", delimiter=",")
    if with_summary:
        (folder / "summary.json").write_text(json.dumps(summary(table["time_s"], list(table), **changes)), encoding="utf-8")
    if scene:
        (folder / "scene.toml").write_text(scene, encoding="utf-8")
    if log:
        (folder / "log.txt").write_text(log, encoding="utf-8")
    if trace:
        (folder / "trace.json.gz").write_bytes(gzip.compress(json.dumps(trace).encode()))
    return folder


if __name__ == "__main__":
    write(sys.argv[1], trace=TRACE)
