"""Unknown effects of the final round only: none of them resembles those of the development."""

from portable import np
from scene import BALL

from .base import Change, Effect
from .probe import directions

UNKNOWN = {}


def unknown(name, draw, change, factors, designs="CD"):
    UNKNOWN[name] = Effect(name, draw, change, ("amplitude_um",), 20.0, tuple(factors), designs=designs)


def centres(scene):
    """Middle of the ball that is touched, in the part."""
    return scene.part_point - BALL * scene.part_normal


def pauses(scene, first=20.0):
    """Seconds from the touch before, or from the start."""
    return np.diff(scene.time, prepend=scene.time[0] - first)


def draw_wax(scene, rng):
    names = [str(f) for f in np.unique(scene.feature)]
    return {
        "amplitude_um": 1.0,
        "waxy": [names[k] for k in sorted(rng.permutation(len(names))[: int(rng.integers(1, 3))])],
        "wide": float(rng.uniform(0.5, 0.9)),
        "keeps": float(rng.uniform(0.75, 0.92)),
    }


def change_wax(scene, p):
    """One or two balls were marked with a wax pencil, as the shop knows its parts by it. Who touches there touches
    the wax, and takes a crumb of it away on that side of the tip; at the next balls the same side of the tip brings the
    crumb between, which is squeezed thinner by every touch on it, until the tip comes by the wax again. The other
    module has another tip, with crumbs of its own, that wait on it in the rack. Amplitude is a fresh crumb."""
    push = -np.einsum("nji,nj->ni", scene.head, scene.normal)
    thick = np.zeros(scene.size)
    crumbs = {length: (np.zeros((0, 3)), np.zeros(0)) for length in np.unique(scene.length)}
    for k in range(scene.size):
        places, left = crumbs[scene.length[k]]
        near = np.exp(-np.sum((places - push[k]) ** 2, 1) / p["wide"] ** 2)
        if scene.feature[k] in p["waxy"]:
            thick[k] = 1.0
            places, left = np.vstack([places, push[k]]), np.append(left, 1.0)
        else:
            thick[k] = np.max(left * near, initial=0.0)
            left = left * (1 - (1 - p["keeps"]) * near)
        crumbs[scene.length[k]] = places, left
    return Change(along=p["amplitude_um"] * thick)


def draw_exhaust(scene, rng):
    out = np.abs(scene.reading[:, 2])
    return {
        "amplitude_um": 1.0,
        "in_mm": float(out.min()),
        "reach_mm": float(rng.uniform(0.8, 1.5) * np.ptp(out)),
        "tau_s": float(rng.uniform(30, 150)),
    }


def change_exhaust(scene, p):
    """The bearings of the ram blow their used air downwards, and it is cold, as it has just expanded. When the ram is
    drawn in the stylus stands in this breath, cools and shrinks towards the head; when the ram goes down the stylus
    gets out of it, and becomes as warm as the hall again, both in a minute or two. A module comes warm from the rack.
    Amplitude for the longest stylus, when it has been in the breath for long."""
    breath = np.clip(1 - (np.abs(scene.reading[:, 2]) - p["in_mm"]) / p["reach_mm"], 0, 1)
    follows = 1 - np.exp(-pauses(scene) / p["tau_s"])
    cold, state = np.zeros(scene.size), 0.0
    for k in range(scene.size):
        if k and scene.length[k] != scene.length[k - 1]:
            state = 0.0
        state += (breath[k] - state) * follows[k]
        cold[k] = state
    longest = max(s.length for s in scene.first_styli)
    return Change(tip=-p["amplitude_um"] * scene.shank * (cold * scene.length / longest)[:, None])


def draw_tensors(scene, rng):
    order = [int(k) for k in rng.permutation(len(scene.styli))]
    takes = [0] * len(order)
    for k, other in zip(order, order[1:] + order[:1]):
        takes[k] = other
    return {"amplitude_um": 1.0, "takes": takes}


def change_tensors(scene, p):
    """A measuring probe bends its stylus, and the software takes this off with a matrix which the qualification has
    found for each stylus: much across the shank, nothing along it. After the list of styli has been sorted anew the
    names go with the tips, but the matrices have stayed in the old order, and each stylus gets that of another one: it
    is corrected for a shank of another length that points another way. Tip and radius are right. Amplitude is the
    bending of the most slender stylus from the side."""
    slender = scene.length**3 / scene.shaft**4
    slender = slender / slender.max()
    own = slender * (1 - np.sum(scene.normal * scene.shank, 1) ** 2)
    first = np.array([np.argmax(scene.sensor == k) for k in p["takes"]])[scene.sensor]
    other = slender[first] * (1 - np.sum(scene.normal * scene.shank[first], 1) ** 2)
    return Change(along=p["amplitude_um"] * (other - own))


def draw_string(scene, rng):
    names = [str(f) for f in np.unique(scene.feature)]
    loop = [names[k] for k in rng.permutation(len(names))[: int(rng.integers(5, len(names) + 1))]]
    return {
        "amplitude_um": 1.0,
        "loop": loop,
        "soft": [float(v) for v in rng.uniform(0.3, 1, len(loop))],
        "cut_s": float(np.quantile(scene.time, rng.uniform(0.35, 0.75))) + 0.5,
        "gives": float(rng.uniform(0.1, 0.4)),
    }


def change_string(scene, p):
    """For the transport a string was wound from post to post, criss-cross, to hold the padding, and when the padding
    was taken off the string stayed. It draws each post towards the two to which it goes on from there, little where
    it comes and goes straight, much where it turns back; it gives way slowly, as strings do, and half way through the
    run somebody sees it and cuts it, and all posts stand as they should. Amplitude of the softest post, where the
    string would turn right back."""
    where = {f: c for f, c in zip(scene.feature, centres(scene))}
    drawn = {f: np.zeros(3) for f in where}
    for k, f in enumerate(p["loop"]):
        for g in (p["loop"][k - 1], p["loop"][(k + 1) % len(p["loop"])]):
            way = (where[g] - where[f]) * np.array([1.0, 1.0, 0.0])
            drawn[f] = drawn[f] + p["soft"][k] / 2 * way / np.linalg.norm(way)
    taut = (1 - p["gives"] * np.log1p(scene.time / 60) / np.log1p(p["cut_s"] / 60)) * (scene.time < p["cut_s"])
    moved = np.array([drawn[f] for f in scene.feature])
    return Change(along=p["amplitude_um"] * taut * np.sum(moved * scene.part_normal, 1))


def draw_feet(scene, rng):
    half = np.abs(scene.part_point[:, :2]).max()
    angle = rng.uniform(0, 2 * np.pi) + 2 * np.pi / 3 * np.arange(3) + rng.uniform(-0.3, 0.3, 3)
    far = half * rng.uniform(0.6, 1.0, 3)
    return {
        "amplitude_um": 1.0,
        "feet_mm": [[float(f * np.cos(v)), float(f * np.sin(v))] for f, v in zip(far, angle)],
        "gives": [float(v) for v in rng.uniform(0.5, 1, 3)],
        "ahead_mm": float(rng.uniform(-0.4, 0.4) * half),
        "wide_mm": float(rng.uniform(0.3, 0.6) * half),
    }


def change_feet(scene, p):
    """The guide of the first axis is a stout rail of its own that does not bend, but the plate in the floor under it
    also carries the part, on three feet. Where the carriage stands now the plate sinks under its weight: a foot that
    is just abreast of it goes down, the two others stay, and the part leans over to this foot, as one rigid body, then
    to the next one as the carriage goes on. Which foot comes when, hangs on how the part lies. Amplitude of the
    softest foot, with the carriage abreast."""
    i = "xyz".index(scene.machine.chain[0])
    place = scene.target - scene.tip_radius[:, None] * scene.normal
    place = place - np.einsum("nij,nj->ni", scene.turn, scene.part_point)
    carriage = scene.target[:, i] - scene.tip[:, i] + p["ahead_mm"]
    feet = np.asarray(p["feet_mm"])
    abreast = scene.turn[:, i, :2] @ feet.T + place[:, i : i + 1]
    sinks = np.asarray(p["gives"]) * np.exp(-(((carriage[:, None] - abreast) / p["wide_mm"]) ** 2))
    height, to_x, to_y = np.linalg.inv(np.column_stack([np.ones(3), feet])) @ sinks.T
    x, y, z = scene.part_point.T
    down = np.column_stack([-to_x * z, -to_y * z, height + to_x * x + to_y * y])
    return Change(along=-p["amplitude_um"] * np.sum(down * scene.part_normal, 1))


def draw_soot(scene, rng):
    return {
        "amplitude_um": 1.0,
        "phase": float(rng.uniform(0, 2 * np.pi / 3)),
        "burns": [float(v) for v in rng.uniform(0.15, 0.6, 3)],
        "straight": float(rng.uniform(0.6, 0.75)),
        "scrubs": float(rng.uniform(0.3, 0.7)),
    }


def change_soot(scene, p):
    """The spark suppressor of the probe is broken. Whenever a touch from the side lifts one of the three
    pairs of contacts a spark leaves soot on it, a slow touch more than a fast one; a sooty pair has a bad contact even
    while it is shut, and lets go at the first breath: the touches that lift it come early, the more the longer the
    stylus. A touch nearly along the stylus lifts all three at once, and when they fall home they scrub each other
    clean, or nearly. Amplitude for a pair full of soot, at the longest stylus from the side."""
    phi, beta = directions(scene)
    lifts = np.maximum(np.cos(phi[:, None] - p["phase"] - 2 * np.pi / 3 * np.arange(3)), 0) * np.cos(beta)[:, None]
    soot, early = np.zeros(3), np.zeros(scene.size)
    for k in range(scene.size):
        early[k] = np.max(soot * lifts[k])
        if np.sin(beta[k]) > p["straight"]:
            soot = soot * (1 - p["scrubs"])
        else:
            spark = np.asarray(p["burns"]) * lifts[k] * 5 / scene.speed[k]
            soot = soot + (1 - soot) * (1 - np.exp(-spark))
    longest = max(s.length for s in scene.first_styli)
    return Change(along=p["amplitude_um"] * early * scene.length / longest)


def draw_liquid(scene, rng):
    side = rng.uniform(0, 2 * np.pi)
    start = rng.uniform(0, 2 * np.pi)
    return {
        "amplitude_um": 1.0,
        "floor": [float(0.02 * np.cos(side)), float(0.02 * np.sin(side))],
        "starts": [float(0.9 * np.cos(start)), float(0.9 * np.sin(start))],
        "tau_s": float(rng.uniform(150, 700)),
    }


def change_liquid(scene, p):
    """The frame of the part is welded of tubes, and the water from the pressure test has never been let out. It runs to
    where the part is lowest, and as the floor of the hall has a slope for the drain it does so even when the part lies
    flat; but the holes from tube to tube are narrow, and it takes its time: after the part has been placed the water
    still stands where it was lowest before. The end with the water sags under the weight, with the square of its way
    from the middle. Amplitude at the corner of the part, with all the water there."""
    fall = np.tile([*p["floor"], -1.0], (scene.size, 1))
    low = np.einsum("nji,nj->ni", scene.turn, fall)[:, :2]
    low /= np.linalg.norm(low, axis=1, keepdims=True) + 0.005
    since = pauses(scene)
    since = np.where(np.diff(scene.setup, prepend=scene.setup[0]) != 0, 30.0, since)
    water, state = np.zeros((scene.size, 2)), np.asarray(p["starts"])
    for k in range(scene.size):
        state = low[k] + (state - low[k]) * np.exp(-since[k] / p["tau_s"])
        water[k] = state
    half = np.linalg.norm(scene.part_point[:, :2], axis=1).max()
    sags = np.maximum(np.sum(water * scene.part_point[:, :2], 1) / half, 0) ** 2
    return Change(along=-p["amplitude_um"] * sags * scene.normal[:, 2])


def draw_crystals(scene, rng):
    return {
        "amplitude_um": float(rng.choice([-1.0, 1.0])),
        "tau_s": float(rng.uniform(200, 900)),
        "straight": float(rng.uniform(-0.5, 0.2)),
    }


def change_crystals(scene, p):
    """The probe feels with crystals that give a charge when they are pressed, and also, for they cannot help it, while
    they become warmer or cooler. As long as the probe limps behind the air of the hall this charge is added to that of
    the touch, and it triggers early where both have the same sign, late while the temperature goes the other way;
    when it has come to rest all is right, warm or cold. It is the long stylus from the side for which the charge
    stands for a long way; along the stylus it is little, and may have the other sign. Amplitude for 1 K that the probe
    is behind, with the longest stylus from the side."""
    air, since = scene.temperature["air"], np.minimum(pauses(scene), 60.0)
    behind, state = np.zeros(scene.size), air[0]
    for k in range(scene.size):
        state += (air[k] - state) * (1 - np.exp(-since[k] / p["tau_s"]))
        behind[k] = air[k] - state
    beta = directions(scene)[1]
    longest = max(s.length for s in scene.first_styli)
    way = np.cos(beta) ** 2 * (scene.length / longest) ** 2 + p["straight"] * np.sin(beta) ** 2
    return Change(along=p["amplitude_um"] * behind * way)


unknown("carried_wax", draw_wax, change_wax, ["feature", "time", "direction", "sensor"])
unknown("breathing_bearing", draw_exhaust, change_exhaust, ["time", "position", "sensor", "head"])
unknown("sorted_matrices", draw_tensors, change_tensors, ["direction", "head", "sensor"])
unknown("wound_string", draw_string, change_string, ["feature", "time", "position"])
unknown("sinking_feet", draw_feet, change_feet, ["position", "setup", "feature"])
unknown("sooty_contacts", draw_soot, change_soot, ["direction", "time", "sensor", "speed"])
unknown("trapped_water", draw_liquid, change_liquid, ["time", "setup", "position"], "D")
unknown("startled_crystals", draw_crystals, change_crystals, ["temperature", "time", "sensor", "direction"], "D")
