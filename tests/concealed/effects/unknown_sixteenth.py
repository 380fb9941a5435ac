"""The strangers of the sixteenth final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np

from .base import Change, unit
from .unknown import unknown


def centres(scene):
    """Middle of the ball that is touched, in the part."""
    return scene.part_point - 12.5 * scene.part_normal


def draw_plastic(scene, rng):
    names = [str(f) for f in rng.permutation(np.unique(scene.feature))]
    return {"amplitude_um": 1.0, "balls": sorted(names[: int(rng.integers(3, 6))])}


def change_plastic(scene, p):
    """Some balls of the part were lost, and cheap ones of plastic have been screwed on in their place. They have the
    right diameter at 20 degrees, but with every kelvin they grow many times as much as the others: touched from any
    side they seem larger in the warm, while their middle stays where it is. Amplitude of the radius for 1 K."""
    swollen = np.array([f in p["balls"] for f in scene.feature]) * (scene.temperature["part"] - 20)
    return Change(along=p["amplitude_um"] * swollen)


def draw_homing(scene, rng):
    skew = rng.normal(size=len(scene.placements))
    skew = skew - skew.mean()
    return {"amplitude_um": 1.0, "skew": (skew / np.abs(skew).max()).tolist()}


def change_homing(scene, p):
    """The bridge is driven at both legs, and each leg has its own scale. Before every placement the machine is switched
    on and homed, and the reference mark of one leg, which is dirty, is found a little early or late: until it is homed
    again the bridge stands askew. The calibration has the mean. Amplitude at the end of the bridge, at the worst."""
    first, second = scene.machine.chain[:2]
    move, turn = np.zeros((scene.size, 3)), np.zeros((scene.size, 3))
    askew = np.asarray(p["skew"])[scene.setup - 1]
    turn[:, 2] = p["amplitude_um"] * askew / (scene.machine.travel[second] / 2) * 1e3
    return Change({first: (move, turn)})


def draw_reference(scene, rng):
    return {"amplitude_um": rng.choice([-1.0, 1.0]), "axis": unit(rng).tolist()}


def change_reference(scene, p):
    """The reference sphere is worn oval. Each orientation has been qualified on the side of it that it faces, on a
    slender end or on a flat flank, and has got another radius of the tip: with this orientation all balls seem larger
    or smaller, with another one less so. The first check has taken the mean. Amplitude from the smallest to the
    largest."""
    used = np.unique(scene.sensor, return_index=True)[1]
    radius = (scene.shank @ np.asarray(p["axis"])) ** 2
    of_each = radius[used]
    return Change(along=p["amplitude_um"] * (radius - of_each.mean()) / np.ptp(of_each))


def draw_aligned(scene, rng):
    every = int(rng.integers(5, 10))
    turns = rng.normal(size=(len(scene.blocks) // every + 1, 3))
    return {
        "amplitude_um": 1.0,
        "origin": str(rng.choice(np.unique(scene.feature))),
        "every": every,
        "turns": (turns / np.sqrt(np.mean(turns**2))).tolist(),
    }


def change_aligned(scene, p):
    """The program aligns the part anew after every few balls, by some touches of its rough frame, and each time finds
    it turned a little otherwise. The origin stays in the middle of one ball, so that this one is always right and those
    far from it are off by their distance, till the next alignment. Amplitude at the farthest ball, the root of the mean
    square of the turns about each axis."""
    here = np.array([f == p["origin"] for f in scene.feature])
    away = centres(scene) - centres(scene)[here].mean(0)
    turn = np.asarray(p["turns"])[scene.block // p["every"]]
    moved = np.cross(turn, away / np.linalg.norm(away, axis=1).max())
    return Change(along=p["amplitude_um"] * np.sum(moved * scene.part_normal, 1))


def draw_swing(scene, rng):
    return {
        "amplitude_um": 1.0,
        "period_s": rng.uniform(7, 16),
        "tau_s": rng.uniform(12, 30),
        "half_size_mm": float(np.abs(scene.part_point[:, :2]).max()),
    }


def change_swing(scene, p):
    """The part stands on a turntable whose brake is open: a soft spring alone holds it. Every touch beside the axis
    sets it swinging about its vertical, by the lever and to the side of the push, and the next touches find it
    somewhere on its way to and fro, until the swing has died away or the part is placed anew. Touches that point at the
    axis neither move it nor see it. Amplitude of the undamped swing for a lever of half the size, after such a push."""
    lever = np.cross(scene.part_point, scene.part_normal)[:, 2] / p["half_size_mm"]
    angle = np.zeros(scene.size)
    for back in range(1, 20):
        since = scene.time[back:] - scene.time[:-back]
        swing = np.exp(-since / p["tau_s"]) * np.sin(2 * np.pi * since / p["period_s"])
        angle[back:] -= lever[:-back] * swing * (scene.setup[back:] == scene.setup[:-back])
    return Change(along=p["amplitude_um"] * angle * lever)


def draw_humming(scene, rng):
    return {
        "amplitude_um": 1.0,
        "turned": rng.uniform(-0.3, 0.3),
        "half_size_mm": float(np.abs(centres(scene)[:, :2]).max()),
    }


def change_humming(scene, p):
    """A fan of the controller makes the plate of the part hum in its second mode, the saddle: balls on the nodal lines,
    about the diagonals, stand still, those between them swing up and down, and those on tall posts rock. A ball that
    swings meets the tip early, from whichever side this comes. The tip radius has taken the mean. Amplitude of the mode
    where it is largest."""
    u, v, z = (scene.part_point / p["half_size_mm"]).T
    c, s = np.cos(2 * p["turned"]), np.sin(2 * p["turned"])
    w, along_u, along_v = c * (u**2 - v**2) + 2 * s * u * v, 2 * (c * u + s * v), 2 * (s * u - c * v)
    early = np.abs(np.sum(scene.part_normal * np.column_stack([-z * along_u, -z * along_v, w]), 1))
    return Change(along=p["amplitude_um"] * (early - early.mean()))


def draw_lift(scene, rng):
    return {
        "amplitude_um": 1.0,
        "seat": rng.uniform(0, 2 * np.pi),
        "weight": rng.uniform(0.5, 0.9),
        "held": rng.uniform(0.2, 0.5),
    }


def change_lift(scene, p):
    """The long module hangs on a magnet that has lost strength at one of its three seats. Where the push of a touch and
    the weight of the module, as the head holds it, pull together at this seat by more than the magnet, the module is
    lifted from it, tips aside and snaps back when the tip is free again. The other modules are held. Amplitude for
    a push straight from the seat, lifted by its full moment."""
    towards = scene.head @ np.array([np.cos(p["seat"]), np.sin(p["seat"]), 0.0])
    push = -np.sum(scene.normal * towards, 1)
    lifted = np.clip(push - p["weight"] * towards[:, 2] - p["held"], 0, None)
    long = scene.length > scene.length.max() - 1
    return Change(along=-p["amplitude_um"] * long * lifted * np.clip(push, 0, None))


def draw_modal(scene, rng):
    return {"amplitude_um": rng.choice([-1.0, 1.0]), "touches": int(rng.integers(1, 3))}


def change_modal(scene, p):
    """A new speed of probing reaches the software at once, the drives only when the next touches are already under way.
    The first one or two after each change from slow to fast are still made slowly, those after a change from fast to
    slow fast, and the delay of the probe is taken off for the other speed. Where the speed stays all is right.
    Amplitude for the change from 2 to 8 mm/s."""
    starts = np.unique(scene.block, return_index=True)[1]
    number = np.arange(scene.size) - starts[scene.block]
    before = scene.speed[np.maximum(starts[scene.block] - 1, 0)]
    wrong = (before - scene.speed) / 6 * (number < p["touches"])
    return Change(tip=scene.travel * (p["amplitude_um"] * wrong)[:, None])


unknown("plastic_balls", draw_plastic, change_plastic, ["temperature", "feature"], "D")
unknown("askew_homing", draw_homing, change_homing, ["setup", "position", "feature"], "D")
unknown("oval_reference", draw_reference, change_reference, ["sensor", "head", "direction"], "D")
unknown("anxious_alignment", draw_aligned, change_aligned, ["time", "position", "feature"])
unknown("open_turntable", draw_swing, change_swing, ["time", "direction", "feature", "position"])
unknown("humming_plate", draw_humming, change_humming, ["feature", "direction", "position"], "D")
unknown("weak_magnet", draw_lift, change_lift, ["sensor", "head", "direction"], "D")
unknown("late_speed", draw_modal, change_modal, ["speed", "time"], "D")
