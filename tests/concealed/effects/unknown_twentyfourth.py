"""The strangers of the twenty-fourth final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np
from scene import BALL

from .base import Change
from .unknown import unknown


def centres(scene):
    """Middle of the ball that is touched, in the part."""
    return scene.part_point - BALL * scene.part_normal


def draw_arm(scene, rng):
    q = scene.reading[:, "xyz".index(scene.machine.chain[0])]
    goes, places, now = [], [], float(-rng.uniform(0, 100))
    while now < scene.duration:
        goes.append(now)
        places.append(float(q.min() + rng.uniform(-0.3, 1.3) * np.ptp(q)))
        now += float(rng.uniform(60, 260))
    return {
        "amplitude_um": 1.0,
        "goes_s": goes,
        "places_mm": places,
        "drives_s": float(rng.uniform(6, 15)),
        "wide_mm": float(rng.uniform(0.25, 0.5) * np.ptp(q)),
        "rail_mm": float(scene.target[:, 2].min() - rng.uniform(0.2, 1.0) * np.ptp(scene.target[:, 2])),
    }


def change_arm(scene, p):
    """The machine has a second arm on the same rail, with a program of its own for another part: it goes to a place,
    works there for some minutes, and goes on to the next. Wherever it stands the rail sinks under its weight, in a
    hollow. When ours is near it goes down with it, and leans over into the hollow, to one side or to the other, the
    more the higher; when both work far from each other, all is right. Amplitude at the bottom of the hollow."""
    i = "xyz".index(scene.machine.chain[0])
    goes, places = np.asarray(p["goes_s"]), np.asarray(p["places_mm"])
    k = np.searchsorted(goes, scene.time, side="right") - 1
    before = places[np.maximum(k - 1, 0)]
    arrived = np.minimum((scene.time - goes[k]) / p["drives_s"], 1)
    away = (scene.reading[:, i] - before - (places[k] - before) * arrived) / p["wide_mm"]
    hollow = np.exp(-(away**2))
    moved = np.zeros((scene.size, 3))
    moved[:, 2] = -hollow
    moved[:, i] = -2 * away * hollow * (scene.target[:, 2] - p["rail_mm"]) / p["wide_mm"]
    return Change(tip=p["amplitude_um"] * moved)


def draw_ridge(scene, rng):
    i = int(rng.integers(2))
    q = scene.reading[:, i]
    side = rng.uniform(0, 2 * np.pi)
    return {
        "amplitude_um": 1.0,
        "axis": "xy"[i],
        "low_mm": float(q.min() + rng.uniform(0.1, 0.4) * np.ptp(q)),
        "high_mm": float(q.max() - rng.uniform(0.1, 0.4) * np.ptp(q)),
        "heaps_mm": float(rng.uniform(0.15, 0.4) * np.ptp(q)),
        "wide_mm": float(rng.uniform(0.06, 0.14) * np.ptp(q)),
        "lifts": [float(0.6 * np.cos(side)), float(0.6 * np.sin(side))],
    }


def change_ridge(scene, p):
    """Nobody has wiped the guide for weeks. The pads of the carriage plough the dirt before them to where they turn
    round, and there it lies as a ridge, one at either end of what has been used today. Near a ridge the carriage is
    lifted, and pushed aside; where it has to go farther than ever before it takes the ridge with it, which grows as
    it does so. Between the ridges all is clean and right, also where one has been before. Amplitude is the lift on a
    ridge that has grown as high as it can."""
    q = scene.reading[:, "xyz".index(p["axis"])]
    low, high, pushed, lift = p["low_mm"], p["high_mm"], [0.3, 0.3], np.zeros((scene.size, 2))
    for k in range(scene.size):
        pushed[0] += max(low - q[k], 0.0) / p["heaps_mm"]
        pushed[1] += max(q[k] - high, 0.0) / p["heaps_mm"]
        low, high = min(low, q[k]), max(high, q[k])
        away = np.array([q[k] - low, high - q[k]]) / p["wide_mm"]
        lift[k] = (1 - np.exp(-np.array(pushed))) * np.exp(-(away**2))
    moved = np.column_stack([(lift[:, :1] - lift[:, 1:]) * np.asarray(p["lifts"]), lift.sum(1)])
    return Change(tip=p["amplitude_um"] * moved)


def draw_plated(scene, rng):
    return {
        "amplitude_um": 1.0,
        "up": float(rng.uniform(0.1, 0.6)),
        "throws": float(rng.uniform(1.0, 2.5)),
        "inside": float(rng.uniform(0.05, 0.4)),
    }


def change_plated(scene, p):
    """The part has been chromed after it had got its certificate, balls and all, in a bath with the anodes round about.
    The current prefers what stands out: the outer balls have got more than the inner ones, which stood in their
    shade, and each of them most on the side that looks outwards and up, next to nothing on the side that looks in.
    Amplitude is the thickest place of the outermost ball."""
    middle = np.mean([centres(scene).min(0), centres(scene).max(0)], axis=0)
    out = centres(scene) - middle
    out[:, 2] = 0
    far = np.linalg.norm(out, axis=1)
    anode = out / far.max() + np.array([0, 0, p["up"]])
    anode /= np.linalg.norm(anode, axis=1, keepdims=True)
    faces = ((1 + np.sum(anode * scene.part_normal, 1)) / 2) ** p["throws"]
    return Change(along=p["amplitude_um"] * faces * (p["inside"] + (1 - p["inside"]) * (far / far.max()) ** 2))


def draw_polar(scene, rng):
    size = float(np.abs(scene.part_point[:, :2]).max())
    return {
        "amplitude_um": 1.0,
        "pole_mm": [float(v) for v in rng.uniform(-0.5, 0.5, 2) * size],
        "unit_rad": float(rng.uniform(0.8, 1.2) * 1e-4),
        "from_rad": float(rng.uniform(0, 2 * np.pi)),
    }


def change_polar(scene, p):
    """The certificate has been printed in polar coordinates, about a bore of the part: the radius with all digits, as
    it is a length, but the angle rounded as angles are on drawings. The operator has typed in what he read. Each ball
    is off across its ray, to one side or to the other as the rounding fell, and may be so by the more the farther it
    is from the bore; along the ray and in height it is right. Amplitude of half a unit at the farthest ball."""
    ray = centres(scene)[:, :2] - np.asarray(p["pole_mm"])
    far = np.linalg.norm(ray, axis=1)
    angle = np.mod(np.arctan2(ray[:, 1], ray[:, 0]) - p["from_rad"], 2 * np.pi) / p["unit_rad"]
    lost = 2 * (angle - np.round(angle)) * far / far.max()
    across = (ray[:, 0] * scene.part_normal[:, 1] - ray[:, 1] * scene.part_normal[:, 0]) / far
    return Change(along=p["amplitude_um"] * lost * across)


def draw_cracked(scene, rng):
    out = np.abs(scene.reading[:, 2])
    towards = rng.uniform(0, 2 * np.pi)
    return {
        "amplitude_um": 1.0,
        "towards": [float(np.cos(towards)), float(np.sin(towards)), 0.0],
        "guided_mm": float(out.min() - rng.uniform(0.1, 0.4) * np.ptp(out)),
        "fully_mm": float(out.max() + rng.uniform(-0.2, 0.3) * np.ptp(out)),
        "above_mm": float(rng.uniform(50, 250)),
    }


def change_cracked(scene, p):
    """The ram is glued of plates of ceramic, and above its flange the glue has cracked on one face. A touch that pushes
    the tip away from this face shuts the crack, and nothing yields; one that pushes the other way opens it, and the
    ram gives way until the probe has triggered, with the square of the lever that the touch has about the face. As
    long as the ram is drawn in, its bearings hold it together; the farther it is out, the more it is left to
    itself. Amplitude at the longest lever, with the ram out."""
    free = (np.abs(scene.reading[:, 2]) - p["guided_mm"]) / (p["fully_mm"] - p["guided_mm"])
    hinge = np.cross(np.asarray(p["towards"]), [0, 0, 1.0])
    lever = scene.tip - np.array([0, 0, p["above_mm"]])
    opens = np.maximum(np.cross(lever, scene.normal) @ hinge, 0) / np.linalg.norm(lever, axis=1).max()
    return Change(along=-p["amplitude_um"] * np.clip(free, 0, 1) * opens**2)


def draw_remembering(scene, rng):
    return {
        "amplitude_um": 1.0,
        "creeps_s": float(rng.uniform(60, 300)),
        "power": float(rng.uniform(2.0, 3.0)),
    }


def change_remembering(scene, p):
    """Between head and stylus is a bar of cheap plastic, which creeps. Lying, it goes on sinking for minutes after it
    has sprung down at once; and when the head is turned it is still bent to where it was down before, which may now be
    a side or up, and forgets it as slowly. The styli were qualified at their leisure, with the bar at rest in
    each orientation. Another bar that is fetched from the rack has stood upright, and is straight. Amplitude is the
    whole creep of the longest bar, when it lies."""
    down = -scene.head[:, 2, :] * np.array([1.0, 1.0, 0.0])
    bent, moved, bar = np.zeros(3), np.zeros((scene.size, 3)), None
    for k in range(scene.size):
        if scene.length[k] != bar:
            bent, bar = np.zeros(3), scene.length[k]
        since = scene.time[k] - scene.time[k - 1] if k else 20.0
        bent = down[k] + (bent - down[k]) * np.exp(-since / p["creeps_s"])
        moved[k] = scene.head[k] @ (bent - down[k])
    longest = max(s.length for s in scene.first_styli)
    return Change(tip=-p["amplitude_um"] * moved * ((scene.length / longest) ** p["power"])[:, None])


def draw_coolant(scene, rng):
    names = [str(f) for f in np.unique(scene.feature)]
    wet = rng.permutation(len(names))[: int(rng.integers(len(names) // 2, len(names) + 1))]
    return {
        "amplitude_um": 1.0,
        "wet": {names[k]: float(rng.uniform(0.4, 1)) for k in sorted(wet)},
        "above": float(rng.uniform(0.1, 0.4)),
    }


def change_coolant(scene, p):
    """The part comes straight from the grinding machine, and its balls drip with coolant as thick as syrup. Before tip
    and ball meet the coolant between them must be squeezed out, and it resists, with the speed and with the square
    of the radius that the gap has: the probe triggers on the liquid alone, early, a fast large tip more than a slow
    small one. At the underside of a ball, wherever this is as the part lies now, the coolant hangs thick, from above
    it has drained away; some balls are wetter than others. Amplitude at 8 mm/s from below on the wettest ball, for
    the largest tip."""
    wet = np.array([p["wet"].get(f, 0.0) for f in scene.feature])
    gap = 1 / (1 / scene.tip_radius + 1 / BALL)
    hangs = p["above"] + (1 - p["above"]) * (1 - scene.normal[:, 2]) / 2
    return Change(along=p["amplitude_um"] * wet * hangs * scene.speed / 8 * (gap / gap.max()) ** 2)


def draw_clamps(scene, rng):
    i = int(rng.integers(3))
    q = scene.reading[:, i]
    holds = float(rng.uniform(0.4, 1.6))
    return {
        "amplitude_um": 1.0,
        "axis": "xyz"[i],
        "holds_K": holds,
        "first_K": float(rng.uniform(-1, 1) * holds),
        "fixed_mm": float(q.min() + rng.uniform(0, 1) * np.ptp(q)),
    }


def change_clamps(scene, p):
    """A scale is screwed down at one place, and should slide in all its other clamps, which somebody has tightened too
    much. When it becomes warmer the clamps hold the scale to its short length, up to what friction can bear, and
    then it slips after; when it becomes cooler again they hold it too long, and it slips only when friction is
    overcome the other way. What the software takes off is the expansion of a free scale: what is left hangs on the way
    that the temperature has come. Amplitude for 1 K held back, at the end that is farther from the screw."""
    warm, away = scene.temperature[p["axis"]], scene.reading[:, "xyz".index(p["axis"])] - p["fixed_mm"]
    held, state = np.zeros(scene.size), p["first_K"]
    for k in range(scene.size):
        state += warm[k] - warm[k - 1] if k else 0.0
        state = min(max(state, -p["holds_K"]), p["holds_K"])
        held[k] = state
    moved = np.zeros((scene.size, 3))
    moved[:, "xyz".index(p["axis"])] = -held * away / np.abs(away).max()
    return Change(tip=p["amplitude_um"] * moved)


unknown("second_arm", draw_arm, change_arm, ["time", "position"])
unknown("ploughed_ridge", draw_ridge, change_ridge, ["position", "time", "feature"])
unknown("plated_balls", draw_plated, change_plated, ["feature", "direction", "position"])
unknown("polar_certificate", draw_polar, change_polar, ["feature", "position"])
unknown("cracked_ram", draw_cracked, change_cracked, ["direction", "position", "head", "sensor"])
unknown("remembering_bar", draw_remembering, change_remembering, ["head", "time", "sensor"], "D")
unknown("squeezed_coolant", draw_coolant, change_coolant, ["speed", "feature", "direction", "sensor"], "D")
unknown("sticking_clamps", draw_clamps, change_clamps, ["temperature", "time", "position"], "D")
