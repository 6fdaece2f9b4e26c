"""What cases read off curves: waves and impacts."""
import math

import numpy


def zero_crossings(time, mode):
    """In straight lines between the samples."""
    i = numpy.flatnonzero(mode[:-1] * mode[1:] < 0)
    return time[i] - mode[i] * (time[i + 1] - time[i]) / (mode[i + 1] - mode[i])


def crests(time, mode):
    """Times and heights of crests and troughs, by parabolas through three samples."""
    size = numpy.abs(mode)
    i = numpy.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:]) & (size[1:-1] > 0.2)) + 1
    slope, bend = (size[i + 1] - size[i - 1]) / 2, size[i + 1] - 2 * size[i] + size[i - 1]
    return time[i] - slope / bend * (time[1] - time[0]), size[i] - slope**2 / (2 * bend)


def averaged(time, values, even, mean):
    """Sampled at the even times, and the centred mean over `mean`."""
    samples = round(mean / (even[1] - even[0]))
    return numpy.convolve(numpy.interp(even, time, values), numpy.ones(samples) / samples, mode="same")


def impact(even, curve, arrived, duration):
    """Arrival at a value, then the peak and the impulse of so long from there on; nan where the curve never arrives."""
    if curve.max() < arrived:
        return math.nan, math.nan, math.nan
    arrival = even[numpy.argmax(curve >= arrived)]
    counted = (even >= arrival) & (even <= arrival + duration)
    return arrival, curve[counted].max(), curve[counted].sum() * (even[1] - even[0])
