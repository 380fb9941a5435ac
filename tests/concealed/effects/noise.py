"""What shifts no mean: noise of the null machines, and the effects that only a covariance shows.

A covariance effect is a set of columns F: it adds F F' m^2 to the covariance, with m its size. Its
signal-to-noise ratio is s = sqrt(2 KL), with KL the Kullback-Leibler divergence of the recording with the
effect from that without; for a shift of the mean the same formula gives sqrt(d' P d).
"""

from dataclasses import dataclass
from typing import Callable

from portable import np

from null import indexing_columns

KINDS = ("white", "t4", "ar1", "dirt", "rounded", "stylus")
# A report of nothing but these is no false alarm where the noise has the property.
TOLERATED = {
    "t4": ["noise.outliers"],
    "ar1": ["noise.vibration"],
    "dirt": ["noise.outliers"],
    "rounded": ["noise.resolution"],
    "stylus": ["noise.unequal", "noise.vibration"],
}


def probe_noise(scene, rng, kind="white", scale=1.0):
    """um along the normal."""
    n, sd = scene.size, scene.machine.probe_sd * scale
    z = rng.normal(size=n)
    if kind == "t4":
        z = z / np.sqrt(rng.chisquare(4, n) / 4) / np.sqrt(2)
    elif kind == "ar1":
        z[1:] *= np.sqrt(1 - 0.5**2)
        for i in range(1, n):
            z[i] += 0.5 * z[i - 1]
    elif kind == "dirt":
        z = z + (rng.uniform(size=n) < 0.005) * rng.uniform(3, 15, n) / sd
    elif kind == "stylus":
        z = z * rng.uniform(0.7, 1.5, len(scene.styli))[scene.sensor]
    return sd * z


@dataclass(frozen=True)
class Spread:
    name: str
    draw: Callable  # (scene, rng) -> parameters
    columns: Callable  # (scene, parameters) -> (N, k), um for size 1; None: no Gaussian
    size: str  # the parameter that the size is written to, beside those drawn
    largest: float
    factors: tuple
    needs: tuple = ()
    designs: str = "ACDE"


def vibration(scene, p):
    return np.diag(np.abs(scene.normal @ p["direction"]))


def coupling(scene, p):
    """One rail profile f per direction across the axis: the mean of f under two bearings b apart is the
    straightness, their difference over b the angle. Harmonics of the travel with random coefficients ~
    1/n."""
    i = "xyz".index(p["axis"])
    length, base = scene.machine.travel[p["axis"]], p["bearing_base_mm"]
    x, lever, out = scene.reading[:, i], scene.target - scene.target.mean(0), []
    lever = lever + np.array([0, 0, p["arm_mm"]])
    for j in (k for k in range(3) if k != i):
        about = np.cross(np.eye(3)[i], np.eye(3)[j])
        for n in range(1, 8):
            for wave in (np.cos, np.sin):
                f = lambda q: wave(np.pi * n * q / length) / n
                front, back = f(x + base / 2), f(x - base / 2)
                moved = np.outer((front + back) / 2, np.eye(3)[j]) + np.cross(
                    np.outer((front - back) / base, about), lever
                )
                out.append(np.sum(scene.normal * moved, 1))
    columns = np.column_stack(out)
    return columns / np.sqrt(2 * np.sum(1 / np.arange(1, 8) ** 2) / 2)


def groups(scene, p):
    loud = {
        "long": scene.length > min(scene.length) + 1,
        "tilted": scene.a > 0.02,
        "fast": scene.speed > min(scene.speed) + 1,
    }[p["group"]]
    return np.diag(scene.machine.probe_sd * loud.astype(float))


def draw_group(scene, rng):
    options = [g for g in ("long", "tilted", "fast") if 0.1 < np.mean(np.diag(groups(scene, {"group": g})) > 0) < 0.9]
    return {"group": str(rng.choice(options))} if options else {"group": "long"}


SPREADS = {
    s.name: s
    for s in (
        Spread(
            "head.reindexing",
            lambda s, r: {},
            lambda s, p: indexing_columns(s) / (s.machine.head_sd * 1e6),
            "sd_urad",
            20,
            ("head", "time"),
            ("visit",),
            "D",
        ),
        Spread(
            "machine.straightness_angle_coupling",
            lambda s, r: {"axis": "xyz"[r.integers(3)], "bearing_base_mm": 300.0, "arm_mm": r.uniform(300, 900)},
            coupling,
            "amplitude_um",
            5,
            ("position", "feature", "setup"),
            (),
            "CDE",
        ),
        Spread(
            "noise.vibration",
            lambda s, r: {"direction": np.eye(3)[r.integers(3)]},
            vibration,
            "sd_um",
            2,
            ("direction",),
            (),
        ),
        Spread(
            "noise.unequal",
            draw_group,
            groups,
            "excess_sd_share",
            3,
            ("sensor", "head", "speed"),
            ("sensor", "head_A_deg", "head_B_deg", "speed_mm_s"),
            "CD",
        ),
        Spread(
            "noise.outliers",
            lambda s, r: {"share": r.uniform(0.006, 0.02), "size_um": r.uniform(8, 20) * s.machine.probe_sd},
            None,
            "share",
            1,
            ("feature", "time"),
            (),
        ),
        Spread(
            "noise.resolution",
            lambda s, r: {"resolution_um": float(r.choice([2.0, 3.0, 4.0])) * s.machine.probe_sd},
            None,
            "resolution_um",
            5,
            ("direction",),
            (),
        ),
    )
}


def sized(spread, scene, null, parameters, target):
    """Size for which sqrt(2 KL) is the target, and the columns."""
    columns = spread.columns(scene, parameters)
    power = np.maximum(0, np.linalg.eigvalsh(columns.T @ null.times(columns)[: scene.size]))
    low, high = 0.0, 1e4
    for _ in range(80):
        m = (low + high) / 2
        s = np.sqrt(np.sum(m * m * power - np.log1p(m * m * power)))
        low, high = (m, high) if s < target else (low, m)
    return m, columns


def outliers(scene, p, rng):
    """Dirt and early triggers make the surface proud: one sign, lognormal sizes."""
    on = rng.uniform(size=scene.size) < p["share"]
    on[rng.integers(scene.size, size=2)] = True
    return on * p["size_um"] * np.exp(0.7 * rng.normal(size=scene.size))
