"""Effects of the workpiece and its fixture: plates. um, mm, kg."""

from portable import np

from .base import Change, along_axis_or_oblique, effect, unit
from .probe import ball_form
from .structure import middle_time


def plate_bowl(u, v):
    """Deflection of a simply supported square plate under a load spread over its middle fifth: Navier's
    series, centre 1. u, v in [-1, 1]."""
    w = centre = 0.0
    for m in range(1, 12, 2):
        for n in range(1, 12, 2):
            patch = (
                np.sin(m * np.pi / 2)
                * np.sin(n * np.pi / 2)
                * np.sin(m * np.pi * 0.1)
                * np.sin(n * np.pi * 0.1)
                / (m * n)
            )
            k = patch / (m**2 + n**2) ** 2
            w = w + k * np.sin(m * np.pi * (u + 1) / 2) * np.sin(n * np.pi * (v + 1) / 2)
            centre += k * np.sin(m * np.pi / 2) * np.sin(n * np.pi / 2)
    return w / centre


def draw_load(scene, rng):
    return {"sag_um_per_500kg": 1.0, "across": rng.uniform(-0.3, 0.3)}


def change_load(scene, p):
    """The guide on the table follows the granite along a line of the plate: it sinks, and its slope turns the
    carriage."""
    guide = scene.machine.chain[0]
    i = "xyz".index(guide)
    half = scene.machine.travel[guide] / 2
    u = scene.reading[:, i] / half - 1
    load = p["sag_um_per_500kg"] * scene.load / 500
    shape = lambda q: 1 - plate_bowl(0.8 * q, np.full_like(q, p["across"]))  # the guide ends near the supports
    low = shape(np.zeros(1))[0]
    slope = (shape(u + 1e-4) - shape(u - 1e-4)) / 2e-4
    move, turn = np.zeros((scene.size, 3)), np.zeros((scene.size, 3))
    move[:, 2] = -load * (shape(u) - low)
    turn[:, 1 - i] = (1 if i == 0 else -1) * load * slope / half * 1e3
    return Change({guide: (move, turn)})


def draw_clamping(scene, rng):
    return {
        "bow_um": rng.normal(),
        "twist_um": rng.normal(),
        "three_point_um": rng.normal(),
        "half_size_mm": float(np.abs(scene.part_point[:, :2]).max()),
    }


def change_clamping(scene, p):
    """Clamp forces bend the plate in its softest modes; the bow of a clamped-free strip is not quite a
    parabola."""
    h = p["half_size_mm"]
    u, v, z = scene.part_point[:, 0] / h, scene.part_point[:, 1] / h, scene.part_point[:, 2] / h
    b, t, c = p["bow_um"], p["twist_um"], p["three_point_um"]
    w = b * (1.2 * u**2 - 0.2 * u**4) + t * u * v + c * (u**3 - 3 * u * v**2)
    along_u = b * (2.4 * u - 0.8 * u**3) + t * v + c * (3 * u**2 - 3 * v**2)
    along_v = t * u - 6 * c * u * v
    moved = np.column_stack([-z * along_u, -z * along_v, w])
    return Change(along=np.sum(scene.part_normal * moved, 1))


def draw_form(scene, rng):
    return {
        "amplitude_um": 1.0,
        "axes": [unit(rng) for _ in range(4)],
        "degrees": [2, 2, 2, 3],
        "weights": rng.normal(size=4),
    }


def change_form(scene, p):
    on_ball = np.array([not f.startswith("LENGTH") for f in scene.feature])
    return Change(along=p["amplitude_um"] * on_ball * ball_form(scene.part_normal, p))


def draw_shift(scene, rng):
    return {"amplitude_um": 1.0, "direction": along_axis_or_oblique(rng), "t0_s": middle_time(scene, rng)}


def change_shift(scene, p):
    """The part slips in its fixture; it stays there until it is placed anew."""
    here = scene.setup[np.searchsorted(scene.time, p["t0_s"]) - 1]
    on = (scene.time >= p["t0_s"]) & (scene.setup == here)
    return Change(along=p["amplitude_um"] * on * (scene.normal @ np.asarray(p["direction"])))


effect(
    "part.load_bending",
    draw_load,
    change_load,
    ["sag_um_per_500kg"],
    5,
    ["position", "setup", "feature"],
    needs=("load_kg",),
    designs="D",
    known=True,
)
effect(
    "part.clamping",
    draw_clamping,
    change_clamping,
    ["bow_um", "twist_um", "three_point_um"],
    50,
    ["feature", "position", "setup"],
    designs="CD",
)
effect("part.form", draw_form, change_form, ["amplitude_um"], 3, ["direction", "feature"], designs="AE", spans=16)
effect("part.shift", draw_shift, change_shift, ["amplitude_um"], 50, ["time", "setup"], needs=("time_s",))
