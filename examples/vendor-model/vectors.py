"""Test vectors of LCL1000: inputs, and the outputs that its description demands, computed without any of its code.

    python vectors.py FOLDER

law.h and lcl1000.py go from sample to sample. Here every quantity is computed for all samples at once, from what it is
defined to be: the sequence filter by its transfer function, counters by how long ago something last was, a limited rate
as the least of what was wanted before, integrators as sums in a frame that turns with them.

Writes inputs.csv and expected.csv, by the names and units of the ports; the two sides of the filter differ in them. The
same with momentary cessation (MC_enable 1) in cessation-inputs.csv and cessation-expected.csv. And plant-inputs.csv and
plant-expected.csv, by the names of a plant's signals (SI), whose filter has one current and one voltage: these go with
every form of the model. All with the model's own parameters, every 100 us.
"""

import csv
import sys
from pathlib import Path

import numpy as np
from scipy.signal import lfilter

T = 1e-4
V_LINE, POWER, FREQUENCY = 600.0, 1e6, 50.0
I_MOST, R1, X1, KP, KI, KDC, KSYNC, T_FREQ = 1.1, 0.003, 0.15, 1.2, 190.0, 6.5, 1.414, 0.05
K_FRT, V_LOW, V_HIGH, RAMP = 3.5, 0.9, 1.1, 5.0
PROTECTION = ((0.85, 1.6), (0.45, 1.0))  # pu, s
CESSATION = (0.5, 0.02)  # pu, s
V_BASE, I_BASE = V_LINE * np.sqrt(2 / 3), POWER / V_LINE * np.sqrt(2 / 3)
W = 2 * np.pi * FREQUENCY
LEAST_VOLTAGE, LEAST_LENGTH = 0.1, 0.02
RATING = 500e3  # of the plant that set-points in pu are by (VA)

# From when on (s): V+ (pu), V- (pu), frequency (Hz), available (pu), asked P and Q (pu), v_DC (V), Run, breaker closed
STORY = (
    (0.00, 1.00, 0.00, 50.0, 0.80, 1.0, 0.0, 1100, 0, 1),  # it does not act yet
    (0.06, 1.00, 0.00, 50.0, 0.80, 1.0, 0.0, 1100, 1, 1),
    (0.12, 1.00, 0.00, 50.0, 0.80, 0.5, 0.3, 1110, 1, 1),  # set-points
    (0.20, 0.70, 0.12, 50.0, 0.80, 1.0, 0.1, 1120, 1, 1),  # an unbalanced sag
    (0.40, 1.00, 0.00, 50.0, 0.80, 1.0, 0.0, 1095, 1, 1),  # active power comes back in time
    (0.60, 1.00, 0.02, 50.7, 0.90, 1.0, 0.0, 1105, 1, 1),  # another frequency
    (0.80, 1.18, 0.00, 50.0, 0.90, 1.0, -0.2, 1105, 1, 1),  # over-voltage
    (0.90, 1.00, 0.00, 50.0, 0.90, 1.0, 0.0, 1105, 1, 0),  # the breaker is open for a while
    (0.95, 1.00, 0.00, 50.0, 0.90, 1.0, 0.0, 1105, 1, 1),
    (1.05, 1.00, 0.00, 50.0, 0.90, 1.0, 0.0, 820, 1, 1),  # too little v_DC for the voltage
    (1.10, 0.05, 0.00, 50.0, 0.90, 1.0, 0.0, 1150, 1, 1),  # next to nothing, which no frequency is measured by
    (1.20, 0.35, 0.05, 50.0, 0.90, 1.0, 0.0, 1150, 1, 1),  # until the second step of the protection has tripped
    (2.20, 1.00, 0.00, 50.0, 0.90, 1.0, 0.0, 1150, 1, 1),
)
END = 2.3


def story():
    """Columns of the story, sample by sample, with the time (s) first."""
    t = T * np.arange(round(END / T))
    rows = np.array(STORY)
    return (t, *rows[np.searchsorted(rows[:, 0], t + T / 2) - 1, 1:].T)


def phases(x):
    """Three phases of a vector."""
    return np.array([x.real, -x.real / 2 + np.sqrt(3) / 2 * x.imag, -x.real / 2 - np.sqrt(3) / 2 * x.imag])


def sequences(v):
    """Output of the sequence filter, and where the positive one was expected: closed forms of two coupled oscillators.

    With t = exp(j W T) and g = K W T / 2 both are filters of v with the denominator 1 - 2 (1 - g) cos(W T) / z +
    (1 - 2 g) / z^2, the positive one with the numerator g (1 - conj(t) / z), the other with g (1 - t / z). What they
    begin with, v[0] and nothing, enters as an impulse.
    """
    t, g = np.exp(1j * W * T), KSYNC * W * T / 2
    denominator = [1, -2 * (1 - g) * np.cos(W * T), 1 - 2 * g]
    impulse = np.zeros(len(v), dtype=complex)
    impulse[0] = v[0]
    pos = lfilter([g, -g * t.conjugate()], denominator, v)
    pos += lfilter([1 - g, -(1 - 2 * g) * t.conjugate()], denominator, impulse)
    neg = lfilter([g, -g * t], denominator, v) + lfilter([-g, 0], denominator, impulse)
    return pos, neg, np.append(v[0], pos[:-1] * t)


def slip_of(pos, before):
    """Frequency beyond the base (rad/s): a first-order filter that stands still while there is no voltage."""
    seen = (abs(pos) > LEAST_VOLTAGE) & (abs(before) > LEAST_VOLTAGE)
    share = T / T_FREQ
    followed = lfilter([share], [1, share - 1], np.angle(pos[seen] / before[seen]) / T)
    latest = np.cumsum(seen)
    return np.clip(np.append(0.0, followed)[latest], -0.1 * W, 0.1 * W)


def lowest_phase(pos, neg):
    """Amplitude of the lowest phase."""
    turns = np.exp(-2j * np.pi / 3 * np.arange(3))[:, np.newaxis]
    squares = abs(pos) ** 2 + abs(neg) ** 2 + 2 * (pos * neg * turns**2).real
    return np.sqrt(squares.min(axis=0))


def trips(v_min, acts):
    """Whether it has tripped: a voltage has been low for longer than a delay."""
    place, found = np.arange(len(v_min)), np.zeros(len(v_min), dtype=bool)
    for level, delay_s in PROTECTION:
        latest_high = np.maximum.accumulate(np.where((v_min < level) & acts, -1, place))
        found |= place - latest_high > round(delay_s / T)
    return np.maximum.accumulate(found)


def ceases(v_min, acts):
    """Whether the bridge is blocked for a time: the voltage is very low, or was a short time ago."""
    level, release_s = CESSATION
    place = np.arange(len(v_min))
    latest_low, latest_idle = (
        np.maximum.accumulate(np.where(flags, place, -len(place))) for flags in ((v_min < level) & acts, ~acts)
    )
    return (latest_low > latest_idle) & (place - latest_low <= round(release_s / T))


def stretches(flags):
    """Begins and ends of the samples that are true."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]])))
    return edges.reshape(-1, 2)


def active_power(wanted, works, fed):
    """Active power (pu) that grows by at most a rate while it works; else what is fed in."""
    p, step = fed.copy(), RAMP * T
    for begin, end in stretches(works):
        count = np.arange(1, end - begin + 1)
        start = fed[begin - 1]  # no story begins at work
        p[begin:end] = np.minimum(np.minimum.accumulate(wanted[begin:end] - step * count), start) + step * count
    return p


def integrated(error, turned, works, idle):
    """States of an oscillator: a sum in the frame that turns with it while it works; else what it is set to."""
    state = idle.copy()
    for begin, end in stretches(works):
        angle = np.cumsum(turned[begin:end])
        frame = np.exp(1j * np.append(0.0, angle[:-1]))
        summed = idle[begin - 1] + np.cumsum(KI * T * error[begin:end] / frame)
        state[begin:end] = summed * np.exp(1j * angle)
    return state


def computed(is_one_filter=False, is_ceasing=False):
    """Inputs in SI by the names of the ports, and outputs in SI.

    Parameters
    ----------
    is_one_filter : bool
        Whether both sides of the filter have one voltage and one current.
    is_ceasing : bool
        Whether momentary cessation is enabled.
    """
    t, v_pos, v_neg, f, available, p_asked, q_asked, v_dc, runs, closed = story()
    angle = 2 * np.pi * T * np.cumsum(f)
    v = v_pos * np.exp(1j * angle) + v_neg * np.exp(-1j * (angle + 0.7))
    u = v if is_one_filter else (1 + 0.02j) * v + 0.015 * np.exp(-5j * angle)
    idle_current = 0.5 * np.exp(1j * (angle - 0.2))
    acts = (runs > 0) & (closed > 0)

    pos, neg, before = sequences(v)
    slip = slip_of(pos, before)
    lag = 2 * slip / (KSYNC * W)
    pos, neg = pos * (1 + 1j * lag), neg * (1 - 1j * lag)
    size = np.maximum(abs(pos), LEAST_VOLTAGE)
    v_min = lowest_phase(pos, neg)
    tripped = trips(v_min, acts)
    blocked = tripped | (ceases(v_min, acts) if is_ceasing else False)
    works = acts & ~blocked

    depth = np.maximum(V_LOW - abs(pos), 0) - np.maximum(abs(pos) - V_HIGH, 0)
    i_q = np.clip(q_asked / size + K_FRT * depth, -I_MOST, I_MOST)
    by_dc = np.maximum(available + KDC * (v_dc / 1100 - 1), 0)
    carried = np.sqrt(I_MOST**2 - i_q**2) * abs(pos)
    p = active_power(np.minimum.reduce([by_dc, p_asked, carried]), works, (v * idle_current.conjugate()).real)
    wanted = (p / size - 1j * i_q) * pos / np.maximum(abs(pos), LEAST_LENGTH)
    follows = wanted + 0.02 * np.exp(1j * (2.6 * angle + 0.3)) + 0.01 * np.exp(-2.2j * angle)
    i1 = np.where(works, follows, idle_current)
    i2 = i1 if is_one_filter else np.where(works, 0.97 * follows + 0.04j * v, idle_current)

    error, turned = np.where(works, wanted - i1, 0), (W + slip) * T
    r_pos = integrated(error, turned, works, complex(R1, X1) * i1 * np.exp(1j * turned))
    r_neg = integrated(error, -turned, works, np.zeros_like(v))
    middle = np.exp(1.5j * turned)
    e = u - pos - neg + middle * pos + neg / middle + KP * error + r_pos + r_neg
    e /= np.maximum(abs(e) * V_BASE * np.sqrt(3) / v_dc, 1)

    power = v * i2.conjugate()
    common = 0.03 * np.sin(3 * angle)  # drops out
    inputs = {"t_s": t}
    for name, base, x in (("VC", V_BASE, u), ("VG", V_BASE, v), ("I1", I_BASE, i1), ("I2", I_BASE, i2)):
        three = phases(x) + (common if base == V_BASE and not is_one_filter else 0.0)
        inputs |= {f"{name}{phase}": base * column for phase, column in zip("abc", three, strict=True)}
    inputs |= {"Vdc": v_dc, "Vdc_MPP": np.full_like(t, 1100.0), "P_avail": available * POWER}
    inputs |= {"P_request": p_asked, "Q_request": q_asked, "Run": runs, "CB_closed": closed}
    outputs = {"t_s": t} | {f"E{x}": V_BASE * column for x, column in zip("abc", phases(e), strict=True)}
    outputs |= {"TRIP": tripped * 1.0, "BLOCK": blocked * 1.0, "Vpos": abs(pos), "Vmin": v_min}
    outputs |= {"Freq": FREQUENCY + slip / (2 * np.pi), "P_meas": power.real * POWER, "Q_meas": power.imag * POWER}
    return inputs, outputs | {"P_ref": p * POWER, "Q_ref": i_q * abs(pos) * POWER}


KILO = ("VC", "VG", "I1", "I2", "Vdc", "E")
MEGA = ("P_avail", "P_meas", "Q_meas", "P_ref", "Q_ref")
SIGNALS = {
    **{f"VG{x}": f"u_{x}_v" for x in "abc"},
    **{f"I2{x}": f"i_{x}_a" for x in "abc"},
    **{"Vdc": "v_dc_v", "Vdc_MPP": "v_dc_nominal_v", "P_avail": "p_available_w"},
    **{"P_request": "p_set_w", "Q_request": "q_set_var", "Run": "enabled", "CB_closed": "connected"},
}
COMMANDS = {f"E{x}": f"u_{x}_ref_v" for x in "abc"} | {"TRIP": "trip", "BLOCK": "block", "Vpos": "v_fault_pu"}


def of_ports(columns):
    """Columns in the units of the ports."""
    scale = {name: 1e3 if name.startswith(KILO) else 1e6 if name in MEGA else 1.0 for name in columns}
    return {name: column / scale[name] for name, column in columns.items()}


def of_plant(inputs):
    """Inputs by the names of a plant's signals; set-points are shares of its rating."""
    found = {"t_s": inputs["t_s"]} | {signal: inputs[name] for name, signal in SIGNALS.items()}
    return found | {name: RATING * found[name] for name in ("p_set_w", "q_set_var")}


def commanded(outputs):
    """Outputs by the names of commands; what is only recorded has the unit of its port."""
    in_ports = of_ports(outputs)
    return {COMMANDS.get(n, n): outputs[n] if n in COMMANDS else in_ports[n] for n in outputs}


def write(file, columns):
    """Write columns with all their digits."""
    with file.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(columns)
        writer.writerows(zip(*(column.tolist() for column in columns.values()), strict=True))


def main(folder):
    """Write all files."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, is_ceasing in (("", False), ("cessation-", True)):
        inputs, outputs = computed(is_ceasing=is_ceasing)
        write(folder / f"{name}inputs.csv", of_ports(inputs))
        write(folder / f"{name}expected.csv", of_ports(outputs))
    inputs, outputs = computed(is_one_filter=True)
    write(folder / "plant-inputs.csv", of_plant(inputs))
    write(folder / "plant-expected.csv", commanded(outputs))


if __name__ == "__main__":
    main(Path(*sys.argv[1:2]))
