"""Trains the small network that `brdfbake converge --bytes` shows beside tables and formulas.

    brdfbake bake tests/values/network.toml -o /tmp/network
    OPENBLAS_NUM_THREADS=1 python3 tests/values/network.py /tmp/network/network.npy > src/report/reading/network.txt

Inputs are the two axes of the table, as texture coordinates from 0 to 1 shifted to [-1, 1]; three hidden layers of 32 units with the
softsign x / (1 + |x|), which takes no transcendental function; outputs are the channels, linear. Adam on batches of 2048 texels, a step
size that falls by a cosine to nothing, seed 1; the loss is the mean of the squared error and, so that the largest counts, 0.01 times
the mean of its fourth power over that of its square. About two minutes on one core. Needs numpy and nothing else.

The weights are rounded to float32 and written layer by layer: biases of a unit, then its weights, in as many digits as round trip.
"""

import sys

import numpy as np

STEPS = 60_000
BATCH = 2048
FIRST = 5e-3
SIZES = [2, 32, 32, 32, 2]


def forward(layers, x):
    """Values of every layer."""
    values = [x]
    for k, (b, w) in enumerate(layers):
        z = values[-1] @ w.T + b
        values.append(z if k + 1 == len(layers) else z / (1 + np.abs(z)))
    return values


def gradients(layers, x, y):
    values = forward(layers, x)
    off = values[-1] - y
    square = np.mean(off**2)
    # d of mean(off^2) + 0.01 mean(off^4) / mean(off^2), its second denominator held
    grad = (2 * off + 0.04 * off**3 / (square + 1e-12)) / off.size
    out = []
    for k in reversed(range(len(layers))):
        b, w = layers[k]
        if k + 1 < len(layers):
            # softsign: h = z / (1 + |z|), h' = (1 - |h|)^2
            grad = grad * (1 - np.abs(values[k + 1])) ** 2
        out.append((grad.sum(0), grad.T @ values[k]))
        grad = grad @ w
    return out[::-1]


def main():
    table = np.load(sys.argv[1]).astype(np.float64)
    rows, columns, channels = table.shape
    u = np.linspace(-1, 1, columns)
    v = np.linspace(-1, 1, rows)
    x = np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2)
    y = table.reshape(-1, channels)
    rng = np.random.default_rng(1)
    layers = []
    for n, m in zip(SIZES, SIZES[1:]):
        layers.append((rng.uniform(-0.5, 0.5, m), rng.normal(0, np.sqrt(2 / n), (m, n))))
    flat = lambda all_: np.concatenate([p.ravel() for layer in all_ for p in layer])

    def unflat(values):
        out, at = [], 0
        for n, m in zip(SIZES, SIZES[1:]):
            b = values[at : at + m]
            w = values[at + m : at + m + m * n].reshape(m, n)
            out.append((b, w))
            at += m + m * n
        return out

    p = flat(layers)
    mean, square = np.zeros_like(p), np.zeros_like(p)
    x32, y32 = x.astype(np.float32), y.astype(np.float32)
    for step in range(1, STEPS + 1):
        chosen = rng.integers(0, len(x), BATCH)
        now = [(b.astype(np.float32), w.astype(np.float32)) for b, w in unflat(p)]
        g = flat(gradients(now, x32[chosen], y32[chosen])).astype(np.float64)
        mean = 0.9 * mean + 0.1 * g
        square = 0.999 * square + 0.001 * g * g
        rate = FIRST * 0.5 * (1 + np.cos(np.pi * step / STEPS))
        p -= rate * (mean / (1 - 0.9**step)) / (np.sqrt(square / (1 - 0.999**step)) + 1e-12)
        if step % 2000 == 0:
            off = forward(unflat(p), x)[-1] - y
            print(f"{step}: RMS {np.sqrt(np.mean(off**2)):.3e}, largest {np.abs(off).max():.3e}", file=sys.stderr)
    for b, w in unflat(p):
        for bias, row in zip(b, w):
            print(" ".join(str(np.float32(v)) for v in [bias, *row]))


main()
