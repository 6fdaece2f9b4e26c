"""What the paper tells of its run: when the load is largest at n1, and the displacement at n5."""
import csv

import numpy

PAPER_LOAD, PAPER_DISPLACEMENT = 0.246, 0.282  # s; the only figures of the run that the paper's text prints
MEAN_OVER = 0.002  # s; of loads, centred


def probe(run, name):
    """Times and values."""
    with open(f"{run}/probes/{name}.csv", newline="") as file:
        rows = list(csv.reader(file))[1:]
    table = numpy.array([[float(cell) for cell in row] for row in rows])
    return table[:, 0], table[:, 1]


def smooth(time, value):
    """Centred mean over MEAN_OVER."""
    width = max(1, round(MEAN_OVER / (time[2] - time[1])))
    return numpy.convolve(value, numpy.ones(width) / width, "same")


def history(run):
    with open(f"{run}/history.csv", newline="") as file:
        rows = list(csv.reader(file))
    table = numpy.array([[float(cell) for cell in row] for row in rows[1:]])
    return {name.split("[")[0]: table[:, i] for i, name in enumerate(rows[0])}


def largest(time, value):
    k = int(numpy.argmax(numpy.abs(value)))
    return time[k], value[k]


def peaks(run):
    """The figures of a run, with their names; times in s, loads in Pa, displacements in m."""
    time, load = probe(run, "load_n1")
    when_smooth, load_smooth = largest(time, smooth(time, load))
    when_raw, load_raw = largest(time, load)
    when_tip, tip = largest(*probe(run, "displacement_n5"))
    when_front, front = probe(run, "front")
    reached = when_front[numpy.argmax(front >= 0.6)] if (front >= 0.6).any() else numpy.nan
    return {
        "end": time[-1],
        "front": reached,
        "load_time": when_smooth,
        "load": load_smooth,
        "raw_load_time": when_raw,
        "raw_load": load_raw,
        "tip_time": when_tip,
        "tip": tip,
    }


def costs(run):
    """Wall time of a run's steps [s], and the shares of structures, coupling (loads, walls that bend, exchange) and fluid."""
    seconds = {}
    with open(f"{run}/run.log") as file:
        for line in file:
            words = line.split()
            if len(words) == 4 and words[0][0].islower() and words[1].replace(".", "").isdigit():
                seconds[words[0]] = float(words[1])
    whole = sum(seconds.values())
    structures = seconds.get("structures", 0)
    coupling = sum(seconds.get(name, 0) for name in ("coupling", "exchange", "moving_walls", "added_mass"))
    return {"seconds": whole, "structures": structures / whole, "coupling": coupling / whole,
            "fluid": 1 - (structures + coupling) / whole}
