"""Small statistics of the scorer: limits of shares, a logistic curve, calibration of probabilities. No more
than numpy is needed."""

import math

from portable import np


def wilson(k, n, z=1.959963985):
    """Wilson's 95 % limits of a share k/n."""
    if n == 0:
        return [0.0, 1.0]
    p, w = k / n, z * z / n
    middle, half = (p + w / 2) / (1 + w), z * math.sqrt(p * (1 - p) / n + w / (4 * n)) / (1 + w)
    return [max(0.0, middle - half), min(1.0, middle + half)]


def binomial_tail(k, n, p):
    """P(X <= k)."""
    if p <= 0:
        return 1.0
    if p >= 1:
        return 1.0 if k >= n else 0.0
    logs = [
        math.lgamma(n + 1) - math.lgamma(i + 1) - math.lgamma(n - i + 1) + i * math.log(p) + (n - i) * math.log1p(-p)
        for i in range(k + 1)
    ]
    return min(1.0, sum(map(math.exp, logs)))


def upper_limit(k, n, level=0.95):
    """Exact one-sided limit of a share (Clopper & Pearson 1934)."""
    if n == 0 or k >= n:
        return 1.0
    low, high = k / n, 1.0
    for _ in range(60):
        p = (low + high) / 2
        low, high = (p, high) if binomial_tail(k, n, p) > 1 - level else (low, p)
    return high


def share(hits):
    """{"k", "n", "share", "low", "high", "upper"} of a list of booleans."""
    k, n = int(sum(map(bool, hits))), len(hits)
    low, high = wilson(k, n)
    return {"k": k, "n": n, "share": k / n if n else None, "low": low, "high": high, "upper": upper_limit(k, n)}


def logistic(x, hit, floor=0.01):
    """Maximum-likelihood curve floor + (1 - floor)/(1 + exp(-(a + b x))); {"a", "b", "at50", "at90"}; None
    when nothing can be fitted.

    A weak prior on b (0.5 to 5) keeps a separable sample finite. at50, at90: x of 50 and 90 %."""
    x, hit = np.asarray(x, float), np.asarray(hit, float)
    if len(x) < 8 or hit.min() == hit.max():
        return None
    best, where = np.inf, None
    middle = np.linspace(0.5, 16, 156)[:, None]
    for b in np.exp(np.linspace(np.log(0.2), np.log(8), 80)):
        p = floor + (1 - floor) / (1 + np.exp(-b * (x - middle)))
        loss = -np.sum(hit * np.log(p) + (1 - hit) * np.log1p(-p + 1e-15), 1) + 0.5 * (np.log(b / 1.5) / 0.8) ** 2
        if loss.min() < best:
            best, where = loss.min(), (b, middle[loss.argmin(), 0])
    b, middle = map(float, where)
    at = lambda share: middle + math.log((share - floor) / (1 - share)) / b
    return {"a": -b * middle, "b": b, "at50": at(0.5), "at90": at(0.9)}


def calibration(probability, right, bins=10):
    """Reliability: expected calibration error, and for each bin count, mean probability and share right."""
    probability, right = np.asarray(probability, float), np.asarray(right, float)
    rows, error = [], 0.0
    index = np.minimum((probability * bins).astype(int), bins - 1)
    for k in range(bins):
        mine = index == k
        if mine.any():
            said, was = float(probability[mine].mean()), float(right[mine].mean())
            error += mine.mean() * abs(said - was)
            rows.append(
                {
                    "n": int(mine.sum()),
                    "said": said,
                    "right": was,
                    "limits": wilson(int(right[mine].sum()), int(mine.sum())),
                }
            )
    return {"error": error if len(probability) else None, "bins": rows}


def area(null, hit):
    """Probability that a hit scores higher than a null (area under the receiver's curve)."""
    null, hit = np.sort(np.asarray(null, float)), np.asarray(hit, float)
    if not len(null) or not len(hit):
        return None
    below, until = np.searchsorted(null, hit, "left"), np.searchsorted(null, hit, "right")
    return float(np.mean((below + until) / 2) / len(null))


def normal_cdf(x):
    return 0.5 * (1 + math.erf(x / math.sqrt(2)))
