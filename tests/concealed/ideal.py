#!/usr/bin/env python3
"""What a perfect search of the whole catalogue can detect. usage: ideal.py --out ideal.json [--stages D=1,C=1,E=1,A=1]

The signal-to-noise ratio s of an effect is that of an oracle that knows its shape. A diagnosis does not: it asks
of some thousand shapes at once whether any is there, and pays for each with a higher threshold. What that costs
at least is a fact of the plan and the catalogue, not of a program. Here it is computed, to judge targets by.

By the lemma of Neyman and Pearson no test of "nothing" against "one effect, drawn from the priors" has more power
on average than the likelihood ratio. Whitened by the null (`null.py`), a recording is w = e + s t with standard
normal e and a unit vector t of the true shape, and the ratio is the mean over families, sizes and shapes of

    one shape of size s, either sign:       exp(-s^2/2) cosh(s u'w)
    a span of shapes U, spread V about s:   prod (1 + s^2 V_i)^(-1/2) exp(1/2 s^2 V_i (U_i'w)^2 / (1 + s^2 V_i))

This search knows everything but the effect: the covariance and the noise exactly, the ladder of sizes, the priors
of the generator. Families count the same. Parameters in which an effect is linear (directions, phases, free terms)
are a Gaussian span; the others are drawn. These are the only approximations. Three answers have 1 % false alarms each:
of an oracle that knows the shape, of one that knows the family, of the search of all families. No sealed case is used.
"""

import argparse
import json
import pathlib
from dataclasses import dataclass

import generate
from cases import Stage
from charts import detection
from effects import CATALOGUE
from portable import np
from seal import generator
from spans import spans
from world import IMPLAUSIBLE, LADDER

SECRET = f"development {generate.PUBLIC}"
STEPS = (2, 3, 3.7, 4.5, 5.2, 6, 7, 9)
ALARMS, LEVEL = 0.01, 2.5758  # and the two-sided point of the normal distribution
NULLS, TRIALS, REPEATS = 2000, 2, 12  # recordings without effect; shapes to find in each family; recordings of each
LARGEST = 600  # touches; the rare longer plans would take most of the time


@dataclass
class Group:
    """Shapes that span equally many dimensions r: unit vectors (N, k, r), their variances (k, r), weights (k)."""

    axes: np.ndarray
    variance: np.ndarray
    weight: np.ndarray

    def terms(self, w, sizes):
        """Logarithm of weighted likelihood ratios of the recordings w (n, N): (n, k) for each size."""
        n, k, r = self.axes.shape
        q = (w @ self.axes.reshape(n, k * r)).reshape(-1, k, r)
        if r == 1:
            a = np.abs(q[:, :, 0])
            return [s * a - s * s / 2 + np.log((1 + np.exp(-2 * s * a)) / 2) + np.log(self.weight) for s in sizes]
        q, variances = (q * q).reshape(-1, k * r), [s * s * self.variance for s in sizes]
        sums = [(q * (v / (1 + v)).ravel()).reshape(-1, k, r).sum(2) for v in variances]
        return [x / 2 - np.log1p(v).sum(1) / 2 + np.log(self.weight) for x, v in zip(sums, variances)]


@dataclass
class Family:
    name: str
    groups: list
    trials: np.ndarray  # (TRIALS, N), unit vectors
    plausible: np.ndarray  # largest s of each trial

    def log_ratio(self, w):
        sizes = [s for s in LADDER if s <= np.median(self.plausible)]
        terms = np.hstack([x for g in self.groups for x in g.terms(w, sizes)])
        top = terms.max(1)
        return top + np.log(np.exp(terms - top[:, None]).sum(1) / len(sizes))


def grouped(white, sets):
    """Groups of the spans, each scaled to shapes of mean square 1; lines that are the same are one."""
    found = {}
    for columns in sets:
        a = white @ np.array(columns).T
        if (size := np.linalg.norm(a)) < 1e-6:
            continue
        u, spread, _ = np.linalg.svd(a / size, full_matrices=False)
        r = int(np.sum(spread > 1e-4))
        group = found.setdefault(r, [])
        same = next((x for x in group if r == 1 and abs(x[0][:, 0] @ u[:, 0]) > 0.9999), None)
        if same:
            same[2] += 1
        else:
            group.append([u[:, :r], spread[:r] ** 2, 1])
    total = sum(x[2] for group in found.values() for x in group)
    return [Group(np.stack(u, 1), np.array(v), np.array(w) / total) for u, v, w in (zip(*group) for group in found.values())]


def families(stage, rng, names=None):
    """Those that the design admits at a plausible size, shapes whitened."""
    values, vectors = np.linalg.eigh(stage.null.times(np.eye(stage.scene.size))[: stage.scene.size])
    white, out = (vectors * np.sqrt(np.maximum(values, 0))).T, []
    for name, effect in sorted(CATALOGUE.items()):
        if stage.design not in effect.designs or names and name not in names:
            continue
        drawn = [effect.draw(stage.scene, rng) for _ in range(TRIALS)]
        shapes = [(p, d, stage.null.snr(d)) for p in drawn for d in [stage.base.signature(effect, p)]]
        shapes = [(p, d, s) for p, d, s in shapes if s > 1e-6]
        plausible = np.array([IMPLAUSIBLE * effect.largest / max(abs(p[effect.scale[0]]), 1e-12) * s for p, _, s in shapes])
        if np.any(plausible >= LADDER[1]) and np.median(plausible) >= LADDER[0]:
            trials = np.array([white @ d / s for _, d, s in shapes])
            out.append(Family(name, grouped(white, spans(stage, effect, rng)), trials, plausible))
    return out


def power(stage, rng, names=None):
    """{"families", "shapes", "steps": {s: {"shape", "family", "search"}}} of one recording's plan."""
    known = families(stage, rng, names)

    def ratios(w):
        each = np.column_stack([f.log_ratio(w) for f in known])
        return each, np.logaddexp.reduce(each, 1)

    each, every = ratios(rng.normal(size=(NULLS, stage.scene.size)))
    level, level_of_all = np.quantile(each, 1 - ALARMS, 0), np.quantile(every, 1 - ALARMS)
    hits = {s: [] for s in STEPS}
    for i, f in enumerate(known):
        for t, largest in zip(f.trials, f.plausible):
            noise, steps = rng.normal(size=(REPEATS, len(t))), [s for s in STEPS if s <= largest]
            if steps:
                each, every = ratios(np.vstack([noise + s * t for s in steps]))
                for k, s in enumerate(steps):
                    mine = slice(k * REPEATS, (k + 1) * REPEATS)
                    hits[s].append([detection(s, LEVEL), np.mean(each[mine, i] > level[i]), np.mean(every[mine] > level_of_all)])
    steps = {f"{s:g}": dict(zip(("shape", "family", "search"), np.mean(h, 0))) for s, h in hits.items()}
    return {"families": len(known), "shapes": sum(len(g.weight) for f in known for g in f.groups), "steps": steps}


def study(design, known, count):
    """One row of the result: the mean over `count` recordings."""
    out, number = [], 0
    while len(out) < count:
        rng = generator(SECRET, "ideal", design, known, number := number + 1)
        stage = Stage(rng, design, known)
        if stage.scene.size <= LARGEST:
            out.append(power(stage, rng))
    mean = lambda values: round(float(np.mean(values)), 4)
    steps = {s: {k: mean([o["steps"][s][k] for o in out]) for k in v} for s, v in out[0]["steps"].items()}
    sizes = {k: round(np.mean([o[k] for o in out])) for k in ("families", "shapes")}
    return {"design": design, "mode": "known" if known else "fresh", "stages": count, **sizes, "steps": steps}


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--stages", default="D=1,C=1,E=1,A=1", help="plans of each design and mode")
    given = parser.parse_args(argv)
    counts = {d: int(n) for d, n in (word.split("=") for word in given.stages.split(","))}
    rows = [study(d, known, n) for d, n in counts.items() for known in (False, True)]
    command = f"tests/concealed/ideal.py --out tests/concealed/ideal.json --stages {given.stages}"
    sampled = {"false_alarms": ALARMS, "nulls": NULLS, "shapes_a_family": TRIALS, "recordings_a_shape": REPEATS}
    given.out.write_text(json.dumps({"command": command, **sampled, "rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
