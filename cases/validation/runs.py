"""Starts the program on a case and reads what the run left."""
import csv
import hashlib
import json
import os
import resource
import subprocess
import sys
from pathlib import Path

import h5py
import numpy

# What each scheme is to a case that is written for the default one. Classic's C = 1.05 is the program's own default.
SCHEMES = {
    "default": {},
    "high": {"mps.scheme": "high"},
    "classic": {
        "mps.scheme": "classic",
        "effects.collision.distance": 0.85,
        "effects.collision.restitution": 0.2,
    },
}


class RunFailed(Exception):
    """The program ended with a code other than 0."""


class Frame:
    """The water at one time: x, u, p of each particle."""

    def __init__(self, group):
        self.time = float(group.attrs["time"])
        self.x = group["position"][:].astype(float)
        self.u = group["velocity"][:].astype(float)
        self.p = group["pressure"][:].astype(float)


class Run:
    """A finished run."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self._frames = None

    def history(self):
        """Columns of history.csv by name, without units."""
        return read_csv(self.folder / "history.csv")

    def probe(self, name):
        """Times and values of a probe."""
        columns = list(read_csv(self.folder / "probes" / f"{name}.csv").values())
        return columns[0], columns[1]

    def frames(self):
        if self._frames is None:
            with h5py.File(self.folder / "results.h5") as file:
                self._frames = [Frame(file["frames"][name]) for name in sorted(file["frames"])]
        return self._frames

    def manifest(self):
        return json.loads((self.folder / "manifest.json").read_text())


class Runs:
    """The runs of one case at one size with one scheme, each in a folder of its own."""

    def __init__(self, program, case, folder, size, scheme):
        self.program, self.case, self.folder = Path(program), Path(case), Path(folder)
        self.size, self.scheme = size, scheme
        self.done = {}

    def run(self, name, settings=None, file="case.toml", options=()):
        """Runs the case with these settings, once: asked again for the name alone, gives the same run."""
        if name not in self.done:
            self.done[name] = self._start(name, settings or {}, file, options)
        return self.done[name]

    def _start(self, name, settings, file, options):
        folder = self.folder / name
        command = [str(self.program), "run", str(self.case / file), "--quiet", *options]
        for key, value in {**settings, **SCHEMES[self.scheme]}.items():
            command += ["--set", f"{key}={as_text(value)}"]
        stamp = self._stamp(command, file)
        if not is_finished(folder, stamp):
            self._execute(name, command + ["--overwrite", "-o", str(folder)])
            (folder / "stamp").write_text(stamp)
        return Run(folder)

    def _execute(self, name, command):
        say(f"  {self.scheme} {name} ...", end=" ")
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        self.folder.mkdir(parents=True, exist_ok=True)
        ended = subprocess.run(command, env=quiet_openmp(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        say(f"{seconds:.1f} s of the processor")
        self.folder.joinpath(name + ".cost").write_text(f"{seconds:.3f}\n")
        if ended.returncode != 0:
            lines = ended.stdout.strip().splitlines()
            raise RunFailed(f"{name}: exit {ended.returncode}: " + (lines[0] if lines else "no word of it"))

    def cost(self):
        """Of all runs so far [s of the processor]."""
        kept = [self.folder / f"{name}.cost" for name in self.done]
        return sum(float(path.read_text()) for path in kept if path.exists())

    def _stamp(self, command, file):
        """What must be the same for a kept run to be read and not done again."""
        program = self.program.stat()
        text = repr((command, program.st_mtime_ns, program.st_size, (self.case / file).read_text()))
        return hashlib.sha256(text.encode()).hexdigest()


def is_finished(folder, stamp):
    kept = folder / "stamp"
    return (folder / "DONE").exists() and kept.exists() and kept.read_text() == stamp


def as_text(value):
    """A value as --set takes it: numbers with all their digits, lists in brackets, texts as they are."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(f'"{v}"' if isinstance(v, str) else as_text(v) for v in value) + "]"
    return value if isinstance(value, str) else repr(float(value) if not isinstance(value, int) else value)


def quiet_openmp():
    """Threads that wait must sleep, see quiet_openmp in scripts/common.sh; what the user has set stays."""
    return {"OMP_WAIT_POLICY": "passive", "OMP_PROC_BIND": "false", **os.environ}


def read_csv(path):
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    table = numpy.array([[float(cell) for cell in row] for row in rows[1:]]).reshape(-1, len(rows[0]))
    return {name.split("[")[0]: table[:, i] for i, name in enumerate(rows[0])}


def say(text, end="\n"):
    print(text, end=end, file=sys.stderr, flush=True)
