#!/usr/bin/python3
"""Draws a picture or a film of a run directory without a display.

    spindrift_picture.py picture DIR [--out FILE.png] [--time T] [--camera scene|side|front|top|rotor]
    spindrift_picture.py film DIR [--out FILE.mp4|.webm] [--seconds 12] [--rate 12] [--camera ...]

Turbines and floating bodies are drawn in three dimensions (VTK), sections and tanks in their plane (matplotlib). `spindrift picture` and
`spindrift film` call it (src/app/report.cpp). SPDX-License-Identifier: Apache-2.0"""
import argparse
import multiprocessing
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time

PACKAGES = {"numpy": "python3-numpy", "matplotlib": "python3-matplotlib", "h5py": "python3-h5py", "vtkmodules": "python3-vtk9"}
MOST_BYTES = 5 << 20   # of a film


def arguments():
    parser = argparse.ArgumentParser(prog="spindrift picture")
    parser.add_argument("kind", choices=("picture", "film"))
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--time", default="last")
    parser.add_argument("--camera", default="scene")
    parser.add_argument("--seconds", type=float, default=12.0)
    parser.add_argument("--rate", type=int, default=12)
    return parser.parse_args()


def fail(code, words):
    """2 bad input, 4 what the machine lacks."""
    print(words, file=sys.stderr)
    sys.exit(code)


class Display:
    """An X server in memory where there is none: VTK of Debian draws through X alone."""

    def __enter__(self):
        self.server = None
        if os.environ.get("DISPLAY"):
            return self
        if shutil.which("Xvfb") is None:
            fail(4, "there is no display and no Xvfb: install the package xvfb (ci/setup --pictures does)")
        get, put = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(put), "-screen", "0", "1920x1200x24", "-nolisten", "tcp"], pass_fds=[put],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(put)
        with os.fdopen(get) as told:
            number = told.readline().strip()
        if not number or not self.answers(number):
            fail(4, "Xvfb does not start")
        os.environ["DISPLAY"] = f":{number}"
        return self

    @staticmethod
    def answers(number, patience_s=20.0):
        """It tells its number before it takes connections."""
        until = time.monotonic() + patience_s
        while time.monotonic() < until:
            with socket.socket(socket.AF_UNIX) as knock:
                try:
                    knock.connect(f"/tmp/.X11-unix/X{number}")
                    return True
                except OSError:
                    time.sleep(0.05)
        return False

    def __exit__(self, *_):
        if self.server:
            self.server.terminate()
            self.server.wait()


def moment(run, asked):
    """The time of a picture."""
    if asked == "last":
        return float(run.time[-1])
    try:
        wanted = float(asked)
    except ValueError:
        fail(2, f"--time {asked}: give seconds, or last")
    if not run.time[0] - 1e-9 <= wanted <= run.time[-1] + 1e-9:
        fail(2, f"--time {asked}: the run goes from {run.time[0]:g} to {run.time[-1]:g} s")
    return wanted


def drawing_of(run, given):
    import verdict
    if verdict.is_plane(run):
        if given.camera != "scene":
            fail(2, f"--camera {given.camera}: sections and tanks are drawn in their plane, without a camera; leave it out")
        import plane_picture
        try:
            return plane_picture.Drawing(run)
        except plane_picture.NoFields as none:
            fail(2, none)
    import quantities
    import scene_picture
    if given.camera == "rotor" and not quantities.rotors_of(run.columns):
        fail(2, "--camera rotor: the run has no rotor; cameras for it: scene, side, front, top")
    # A film is smaller: half of its width and height is what a page shows of it.
    return scene_picture.Drawing(run, (1600, 900), given.camera, finer=2) if given.kind == "picture" else scene_picture.Drawing(run, (960, 540), given.camera)


def picture(run, given):
    import matplotlib.image
    matplotlib.image.imsave(given.out, drawing_of(run, given).draw(moment(run, given.time)))


def begin_frames(given):
    """In each process of a film."""
    global draw
    from run_data import RunData
    draw = drawing_of(RunData(given.directory), given).draw


def frame(t):
    return draw(t)


def film(run, given):
    """Frames are drawn by one process per core and go to ffmpeg in their order."""
    if shutil.which("ffmpeg") is None:
        fail(4, "a film needs ffmpeg: install the package ffmpeg (ci/setup --pictures does)")
    begin = max(float(run.time[0]), 0.0)
    end, count = float(run.time[-1]), max(2, round(given.seconds * given.rate))
    times = [begin + (end - begin) * n / (count - 1) for n in range(count)]
    drawing = drawing_of(run, given)
    if hasattr(drawing, "times") and len(drawing.times()) < 3:
        fail(2, f"{given.directory}: fields of {len(drawing.times())} times are no film; write them more often (the section fields of the scene)")
    rate_bits = int(0.9 * 8 * MOST_BYTES / given.seconds)
    codec = (["-c:v", "libvpx-vp9", "-b:v", str(min(rate_bits, 2_500_000)), "-deadline", "realtime", "-cpu-used", "6"] if given.out.suffix == ".webm" else
             ["-c:v", "libx264", "-preset", "veryfast", "-crf", "24", "-maxrate", str(rate_bits), "-bufsize", str(2 * rate_bits), "-movflags", "+faststart"])
    cores = min(len(os.sched_getaffinity(0)), count)
    os.environ["LP_NUM_THREADS"] = "1"   # of Mesa, in each process
    said, began = time.monotonic(), time.monotonic()
    with tempfile.TemporaryFile() as errors, multiprocessing.get_context("spawn").Pool(cores, begin_frames, [given]) as pool:
        encoder = None
        try:
            # In small shares, so that the cores end together and each reads few fields.
            for n, image in enumerate(pool.imap(frame, times, chunksize=max(1, min(6, count // (2 * cores))))):
                height, width = (side - side % 2 for side in image.shape[:2])
                if encoder is None:
                    command = ["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", str(given.rate), "-i", "-",
                               *codec, "-pix_fmt", "yuv420p", str(given.out)]
                    encoder = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=errors)
                encoder.stdin.write(image[:height, :width].tobytes())
                if time.monotonic() - said > 5.0:
                    said = time.monotonic()
                    print(f"  {said - began:3.0f} s: frame {n + 1} of {count}", flush=True)
            encoder.stdin.close()
        except BrokenPipeError:
            pass
        if encoder.wait() != 0:
            errors.seek(0)
            fail(4, "ffmpeg: " + (errors.read().decode(errors="replace").strip().splitlines() or ["says nothing"])[-1])


def main():
    given = arguments()
    if not (given.directory / "history.csv").exists():
        why = "it has no history.csv" if given.directory.is_dir() else "it is a file" if given.directory.exists() else "there is nothing of that name"
        fail(2, f"{given.directory} is not a run directory: {why}; name the folder of a run (run SCENE --out FOLDER)")
    given.out = given.out or given.directory / ("picture.png" if given.kind == "picture" else "film.mp4")
    try:
        from run_data import RunData
        run = RunData(given.directory)
        if not len(run.time):
            fail(2, f"{given.directory}: history.csv has no rows")
        with Display():
            (picture if given.kind == "picture" else film)(run, given)
    except ModuleNotFoundError as missing:
        top = (missing.name or "").split(".")[0]
        fail(4, f"Python at {sys.executable} has no module '{top}': install the package {PACKAGES.get(top, top)} (ci/setup --pictures does)")
    except (OSError, ValueError) as error:
        fail(4, f"not drawn: {error}")


if __name__ == "__main__":
    main()
