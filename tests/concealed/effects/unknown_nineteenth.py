"""The strangers of the nineteenth final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np
from scene import BALL

from .base import Change, unit
from .unknown import unknown


def centres(scene):
    """Middle of the ball that is touched, in the part."""
    return scene.part_point - BALL * scene.part_normal


def half_size(scene):
    return float(np.abs(scene.part_point[:, :2]).max())


def draw_air(scene, rng):
    shares = rng.uniform(0.3, 1, 2) * rng.choice([-1.0, 1.0], 2)
    shares[rng.integers(2)] = 1.0
    return {
        "amplitude_um": 1.0,
        "shares": [float(v) for v in shares],
        "period_s": float(rng.uniform(130, 380)),
        "first_s": float(rng.uniform(0, 380)),
        "filling": float(rng.uniform(0.15, 0.35)),
        "held": float(rng.uniform(0.1, 0.3)),
    }


def change_air(scene, p):
    """The compressor is too small for the hall: the pressure falls slowly, and rises quickly when it starts. With
    little air the bearings of the two lower axes rub, and each carriage stays behind its scale, or goes ahead of it if
    the drive pulls on the other side, in the sense of its motion; with much air it is the other way round, as the
    controller takes off what there was on the day it was set. Amplitude to either side, along the axis that suffers
    most."""
    q = np.mod((scene.time - p["first_s"]) / p["period_s"], 1)
    fallen = np.where(q < 1 - p["filling"], q / (1 - p["filling"]), (1 - q) / p["filling"])
    sense = np.clip(scene.travel[:, :2] / p["held"], -1, 1) * p["shares"]
    return Change(tip=p["amplitude_um"] * (2 * fallen - 1)[:, None] * np.column_stack([sense, np.zeros(scene.size)]))


def draw_lorry(scene, rng):
    count = int(rng.integers(3, 6))
    arrives = ((np.arange(count) + rng.uniform(0.1, 0.4, count)) / count * scene.size).astype(int)
    leaves = np.minimum(arrives + (rng.uniform(0.3, 0.6, count) / count * scene.size).astype(int), scene.size - 1)
    return {
        "amplitude_um": float(rng.choice([-1.0, 1.0])),
        "arrives_s": [float(scene.time[k]) + 0.5 for k in arrives],
        "leaves_s": [float(scene.time[k]) + 0.5 for k in leaves],
        "load": [float(v) for v in rng.uniform(0.5, 1, count)],
        "table_mm": float(scene.target[:, 2].min() - rng.uniform(0.2, 0.6) * np.ptp(scene.target[:, 2])),
    }


def change_lorry(scene, p):
    """One foot of the machine stands on another slab of concrete than the others, and on the same slab is the ramp
    where the lorries are loaded. While a lorry stands there the slab goes down, and the table is twisted: the bridge
    rolls to one side at one end of its guide, to the other side at the other end, and stands as it should half way.
    When the machine was mapped the ramp was as busy as ever: the map has taken the mean. Amplitude at one end of the
    part, for the largest lever, between no lorry and a full one."""
    i = "xyz".index(scene.machine.chain[0])
    x = scene.target[:, i]
    twist = 2 * (x - (x.min() + x.max()) / 2) / np.ptp(x)
    lever = np.cross(np.eye(3)[i], scene.target - [scene.middle[0], scene.middle[1], p["table_mm"]])
    stands = np.zeros(scene.size)
    for since, until, load in zip(p["arrives_s"], p["leaves_s"], p["load"]):
        stands += load * ((scene.time >= since) & (scene.time < until))
    twisted = p["amplitude_um"] * (stands - stands.mean()) * twist
    return Change(tip=twisted[:, None] * lever / np.linalg.norm(lever, axis=1).max())


def draw_shells(scene, rng):
    names = [str(f) for f in np.unique(scene.feature)]
    return {
        "amplitude_um": 1.0,
        "axes": {f: unit(rng).tolist() for f in names},
        "soft": {f: [float(v) for v in rng.uniform(0.1, 1, 2)] for f in names},
        "belt_deg": float(rng.uniform(20, 35)),
    }


def change_shells(scene, p):
    """To save weight the balls are hollow: each is welded of two half shells of sheet metal, and sits on its post as it
    came. At the seam they are stiff, away from it a touch presses the sheet in a little, and it springs back; one half
    is thinner than the other, as the sheet was drawn. The tip radius has taken the mean. Amplitude at the pole of the
    softest shell."""
    known = np.array([f in p["axes"] for f in scene.feature])
    axes = np.array([p["axes"].get(f, (0.0, 0.0, 1.0)) for f in scene.feature])
    halves = np.array([p["soft"].get(f, (0.0, 0.0)) for f in scene.feature])
    height = np.sum(scene.part_normal * axes, 1)
    away = np.degrees(np.arcsin(np.clip(height, -1, 1))) / p["belt_deg"]
    yields = known * np.where(height > 0, halves[:, 0], halves[:, 1]) * (1 - np.exp(-0.5 * away**2))
    return Change(along=-p["amplitude_um"] * (yields - yields.mean()))


def draw_zone(scene, rng):
    turn = rng.uniform(0, 2 * np.pi)
    corner = np.array([np.cos(turn), np.sin(turn)])
    return {
        "amplitude_um": 1.0,
        "towards": [float(v) for v in corner],
        "begins_mm": float(np.quantile(scene.reading[:, :2] @ corner, rng.uniform(0.68, 0.8))),
    }


def change_zone(scene, p):
    """Behind a part of the table people pass by, and a scanner guards this side: where the carriage comes near to it
    the controller brakes every motion down to a crawl, and says nothing of it. The software goes on to take off the
    delay of the probe for the speed of the program, and there takes off too much, in proportion to this speed.
    Everywhere else it is right. Amplitude at 8 mm/s."""
    guarded = scene.reading[:, :2] @ np.asarray(p["towards"]) > p["begins_mm"]
    return Change(tip=-scene.travel * (p["amplitude_um"] * guarded * scene.speed / 8)[:, None])


def draw_lead(scene, rng):
    soft = {str(f): float(rng.uniform(0.3, 1)) for f in np.unique(scene.feature)}
    return {"amplitude_um": 1.0, "soft": soft, "kept": float(rng.uniform(0.86, 0.94))}


def change_lead(scene, p):
    """Somebody has made the posts of the balls of lead. Every touch from the side bends a post on a little in the
    direction of its push, and so it stays, until touches from the other side, of the same stylus or of the next one,
    bend it back bit by bit. Some posts are softer than others. Amplitude of the softest post, when it has always been
    pushed from the same side."""
    names, moved = np.array(scene.feature), np.zeros((scene.size, 3))
    push = -scene.part_normal * [1, 1, 0]
    for ball in np.unique(names):
        bent = np.zeros(3)
        for k in np.flatnonzero(names == ball):
            moved[k] = p["soft"].get(str(ball), 0.0) * bent
            bent = p["kept"] * bent + (1 - p["kept"]) * push[k]
    return Change(along=p["amplitude_um"] * np.sum(moved * scene.part_normal, 1))


def draw_rail(scene, rng):
    axis, spans = int(rng.integers(2)), int(rng.integers(4, 7))
    warm = scene.temperature["xyz"[axis]]
    sides = rng.choice([-1.0, 1.0], spans) * rng.uniform(0.4, 1, spans)
    return {
        "amplitude_um": 1.0,
        "axis": axis,
        "first_bolt_mm": float(scene.reading[:, axis].min() - 1),
        "last_bolt_mm": float(scene.reading[:, axis].max() + 1),
        "sides": [float(v) for v in sides],
        "tight_at_C": float(warm.min() + rng.uniform(0.1, 0.5) * np.ptp(warm)),
    }


def change_rail(scene, p):
    """A rail of steel is bolted to a beam that hardly grows with the temperature. In the cool it is straight and lies
    as it was mapped; but from the temperature on at which it has no room left it buckles between the bolts, each piece
    to the side that it likes and by its own amount, with the root of what is too much, and the carriage is led aside.
    Amplitude of the worst piece in its middle, 1 K later."""
    i, sides = p["axis"], np.asarray(p["sides"])
    place = (scene.reading[:, i] - p["first_bolt_mm"]) / (p["last_bolt_mm"] - p["first_bolt_mm"]) * len(sides)
    piece = np.clip(place.astype(int), 0, len(sides) - 1)
    aside = sides[piece] * np.sin(np.pi * np.clip(place - piece, 0, 1)) ** 2
    buckled = np.sqrt(np.clip(scene.temperature["xyz"[i]] - p["tight_at_C"], 0, None))
    return Change(tip=np.outer(p["amplitude_um"] * buckled * aside, np.eye(3)[1 - i]))


def draw_fold(scene, rng):
    turn = rng.uniform(0, 2 * np.pi)
    across = np.array([np.cos(turn), np.sin(turn), 0.0])
    angles = rng.normal(size=len(np.unique(scene.setup)))
    angles -= angles.mean()
    return {
        "amplitude_um": 1.0,
        "across": [float(v) for v in across],
        "hinge_mm": float(np.quantile(centres(scene) @ across, rng.uniform(0.4, 0.6))),
        "angles": [float(v) for v in angles / np.abs(angles).max()],
        "half_size_mm": half_size(scene),
    }


def change_fold(scene, p):
    """The part is a frame for travelling, which folds in the middle like a suitcase. Whenever it is placed it is
    unfolded, and the latch never snaps in quite the same: one half, with all of its balls, stands up a little against
    the other, or hangs. The certificate has the mean. Amplitude at half the size of the part from the hinge, in the
    worst placement."""
    across = np.asarray(p["across"])
    beyond = centres(scene) @ across > p["hinge_mm"]
    out, high = scene.part_point @ across - p["hinge_mm"], scene.part_point[:, 2]
    moved = (out * scene.part_normal[:, 2] - high * (scene.part_normal @ across)) / p["half_size_mm"]
    angle = np.asarray(p["angles"])[np.minimum(scene.setup, len(p["angles"])) - 1]
    return Change(along=p["amplitude_um"] * angle * beyond * moved)


def draw_unwinding(scene, rng):
    return {
        "amplitude_um": float(rng.choice([-1.0, 1.0])),
        "tau_s": float(rng.uniform(8, 20)),
        "elbow": float(rng.uniform(0.5, 1.2)),
    }


def change_unwinding(scene, p):
    """In the head a coupling of plastic lies between each motor and its axis. It winds up with every turn, the more the
    farther the head goes, and then lets the axis creep after until it has come to where the encoder of the motor has
    long been: the first touches after an indexing are off by the lever of the stylus, in the sense of the last turn,
    about the vertical and about the elbow, the later ones less and less. Amplitude for half a turn of a lying stylus,
    the longest, at the first touch."""
    _, first, index = np.unique(scene.visit, return_index=True, return_inverse=True)
    about_b = np.diff(scene.b[first], prepend=scene.b[first[0]])[index] / np.pi
    about_a = np.diff(scene.a[first], prepend=scene.a[first[0]])[index] / np.pi
    left = np.exp(-(scene.time - scene.time[first][index]) / p["tau_s"]) / scene.length.max()
    elbow = np.column_stack([np.sin(scene.b), -np.cos(scene.b), np.zeros(scene.size)])
    axis = np.outer(about_b, [0, 0, 1.0]) + p["elbow"] * about_a[:, None] * elbow
    return Change(tip=-p["amplitude_um"] * left[:, None] * np.cross(axis, scene.arm))


unknown("starved_bearings", draw_air, change_air, ["time", "direction"])
unknown("parked_lorry", draw_lorry, change_lorry, ["time", "position", "feature"])
unknown("hollow_balls", draw_shells, change_shells, ["feature", "direction"])
unknown("guarded_side", draw_zone, change_zone, ["position", "speed", "feature"])
unknown("leaden_posts", draw_lead, change_lead, ["feature", "time", "direction"])
unknown("buckled_rail", draw_rail, change_rail, ["temperature", "position", "feature", "setup"], "D")
unknown("folding_frame", draw_fold, change_fold, ["setup", "feature", "position"], "D")
unknown("unwinding_head", draw_unwinding, change_unwinding, ["head", "sensor", "time"], "D")
