"""The strangers of the twenty-third final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np

from .base import Change, unit
from .unknown import unknown


def some_of(rng, names, low, high):
    """Between these shares of the names, in their order."""
    count = int(rng.integers(max(1, round(low * len(names))), max(2, round(high * len(names)) + 1)))
    return [names[k] for k in sorted(rng.permutation(len(names))[:count])]


def draw_signs(scene, rng):
    waves = rng.normal(size=(3, 2)) * np.array([1.0, 0.6])
    i = int(rng.integers(3))
    return {
        "amplitude_um": 1.0,
        "axis": "xyz"[i],
        "length_mm": float(rng.uniform(0.7, 1.3) * np.ptp(scene.reading[:, i])),
        "waves": (waves / np.sqrt(np.sum(waves**2, 1, keepdims=True) / 2)).tolist(),
        "phases": rng.uniform(0, 2 * np.pi, (3, 2)).tolist(),
    }


def change_signs(scene, p):
    """The correction table of one axis was copied to the new controller as numbers without a sign: each minus has
    been lost on the way. Where an error of the guide is positive the correction is as good as ever; where it is
    negative the controller now adds to it instead of taking it off, and the error is there twice. Between the two
    lies a kink, at another place for the position and for either straightness. Amplitude is the root of the mean
    square of the table in each of its three columns."""
    q = scene.reading[:, "xyz".index(p["axis"])]
    waves, phases = np.asarray(p["waves"]), np.asarray(p["phases"])
    table = np.zeros((scene.size, 3))
    for m in range(2):
        angle = 2 * np.pi * (m + 1) * q / p["length_mm"]
        table += waves[:, m] * np.cos(angle[:, None] + phases[:, m])
    return Change(tip=p["amplitude_um"] * 2 * np.minimum(table, 0))


def draw_handshake(scene, rng):
    own = rng.normal(size=(len(scene.styli), 3))
    return {
        "amplitude_um": 1.0,
        "own": (own / np.sqrt(np.mean(own**2))).tolist(),
        "late": int(rng.integers(1, 4)),
    }


def change_handshake(scene, p):
    """The software tells the controller which stylus is up now, and does not wait for an answer. The nominal vector
    of the new tip comes at once, out of the angles of the head; but the few micrometres by which the qualification
    has found this tip elsewhere come from a file, and for the first touches after each indexing those of the stylus
    before are still in force. Then all is right, until the next indexing; which touches are wrong, and whither, hangs
    on the pair of styli. Amplitude is the root of the mean square of a coordinate in the file."""
    own, shifted, before, count = np.asarray(p["own"]), np.zeros((scene.size, 3)), None, 0
    for k in range(scene.size):
        if k and scene.visit[k] != scene.visit[k - 1]:
            before, count = min(int(scene.sensor[k - 1]), len(own) - 1), 0
        if before is not None and count < p["late"]:
            shifted[k] = own[before] - own[min(int(scene.sensor[k]), len(own) - 1)]
        count += 1
    return Change(tip=p["amplitude_um"] * shifted)


def draw_joystick(scene, rng):
    stands = rng.uniform(0, 2 * np.pi)
    blocks = [int(b) for b in np.unique(scene.block)]
    return {
        "amplitude_um": 1.0,
        "blocks": some_of(rng, blocks, 0.25, 0.5),
        "stands": [float(np.cos(stands)), float(np.sin(stands))],
        "first_mm_per_s": float(rng.uniform(2, 4)),
        "last_mm_per_s": float(rng.uniform(12, 20)),
        "careful": float(rng.uniform(0.5, 0.8)),
    }


def change_joystick(scene, p):
    """Now and then the operator does not trust the program, and takes a ball by hand with the joystick. He begins
    gently and loses patience from touch to touch; on the side of the ball that is turned away from him, where he
    cannot see the tip, he feels his way, and from above he is neither quick nor slow. The software takes off the
    delay of the probe at the speed of the program, which his hand does not know: the quick touches are too deep, the
    slow ones too shallow, and the log has the speed of the program for all. Amplitude for 8 mm/s too fast."""
    ours, wrong = set(p["blocks"]), np.zeros(scene.size)
    first = np.searchsorted(scene.block, scene.block)
    count = np.bincount(scene.block)[scene.block]
    impatient = (np.arange(scene.size) - first) / np.maximum(count - 1, 1)
    hand = p["first_mm_per_s"] + (p["last_mm_per_s"] - p["first_mm_per_s"]) * impatient
    hand *= 1 - p["careful"] * 0.5 * (1 - scene.normal[:, :2] @ np.asarray(p["stands"]))
    by_hand = np.array([int(b) in ours for b in scene.block])
    wrong[by_hand] = (hand - scene.speed)[by_hand] / 8
    return Change(along=-p["amplitude_um"] * wrong)


def draw_lacquer(scene, rng):
    names = [str(f) for f in np.unique(scene.feature)]
    soft = some_of(rng, names, 0.4, 1.0)
    return {
        "amplitude_um": 1.0,
        "soft": {name: float(rng.uniform(0.4, 1)) for name in soft},
        "wide_deg": float(rng.uniform(14, 24)),
        "recovers_s": float(rng.uniform(1500, 8000)),
    }


def change_lacquer(scene, p):
    """Against rust some of the balls have been dipped in a thick lacquer that stays soft. Each touch leaves a broad
    dent in it, which fills again only slowly; a later touch near the same place, with whatever stylus, falls into
    the dents that earlier ones have left there, and finds the ball too small. The first touch of a ball is right, and
    where nobody has touched before all is right as well, however late. Amplitude is the depth of one fresh dent in
    the softest lacquer."""
    feature, deep = np.array(scene.feature), np.zeros(scene.size)
    for name, softness in p["soft"].items():
        mine = np.flatnonzero(feature == name)
        n, when = scene.part_normal[mine], scene.time[mine]
        angle = np.degrees(np.arccos(np.clip(n @ n.T, -1, 1)))
        since = when[:, None] - when
        dents = np.exp(-((angle / p["wide_deg"]) ** 2) - np.maximum(since, 0) / p["recovers_s"]) * (since > 0)
        deep[mine] = softness * dents.sum(1)
    return Change(along=-p["amplitude_um"] * deep)


def draw_weather(scene, rng):
    every = float(rng.uniform(300, 700))
    return {
        "amplitude_um": 1.0,
        "every_s": every,
        "first_s": float(-rng.uniform(0, 1) * every),
        "periods_s": [float(rng.uniform(1500, 3000)), float(rng.uniform(4000, 9000))],
        "phases": [float(v) for v in rng.uniform(0, 2 * np.pi, 2)],
        "dead_mm": [float(v) for v in rng.uniform(0.05, 0.3, 3) * np.abs(scene.reading).max()],
    }


def change_weather(scene, p):
    """The machine has lasers for scales, and the length of their waves goes with the weather in the hall: all axes
    grow and shrink together, in proportion to the way of the light from its source, dead path and all. The software
    knows pressure and damp from a small station, which it asks only every few minutes. Just after that all is right,
    then what the weather has done since adds up, this way or that, until it asks again and all leaps back. Amplitude
    of a wave of the weather at the end of the longest path."""

    def weather(t):
        return sum(a * np.sin(2 * np.pi * t / s + f) for a, s, f in zip((0.7, 1.0), p["periods_s"], p["phases"]))

    asked = p["first_s"] + p["every_s"] * np.floor((scene.time - p["first_s"]) / p["every_s"])
    path = np.abs(scene.reading) + np.asarray(p["dead_mm"])
    path *= np.array([scene.machine.direction[a] for a in "xyz"]) / path.max()
    return Change(tip=p["amplitude_um"] * path * (weather(scene.time) - weather(asked))[:, None])


def draw_magnetised(scene, rng):
    names = [str(f) for f in np.unique(scene.feature)]
    return {
        "amplitude_um": 1.0,
        "poles": {name: [float(v) for v in unit(rng)] for name in names},
        "strength": {name: float(rng.uniform(0.2, 1)) for name in names},
        "stiff": float(rng.uniform(0.03, 0.15)),
    }


def change_magnetised(scene, p):
    """The steel balls have been gripped on a magnetic chuck when they were ground, and nobody has demagnetised them.
    Each draws at the shank of the stylus, steel or the cobalt in hard metal, with the square of its field, that is
    four times as much over its poles as at its equator, and each has its poles elsewhere. The stylus bends towards
    the ball before it touches, most when it is long and comes from the side, and the touch is too early; straight
    along the stylus it cannot give way. Amplitude over the pole of the strongest ball, at the softest stylus."""
    poles = np.array([p["poles"][f] for f in scene.feature])
    strength = np.array([p["strength"][f] for f in scene.feature])
    pull = strength**2 * (1 + 3 * np.sum(poles * scene.part_normal, 1) ** 2) / 4
    bends = scene.length**3 / (scene.shaft**4 * scene.young)
    across = 1 - np.sum(scene.normal * scene.shank, 1) ** 2
    return Change(along=p["amplitude_um"] * pull * (across + p["stiff"]) * bends / bends.max())


def draw_chip(scene, rng):
    i = int(rng.integers(2))
    q = scene.reading[:, i]
    return {
        "amplitude_um": 1.0,
        "axis": "xy"[i],
        "chip_mm": float(q.min() + rng.uniform(0.35, 0.65) * np.ptp(q)),
        "half_mm": float(rng.uniform(0.3, 0.45) * np.ptp(q)),
        "pad_mm": float(rng.uniform(0.13, 0.22) * np.ptp(q)),
        "rolls": float(rng.uniform(-0.6, 0.6)),
    }


def change_chip(scene, p):
    """A chip has been rolled into one of the rails, and the carriage runs on two pads, one before and one behind.
    When the front pad climbs on the chip the carriage nods back, half the chip rises at its middle, and it rolls a
    little to the other rail; in between, with the chip under its belly, all is right; then the rear pad climbs on it,
    and the carriage nods forward. What is far below or above the rail goes to and fro the more. Amplitude is the
    height of the chip, as the long pads feel it."""
    i = "xy".index(p["axis"])
    away = scene.reading[:, i] - p["chip_mm"]
    front = np.exp(-(((away + p["half_mm"]) / p["pad_mm"]) ** 2))
    rear = np.exp(-(((away - p["half_mm"]) / p["pad_mm"]) ** 2))
    move, turn = np.zeros((scene.size, 3)), np.zeros((scene.size, 3))
    move[:, 2] = (front + rear) / 2
    nod = (front - rear) / (2 * p["half_mm"]) * 1e3
    turn[:, 1 - i] = nod if i == 1 else -nod
    turn[:, i] = p["rolls"] * (front + rear) / (2 * p["half_mm"]) * 1e3
    return Change(carriages={p["axis"]: (p["amplitude_um"] * move, p["amplitude_um"] * turn)})


def draw_collet(scene, rng):
    warm = scene.temperature["z"]
    return {
        "amplitude_um": 1.0,
        "opens_at_C": float(warm.min() + rng.uniform(0.1, 0.6) * np.ptp(warm)),
        "slit_deg": float(rng.uniform(0, 360)),
        "oval": float(rng.uniform(0.2, 0.8)),
    }


def change_collet(scene, p):
    """The styli are held in a collet of aluminium, which grows more than their shanks. In the cool it grips; above a
    certain temperature it opens, and lets the stylus nod in it, more with every kelvin, and more along its slit than
    across. A touch from the side must first push the tip to the end of this play before the probe feels anything, and
    is too deep, in proportion to the length of the stylus; one along the stylus is right, and so is all that was
    measured in the cool, the qualification as well. Amplitude for 1 K too warm, at the longest, along the slit."""
    play = np.maximum(scene.temperature["z"] - p["opens_at_C"], 0) * scene.length / max(s.length for s in scene.first_styli)
    n = np.einsum("nji,nj->ni", scene.head, scene.normal)[:, :2]
    slit = np.radians(p["slit_deg"])
    along, across = n @ np.array([np.cos(slit), np.sin(slit)]), n @ np.array([-np.sin(slit), np.cos(slit)])
    return Change(along=-p["amplitude_um"] * play * np.sqrt(along**2 + (p["oval"] * across) ** 2))


unknown("lost_signs", draw_signs, change_signs, ["position", "feature"])
unknown("late_handshake", draw_handshake, change_handshake, ["time", "sensor", "head"], "D")
unknown("borrowed_joystick", draw_joystick, change_joystick, ["time", "direction", "feature", "speed"])
unknown("soft_lacquer", draw_lacquer, change_lacquer, ["feature", "direction", "time"])
unknown("rare_weather", draw_weather, change_weather, ["time", "position"])
unknown("magnetised_balls", draw_magnetised, change_magnetised, ["feature", "direction", "sensor", "head"])
unknown("straddled_chip", draw_chip, change_chip, ["position", "feature"])
unknown("warm_collet", draw_collet, change_collet, ["temperature", "direction", "sensor", "head"], "D")
