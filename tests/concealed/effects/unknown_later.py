"""More effects that no catalogue names: the strangers of earlier final rounds, from the third to the sixth, which
everybody knows now. They register themselves with those of `unknown.py`."""

from portable import np
from scene import BALL

from .base import Change, unit, vector
from .probe import directions
from .unknown import unknown


def draw_leaves(scene, rng):
    soft = rng.choice(np.unique(scene.feature), 3, replace=False)
    return {"amplitude_um": 1.0, "soft_deg": {str(f): rng.uniform(0, 180) for f in soft}}


def change_leaves(scene, p):
    """Three balls stand on upright leaves, each turned its own way: a push along the soft side of a leaf bends it."""
    yielding = np.zeros(scene.size)
    for ball, deg in p["soft_deg"].items():
        push = scene.part_normal @ [np.cos(np.radians(deg)), np.sin(np.radians(deg)), 0]
        yielding += push**2 * [f == ball for f in scene.feature]
    return Change(along=-p["amplitude_um"] * yielding)


def draw_magnet(scene, rng):
    size, aside = np.ptp(scene.target, axis=0), rng.choice([-1.0, 1.0], 3) * rng.uniform(0.1, 0.35, 3)
    return {
        "amplitude_um": rng.choice([-1.0, 1.0]),
        "place_mm": scene.target.min(0) + (0.5 + aside) * size,
        "reach_mm": rng.uniform(0.18, 0.28) * float(size[:2].mean()),
    }


def change_magnet(scene, p):
    """A magnet of the fixture draws the steel stylus towards it, or pushes it off: most at some distance, nothing far
    away."""
    away = (scene.target - p["place_mm"]) / p["reach_mm"]
    return Change(tip=-p["amplitude_um"] * away * np.exp(0.5 - 0.5 * np.sum(away**2, 1))[:, None])


def draw_sunbeam(scene, rng):
    axis = int(rng.integers(2))
    return {
        "amplitude_um": 1.0,
        "axis": axis,
        "backwards": bool(rng.integers(2)),
        "width_mm": rng.uniform(0.15, 0.25) * float(np.ptp(scene.reading[:, axis])),
        "late": rng.uniform(-0.15, 0.15),
    }


def change_sunbeam(scene, p):
    """A beam of sunlight wanders along a guide in the course of the run: the guide bulges where it falls, and there
    the carriage is lifted."""
    x = scene.reading[:, p["axis"]]
    share = scene.time / scene.duration - p["late"]
    beam = x.min() + np.ptp(x) * (1 - share if p["backwards"] else share)
    return Change(tip=vector([0, 0, 1], p["amplitude_um"] * np.exp(-0.5 * ((x - beam) / p["width_mm"]) ** 2)))


def draw_overhang(scene, rng):
    return {"amplitude_um": 1.0, "qualified_at": rng.uniform(0.4, 0.6)}


def change_overhang(scene, p):
    """The weight of a lying stylus bends the ram to the other side, the more the further the ram is out. At the height
    of the reference sphere the qualification has taken it."""
    out = np.abs(scene.reading[:, 2])
    out = out / out.max()
    level = np.quantile(out, p["qualified_at"])
    side = scene.arm * [1, 1, 0] / scene.length.max()
    return Change(tip=-p["amplitude_um"] * side * (out**2 - level**2)[:, None])


def draw_bellows(scene, rng):
    axis = int(rng.integers(2))
    return {"amplitude_um": 1.0, "axis": axis, "end": rng.choice([-1.0, 1.0]), "direction": unit(rng)}


def change_bellows(scene, p):
    """The air in a bellows escapes too slowly when the machine is fast: it pushes the carriage away near the end where
    the bellows is folded."""
    x = scene.reading[:, p["axis"]]
    folded = np.exp(-3 * (0.5 - p["end"] * ((x - x.min()) / np.ptp(x) - 0.5)))
    return Change(tip=vector(p["direction"], p["amplitude_um"] * folded * (scene.speed / scene.speed.max()) ** 2))


def draw_glue(scene, rng):
    ball = str(rng.choice(np.unique(scene.feature)))
    used = scene.time[[f == ball for f in scene.feature]]
    return {
        "amplitude_um": 1.0,
        "ball": ball,
        "direction": unit(rng),
        "half_life_s": rng.uniform(0.15, 0.4) * float(np.ptp(used)),
        "knocked_s": float(np.quantile(used, rng.uniform(0.15, 0.6))) + 0.5,
    }


def change_glue(scene, p):
    """A ball is knocked aside in its soft glue and creeps back to its place."""
    here = np.array([f == p["ball"] for f in scene.feature])
    since = scene.time - p["knocked_s"]
    left = here * (since >= 0) * 0.5 ** (np.maximum(since, 0) / p["half_life_s"])
    return Change(along=p["amplitude_um"] * left * (scene.part_normal @ np.asarray(p["direction"])))


def draw_chains(scene, rng):
    turn = rng.uniform(0, 2 * np.pi)
    return {
        "amplitude_um": 1.0,
        "falling": rng.choice([-1.0, 1.0]),
        "aside": rng.choice([-1.0, 1.0]) * rng.uniform(0, 0.35),
        "width": rng.uniform(0.12, 0.2),
        "direction": [np.cos(turn), np.sin(turn), 0.0],
    }


def change_chains(scene, p):
    """The cable chains of two axes rub against each other where their loops meet, on a line across the table: there
    the carriage is pushed aside."""
    low, high = scene.reading.min(0), scene.reading.max(0)
    u, v, _ = ((scene.reading - (low + high) / 2) / (high - low)).T
    away = u - p["falling"] * v - p["aside"]
    return Change(tip=vector(p["direction"], p["amplitude_um"] * np.exp(-0.5 * (away / p["width"]) ** 2)))


def draw_worn(scene, rng):
    along, across = rng.permutation(2)
    x = scene.reading[:, along]
    return {
        "amplitude_um": 1.0,
        "guide": int(along),
        "across": int(across),
        "middle_mm": float(np.quantile(x, rng.uniform(0.2, 0.8))),
        "width_mm": rng.uniform(0.12, 0.2) * float(np.ptp(x)),
    }


def change_worn(scene, p):
    """Where a guide is worn the air gap is wide: the carriage yields to the probing force across the guide, on either
    side. The tip radius has taken the mean."""
    away = (scene.reading[:, p["guide"]] - p["middle_mm"]) / p["width_mm"]
    wide = np.exp(-0.5 * away**2)
    return Change(along=-p["amplitude_um"] * scene.normal[:, p["across"]] ** 2 * (wide - wide.mean()))


def draw_leaking(scene, rng):
    turn = rng.uniform(0, 2 * np.pi)
    return {
        "amplitude_um": 1.0,
        "direction": [np.cos(turn), np.sin(turn), 0.0],
        "pumped_s": np.quantile(scene.time, (np.arange(5) + rng.uniform(0.15, 0.85, 5)) / 5),
        "tau_s": rng.uniform(0.5, 1) * float(np.ptp(scene.time)) / 6,
    }


def change_leaking(scene, p):
    """An isolator under the machine leaks, and is pumped up when it has sunk too far: meanwhile the column leans, and
    the tip is off by its height. The calibration has taken the mean."""
    moments = np.concatenate([[0.0], p["pumped_s"]])
    since = scene.time - moments[np.searchsorted(moments, scene.time, side="right") - 1]
    sunk = 1 - np.exp(-since / p["tau_s"])
    height = (scene.reading[:, 2] - scene.reading[:, 2].mean()) / np.ptp(scene.reading[:, 2])
    return Change(tip=vector(p["direction"], p["amplitude_um"] * 2 * (sunk - sunk.mean()) * height))


def draw_posts(scene, rng):
    return {"amplitude_um": 1.0, "foot_mm": rng.uniform(5, 25), "power": rng.uniform(3, 4)}


def change_posts(scene, p):
    """The balls stand on thin posts: in a tilted placement these bend under the weight, the tall ones far more than
    the short."""
    height = (scene.part_point - BALL * scene.part_normal)[:, 2]
    height = height - height.min() + p["foot_mm"]
    down = -scene.turn[:, 2, :] * [1, 1, 0]
    return Change(
        along=p["amplitude_um"] * (height / height.max()) ** p["power"] * np.sum(scene.part_normal * down, 1) / 0.3
    )


def draw_bimetal(scene, rng):
    return {
        "amplitude_um": rng.choice([-1.0, 1.0]),
        "flat_at_C": float(np.mean(scene.temperature["part"]) + rng.uniform(-0.4, 0.4)),
        "half_size_mm": float(np.abs(scene.part_point[:, :2]).max()),
        "strip_deg": rng.uniform(0, 180),
    }


def change_bimetal(scene, p):
    """A strip of another metal is screwed under the plate: the plate is straight at one temperature, and bows along
    the strip above and below it, about the supports."""
    a = np.radians(p["strip_deg"])
    axis = np.array([np.cos(a), np.sin(a), 0])
    u, z = scene.part_point @ axis / p["half_size_mm"], scene.part_point[:, 2] / p["half_size_mm"]
    bow = scene.part_normal[:, 2] * (u**2 - np.mean(u**2)) - scene.part_normal @ axis * 2 * u * z
    return Change(along=p["amplitude_um"] * (scene.temperature["part"] - p["flat_at_C"]) * bow)


def draw_busy(scene, rng):
    return {"amplitude_um": 1.0, "tau_s": rng.uniform(250, 600)}


def change_busy(scene, p):
    """The motor of the head warms with every indexing and cools in the pauses: the joint grows towards the tip. The
    qualification was made at a mean heat."""
    turned = np.array([scene.time[scene.visit == v].min() for v in np.unique(scene.visit)])
    since = scene.time[:, None] - turned
    heat = np.sum(np.where(since >= 0, np.exp(-np.maximum(since, 0) / p["tau_s"]), 0), 1)
    return Change(tip=-scene.shank * (p["amplitude_um"] * (heat - heat.mean()) / np.ptp(heat))[:, None])


def draw_sagging(scene, rng):
    return {
        "amplitude_um": 1.0,
        "spans_mm": rng.uniform(0.6, 0.85, 2) * np.ptp(scene.reading[:, :2], axis=0),
        "first_mm": [float(rng.uniform(*np.quantile(scene.reading[:, i], [0.05, 0.95]))) for i in range(2)],
    }


def change_sagging(scene, p):
    """The table lies on a grid of posts and sags between them, and the carriage follows it: hills and hollows in
    both directions, as in an egg box."""
    waves = np.cos(2 * np.pi * (scene.reading[:, :2] - p["first_mm"]) / p["spans_mm"])
    return Change(tip=vector([0, 0, 1], p["amplitude_um"] * waves[:, 0] * waves[:, 1]))


def draw_ganged(scene, rng):
    return {"amplitude_um": rng.choice([-1.0, 1.0]), "right_at_mm_s": rng.uniform(4.4, 5.6)}


def change_ganged(scene, p):
    """Every axis drives at the full speed by itself, so that an approach between the axes is faster than the
    controller believes. The compensation of the delay is right on average, and at one speed in all directions."""
    faster = np.abs(scene.travel).sum(1)
    share = (scene.speed - p["right_at_mm_s"]) / 6
    return Change(along=-p["amplitude_um"] * share * (faster - faster.mean()) / faster.std())


def draw_sinking(scene, rng):
    return {"amplitude_um": 1.0, "towards": rng.uniform(0, 2 * np.pi), "tau_s": rng.uniform(120, 400)}


def change_sinking(scene, p):
    """The fixture stands on a post in its middle and on pads around it. One pad is soft: after every placement it
    sinks for some minutes, and the part tilts about the post. Amplitude at the pad."""
    out = np.array([np.cos(p["towards"]), np.sin(p["towards"]), 0])
    placed = np.array([scene.time[scene.setup == k].min() for k in scene.setup])
    sunk = p["amplitude_um"] * (1 - np.exp(-(scene.time - placed) / p["tau_s"]))
    away = scene.target - scene.target.mean(0)
    angle = np.outer(sunk / np.abs(away @ out).max(), np.cross(out, [0, 0, -1]))
    return Change(tip=np.cross(angle, away))


def draw_hose(scene, rng):
    low, high = np.quantile(scene.target[:, :2], [0.05, 0.95], axis=0)
    return {
        "amplitude_um": 1.0,
        "hung_at_mm": low + rng.uniform(0.3, 0.7, 2) * (high - low),
        "slack": rng.uniform(0.15, 0.35),
    }


def change_hose(scene, p):
    """A hose hangs from the ceiling to the head. Where it is taut it pulls the elbow of a lying stylus towards the
    place below its hook: the wrist turns by the lever."""
    pull = np.asarray(p["hung_at_mm"]) - (scene.target - scene.arm)[:, :2]
    far = np.linalg.norm(pull, axis=1)
    taut = np.clip(far / far.max() - p["slack"], 0, None) / np.maximum(far, 1e-9)
    torque = taut * (scene.shank[:, 1] * pull[:, 0] - scene.shank[:, 0] * pull[:, 1])
    return Change(tip=np.cross([0, 0, 1.0], scene.arm / scene.length.max()) * p["amplitude_um"] * torque[:, None])


def draw_pickup(scene, rng):
    count = int(rng.integers(3, 6))
    return {
        "amplitude_um": 1.0,
        "wiped_s": np.quantile(scene.time, (np.arange(count) + rng.uniform(0.2, 0.8, count)) / count),
    }


def change_pickup(scene, p):
    """A tip picks up metal from the part with every touch and grows, until it is wiped. The qualification has taken
    the mean."""
    layer, wiped = np.zeros(scene.size), np.searchsorted(p["wiped_s"], scene.time)
    for tip in np.unique(scene.length):
        mine = scene.length == tip
        for k in np.unique(wiped[mine]):
            here = mine & (wiped == k)
            layer[here] = np.arange(here.sum())
        layer[mine] -= layer[mine].mean()
    return Change(along=p["amplitude_um"] * layer / np.ptp(layer))


def draw_bar(scene, rng):
    angles = rng.normal(size=len(np.unique(scene.setup)))
    return {
        "amplitude_um": 1.0,
        "across": int(rng.integers(2)),
        "side": rng.choice([-1.0, 1.0]),
        "screw": rng.choice([-1.0, 1.0]) * rng.uniform(1.1, 1.6),
        "turned": (angles - angles.mean()) / angles.std(),
        "half_size_mm": float(np.abs(scene.part_point[:, :2]).max()),
    }


def change_bar(scene, p):
    """The balls of one side sit on a bar that a single screw holds at its end: whenever the part is placed anew, the
    bar is turned a little about the screw."""
    i, h = p["across"], p["half_size_mm"]
    on_bar = p["side"] * scene.part_point[:, i] > 0.5 * h
    lever = (scene.part_point[:, 1 - i] / h - p["screw"]) / (1 + abs(p["screw"]))
    turned = np.asarray(p["turned"])[np.unique(scene.setup, return_inverse=True)[1]]
    return Change(along=p["amplitude_um"] * on_bar * turned * lever * scene.part_normal[:, i])


def draw_refitted(scene, rng):
    return {"amplitude_um": 1.0, "turned": unit(rng), "placement": int(rng.choice(np.unique(scene.setup)[1:]))}


def change_refitted(scene, p):
    """Before one placement the head is taken off and put on again, a little turned on its mount, and nobody qualifies
    the styli: each tip is off by its lever, until the head is put right. Amplitude at the longest lever."""
    lever = scene.tip / np.linalg.norm(scene.tip, axis=1).max()
    moved = np.cross(p["turned"], lever) * (scene.setup == p["placement"])[:, None]
    return Change(tip=p["amplitude_um"] * moved)


def draw_dust(scene, rng):
    turn, lean = rng.uniform(0, 2 * np.pi), np.radians(rng.uniform(20, 40))
    return {
        "amplitude_um": 1.0,
        "towards": [np.sin(lean) * np.cos(turn), np.sin(lean) * np.sin(turn), np.cos(lean)],
        "width_deg": rng.uniform(18, 28),
    }


def change_dust(scene, p):
    """Dust of a grinding machine settles on the balls where they are flat, a little to the side it comes from. The
    layer grows until the part is placed anew and wiped. Amplitude in the longest placement."""
    placed = np.array([scene.time[scene.setup == k].min() for k in scene.setup])
    layer = (scene.time - placed) / np.max(scene.time - placed)
    angle = np.degrees(np.arccos(np.clip(scene.normal @ np.asarray(p["towards"]), -1, 1)))
    return Change(along=p["amplitude_um"] * layer * np.exp(-0.5 * (angle / p["width_deg"]) ** 2))


def draw_grease(scene, rng):
    air = scene.temperature["air"]
    return {"amplitude_um": 1.0, "qualified_at_C": float((air.min() + air.max()) / 2 + rng.uniform(-0.4, 0.4))}


def change_grease(scene, p):
    """The grease of the probe's seats is stiff in the cold: it takes a larger moment to tip them than when the styli
    were qualified, and a stylus touched from the side bends more, by the square of its length. The warm probe is the
    other way round."""
    _, beta = directions(scene)
    bent = np.cos(beta) ** 2 * (scene.length / scene.length.max()) ** 2
    return Change(along=p["amplitude_um"] * (scene.temperature["air"] - p["qualified_at_C"]) * bent)


def draw_leg(scene, rng):
    along = "xyz".index(scene.machine.chain[0])
    return {
        "amplitude_um": 1.0,
        "along": along,
        "driven_end": rng.choice([-1.0, 1.0]),
        "freed_after_mm": rng.uniform(0.1, 0.2) * float(np.ptp(scene.reading[:, along])),
    }


def change_leg(scene, p):
    """The bridge is driven at one leg; the other one drags and stays behind in the sense of the last long way. A short
    approach does not free it. Amplitude at the far leg."""
    i, held = p["along"], p["freed_after_mm"]
    state, behind = scene.start[0, i], np.empty(scene.size)
    for k, way in enumerate(np.column_stack([scene.start[:, i], scene.reading[:, i]])):
        for x in way:
            state = min(max(state, x - held), x + held)
        behind[k] = (way[1] - state) / held
    x = scene.target[:, 1 - i]
    far = 0.5 - p["driven_end"] * (x - (x.min() + x.max()) / 2) / np.ptp(x)
    return Change(tip=vector(np.eye(3)[i], p["amplitude_um"] * behind * far))


def draw_battery(scene, rng):
    return {
        "amplitude_um": 1.0,
        "low_s": float(np.quantile(scene.time, rng.uniform(0.3, 0.5))),
        "changed_s": float(np.quantile(scene.time, rng.uniform(0.75, 0.95))) + 0.5,
    }


def change_battery(scene, p):
    """The battery of a radio probe runs low: its message must be repeated more and more often, and the machine goes on
    meanwhile. Then the battery is changed. Amplitude at 8 mm/s."""
    low = np.clip((scene.time - p["low_s"]) / (p["changed_s"] - p["low_s"]), 0, 1) * (scene.time < p["changed_s"])
    return Change(tip=scene.travel * (p["amplitude_um"] * low * scene.speed / 8)[:, None])


def draw_certificate(scene, rng):
    excess = rng.normal(size=(3, 3, 3)) * [1, 1, 0.5]
    swapped = excess - excess.transpose(1, 0, 2)
    return {"amplitude_um": 1.0, "excess": (swapped / np.sqrt(np.mean(swapped**2))).reshape(9, 3)}


def change_certificate(scene, p):
    """The certificate counts the balls by columns, the operator types its deviations in by rows: balls on both sides of
    the diagonal have each other's deviations, and are off by opposite amounts, in height by less."""
    ball = [int(f.removeprefix("BALL")) - 1 for f in scene.feature]
    return Change(along=p["amplitude_um"] * np.sum(np.asarray(p["excess"])[ball] * scene.part_normal, 1))


unknown("leaves", draw_leaves, change_leaves, ["feature", "direction", "position"])
unknown("magnet", draw_magnet, change_magnet, ["position", "feature"])
unknown("sunbeam", draw_sunbeam, change_sunbeam, ["time", "position"])
unknown("overhang", draw_overhang, change_overhang, ["head", "sensor", "position", "feature"], "D")
unknown("bellows", draw_bellows, change_bellows, ["speed", "position", "feature"], "D")
unknown("glue", draw_glue, change_glue, ["feature", "time", "position"])
unknown("chains", draw_chains, change_chains, ["position", "feature"])
unknown("worn_guide", draw_worn, change_worn, ["position", "direction", "feature"])
unknown("leaking_isolator", draw_leaking, change_leaking, ["time", "position", "head", "sensor"])
unknown("leaning_posts", draw_posts, change_posts, ["feature", "position", "setup"], "D")
unknown("bimetal", draw_bimetal, change_bimetal, ["temperature", "feature", "position"], "D")
unknown("busy_motor", draw_busy, change_busy, ["time", "head", "sensor"], "D")
unknown("sagging_table", draw_sagging, change_sagging, ["position", "feature"])
unknown("ganged_axes", draw_ganged, change_ganged, ["speed", "direction"], "D")
unknown("sinking_pad", draw_sinking, change_sinking, ["time", "setup", "position", "feature"], "D")
unknown("hanging_hose", draw_hose, change_hose, ["head", "sensor", "position", "feature"], "D")
unknown("metal_pickup", draw_pickup, change_pickup, ["time", "sensor"])
unknown("loose_bar", draw_bar, change_bar, ["feature", "setup", "position"], "D")
unknown("refitted_head", draw_refitted, change_refitted, ["setup", "head", "sensor", "time"], "D")
unknown("falling_dust", draw_dust, change_dust, ["direction", "time"], "D")
unknown("cold_grease", draw_grease, change_grease, ["temperature", "direction", "sensor"], "D")
unknown("dragging_leg", draw_leg, change_leg, ["position", "feature"])
unknown("weak_battery", draw_battery, change_battery, ["speed", "time"], "D")
unknown("swapped_certificate", draw_certificate, change_certificate, ["feature", "position"])
