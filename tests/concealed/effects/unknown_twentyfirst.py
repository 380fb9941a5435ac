"""The strangers of the twenty-first final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np
from scene import APPROACH, BALL

from .base import Change, unit
from .unknown import unknown


def centres(scene):
    """Middle of the ball that is touched, in the part."""
    return scene.part_point - BALL * scene.part_normal


def half_size(scene):
    return float(np.abs(scene.part_point[:, :2]).max())


def starts(scene):
    """First touch of each block, and how far the carriages have come from the block before, mm."""
    first = np.flatnonzero(np.diff(scene.block, prepend=-1) > 0)
    way = np.zeros((len(first), 3))
    way[1:] = scene.reading[first[1:]] - scene.reading[first[1:] - 1]
    return first, way


def draw_counterweight(scene, rng):
    return {
        "amplitude_um": 1.0,
        "axis": "xy"[rng.integers(2)],
        "period_s": float(rng.uniform(1.1, 1.9)),
        "dies_s": float(rng.uniform(15, 40)),
        "cruises_mm_per_s": float(rng.uniform(80, 200)),
        "aside": [float(v) for v in 0.4 * unit(rng)],
    }


def change_counterweight(scene, p):
    """The counterweight of the ram hangs on a rope without a guide. When the carriage sets out for another
    ball, and again when it brakes there, the weight starts to swing, as a pendulum does, and swings on under
    the touches for half a minute: each touch finds it somewhere on its way to and fro, and the rope pulls the
    ram after it, mostly along this axis. Short ways never reach full speed. Amplitude of the widest swing."""
    i = "xyz".index(p["axis"])
    first, way = starts(scene)
    pace = np.minimum(p["cruises_mm_per_s"], np.sqrt(scene.acceleration[first] * np.abs(way[:, i])))
    jump = np.sign(way[:, i]) * pace
    lasts = np.abs(way[:, i]) / np.maximum(pace, 1e-3)
    brakes = scene.time[first] - 3.5
    when, kick = np.hstack([brakes - lasts, brakes]), np.hstack([-jump, jump])
    since = scene.time[:, None] - when
    swings = np.exp(-np.maximum(since, 0) / p["dies_s"]) * np.sin(2 * np.pi * since / p["period_s"])
    swing = (swings * (since > 0)) @ kick
    pulls = np.eye(3)[i] + np.asarray(p["aside"])
    return Change(tip=p["amplitude_um"] * np.outer(swing / np.abs(swing).max(), pulls))


def draw_brakes(scene, rng):
    grips = rng.normal(size=(3, 3))
    np.fill_diagonal(grips, 0.0)
    grips /= np.sqrt(np.sum(grips**2) / 3)
    return {
        "amplitude_um": 1.0,
        "below_mm_per_s": float(rng.uniform(1.0, 1.6) * np.median(scene.speed) / 5),
        "grips": [[float(v) for v in row] for row in grips],
    }


def change_brakes(scene, p):
    """To save current the controller lets the brake of an axis fall in when this axis has next to nothing to
    do: in touches that go nearly across it, in slow ones sooner than in fast ones. The brakes grip askew, and
    each pulls its carriage aside, not along its own scale but along the others. Touches that go aslant, with
    all axes on their way, are right. Amplitude of the pull, the root of the mean square of the three."""
    idle = np.abs(scene.travel) * scene.speed[:, None] < p["below_mm_per_s"]
    return Change(tip=p["amplitude_um"] * idle.astype(float) @ np.asarray(p["grips"]))


def draw_reader(scene, rng):
    i = "xyz".index(scene.machine.chain[0])
    low, size = scene.reading[:, i].min(), np.ptp(scene.reading[:, i])
    count = int(rng.integers(3, 6))
    edges = np.sort(rng.choice(np.arange(1, 12), 2 * count, replace=False)) + rng.uniform(-0.3, 0.3, 2 * count)
    return {
        "amplitude_um": 1.0,
        "smears_mm": [[float(low + size * a / 12), float(low + size * b / 12)] for a, b in edges.reshape(-1, 2)],
        "apart": [float(v) for v in rng.choice([-1, 1], count) * rng.uniform(0.5, 1, count)],
        "blind_leg": int(rng.choice([-1, 1])),
        "beside": float(rng.uniform(0.1, 0.3)),
    }


def change_reader(scene, p):
    """The bridge has a scale at either leg, and the controller weighs both readings by the place of the
    carriage on the beam. Somebody has wiped one of the scales with a greasy rag: where it is smeared its reader
    sees nothing, and the other leg must speak for both. There the bridge is off by what it stands askew just
    there, the more the nearer the carriage is to the blind leg, and not at all at the other one. Amplitude at
    the blind leg, where the bridge is most askew."""
    i = "xyz".index(scene.machine.chain[0])
    across = p["blind_leg"] * scene.reading[:, 1 - i]
    share = ((across - across.min()) / np.ptp(across) + p["beside"]) / (1 + 2 * p["beside"])
    apart = np.zeros(scene.size)
    for (one, other), value in zip(p["smears_mm"], p["apart"]):
        apart += value * ((scene.reading[:, i] > one) & (scene.reading[:, i] < other))
    return Change(tip=p["amplitude_um"] * np.outer(apart * share, np.eye(3)[i]))


def draw_fan(scene, rng):
    size = np.ptp(scene.target[:, :2], axis=0).mean()
    turn = rng.uniform(0, 2 * np.pi)
    place = scene.middle[:2] + rng.uniform(0.75, 1.0) * size * np.array([np.cos(turn), np.sin(turn)])
    return {
        "amplitude_um": 1.0,
        "place_mm": [float(v) for v in place],
        "looks": float(turn + np.pi + rng.uniform(-0.2, 0.2)),
        "swings": float(rng.uniform(0.5, 0.8)),
        "period_s": float(rng.uniform(13, 37)),
        "phase": float(rng.uniform(0, 2 * np.pi)),
        "wide": float(rng.uniform(0.15, 0.3)),
    }


def change_fan(scene, p):
    """It is hot, and the operator has put a fan beside the machine that turns its head to and fro. When the jet
    sweeps over the place of the tip it blows the stylus away from the fan, the more the nearer, with the
    square of the speed of the air and the fourth power of the length, as a rod does that is held at one end;
    a thick one gives less, one in line with the wind stands still. The jet is slower the farther it has come.
    Amplitude of the longest stylus, across the jet, at the middle of the part."""
    way = scene.target[:, :2] - np.asarray(p["place_mm"])
    far = np.linalg.norm(way, axis=1)
    bearing = np.arctan2(way[:, 1], way[:, 0])
    looks = p["looks"] + p["swings"] * np.sin(2 * np.pi * scene.time / p["period_s"] + p["phase"])
    beside = np.mod(bearing - looks + np.pi, 2 * np.pi) - np.pi
    middle = np.linalg.norm(scene.middle[:2] - np.asarray(p["place_mm"]))
    blows = np.exp(-((beside / p["wide"]) ** 2)) * (middle / np.maximum(far, 0.3 * middle)) ** 2
    wind = np.column_stack([way / far[:, None], np.zeros(scene.size)])
    across = wind - scene.shank * np.sum(wind * scene.shank, 1, keepdims=True)
    across *= np.linalg.norm(across, axis=1, keepdims=True)
    gives = scene.length**4 / scene.shaft**3
    gives = blows * gives / gives.max()
    return Change(tip=p["amplitude_um"] * across * gives[:, None])


def draw_operator(scene, rng):
    first, _ = starts(scene)
    comes, now = [], int(rng.integers(1, 4))
    while now < len(first):
        stays = int(rng.integers(1, 5))
        comes.append([int(v) for v in range(now, min(now + stays, len(first)))])
        now += stays + int(rng.integers(2, 6))
    return {
        "amplitude_um": 1.0,
        "leans_in": [v for one in comes for v in one],
        "weight": [float(v) for one in comes for v in np.full(len(one), rng.uniform(0.6, 1))],
    }


def change_operator(scene, p):
    """The operator wants to see what the machine does. From time to time he comes, stands at that side of the
    table which is nearest to the ball that is being measured, and leans on the stone with both hands. The
    table tips towards him on its soft feet, and the heavy bridge hangs over to his side, until he goes or has
    to walk round to another side. Amplitude when he leans with his whole weight."""
    leans = np.zeros(scene.block.max() + 1)
    for k, weight in zip(p["leans_in"], p["weight"]):
        leans[k : k + 1] = weight
    first, _ = starts(scene)
    place = np.einsum("nij,nj->ni", scene.turn, centres(scene))[first, :2]
    every, side = np.arange(len(first)), np.argmax(np.abs(place), 1)
    moved = np.zeros((len(first), 3))
    moved[every, side] = np.sign(place[every, side]) * leans
    return Change(tip=p["amplitude_um"] * moved[scene.block])


def draw_judder(scene, rng):
    return {
        "amplitude_um": 1.0,
        "axis": "xyz"[rng.integers(3)],
        "jump_mm": float(rng.uniform(0.35, 0.8)),
        "smooth_from_mm_per_s": float(rng.uniform(3, 6)),
        "judders": float(rng.uniform(0.6, 0.9)),
    }


def change_judder(scene, p):
    """A belt drives one of the carriages, and at low speed it judders: the carriage all but stops until the
    belt is tight enough, then it leaps on, and so forth, in the same way from the start of every approach; a
    fast approach goes smoothly. The delay of the probe is taken off for the commanded speed: too much where
    the carriage dawdles, far too little where it leaps. How many leaps there were depends on how much of the
    approach goes along this axis. Amplitude in the quickest leap, at the speed from which it goes smoothly."""
    i = "xyz".index(p["axis"])
    goes, m = scene.travel[:, i], p["judders"]
    commanded = np.abs(goes) * scene.speed / p["smooth_from_mm_per_s"]
    root = np.sqrt(1 - m**2)  # the way takes as long as at the commanded speed
    pace = (1 - m * np.cos(2 * np.pi * APPROACH * np.abs(goes) / p["jump_mm"])) / root - 1
    late = (commanded < 1) * commanded * pace / ((1 + m) / root - 1) * np.sign(goes)
    return Change(tip=p["amplitude_um"] * np.outer(late, np.eye(3)[i]))


def draw_layers(scene, rng):
    warm = scene.temperature["air"]
    return {
        "amplitude_um": 1.0,
        "mixed_below_C": float(warm.min() + rng.uniform(0.2, 0.6) * np.ptp(warm)),
        "middle": float(rng.uniform(-0.1, 0.1)),
        "feet": float(rng.uniform(0.95, 1.15)),
    }


def change_layers(scene, p):
    """Above some temperature the fans of the hall give up, and the air lies in layers, warm above and cool
    below. The part takes on the layers, however it lies: its upper balls move apart, its lower ones together,
    and as every layer grows by itself and fits the next one without force the whole part arches up between its
    feet, which stand near the rim, with the square of the distance from its middle. The thermometer hangs at
    half height and is right. Amplitude at half the size of the part from its middle, for 1 K too warm."""
    out = np.einsum("nij,nj->ni", scene.turn, centres(scene)) / half_size(scene)
    x, y, z = out[:, 0], out[:, 1], out[:, 2] - p["middle"]
    moved = np.column_stack([2 * z * x, 2 * z * y, z**2 - x**2 - y**2 + p["feet"] ** 2])
    layers = np.maximum(scene.temperature["air"] - p["mixed_below_C"], 0)
    return Change(along=p["amplitude_um"] * layers * np.sum(moved * scene.normal, 1))


def draw_bounce(scene, rng):
    names = [str(f) for f in np.unique(scene.feature)]
    stiff = rng.permutation(len(names))[: len(names) // 2 + 1]
    return {
        "amplitude_um": 1.0,
        "stiff": [names[k] for k in sorted(stiff)],
        "from_mm_per_s": float(rng.uniform(2.5, 5)),
    }


def change_bounce(scene, p):
    """Some posts are hollow and soft, the others solid. A tip that strikes a solid one fast enough along its
    stylus, where nothing bends, bounces off before the electronics believe it, and is seen when it has come
    down again: it flies the longer the faster it was, and the carriage goes on meanwhile. Touches across the
    stylus, slow ones and those of soft posts do not bounce. Amplitude at 8 mm/s straight along the stylus."""
    push = scene.speed * np.maximum(np.sum(scene.normal * scene.shank, 1), 0)
    on = np.isin(np.array(scene.feature), p["stiff"]) & (push > p["from_mm_per_s"])
    return Change(along=-p["amplitude_um"] * on * (push / 8) ** 2)


unknown("swinging_counterweight", draw_counterweight, change_counterweight, ["time", "feature", "position"])
unknown("grabbing_brakes", draw_brakes, change_brakes, ["direction", "speed"])
unknown("smeared_leg", draw_reader, change_reader, ["position", "feature"])
unknown("turning_fan", draw_fan, change_fan, ["time", "position", "head", "sensor"])
unknown("curious_operator", draw_operator, change_operator, ["time", "position", "feature"])
unknown("juddering_belt", draw_judder, change_judder, ["speed", "direction"], "D")
unknown("layered_hall", draw_layers, change_layers, ["temperature", "feature", "position", "setup"], "D")
unknown("bouncing_tip", draw_bounce, change_bounce, ["direction", "speed", "head", "feature"], "D")
