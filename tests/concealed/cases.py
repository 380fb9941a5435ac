"""Which cases a round has, and how one is made. The plan fixes kind, size and family; designs, machines and
shapes are drawn until the effect reaches its signal-to-noise ratio at a plausible size."""

import hashlib
from dataclasses import dataclass

import designs
import files
import machine as cmm
from effects import CATALOGUE, noise, unknown, unknown_final
from null import Null
from portable import np
from seal import generator
from world import LADDER, Baseline, scaled, short

COUNTS = {"null": 400, "single": 288, "pair": 60, "unknown": 80, "missing": 40, "covariance": 40}
STRIDE = 7  # has no divisor in common with the number of families, so that all come
# Parameters with one meaning everywhere (docs/physics), by which answers are judged.
FIXED = {
    "thermal.part_expansion": ["cte_error_ppm_per_K"],
    "thermal.scale_expansion": ["cte_error_ppm_per_K"],
    "machine.scale": ["scale_um_per_m"],
    "machine.squareness": ["squareness_urad"],
    "machine.scale_interpolation": ["amplitude_um", "period_um"],
    "thermal.cycle": ["amplitude_um", "period_s"],
    "thermal.drift": ["amplitude_um"],
    "machine.step": ["t0_s", "amplitude_um"],
    "part.shift": ["t0_s", "amplitude_um"],
    "probe.step": ["t0_s", "amplitude_um"],
    "probe.tip_radius": ["amplitude_um"],
    "probe.stylus_length": ["length_error_um"],
    "probe.trigger_delay": ["delay_ms"],
    "head.reindexing": ["sd_urad"],
    "noise.vibration": ["sd_um"],
    "noise.outliers": ["share"],
    "noise.resolution": ["resolution_um"],
    "noise.unequal": ["ratio"],
}


@dataclass(frozen=True)
class Spec:
    kind: str
    family: str = ""
    snr: float = 0.0
    detail: str = ""


def plan(counts, final=False):
    """The list of cases of a round."""
    out = [Spec("null", detail=("clean", "hard")[i % 2]) for i in range(counts["null"])]
    families = sorted(CATALOGUE)
    for i in range(counts["single"]):
        # The stride spreads the families of every ratio over the whole catalogue, in a small round too: power by
        # ratio must not compare one family with another.
        family = families[(STRIDE * (i // len(LADDER)) + 5 * (i % len(LADDER))) % len(families)]
        out.append(Spec("single", family, LADDER[i % len(LADDER)]))
    out += [
        Spec("pair", snr=(8.0, 10.0)[i % 2], detail=("separable", "decoy", "masking")[i % 3])
        for i in range(counts["pair"])
    ]
    strangers = sorted((unknown_final if final else unknown).UNKNOWN)
    out += [
        Spec(
            "unknown",
            strangers[i % len(strangers)],
            (6.0, 10.0, 16.0)[i // len(strangers) % 3],
            "final" if final else "",
        )
        for i in range(counts["unknown"])
    ]
    without = [f for f in families if CATALOGUE[f].needs]
    out += [
        Spec("missing", without[i % len(without)], 10.0, ("dropped", "stuck")[i % 2]) for i in range(counts["missing"])
    ]
    spreads = sorted(noise.SPREADS)
    for i in range(counts["covariance"]):
        name = spreads[i % len(spreads)]
        sized = noise.SPREADS[name].columns is not None  # dirt and resolution are no Gaussians: they have no ratio
        out.append(Spec("covariance", name, (6.0, 9.0, 15.0)[i // len(spreads) % 3] if sized else 0.0))
    return out


class Stage:
    """Machine, plan and baseline of one case: everything but what is concealed."""

    def __init__(self, rng, design, known, hard=False, geometry_kind=None):
        self.machine = cmm.MACHINES[rng.integers(len(cmm.MACHINES))]
        self.design, self.known = design, known
        size = 1125 if design == "D" and rng.uniform() < 0.06 else None
        self.scene = designs.build(design, self.machine, rng, size)
        self.nuisance = {"geometry": "paper", "geometry_scale": 1.0, "noise": "white", "noise_scale": 1.0}
        if hard:
            self.nuisance = {
                "geometry": str(rng.choice(["paper", "rough"])),
                "geometry_scale": float(2 ** rng.uniform(-1, 1)),
                "noise": str(rng.choice(noise.KINDS)),
                "noise_scale": float(rng.uniform(0.7, 1.5)),
            }
        draw = cmm.rough_geometry if self.nuisance["geometry"] == "rough" else cmm.paper_geometry
        self.geometry = geometry = draw(self.machine, rng, self.nuisance["geometry_scale"])
        self.noise = more = (self.nuisance["noise"], self.nuisance["noise_scale"])
        self.base = Baseline(self.scene, geometry, rng, *more)
        self.calibration = Baseline(designs.build("K", self.machine, rng), geometry, rng, *more) if known else None
        self._null = None

    @property
    def null(self):
        if self._null is None:
            self._null = Null(self.scene, self.calibration.scene if self.known else None)
        return self._null

    def residual(self, r):
        """Of recording and calibration."""
        return np.concatenate([r, self.calibration.r]) if self.known else r

    def files(self, r, **how):
        digits = 0.5 * self.machine.probe_sd if self.nuisance["noise"] == "rounded" else 0.0
        how.setdefault("resolution", digits)
        out = {
            "machine.json": files.machine_json(self.scene, self.calibration.scene if self.known else None),
            "recording.csv": files.recording_csv(self.scene, r, **how),
        }
        if self.known:
            out["calibration.csv"] = files.recording_csv(self.calibration.scene, self.calibration.r, resolution=digits)
        return out


def described(effect, parameters, snr):
    return {
        "name": effect.name,
        "snr": snr,
        "parameters": parameters,
        "fixed": {k: parameters[k] for k in FIXED.get(effect.name, [])},
        "factors": list(effect.factors),
    }


def oracle(stage, d, r):
    """The best that one can do who knows the shape: matched filter; likelihood ratio and held-out log score,
    in nats."""
    scene, y = stage.scene, stage.residual(r)
    s = stage.null.snr(d)
    z = float(d @ stage.null.times(y)[: scene.size] / s)
    groups = next((g for g in (scene.setup, scene.sensor) if len(np.unique(g)) > 1), scene.time // (scene.duration / 5))
    return {"z": z, "log_likelihood_ratio": z * z / 2, "held_out_gain": stage.null.held_out_gain(y, d, groups)}


def staged(rng, designs_allowed, known_share, **more):
    return Stage(rng, str(rng.choice(list(designs_allowed))), bool(rng.uniform() < known_share), **more)


def poor_or_rich(effect):
    """Half of the cases in the rich design where the effect can be in others too."""
    return effect.designs + "D" * (len(effect.designs) - 1) * ("D" in effect.designs)


def table_of(spec):
    """The effects that may be concealed in such a case."""
    return {"unknown": (unknown_final if spec.detail == "final" else unknown).UNKNOWN}.get(spec.kind, CATALOGUE)


def find(rng, spec, family=None, attempts=8):
    """A stage on which the effect of the spec is possible: (stage, effect, parameters, signature), or None."""
    effect = table_of(spec)[family or spec.family]
    for _ in range(attempts):
        stage = staged(rng, poor_or_rich(effect) if spec.kind != "missing" else "D", 0.8 if effect.known else 0.15)
        got = scaled(effect, stage.base, stage.null, effect.draw(stage.scene, rng), spec.snr)
        if got:
            return stage, effect, *got
    return None


def found(rng, spec):
    """As find; another family when this one cannot be that large anywhere."""
    family, table = spec.family, table_of(spec)
    others = [f for f in sorted(table) if f != family and (spec.kind != "missing" or table[f].needs)]
    while True:
        got = find(rng, spec, family)
        if got:
            return got
        family = str(rng.choice(others))


def make_null(rng, spec):
    stage = staged(rng, "ACDED", 0.3, hard=spec.detail == "hard")
    return (
        stage,
        stage.base.r,
        {"verdict": "no_mismatch", "effects": [], "tolerated": noise.TOLERATED.get(stage.nuisance["noise"], [])},
        {},
    )


def make_single(rng, spec):
    stage, effect, p, d = found(rng, spec)
    r = stage.base.r + d
    return (
        stage,
        r,
        {"verdict": "named", "effects": [described(effect, p, spec.snr)], "oracle": oracle(stage, d, r)},
        {},
    )


def make_unknown(rng, spec):
    stage, effect, p, d = found(rng, spec)
    r = stage.base.r + d
    near = nearest(rng, stage, d)
    return (
        stage,
        r,
        {
            "verdict": "unexplained",
            "effects": [described(effect, p, spec.snr)],
            "nearest": near[:3],
            "oracle": oracle(stage, d, r),
        },
        {},
    )


def nearest(rng, stage, d):
    """Catalogue effects by how well combinations of their draws can imitate d: [[name, correlation], ...]."""
    out = []
    for name, effect in sorted(CATALOGUE.items()):
        if stage.design in effect.designs:
            columns = [stage.base.signature(effect, effect.draw(stage.scene, rng)) for _ in range(effect.spans)]
            out.append([name, stage.null.correlation(d, np.column_stack(columns))])
    return sorted(out, key=lambda row: -row[1])


def make_missing(rng, spec):
    stage, effect, p, d = found(rng, spec)
    r = stage.base.r + d
    can_stick = effect.needs[0].startswith(("temp", "speed", "accel", "load"))
    how = {"stuck" if spec.detail == "stuck" and can_stick else "without": list(effect.needs)}
    return stage, r, {"verdict": "cannot_judge", "effects": [described(effect, p, spec.snr)], **how}, how


def make_pair(rng, spec):
    """separable: two effects, correlation below 0.7; masking: two that partly cancel; decoy: one, with a
    rival that looks the same."""
    while True:
        stage = staged(rng, "CDD" if spec.detail != "decoy" else "ACE", 0.25)
        pool = []
        for name in rng.permutation([n for n in sorted(CATALOGUE) if stage.design in CATALOGUE[n].designs])[:14]:
            got = scaled(CATALOGUE[name], stage.base, stage.null, CATALOGUE[name].draw(stage.scene, rng), spec.snr)
            if got:
                pool.append((CATALOGUE[name], *got))
        got = (decoy if spec.detail == "decoy" else two_of)(rng, spec, stage, pool)
        if got:
            return (stage, *got, {})


def decoy(rng, spec, stage, pool):
    for effect, p, d in pool:
        rivals = [row for row in nearest(rng, stage, d) if row[0] != effect.name and row[1] > 0.9]
        if rivals:
            r = stage.base.r + d
            return r, {
                "verdict": "one_of",
                "effects": [described(effect, p, spec.snr)],
                "rivals": rivals,
                "oracle": oracle(stage, d, r),
            }
    return None


def two_of(rng, spec, stage, pool):
    for i, (one, p, d) in enumerate(pool):
        for other, q, e in pool[:i]:
            rho = float(d @ stage.null.times(e)[: stage.scene.size]) / spec.snr**2
            if spec.detail == "separable" and abs(rho) < 0.7 or spec.detail == "masking" and -0.85 < rho < -0.3:
                r = stage.base.r + d + e
                return r, {
                    "verdict": "named",
                    "effects": [described(one, p, spec.snr), described(other, q, spec.snr)],
                    "rho": rho,
                    "oracle": oracle(stage, d + e, r),
                }
    return None


def make_covariance(rng, spec):
    spread = noise.SPREADS[spec.family]
    while True:
        stage = staged(rng, spread.designs, 0.2)
        scene, p, how, d = stage.scene, spread.draw(stage.scene, rng), {}, 0.0
        if spec.family == "noise.outliers":
            d = noise.outliers(scene, p, rng)
        elif spec.family == "noise.resolution":
            how = {"resolution": p["resolution_um"]}
        else:
            size, columns = noise.sized(spread, scene, stage.null, p, spec.snr)
            if size > 3 * spread.largest:
                continue
            size = p[spread.size] = short(size)
            d = size * columns @ rng.normal(size=columns.shape[1])
            if spec.family == "noise.unequal":
                p["ratio"] = float(np.sqrt(1 + size**2))
        entry = {
            "name": spread.name,
            "snr": spec.snr,
            "parameters": p,
            "fixed": {k: p[k] for k in FIXED.get(spread.name, [])},
            "factors": list(spread.factors),
        }
        return stage, stage.base.r + d, {"verdict": "named", "effects": [entry]}, how


MAKERS = {
    "null": make_null,
    "single": make_single,
    "pair": make_pair,
    "unknown": make_unknown,
    "missing": make_missing,
    "covariance": make_covariance,
}


def make(secret, number, spec):
    """(data files as text by name, truth) of one case."""
    stage, r, truth, how = MAKERS[spec.kind](generator(secret, "case", number), spec)
    data = stage.files(r, **how)
    h = hashlib.sha256()
    for name in sorted(data):
        h.update(name.encode() + b"\0" + data[name].encode() + b"\0")
    truth.update(
        case=number,
        kind=spec.kind,
        detail=spec.detail,
        snr=spec.snr,
        design=stage.design,
        touches=stage.scene.size,
        machine=stage.machine.name,
        mode="known" if stage.known else "fresh",
        nuisance=stage.nuisance,
        data_sha256=h.hexdigest(),
    )
    return data, truth
