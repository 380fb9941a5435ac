"""Effects of the machine's structure and scales: play with memory, ringing of the bridge as an ordinary
differential equation, coupled guides. The tip lies behind the levers of the exact kinematics. um, urad, mm,
s."""

from portable import np

from .base import Change, along_axis_or_oblique, effect, vector


def one_axis(scene, rng):
    return "xyz"[rng.integers(3)]


def draw_scale(scene, rng):
    return {"scale_um_per_m": rng.choice([-1.0, 1.0]), "axis": one_axis(scene, rng)}


def change_scale(scene, p):
    i = "xyz".index(p["axis"])
    return Change(tip=vector(np.eye(3)[i], p["scale_um_per_m"] * scene.reading[:, i] * 1e-3))


SQUARE = {"cwy": (0, 1), "bwz": (0, 2), "awz": (1, 2)}


def draw_squareness(scene, rng):
    return {"squareness_urad": rng.choice([-1.0, 1.0]), "which": str(rng.choice(list(SQUARE)))}


def change_squareness(scene, p):
    """The second axis leans: seen by the machine, the first coordinate grows with the reading of the second."""
    i, j = SQUARE[p["which"]]
    return Change(tip=vector(np.eye(3)[i], 1e3 * np.tan(p["squareness_urad"] * 1e-6) * scene.reading[:, j]))


def draw_backlash(scene, rng):
    return {"backlash_um": 1.0, "axis": one_axis(scene, rng), "memory_mm": float(rng.choice([0.01, 0.3, 1.0]))}


def change_backlash(scene, p):
    """Play operators of several widths (Prandtl-Ishlinskii): each follows the reading, lagging by at most its
    radius."""
    i = "xyz".index(p["axis"])
    path = np.column_stack([scene.start[:, i], scene.reading[:, i]]).ravel()
    lag = np.zeros(scene.size)
    for radius in p["memory_mm"] * np.array([0.3, 1.0, 2.0]):
        state, states = path[0], np.empty(len(path))
        for k, x in enumerate(path):
            state = min(max(state, x - radius), x + radius)
            states[k] = state
        lag += (path - states)[1::2] / radius / 3
    return Change(tip=vector(np.eye(3)[i], p["backlash_um"] / 2 * lag))


def draw_interpolation(scene, rng):
    return {
        "amplitude_um": 1.0,
        "second_share": rng.uniform(0, 0.4),
        "period_um": float(rng.choice([20, 40, 100, 200])),
        "axis": one_axis(scene, rng),
        "phase": rng.uniform(0, 2 * np.pi),
        "second_phase": rng.uniform(0, 2 * np.pi),
    }


def change_interpolation(scene, p):
    """raw_um: reading at the touch to a fraction of the period, which the recording fills in before it asks."""
    i = "xyz".index(p["axis"])
    q = 2 * np.pi * (scene.raw[:, i] * 1e3) / p["period_um"]
    return Change(
        tip=vector(
            np.eye(3)[i],
            p["amplitude_um"] * (np.sin(q + p["phase"]) + p["second_share"] * np.sin(2 * q + p["second_phase"])),
        )
    )


def draw_dynamics(scene, rng):
    axis = str(rng.choice(["x", "y"]))
    return {
        "rotation_urad_per_m_s2": rng.choice([-1.0, 1.0]),
        "axis": axis,
        "about": "z" if rng.uniform() < 0.5 else ("y" if axis == "x" else "x"),
        "frequency_Hz": rng.uniform(10, 30),
        "damping_ratio": rng.uniform(0.02, 0.1),
        "settled_s": float(rng.choice([0.0, rng.uniform(0.005, 0.03)])),
    }


def ringing(frequency, damping, settled):
    """Twist over quasi-static twist, `settled` s after the acceleration ended: the mode equation, integrated.
    The acceleration rises and falls over 5 ms."""
    w, h = 2 * np.pi * frequency, 2e-4
    x, v, hold = 0.0, 0.0, 40 / w / damping

    def forced(t):
        return min(1.0, t / 0.005) if t < hold else max(0.0, 1 - (t - hold) / 0.005)

    x = 1.0  # held long enough to be at rest on the quasi-static twist
    for k in range(int((settled + 0.005) / h) if settled else 0):
        a = w * w * (forced(hold + k * h) - x) - 2 * damping * w * v
        v += a * h
        x += v * h
    return x


def change_dynamics(scene, p):
    i = "xyz".index(p["axis"])
    turn = np.zeros((scene.size, 3))
    shape = ringing(p["frequency_Hz"], p["damping_ratio"], p["settled_s"])
    turn[:, "xyz".index(p["about"])] = (
        p["rotation_urad_per_m_s2"] * shape * scene.acceleration * 1e-3 * scene.travel[:, i]
    )
    return Change({p["axis"]: (np.zeros((scene.size, 3)), turn)})


def draw_droop(scene, rng):
    return {"droop_um": 1.0, "direction": "xy"[rng.integers(2)]}


def change_droop(scene, p):
    share = np.abs(scene.reading[:, 2]) / scene.machine.travel["z"]
    return Change(
        tip=vector(np.eye(3)["xy".index(p["direction"])], p["droop_um"] * (1.5 * share**2 - 0.5 * share**3) * share)
    )


def draw_scallops(scene, rng):
    return {
        "amplitude_um": 1.0,
        "spacing_mm": float(rng.choice([25, 50, 100])),
        "axis": one_axis(scene, rng),
        "direction": int(rng.integers(3)),
        "uneven": rng.uniform(0, 0.3),
        "phase": rng.uniform(0, 2 * np.pi),
    }


def change_scallops(scene, p):
    """Linear interpolation between nodes misses the curvature of the error, which itself changes a little
    along the axis."""
    x = scene.reading[:, "xyz".index(p["axis"])]
    q = np.mod(x / p["spacing_mm"], 1)
    bend = 1 + p["uneven"] * np.sin(2 * np.pi * x / scene.machine.travel[p["axis"]] + p["phase"])
    return Change(tip=vector(np.eye(3)[p["direction"]], p["amplitude_um"] * bend * 4 * q * (1 - q)))


def middle_time(scene, rng):
    """A moment well inside the longest placement, between two touches."""
    numbers, counts = np.unique(scene.setup, return_counts=True)
    mine = scene.time[scene.setup == numbers[counts == counts.max()][rng.integers(np.sum(counts == counts.max()))]]
    return float(np.quantile(mine, rng.uniform(0.25, 0.75))) + 0.5


def draw_jump(scene, rng):
    return {"amplitude_um": 1.0, "direction": along_axis_or_oblique(rng), "t0_s": middle_time(scene, rng)}


def change_jump(scene, p):
    return Change(tip=vector(p["direction"], p["amplitude_um"] * (scene.time >= p["t0_s"])))


PLACE = ["position", "feature", "setup"]
effect("machine.scale", draw_scale, change_scale, ["scale_um_per_m"], 20, PLACE, designs="CDE", known=True)
effect(
    "machine.squareness", draw_squareness, change_squareness, ["squareness_urad"], 20, PLACE, designs="CDE", known=True
)
# The sense of the axes follows from the normals, too: no column is indispensable.
effect("machine.backlash", draw_backlash, change_backlash, ["backlash_um"], 4, ["direction", "feature"])
effect(
    "machine.scale_interpolation",
    draw_interpolation,
    change_interpolation,
    ["amplitude_um"],
    1.0,
    ["position"],
    needs=("enc_x", "enc_y", "enc_z"),
    designs="DE",
)
effect(
    "machine.dynamics",
    draw_dynamics,
    change_dynamics,
    ["rotation_urad_per_m_s2"],
    30,
    ["direction", "speed", "position"],
    needs=("accel_mm_s2",),
    designs="D",
)
effect("machine.ram_droop", draw_droop, change_droop, ["droop_um"], 4, PLACE, designs="CDE", known=True)
effect("machine.map_scallops", draw_scallops, change_scallops, ["amplitude_um"], 3, PLACE, designs="DE")
effect("machine.step", draw_jump, change_jump, ["amplitude_um"], 50, ["time"], needs=("time_s",))
