"""Effects of temperature: spec of signs and sizes in docs/physics/thermal.md, other mathematics here:
conduction instead of exponentials, a relay control instead of a sine. Lengths mm, temperatures C and K,
um."""

from portable import np

from .base import Change, along_axis_or_oblique, conduction_response, effect, slab_gradient, vector


def from_part(scene, factor):
    """Growth of the part from its origin by `factor` um/m, as readings along the normal."""
    return factor * np.sum(scene.part_normal * scene.part_point, 1) * 1e-3


def sign(rng):
    return rng.choice([-1.0, 1.0])


def draw_part(scene, rng):
    return {"cte_error_ppm_per_K": sign(rng)}


def change_part(scene, p):
    return Change(along=from_part(scene, p["cte_error_ppm_per_K"] * (scene.temperature["part"] - 20)))


def change_scales(scene, p):
    tip = -np.column_stack(
        [
            p["cte_error_ppm_per_K"] * (scene.temperature[a] - 20) * scene.reading[:, i] * 1e-3
            for i, a in enumerate("xyz")
        ]
    )
    return Change(tip=tip)


def arch(scene, axis, curvature):
    """A guide of `axis` bent upwards in the middle by `curvature` (um/m^2): the carriage rises and tilts."""
    i = "xyz".index(axis)
    s = scene.reading[:, i]
    move, turn = np.zeros((scene.size, 3)), np.zeros((scene.size, 3))
    move[:, 2] = curvature * (s * 1e-3) ** 2 / 2
    turn[:, 1 - i] = (-1 if i == 0 else 1) * curvature * s * 1e-3
    return {axis: (move, turn)}


def draw_table(scene, rng):
    return {
        "gradient_K": sign(rng),
        "since_h": rng.uniform(4, 24),
        "thickness_mm": rng.uniform(180, 250),
        "cte_ppm_per_K": 6.5,
    }


def change_table(scene, p):
    shape = slab_gradient(scene.time + p["since_h"] * 3600, p["thickness_mm"] * 1e-3)
    gradient = p["gradient_K"] * shape / shape.mean()
    return Change(arch(scene, scene.machine.chain[0], p["cte_ppm_per_K"] * gradient / p["thickness_mm"] * 1e3))


def draw_bridge(scene, rng):
    return {
        "gradient_K": sign(rng),
        "height_mm": rng.uniform(150, 250),
        "cte_ppm_per_K": 23.1,
        "tau_s": rng.uniform(900, 2400),
    }


def change_bridge(scene, p):
    gradient = p["gradient_K"] * conduction_response(scene.time + 3 * p["tau_s"], p["tau_s"])
    return Change(arch(scene, scene.machine.chain[1], p["cte_ppm_per_K"] * gradient / p["height_mm"] * 1e3))


def draw_drift(scene, rng):
    return {
        "amplitude_um": 1.0,
        "direction": along_axis_or_oblique(rng),
        "tau_s": scene.duration * rng.uniform(0.15, 0.8),
    }


def change_drift(scene, p):
    return Change(tip=vector(p["direction"], p["amplitude_um"] * conduction_response(scene.time, p["tau_s"])))


def draw_cycle(scene, rng):
    shortest = max(420.0, scene.duration / 25)
    return {
        "amplitude_um": 1.0,
        "direction": along_axis_or_oblique(rng),
        "period_s": rng.uniform(shortest, max(1.2 * shortest, min(3600, scene.duration / 3))),
        "phase_deg": rng.uniform(0, 360),
    }


def relay(t, period, softness=0.25):
    """Room under on-off control: exponentials between two switching points, fundamental of amplitude 1."""
    tau = softness * period

    def raw(x):
        half, q = np.mod(x, 1.0) % 0.5, np.exp(-0.5 * period / tau)
        value = 1 - 2 / (1 + q) * np.exp(-half * period / tau)
        return np.where(np.mod(x, 1.0) < 0.5, value, -value)

    grid = (np.arange(2000) + 0.5) / 2000
    first = np.hypot(*(2 * np.mean(raw(grid) * f(2 * np.pi * grid)) for f in (np.cos, np.sin)))
    return raw(t / period) / first


def change_cycle(scene, p):
    t = scene.time + p["phase_deg"] / 360 * p["period_s"]
    return Change(tip=vector(p["direction"], p["amplitude_um"] * relay(t, p["period_s"])))


def draw_ram(scene, rng):
    return {"rise_K": 1.0, "tau_s": scene.duration * rng.uniform(0.1, 0.5), "cte_ppm_per_K": 23.1}


def change_ram(scene, p):
    out = np.zeros((scene.size, 3))
    extension = np.abs(scene.reading[:, 2]) + 100.0
    out[:, 2] = p["cte_ppm_per_K"] * p["rise_K"] * conduction_response(scene.time, p["tau_s"]) * extension * 1e-3
    return Change(tip=out)


def draw_stylus(scene, rng):
    return {"rise_K": 1.0, "tau_s": scene.duration * rng.uniform(0.1, 0.4)}


def change_stylus(scene, p):
    growth = scene.stylus_cte * scene.length * 1e-3 * p["rise_K"] * conduction_response(scene.time, p["tau_s"])
    return Change(tip=scene.shank * growth[:, None])


def draw_soak(scene, rng):
    return {
        "start_K": sign(rng),
        "tau_s": scene.duration * rng.uniform(0.1, 0.4),
        "cte_ppm_per_K": float(rng.choice([11.5, 23.1])),
    }


def change_soak(scene, p):
    return Change(
        along=from_part(scene, p["cte_ppm_per_K"] * p["start_K"] * (1 - conduction_response(scene.time, p["tau_s"])))
    )


TIME, HEAT, PLACE = ("time_s",), "temperature", "position"
effect(
    "thermal.part_expansion",
    draw_part,
    change_part,
    ["cte_error_ppm_per_K"],
    12,
    [HEAT, PLACE, "feature", "setup"],
    needs=("temp_part_C",),
    designs="D",
)
effect(
    "thermal.scale_expansion",
    draw_part,
    change_scales,
    ["cte_error_ppm_per_K"],
    10,
    [HEAT, PLACE, "feature", "setup"],
    needs=("temp_x_C", "temp_y_C", "temp_z_C"),
    designs="D",
)
effect(
    "thermal.table_bending",
    draw_table,
    change_table,
    ["gradient_K"],
    1.0,
    [PLACE, "setup", "feature"],
    designs="CDE",
    known=True,
)
effect(
    "thermal.bridge_bending",
    draw_bridge,
    change_bridge,
    ["gradient_K"],
    0.5,
    [PLACE, "setup", "feature"],
    designs="CDE",
    known=True,
)
effect("thermal.drift", draw_drift, change_drift, ["amplitude_um"], 10, ["time"], needs=TIME)
effect("thermal.cycle", draw_cycle, change_cycle, ["amplitude_um"], 4, ["time"], needs=TIME, designs="CDE")
effect("thermal.ram_growth", draw_ram, change_ram, ["rise_K"], 1.0, ["time", PLACE], needs=TIME)
effect(
    "thermal.stylus_growth",
    draw_stylus,
    change_stylus,
    ["rise_K"],
    5.0,
    ["time", "head", "sensor"],
    needs=TIME,
    designs="CD",
)
effect(
    "thermal.part_soak",
    draw_soak,
    change_soak,
    ["start_K"],
    3.0,
    ["time", PLACE, "feature", "setup"],
    needs=TIME,
    designs="CDE",
)
