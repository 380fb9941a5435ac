"""The strangers of the twelfth final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np

from .base import Change, unit, vector
from .unknown import unknown


def draw_ruby(scene, rng):
    return {
        "amplitude_um": 1.0,
        "turns": rng.choice([-1.0, 1.0]) * rng.uniform(0.7, 1.6),
        "phase": rng.uniform(0, 2 * np.pi),
    }


def change_ruby(scene, p):
    """The ruby has come loose in its glue. It is oval across the shank, and every touch from the side turns it on a
    little about its stem, the long tip as well as the short one: the side that stands out wanders round the tip in the
    course of the run. Amplitude from the mean radius to the longest, and turns of the ruby that is used most."""
    push = -np.einsum("nji,nj->ni", scene.head, scene.normal)
    around, aside = np.arctan2(push[:, 1], push[:, 0]), 1 - push[:, 2] ** 2
    turned = np.zeros(scene.size)
    for tip in np.unique(scene.length):
        mine = scene.length == tip
        turned[mine] = np.cumsum(aside[mine]) - aside[mine]
    turned *= 2 * np.pi * p["turns"] / turned.max()
    return Change(along=p["amplitude_um"] * aside * np.cos(2 * (around - turned) + p["phase"]))


def draw_hunting(scene, rng):
    return {"amplitude_um": rng.choice([-1.0, 1.0]), "period_s": rng.uniform(16, 36)}


def change_hunting(scene, p):
    """A motor holds the head at its angle A against friction, and hunts: its controller winds up until the head breaks
    loose, which then sticks as far on the other side, and so on from every indexing. The tip goes to and fro by its
    lever, up and down when it lies. Amplitude to either side, at the longest stylus."""
    first = np.array([scene.time[scene.visit == v].min() for v in scene.visit])
    side = np.where(np.mod((scene.time - first) / p["period_s"], 1) < 0.5, 1.0, -1.0)
    axis = np.column_stack([np.sin(scene.b), -np.cos(scene.b), np.zeros(scene.size)])
    return Change(tip=p["amplitude_um"] * side[:, None] * np.cross(axis, scene.arm / scene.length.max()))


def draw_stale(scene, rng):
    waves = rng.normal(size=(4, 2))
    return {
        "amplitude_um": 1.0,
        "coordinate": int(rng.integers(3)),
        "numbers": rng.uniform(-1.2, 1.2, (4, 2)),
        "waves": waves / np.sqrt(np.sum(waves**2) / 2),
        "period_s": rng.uniform(22, 45),
        "first_s": rng.uniform(0, 20),
    }


def change_stale(scene, p):
    """The controller works out the correction of its guides in a slow task, which comes round only now and then, and
    takes it for the place where the machine is at this moment. After the way to another ball the touches still get the
    correction of the ball before, until the task comes round again. Amplitude of the correction where its waves add
    up."""
    done = p["first_s"] + np.floor((scene.time - p["first_s"]) / p["period_s"]) * p["period_s"]
    then = np.maximum(np.searchsorted(scene.time, done, side="right") - 1, 0)
    low = scene.reading[:, :2].min(0)
    q = 2 * np.pi * ((scene.reading[:, :2] - low) / np.ptp(scene.reading[:, :2], axis=0)) @ np.asarray(p["numbers"]).T
    correction = np.sum(np.asarray(p["waves"])[:, 0] * np.sin(q) + np.asarray(p["waves"])[:, 1] * np.cos(q), 1)
    return Change(tip=vector(np.eye(3)[p["coordinate"]], p["amplitude_um"] * (correction[then] - correction)))


def draw_matched(scene, rng):
    turned = rng.normal(size=(len(scene.styli), 3))
    turned -= turned.mean(0)
    return {"amplitude_um": 1.0, "turned": turned / np.sqrt(np.mean(turned**2))}


def change_matched(scene, p):
    """The operator has matched the orientations of the head on three spheres at the edges of the table, not on one. The
    software therefore gives every orientation a whole coordinate system, each turned a little otherwise about the
    middle, and all of the part is turned with it. Amplitude at the end of the part, the root of the mean square of the
    turns."""
    away = scene.target - scene.target.mean(0)
    away = away / np.linalg.norm(away, axis=1).max()
    return Change(tip=p["amplitude_um"] * np.cross(np.asarray(p["turned"])[scene.sensor], away))


def draw_seams(scene, rng):
    return {
        "amplitude_um": 1.0,
        "axes": {str(f): unit(rng) for f in np.unique(scene.feature)},
        "width_deg": rng.uniform(6, 11),
    }


def change_seams(scene, p):
    """The balls are sintered in two halves, and were polished too little: around each runs a seam, on the great circle
    where its mould was parted, and each is screwed on as it came. The certificate has the mean diameter. Amplitude on
    the crest."""
    axes = np.array([p["axes"][f] for f in scene.feature])
    aside = np.degrees(np.arcsin(np.clip(np.sum(scene.part_normal * axes, 1), -1, 1))) / p["width_deg"]
    seam = np.exp(-0.5 * aside**2)
    return Change(along=p["amplitude_um"] * (seam - seam.mean()))


def draw_clocks(scene, rng):
    return {"amplitude_um": rng.choice([-1.0, 1.0]), "period_s": rng.uniform(150, 450), "phase": rng.uniform()}


def change_clocks(scene, p):
    """The interface of the probe writes down the time of each touch, and the controller looks up where it was then. The
    two clocks do not run alike, and are set equal again every few minutes: meanwhile the touch is looked up later and
    later, in proportion to the speed. The qualification has taken the mean. Amplitude from this mean to the worst, at
    8 mm/s."""
    apart = 2 * np.mod(scene.time / p["period_s"] + p["phase"], 1) - 1
    return Change(tip=scene.travel * (p["amplitude_um"] * apart * scene.speed / 8)[:, None])


def draw_butted(scene, rng):
    axis = int(rng.integers(2))
    return {
        "amplitude_um": 1.0,
        "axis": axis,
        "far_side": rng.choice([-1.0, 1.0]),
        "gap_mm": float(np.quantile(scene.reading[:, axis], rng.uniform(0.35, 0.65))),
    }


def change_butted(scene, p):
    """A scale is made of two pieces with a gap between them, and each piece is held at its outer end: warm, they grow
    towards each other and the gap closes. The software corrects one long scale that is held at the near end. Before the
    gap it is right, beyond it all is off by the growth of the whole length. Amplitude for 1 K away from 20 degrees."""
    beyond = p["far_side"] * (scene.reading[:, p["axis"]] - p["gap_mm"]) > 0
    warmer = scene.temperature["xyz"[p["axis"]]] - 20
    return Change(tip=vector(np.eye(3)[p["axis"]], p["far_side"] * p["amplitude_um"] * warmer * beyond))


def draw_spray(scene, rng):
    turn, half = rng.uniform(0, 2 * np.pi), float(np.abs(scene.part_point[:, :2]).max())
    away = rng.uniform(1.8, 2.6) * half
    return {
        "amplitude_um": 1.0,
        "placement": int(rng.choice(np.unique(scene.setup))),
        "nozzle_mm": [float(away * np.cos(turn)), float(away * np.sin(turn)), float(rng.uniform(0.8, 1.6) * half)],
    }


def change_spray(scene, p):
    """For an optical scanner the part has been sprayed with white powder, and one placement is measured before it is
    wiped. The layer is thick on the side of each ball that faced the can, thin where the spray came aslant, none
    behind, and less on the balls that stood farther away. Amplitude where it is thickest."""
    way = np.asarray(p["nozzle_mm"]) - scene.part_point
    far = np.linalg.norm(way, axis=1)
    layer = np.clip(np.sum(way * scene.part_normal, 1) / far, 0, None) * (far.min() / far) ** 2
    return Change(along=p["amplitude_um"] * layer * (scene.setup == p["placement"]))


unknown("rolling_ruby", draw_ruby, change_ruby, ["direction", "time", "sensor", "head"])
unknown("hunting_head", draw_hunting, change_hunting, ["time", "head", "sensor"])
unknown("stale_correction", draw_stale, change_stale, ["time", "position", "feature"])
unknown("matched_frames", draw_matched, change_matched, ["head", "sensor", "position", "feature"])
unknown("moulded_seams", draw_seams, change_seams, ["feature", "direction"])
unknown("drifting_clocks", draw_clocks, change_clocks, ["time", "speed"])
unknown("butted_scale", draw_butted, change_butted, ["temperature", "position", "feature", "setup"], "D")
unknown("matting_spray", draw_spray, change_spray, ["setup", "direction", "feature"], "D")
