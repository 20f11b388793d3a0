"""Prints a digest of every bit of each history column of short runs, one line each: scene, column, digest. Usage: scene_bits.py SPINDRIFT.
SPDX-License-Identifier: Apache-2.0"""
import csv
import os
import pathlib
import struct
import subprocess
import sys
import tempfile

PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
INPUTS = pathlib.Path(__file__).resolve().parents[3] / "inputs"
SCENES = {
    "platform": ("leble_barakos/case3_engineering.toml", ["time.end_s=3.0"]),
    "case3_demo": ("leble_barakos/case3_demo.toml", ["sea.particles.spacing_m=5.0", "start.air_steps=10", "time.end_s=0.15"]),
    "tank": ("validation/dam_break/koshizuka_oka.toml", ["sea.particles.spacing_m=0.1", "time.end_s=0.2"]),
    "aerofoil": ("validation/naca0012/naca0012.toml", [f'aero.flow.{key}="{INPUTS}/validation/naca0012/tmr_112x32.{end}"' for key, end in (("grid", "p3d"), ("map", "nmf"))] + ["time.end_s=8.0", "aero.flow.drop=0.0"]),
}


def digest(values):
    """FNV-1a over the bytes of doubles."""
    value = 0xCBF29CE484222325
    for byte in struct.pack(f"<{len(values)}d", *values):
        value = (value ^ byte) * 0x100000001B3 % 2**64
    return f"{value:016x}"


def main():
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    with tempfile.TemporaryDirectory(prefix="spindrift_bits_") as scratch:
        for name, (scene, overrides) in SCENES.items():
            words = [PROGRAM, "run", str(INPUTS / scene), "--out", f"{scratch}/{name}", "--no-report", "--quiet"]
            for text in overrides:
                words += ["--set", text]
            done = subprocess.run(words, capture_output=True, text=True, check=False)
            if done.returncode != 0:
                sys.exit(done.returncode if done.returncode == 4 else f"{scene}: {done.stdout}{done.stderr}")
            with open(f"{scratch}/{name}/history.csv", encoding="utf-8") as file:
                header, *rows = csv.reader(file)
            for n, column in enumerate(header):
                print(f"{name:<12}{column:<44}{digest([float(row[n]) for row in rows])}")


main()
