"""The strangers of the fifteenth final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np

from .base import Change, unit, vector
from .unknown import unknown


def draw_matrix(scene, rng):
    return {"amplitude_um": 1.0, "digits": int(rng.integers(4, 8))}


def change_matrix(scene, p):
    """The matrix that says how the part lies is handed on as text with a few digits. Its rows are then not quite of
    length one nor at right angles, and the part is stretched and sheared, in another way in each placement; where it
    lies straight along the axes nothing is lost. Amplitude at the farthest ball, for half a unit of the last digit."""
    exact = scene.turn * 10.0 ** p["digits"]
    lost = 2 * (np.floor(exact + 0.5) - exact)
    far = scene.part_point / np.linalg.norm(scene.part_point, axis=1).max()
    return Change(tip=p["amplitude_um"] * np.einsum("nij,nj->ni", lost, far))


def draw_archive(scene, rng):
    names = [str(f) for f in rng.permutation(np.unique(scene.feature))]
    moved = rng.normal(size=(len(scene.styli), 3))
    return {
        "amplitude_um": 1.0,
        "balls": sorted(names[: int(rng.integers(3, 6))]),
        "moved": (moved / np.sqrt(np.mean(moved**2))).tolist(),
    }


def change_archive(scene, p):
    """Some balls are measured by a subprogram that was copied from elsewhere, and it loads the tips as they were
    qualified a month ago: there every orientation has its old place, at all other balls the right one. Amplitude is
    the root of the mean square of the coordinates by which the tips have moved since."""
    there = np.array([f in p["balls"] for f in scene.feature])
    return Change(tip=p["amplitude_um"] * np.asarray(p["moved"])[scene.sensor] * there[:, None])


def draw_averaged(scene, rng):
    return {"amplitude_um": rng.choice([-1.0, 1.0]), "touches": int(rng.integers(20, 45))}


def change_averaged(scene, p):
    """Against the noise of the thermometer the software takes the mean of its last readings, one for each touch. When
    the hall has become warmer or colder in a pause, the first touches after it are still corrected for the old
    temperature of the part, and bit by bit for the new one. Amplitude at the farthest ball, for 1 K."""
    warm = scene.temperature["part"]
    mean = np.array([warm[max(0, k + 1 - p["touches"]) : k + 1].mean() for k in range(scene.size)])
    far = np.sum(scene.part_point * scene.part_normal, 1) / np.linalg.norm(scene.part_point, axis=1).max()
    return Change(along=p["amplitude_um"] * (warm - mean) * far)


def draw_rack(scene, rng):
    return {"amplitude_um": 1.0, "tau_s": rng.uniform(30, 90)}


def change_rack(scene, p):
    """The rack of the styli stands in the warm air of the controller's fan. A module that has waited there is long when
    it is fetched, shrinks while it measures, and gets warm again when it is put back, the long one by more than the
    short one. The qualification has taken the mean of each. Amplitude of the longest, from cool to warm."""
    lengths = np.unique(scene.length)
    module = np.searchsorted(lengths, scene.length)
    warm, grown = np.ones(len(lengths)), np.zeros(scene.size)
    for k in range(scene.size):
        if k:
            air = (np.arange(len(lengths)) != module[k - 1]).astype(float)
            warm = air + (warm - air) * np.exp(-(scene.time[k] - scene.time[k - 1]) / p["tau_s"])
        grown[k] = warm[module[k]]
    for j in range(len(lengths)):
        grown[module == j] -= grown[module == j].mean()
    return Change(tip=scene.shank * (p["amplitude_um"] * grown * scene.length / scene.length.max())[:, None])


def draw_parked(scene, rng):
    axis = int(rng.integers(2))
    x = scene.reading[:, axis]
    return {
        "amplitude_um": rng.choice([-1.0, 1.0]),
        "axis": axis,
        "parked_mm": float(np.quantile(x, rng.uniform(0.1, 0.9))),
        "width_mm": rng.uniform(0.12, 0.22) * float(np.ptp(x)),
        "tau_s": rng.uniform(300, 900),
    }


def change_parked(scene, p):
    """In every long pause the machine is parked at the same place. The air that blows out of the bearings cools one
    side of the guide just there, and the guide is bent there when the machine starts again, until the stone has warmed
    through: the carriage is pushed aside when it passes this place soon after a pause. Amplitude at the place, right
    after the pause."""
    pause = np.diff(scene.time, prepend=scene.time[0] - 3600) > 600
    began = scene.time[np.maximum.accumulate(np.where(pause, np.arange(scene.size), 0))]
    cold = np.exp(-(scene.time - began) / p["tau_s"])
    away = (scene.reading[:, p["axis"]] - p["parked_mm"]) / p["width_mm"]
    return Change(tip=vector(np.eye(3)[1 - p["axis"]], p["amplitude_um"] * cold * np.exp(-0.5 * away**2)))


def draw_knob(scene, rng):
    share = rng.uniform(0.3, 1, len(scene.styli))
    return {"amplitude_um": 1.0, "slower": ((share.mean() - share) / 0.35).tolist()}


def change_knob(scene, p):
    """While the orientations were qualified somebody played with the knob that slows the machine down. The software
    believes in the speed of the program, and has got for each orientation another delay of the probe, some too short,
    some too long: a touch is off along its way in proportion to the speed. Amplitude at 8 mm/s for an orientation
    at one end of the knob, when the mean is half way."""
    late = np.asarray(p["slower"])[scene.sensor] * scene.speed / 8
    return Change(tip=scene.travel * (p["amplitude_um"] * late)[:, None])


def draw_ring(scene, rng):
    slots = int(rng.choice([4, 8]))
    return {"amplitude_um": 1.0, "slots": slots, "slot": int(rng.integers(slots)), "zero": unit(rng).tolist()}


def change_ring(scene, p):
    """The controller puts the counters of the scales, touch by touch, into a few memories in turn. When the machine was
    homed again one of these was forgotten and still adds the old zero: every fourth or eighth touch is off, by the same
    vector, whatever is touched. Amplitude is the distance between the zeros."""
    here = np.arange(scene.size) % p["slots"] == p["slot"]
    return Change(tip=vector(p["zero"], p["amplitude_um"] * here))


def draw_fillets(scene, rng):
    names = [str(f) for f in rng.permutation(np.unique(scene.feature))][: int(rng.integers(3, 6))]
    return {
        "amplitude_um": 1.0,
        "begins": {f: rng.uniform(0.05, 0.4) for f in names},
        "thick_at": {f: rng.uniform(0, 2 * np.pi) for f in names},
    }


def change_fillets(scene, p):
    """The balls are glued on their posts. On some of them there was too much glue, and it has crept up the underside,
    on one higher than on another, mostly on the side to which it ran. Touches of the upper half are right, those well
    below the equator meet the glue. Amplitude 40 degrees below the equator, where it is thick."""
    glued = np.array([f in p["begins"] for f in scene.feature])
    begins = np.array([p["begins"].get(f, 0.0) for f in scene.feature])
    thick = np.array([p["thick_at"].get(f, 0.0) for f in scene.feature])
    around = np.arctan2(scene.part_normal[:, 1], scene.part_normal[:, 0])
    deep = np.clip((-scene.part_normal[:, 2] - begins) / (np.sin(np.radians(40)) - begins), 0, None)
    return Change(along=p["amplitude_um"] * glued * deep * (1 + np.cos(around - thick)) / 2)


unknown("rounded_matrix", draw_matrix, change_matrix, ["setup", "position", "feature"], "D")
unknown("archived_tips", draw_archive, change_archive, ["feature", "sensor", "head"])
unknown("averaged_thermometer", draw_averaged, change_averaged, ["temperature", "time", "position", "feature"], "D")
unknown("warm_rack", draw_rack, change_rack, ["time", "sensor", "head"], "D")
unknown("parked_chill", draw_parked, change_parked, ["time", "position", "feature", "setup"], "D")
unknown("turned_knob", draw_knob, change_knob, ["speed", "sensor", "head"], "D")
unknown("ring_buffer", draw_ring, change_ring, ["time"])
unknown("glue_fillets", draw_fillets, change_fillets, ["direction", "feature"])
