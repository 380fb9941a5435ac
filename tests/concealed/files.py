"""What the program under test gets to see: the recording (CSV) and the machine's data sheet (JSON), formats
of docs/recording.md and docs/machine.md. Nothing here knows what was concealed."""

import json

import machine as cmm
from designs import ARTEFACTS
from portable import np

TEMPERATURES = {"temp_part_C": "part", "temp_x_C": "x", "temp_y_C": "y", "temp_z_C": "z", "temp_air_C": "air"}


def machine_json(scene, other=None):
    """The specification: sizes, expected errors, sensors. Those of the calibration too, when there is one."""
    m = scene.machine
    components = {}
    for axis in m.chain:
        for motion in range(6):
            s, c = cmm.SHARES[cmm.share_of(axis, motion)]
            name = "e" + ("xyz"[motion] if motion < 3 else "abc"[motion - 3]) + axis
            components[name] = {"s": s, "c": c, "e_max": m.angle_max if motion >= 3 else m.e_max}
    sensors = {}
    for stylus in scene.styli + (other.styli if other else []):
        sensors[stylus.name] = {
            "head_deg": list(stylus.head),
            "tip_in_r_mm": [0, 0, -stylus.length],
            "diameter_mm": stylus.diameter,
            "shaft_diameter_mm": stylus.shaft,
            "material": stylus.material,
        }
    arcsec = round(m.head_sd / cmm.ARCSEC, 4)
    return (
        json.dumps(
            {
                "schema": "abbe.machine/1",
                "name": m.name,
                "axes": {a: {"travel_mm": m.travel[a], "direction": m.direction[a]} for a in cmm.AXES},
                "chain": {"ram_side": list(m.chain), "table_side": []},
                "offsets_mm": {**{a: list(m.offsets[a]) for a in m.chain}, "mount": list(m.mount)},
                "geometry": {"harmonics": cmm.HARMONICS, "components": components},
                "specification": {"standard": "ISO 10360-2:2009", "mpe": {"a_um": m.mpe[0], "k_um_per_m": m.mpe[1]}},
                "head": {"model": "PH10M", "l_r_mm": m.head_length, "angle_sd_arcsec": {"A": arcsec, "B": arcsec}},
                "probe": {"sd_um": [m.probe_sd] * 3},
                "sensors": sensors,
            },
            indent=1,
        )
        + "\n"
    )


def columns(scene, r, resolution):
    """Name -> list of text, in the order of the file."""
    s = scene
    position = s.target + r[:, None] * 1e-3 * s.normal
    reading = position - cmm.home_offset(s.machine) - s.tip
    if resolution:
        position = np.round(position / (resolution * 1e-3)) * resolution * 1e-3
    seen, touch = {}, []
    for key in zip(s.feature, s.run):
        seen[key] = seen.get(key, 0) + 1
        touch.append(seen[key])

    def fixed(values, digits):
        return [f"{v:.{digits}f}" for v in values]

    out = {"feature": s.feature, "touch": [str(t) for t in touch]}
    for name, block, digits in (("", position, 6), ("t", s.target, 6), ("n", s.normal, 9)):
        out.update({name + a: fixed(block[:, i], digits) for i, a in enumerate(cmm.AXES)})
    out.update(setup=[str(v) for v in s.setup], run=[str(v) for v in s.run], sensor=[s.styli[k].name for k in s.sensor])
    out.update(head_A_deg=fixed(np.degrees(s.a), 1), head_B_deg=fixed(np.degrees(s.b), 1))
    out.update(qualification=[str(v) for v in s.qualification], visit=[str(v) for v in s.visit])
    out.update(time_s=fixed(s.time, 2), speed_mm_s=fixed(s.speed, 2), accel_mm_s2=fixed(s.acceleration, 0))
    out.update({"a" + a: fixed(s.travel[:, i], 6) for i, a in enumerate(cmm.AXES)})
    out.update({name: fixed(s.logged[place], 2) for name, place in TEMPERATURES.items()})
    out["load_kg"] = fixed(s.load, 1)
    if s.logs_readings:
        out.update({"enc_" + a: fixed(reading[:, i], 6) for i, a in enumerate(cmm.AXES)})
    return out


def recording_csv(scene, r, resolution=0.0, without=(), stuck=()):
    """without: columns that were not logged; stuck: columns that say the same all the time, the first value."""
    table = {k: v for k, v in columns(scene, r, resolution).items() if k not in without}
    for name in stuck:
        if name in table:
            table[name] = [table[name][0]] * scene.size
    head = [
        f"# machine: {scene.machine.name}",
        "# frame: mcs",
        "# point: tip_centre",
        f"# artefact: {ARTEFACTS[scene.design]}",
        ",".join(table),
    ]
    return "\n".join(head + [",".join(row) for row in zip(*table.values())]) + "\n"
