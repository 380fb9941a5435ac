"""abbe diagnose where something looks like an effect that it is not, or hides one that it is."""
import itertools
import json
import math
import random

import harness

MACHINE = harness.ROOT / "examples/machines/coord3-mc16.json"
PORTAL, SPHERE = (harness.ROOT / "examples/iso10360" / name for name in ("portal-2009.json", "form_and_size_1x25.dmi"))
BALLS = ((0, 0, 0), (350, 0, 0), (0, 250, 0), (350, 250, 0), (180, 120, 150), (60, 200, 80))
RADIUS = 12.5


def program(orientations=((0, 0), (45, 90), (45, -90))):
    """Six balls at round heights, the same touches on each, in these orientations of the head."""
    lines = ["DMISMN/'six balls',4.0", "UNITS/MM,ANGDEC", "SNSET/APPRCH,3", "SNSET/RETRCT,3", "FEDRAT/MESVEL,MMPS,4"]
    lines += [f"S(O{k})=SNSDEF/PROBE,INDEX,POL,{a},{b},0,0,-1,120,3" for k, (a, b) in enumerate(orientations)]
    lines.append("D(R)=TRANS/XORIG,700,YORIG,400,ZORIG,-550")
    rings = ((90, 1, 0), (55, 5, 0), (20, 6, 15))   # elevation, touches, azimuth of the first
    normals = [(math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)) for elevation, count, first in rings
               for e, a in ((math.radians(elevation), math.radians(first + 360 * k / count)) for k in range(count))]
    for k, (ball, centre) in itertools.product(range(len(orientations)), enumerate(BALLS)):
        if ball == 0:
            lines.append(f"SNSLCT/S(O{k})")
        lines.append(f"GOTO/{centre[0]},{centre[1]},{centre[2] + 60}")
        lines += [f"F(B{ball}_{k})=FEAT/SPHERE,OUTER,CART,{','.join(map(str, centre))},{2 * RADIUS}", f"MEAS/SPHERE,F(B{ball}_{k}),{len(normals)}"]
        lines += ["PTMEAS/CART," + ",".join(f"{v:.7f}" for v in (*(c + RADIUS * n for c, n in zip(centre, normal)), *normal)) for normal in normals]
        lines.append("ENDMES")
    return "\n".join([*lines, "ENDFIL", ""])


def steps():
    """A step gauge of ten steps along x, every face touched three times."""
    lines = ["DMISMN/'steps',4.0", "UNITS/MM,ANGDEC", "SNSET/APPRCH,3", "SNSET/RETRCT,3", "FEDRAT/MESVEL,MMPS,5",
             "S(P)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,100,3", "SNSLCT/S(P)", "D(R)=TRANS/XORIG,800,YORIG,500,ZORIG,-500"]
    for again, step, way in itertools.product(range(3), range(10), (-1, 1)):
        x = 40 * step + (20 if way > 0 else 0)
        label = f"F({'AB'[way > 0]}{step}_{again})"
        lines += [f"GOTO/{x + 8 * way},0,30", f"{label}=FEAT/POINT,CART,{x},0,0,{way},0,0", f"MEAS/POINT,{label},1", f"PTMEAS/CART,{x},0,0,{way},0,0",
                  "ENDMES", f"GOTO/{x + 8 * way},0,30"]
    return "\n".join([*lines, "ENDFIL", ""])


def farther(row, um):
    """The touch `um` farther out, as its scales show it."""
    by = {a: um / 1000 * float(row["n" + a]) for a in "xyz"}
    return row | {a: f"{float(row[a]) + by[a]:.7f}" for a in "xyz"} | {f"enc_{a}": f"{float(row['enc_' + a]) + by[a]:.7f}" for a in "xyz"}


def plate(displaced_mm, seed, clock=True, sd_um=0.5, digits=7):
    """Twenty balls in a plane, nine touches on each with one stylus in one orientation, each displaced by a function of target and time."""
    random_um, time_s = random.Random(seed), 10.0
    steep = math.sqrt(0.5)
    normals = [(0, 0, 1)] + [(math.cos(a) * c, math.sin(a) * c, s) for c, s, first in ((1, 0, 0), (steep, steep, 45)) for a in (math.radians(first + 90 * k) for k in range(4))]
    lines = ["# sensor S1: head_deg 0 0 tip_in_r_mm 0 0 -150 diameter_mm 4 shaft_diameter_mm 2", "# surfaces: calibrated",
             "feature,touch,x,y,z,tx,ty,tz,nx,ny,nz,sensor" + (",time_s" if clock else "")]
    for i, j in itertools.product(range(5), range(4)):
        for k, n in enumerate(normals):
            target = [c + 12 * along for c, along in zip((300 + 120 * i, 200 + 120 * j, -500), n)]
            out = sum(d * along for d, along in zip(displaced_mm(target, time_s), n)) + random_um.gauss(0, sd_um) / 1000
            row = [f"B{i}{j}", k + 1, *(f"{t + out * along:.{digits}f}" for t, along in zip(target, n)), *(f"{v:.7f}" for v in (*target, *n)), "S1"]
            lines.append(",".join(map(str, row + ([time_s] if clock else []))))
            time_s += 4
        time_s += 6
    return "\n".join(lines) + "\n"


class Traps(harness.Case):
    def setUp(self):
        super().setUp()
        self.write("balls.dmi", program())

    def record(self, *options, name="balls.csv", machine=MACHINE):
        self.abbe("record", "balls.dmi", "--machine", machine, "-o", name, *options)
        return self.folder / name

    def diagnosis(self, recording, machine=MACHINE):
        return json.loads(self.abbe("diagnose", recording, "--machine", machine, "--format", "json").stdout)

    def test_what_depends_on_the_direction_is_no_period_of_a_scale_at_round_heights(self):
        """Each ring of every ball is at one phase of a scale of 50 um."""
        poles = self.changed(self.record("--seed", 31), lambda row: farther(row, 5 * max(float(row["nz"]), 0) ** 4))
        said = self.diagnosis(poles)
        for e in said["effects"]:
            self.assertLessEqual(e["probability"], 0.5)
            if e["members"][0] == "machine.scale_interpolation":
                self.assertIn("moved by a third of the period", e["sentence"])

    def test_what_is_wrong_with_a_step_gauge_is_no_period_of_a_scale(self):
        """Its faces are at one phase of every scale, but for what is wrong with each: a period of 20 um would explain that by itself."""
        for wave in ("wave_cosine_um=0.95,wavelength_mm=100", "wave_um=1.5,wavelength_mm=150"):
            self.abbe("record", self.write("steps.dmi", steps()), "--machine", PORTAL, "--seed", 301, "-o", "steps.csv", "--with", f"part.form:{wave}")
            said = self.diagnosis("steps.csv", PORTAL)
            self.assertEqual([e["members"] for e in said["effects"]], [["part.form"]])
            length = float(wave.split("=")[-1])
            self.assertAlmostEqual(said["effects"][0]["parameters"]["wavelength_mm"]["value"], length, delta=0.2 * length)

    def test_a_ball_that_stands_elsewhere_is_touched_beside_its_targets(self):
        """The machine goes its programmed ways and meets the surface where it bends away."""
        self.abbe("record", SPHERE, "--machine", PORTAL, "--seed", 1, "-o", "sphere.csv")
        shift = (1.2, -0.8, 0.4)

        def met(row):
            normal, error = [float(row["n" + a]) for a in "xyz"], sum((float(row[a]) - float(row["t" + a])) * float(row["n" + a]) for a in "xyz")
            radius = 12.5 + 2   # of the centres of the tip
            arm = [radius * n - s for n, s in zip(normal, shift)]   # from the middle of the ball to the target
            along = sum(a * n for a, n in zip(arm, normal))
            way = -along + math.sqrt(along ** 2 - sum(a * a for a in arm) + (radius + error) ** 2)
            return row | {a: f"{float(row['t' + a]) + way * n:.7f}" for a, n in zip("xyz", normal)}
        for change in (met, lambda row: row | {a: f"{float(row[a]) + s:.7f}" for a, s in zip("xyz", shift)}):
            def read(row):
                moved = change(row)
                return moved | {f"enc_{a}": f"{float(row['enc_' + a]) + float(moved[a]) - float(row[a]):.7f}" for a in "xyz"}
            said = self.diagnosis(self.changed(self.folder / "sphere.csv", read), PORTAL)
            self.assertEqual(said["verdict"], "no_mismatch")
            self.assertIn("1.50 mm beside its targets and turned by 0.000 degrees", said["messages"][0]["message"])

    def test_a_machine_in_order_that_looks_unusual_is_held_against_more_of_its_kind(self):
        """Among 300 of its kind this one is one in 190; among 1800 it is not one in a hundred."""
        self.abbe("record", harness.ROOT / "examples/programs/prismatic_part.dmi", "--machine", MACHINE, "--seed", 283, "-o", "part.csv")
        said = self.diagnosis(self.folder / "part.csv")
        self.assertEqual(said["verdict"], "no_mismatch")
        self.assertLess(said["p_value"], 0.03)

    def test_axes_that_do_the_same_to_these_touches_are_both_told(self):
        """Every touch is at 45 degrees between x and y, or along z."""
        h = math.sqrt(0.5)
        directions = ((h, h, 0), (-h, h, 0), (-h, -h, 0), (h, -h, 0), (0, 0, 1))
        centres = [(300 + 200 * i, 200 + 150 * j, -500 + 100 * ((i + j) % 2)) for i in range(3) for j in range(3)]
        program = self.write("diagonal.dmi", harness.balls(centres, directions))
        self.abbe("record", program, "--machine", MACHINE, "--seed", 4, "-o", "diagonal.csv", "--with", "machine.backlash:backlash_um=5,axis=y")
        found = self.diagnosis("diagonal.csv")["effects"][0]
        at = found["members"].index("machine.backlash")
        axis = (found["by_member"][at]["parameters"] if found["by_member"] else found["parameters"])["axis"]
        self.assertEqual((axis["value"], [other["value"] for other in axis["others"]]), ("x", ["y"]))
        self.assertAlmostEqual(axis["probability"], axis["others"][0]["probability"])

    def test_what_cannot_be_told_apart_cannot_beside_another_effect_either(self):
        """One stylus, one orientation, one placement: whatever jumps, all later touches do."""
        path = self.write("plate.csv", plate(lambda t, time_s: (40e-6 * (t[0] - 300), 5e-3 * (time_s > 400), 0), seed=15))
        said = self.diagnosis(path, PORTAL)
        self.assertEqual([set(e["members"]) for e in said["effects"]], [{"machine.scale"}, {"part.shift", "probe.step", "machine.step"}])
        self.assertTrue(said["effects"][1]["sentence"].startswith("One of these explains what that leaves"))
        self.assertNotEqual(said["next_measurement"], [])

    def test_a_change_in_the_middle_of_a_ball_makes_no_dirt(self):
        """The fewer touches of that ball, on one side of the moment, contradict the others by as much as the change."""
        for moment, um, seed in ((238, 8, 2), (400, 8, 2), (556, 20, 1)):
            path = self.write("plate.csv", plate(lambda t, time_s: (0, um / 1000 * (time_s > moment), 0), seed=seed))
            said = self.diagnosis(path, PORTAL)
            self.assertEqual([set(e["members"]) for e in said["effects"]], [{"part.shift", "probe.step", "machine.step"}])
            self.assertEqual(said["baseline"]["outliers"], [])
            low, high = said["effects"][0]["parameters"]["t0_s"]["interval95"]
            self.assertTrue(low <= moment <= high and high - low < 20, (low, high))

    def test_touches_that_repeat_are_no_dirt(self):
        """Gauge faces touched three times each, other faces in between: where a rail is bent, all three are off alike."""
        folder = harness.ROOT / "examples/iso10360"
        self.abbe("record", folder / "e0.dmi", "--machine", PORTAL, "--with", "machine.straightness_angle_coupling:amplitude_um=8,axis=y", "--seed", 5, "-o", "e0.csv")
        said = self.diagnosis(self.folder / "e0.csv", PORTAL)
        self.assertEqual(said["baseline"]["outliers"], [])
        self.assertEqual([e["members"][0] for e in said["effects"]], ["machine.straightness_angle_coupling"])

    def test_dirt_that_makes_readings_shorter_has_a_size_below_0(self):
        said = self.diagnosis(self.record("--seed", 5, "--with", "noise.outliers:share=0.06,size_um=-15"))
        size, = [e["parameters"]["size_um"] for e in said["effects"] if e["members"] == ["noise.outliers"]]
        low, high = size["interval95"]
        self.assertTrue(low < size["value"] < high <= 0, size)

    def test_a_pattern_is_as_large_as_what_shows_of_it(self):
        """The placement of the plate takes up most of what follows one axis, whatever size that has."""
        path = self.write("plate.csv", plate(lambda t, _: (0, 4e-3 * (2 * (t[0] / 137 % 1) - 1), 0), seed=2))
        amplitude = self.diagnosis(path, PORTAL)["unexplained"]["amplitude_um"]
        self.assertLess(amplitude["value"], 2)   # before anything is taken up, the sawtooth has 1.3 um rms along the normals
        self.assertGreater(amplitude["interval95"][0], 0.2)

    def test_seconds_are_those_of_the_clock_or_doubted(self):
        doubted = []
        for clock in (True, False):
            path = self.write("plate.csv", plate(lambda _, time_s: (0, 5e-3 * (time_s > 400), 0), seed=6, clock=clock))
            doubted.append("log time_s" in self.diagnosis(path, PORTAL)["effects"][0]["sentence"])
        self.assertEqual(doubted, [False, True])

    def test_what_is_smaller_than_the_rounding_is_in_no_machine_file(self):
        """One place on every ball is rounded alike, and looks like a period of the scale."""
        path = self.write("plate.csv", plate(lambda *_: (0, 0, 0), seed=14, sd_um=0.2, digits=2))
        said = json.loads(self.abbe("diagnose", path, "--machine", PORTAL, "--format", "json", "--model-out", "model.json").stdout)
        self.assertGreater(len(said["effects"]), 1)
        self.assertIn(["noise.resolution"], [e["members"] for e in said["effects"]])
        for e in said["effects"][:-1]:
            self.assertLessEqual(e["probability"], 0.5)
            self.assertIn("record the digits that the machine has", e["sentence"])
        self.assertEqual([e["name"] for e in json.loads((self.folder / "model.json").read_text())["effects"]], ["noise.resolution"])

    def test_a_normal_of_the_wrong_sign_is_refused(self):
        self.abbe("record", self.write("steps.dmi", steps()), "--machine", PORTAL, "--seed", 301, "-o", "steps.csv")
        for recording, axis, why in ((self.record("--seed", 31), "y", "normals do not stand on the balls"),
                                     (self.folder / "steps.csv", "x", "only with the other sign does the machine travel against the normals")):
            turned = self.changed(recording, lambda row: row | {"n" + axis: repr(-float(row["n" + axis]))})
            said = self.refused("E0701", "diagnose", turned, "--machine", PORTAL)
            self.assertIn(f"the sign of n{axis} is turned round", said)
            self.assertIn(why, said)

    def test_exchanged_columns_of_normals_are_refused(self):
        swapped = self.changed(self.record("--seed", 5), lambda row: row | {"nx": row["ny"], "ny": row["nx"]})
        self.assertIn("write the columns nx, ny, nz as they are now ny, nx, nz", self.refused("E0701", "diagnose", swapped, "--machine", MACHINE))

    def test_what_predicts_as_well_is_not_left_out_for_its_size(self):
        """A drift along z seven times as large as usual, at one height: growth of the ram does the same with a size that is usual."""
        self.abbe("record", harness.ROOT / "examples/iso10360/form_and_size_5x25.dmi", "--machine", PORTAL, "--seed", 2,
                  "--with", "thermal.drift:amplitude_um=20,direction=z,tau_s=100", "-o", "drift.csv")
        said = json.loads(self.abbe("diagnose", "drift.csv", "--machine", PORTAL, "--format", "json").stdout)
        self.assertEqual(said["verdict"], "one_of")
        self.assertEqual(said["effects"][0]["members"], ["thermal.ram_growth", "thermal.drift"])
        self.assertEqual(said["next_measurement"][0]["separates"], ["thermal.ram_growth", "thermal.drift"])

    def test_what_tells_a_warm_part_from_scales_is_no_other_run(self):
        """A part that is warm in the second placement, or scales: the same touches once more say little, and two temperatures all."""
        self.write("upright.dmi", program(((0, 0),)))
        for run in (1, 2):
            scale = ("--with", "machine.scale:scale_um_per_m=40,axis=all") if run == 2 else ()
            self.abbe("record", "upright.dmi", "--machine", PORTAL, "--seed", 3, "--run", run, "--setup", run, "-o", f"{run}.csv", *scale)
        said = json.loads(self.abbe("diagnose", "1.csv", "2.csv", "--machine", PORTAL, "--format", "json").stdout)
        self.assertEqual(set(said["effects"][0]["members"]), {"machine.scale", "thermal.part_expansion"})
        self.assertEqual(said["next_measurement"], [])
        self.assertRegex(said["otherwise"], "^Log temp_part_C, .*No other run of these touches would .* What would: machine.scale: .*two temperatures")

    def test_why_touches_are_too_few_is_told_with_it(self):
        """Of 30 rows 22 are their targets and are left out: the error alone would only count the rest."""
        count = itertools.count()
        few = self.changed(self.record("--seed", 5), lambda row: (row if k < 8 else row | {a: row["t" + a] for a in "xyz"}) if (k := next(count)) < 30 else None)
        self.assertIn("W0717", self.refused("E0705", "diagnose", few, "--machine", MACHINE))

    def test_of_features_one_after_the_other_it_may_be_the_time(self):
        """Every ball has come loose by its own amount, or something has happened between any two."""
        def loose(target, _):
            own = random.Random(f"{round((target[0] - 300) / 120)} {round((target[1] - 200) / 120)}")
            return tuple(own.gauss(0, 8e-3) for _ in "xyz")
        said = self.diagnosis(self.write("plate.csv", plate(loose, seed=3)))
        self.assertEqual(said["unexplained"]["factor"], "feature")
        self.assertIn("so that it may be the time: measure them in another order", said["otherwise"])

    def test_what_every_fifth_touch_does_no_room_does(self):
        for seed in (7, 8):
            count = itertools.count()
            said = self.diagnosis(self.changed(self.record("--seed", seed), lambda row: farther(row, 3 if next(count) % 5 == 0 else 0)))
            for e in said["effects"]:
                self.assertNotIn("thermal.cycle", e["members"])

    def test_the_first_touches_after_a_step_are_no_dirt(self):
        for moment_s in (151, 207):
            said = self.diagnosis(self.record("--seed", 24, "--with", f"machine.step:t0_s={moment_s},amplitude_um=6"))
            self.assertIn("machine.step", said["effects"][0]["members"])
            self.assertNotIn(["noise.outliers"], [e["members"] for e in said["effects"]])

    def test_one_ball_beside_its_certificate_is_no_dirt(self):
        """Of every placement the two touches along the shift were left out, which are others where the plate is turned."""
        turned = {1: lambda x, y, z: (x, y, z), 2: lambda x, y, z: (-y, x, z), 3: lambda x, y, z: (x, 0.8 * y - 0.6 * z, 0.6 * y + 0.8 * z)}
        normals = ((0, 0, 1), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0))
        files = []
        for setup, turn in turned.items():
            lines = ["DMISMN/'twelve balls',4.0", "UNITS/MM,ANGDEC", "SNSET/APPRCH,3", "SNSET/RETRCT,3", "S(P)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,100,4",
                     "SNSLCT/S(P)", "D(R)=TRANS/XORIG,800,YORIG,500,ZORIG,-500"]
            for i, j in itertools.product(range(4), range(3)):
                centre = turn(100 * i - 150, 100 * j - 100, 0)
                lines += [f"GOTO/{','.join(map(str, (*centre[:2], centre[2] + 60)))}", f"F(B{i}{j})=FEAT/SPHERE,OUTER,CART,{','.join(map(str, centre))},{2 * RADIUS}",
                          f"MEAS/SPHERE,F(B{i}{j}),5"]
                lines += ["PTMEAS/CART," + ",".join(str(v) for v in (*(c + RADIUS * n for c, n in zip(centre, normal)), *normal)) for normal in normals]
                lines += ["ENDMES"]
            self.abbe("record", self.write(f"plate{setup}.dmi", "\n".join([*lines, "ENDFIL", ""])), "--machine", PORTAL, "--seed", 1, "--setup", setup,
                      "-o", f"plate{setup}.csv")
            shift = turn(0.004, 0, 0)

            def shifted(row):
                out = sum(s * float(row["n" + a]) for s, a in zip(shift, "xyz")) if row["feature"] == "B11" else 0
                return farther(row, 1000 * out) | {"time_s": str(float(row["time_s"]) + 2000 * setup)}
            files.append(self.changed(self.folder / f"plate{setup}.csv", shifted, f"shifted{setup}.csv"))
        text = "".join(f.read_text() if k == 0 else "\n".join(f.read_text().split("feature,", 1)[1].splitlines()[1:]) + "\n" for k, f in enumerate(files))
        said = self.diagnosis(self.write("plate.csv", "# surfaces: calibrated\n" + text), PORTAL)
        self.assertNotIn(["noise.outliers"], [e["members"] for e in said["effects"]])
        self.assertEqual((said["verdict"], said["unexplained"]["factor"]), ("unexplained", "feature"))
        self.assertIn("B11", json.dumps(said["location"]))

    def test_a_new_form_of_the_part_may_be_a_new_tip(self):
        """A tip that was damaged between two runs was told as balls that changed their form, for certain."""
        self.write("balls.dmi", program(((0, 0),)))
        files = [self.record("--seed", 2, "--run", run, *options, name=f"run{run}.csv", machine=PORTAL)
                 for run, options in ((1, ()), (2, ("--with", "part.form:three_lobe_um=3")))]
        said = json.loads(self.abbe("diagnose", *files, "--machine", PORTAL, "--format", "json").stdout)
        form = next(e for e in said["effects"] if e["members"][0] == "part.form")
        self.assertEqual(form["new_in_run"][0], 2)
        self.assertLessEqual(form["probability"], 0.5)
        self.assertIn("a tip that was changed or damaged in between may look like it", form["sentence"])

    def test_periods_that_fit_alike_are_told(self):
        """Of blocks of touches with pauses in between, several periods tell the same: one was told for certain."""
        lines = plate(lambda *_: (0, 0, 0), 3, sd_um=0.001).splitlines()
        rows = [dict(zip(lines[2].split(","), line.split(","))) for line in lines[3:]]
        blocks = [row | {"touch": str(18 * k + i + 1), "time_s": f"{960 * k + 4 * i:g}"} for k in range(8) for i, row in enumerate(rows[45:63])]
        noise = random.Random(8)

        def swung(row):
            return farther(row | {f"enc_{a}": row[a] for a in "xyz"}, 2.6 * float(row["nx"]) * math.sin(2 * math.pi * float(row["time_s"]) / 3000) + noise.gauss(0, 0.4))
        header = lines[2].split(",")
        text = "\n".join([*lines[:3], *(",".join(row[c] for c in header) for row in map(swung, blocks))]) + "\n"
        said = self.diagnosis(self.write("blocks.csv", text), PORTAL)
        period = said["effects"][0]["parameters"]["period_s"]
        self.assertEqual(said["effects"][0]["members"][0], "thermal.cycle")
        self.assertLess(period["interval95"][0], 3100)
        self.assertGreater(period["interval95"][1], 2900)

    def test_few_outliers_are_told_as_what_they_look_like(self):
        for seed, certain in ((4, False), (3, True)):
            dirt, = self.diagnosis(self.record("--seed", seed, "--with", "noise.outliers:share=0.01,size_um=6"))["effects"]
            self.assertEqual((dirt["probability"] >= 0.9, "may still be chance" in dirt["sentence"]), (certain, not certain))

    def test_outliers_of_both_signs_are_no_dirt(self):
        """Four at +9 and at -9 um were one size of 8.6 or -8.6 um, and were to be cleaned away."""
        recording = self.record("--seed", 3, "--with", "noise.outliers:share=0.06,size_um=20,opposite=0.5")
        said = json.loads(self.abbe("diagnose", recording, "--machine", MACHINE, "--format", "json", "--model-out", "disturbed.json").stdout)
        found = next(e for e in said["effects"] if e["members"] == ["noise.outliers"])
        self.assertRegex(found["sentence"], r"\d touches are outliers, \d+ too far out and \d+ too far in: a disturbed probe")
        low, high = found["parameters"]["opposite"]["interval95"]
        self.assertTrue(low < 0.5 < high, (low, high))
        self.assertNotIn("W0716", [m["code"] for m in said["messages"]])   # lengths with outliers at their ends are not the machine's
        carried, = json.loads((self.folder / "disturbed.json").read_text())["effects"]
        self.assertGreater(carried["parameters"]["opposite"]["value"], 0)

    def test_the_size_of_dirt_is_its_median(self):
        logs = []
        for seed in range(1, 7):
            said = self.diagnosis(self.record("--seed", seed, "--with", "noise.outliers:share=0.05,size_um=-30"))
            size = next(e["parameters"]["size_um"] for e in said["effects"] if e["members"] == ["noise.outliers"])
            self.assertLess(size["value"], 0)
            self.assertIn("all too far in", said["effects"][0]["sentence"])
            logs.append(math.log(size["value"] / -30))
        # about 10 touches in each of 6 recordings, whose logarithms have a standard deviation of 0.7: 0.09 of the mean
        self.assertLess(abs(sum(logs) / len(logs)), 3 * 0.09)

    def test_a_step_at_a_place_is_anywhere_between_the_readings(self):
        """298 and 529 mm are next to each other among those along x; a model with the step at one end would be as good and mislead."""
        lengths = harness.ROOT / "examples/iso10360/e0.dmi"
        self.abbe("record", lengths, "--machine", PORTAL, "--seed", 3, "-o", "e0.csv", "--with", "machine.step:amplitude_um=25,along=x,position_mm=420")
        [step] = self.diagnosis(self.folder / "e0.csv", PORTAL)["effects"]
        place = step["parameters"]["position_mm"]
        self.assertEqual(step["members"], ["machine.step"])
        self.assertAlmostEqual(place["value"], (298 + 529) / 2, delta=30)
        self.assertAlmostEqual(place["u"], (529 - 298) / math.sqrt(12), delta=15)
        self.assertTrue(298 - 10 < place["interval95"][0] < 310 and 515 < place["interval95"][1] < 529 + 10)

    def test_a_part_grows_from_where_it_is_held(self):
        """Logged temperatures rise by 3 K; the part is held at its left end, and grows by 15 ppm/K more than is compensated."""
        def warm(row):
            kelvin = float(row["time_s"]) / 114
            grown = [15e-3 * kelvin * (float(row["t" + a]) - at) for a, at in zip("xyz", (700, 525, -600))]   # um
            return farther(row, sum(g * float(row["n" + a]) for g, a in zip(grown, "xyz"))) | {"temp_part_C": f"{20 + kelvin:.3f}"}
        said = self.diagnosis(self.changed(self.record("--seed", 5), warm))
        [expansion] = said["effects"]
        self.assertEqual(expansion["members"], ["thermal.part_expansion"])
        cte, held = (expansion["parameters"][name] for name in ("cte_error_ppm_per_K", "held"))
        self.assertLess(abs(cte["value"] - 15), 3 * cte["u"])
        self.assertEqual(held["value"], "elsewhere")

    def test_the_size_of_an_expansion_goes_by_no_temperature_that_nobody_logged(self):
        """A wrong coefficient acts on a temperature. A wrong temperature acts by itself, so a machine file can carry it."""
        def grown(row):
            um_per_mm = 30e-3
            return farther(row, sum(um_per_mm * (float(row["t" + a]) - at) * float(row["n" + a]) for a, at in zip("xyz", (850, 510, -540))))
        first, second = (self.changed(self.record("--seed", 5, "--run", run), grown, f"run{run}.csv") for run in (1, 2))
        said = json.loads(self.abbe("diagnose", first, "--machine", MACHINE, "--model-out", "model.json", "--format", "json").stdout)
        [expansion] = [e for e in said["effects"] if e["members"][0] == "thermal.part_expansion"]
        self.assertNotIn("cte_error_ppm_per_K", expansion["parameters"])
        kelvin = expansion["parameters"]["temperature_error_K"]
        self.assertLess(abs(kelvin["value"] - 30 / 11.5), 3 * kelvin["u"])
        self.assertIn("Kelvins are reckoned with 11.5 ppm/K: of what expands less there are as many more.", expansion["sentence"])
        again = json.loads(self.abbe("diagnose", second, "--known", "model.json", "--format", "json").stdout)
        self.assertEqual(again["verdict"], "no_mismatch")

    def test_a_part_without_a_thermometer_follows_the_scales(self):
        """The part grows as the scales get warmer, and only these have thermometers: whether it is the part or they is not told for certain."""
        def warm(row):
            kelvin = float(row["time_s"]) / 114
            grown = [15e-3 * kelvin * (float(row["t" + a]) - at) for a, at in zip("xyz", (700, 525, -600))]   # um
            return (farther(row, sum(g * float(row["n" + a]) for g, a in zip(grown, "xyz")))
                    | {f"temp_{a}_C": f"{20 + kelvin + k / 10:.3f}" for k, a in enumerate("xyz")})
        said = self.diagnosis(self.changed(self.record("--seed", 5), warm))
        self.assertEqual(said["verdict"], "cannot_judge")
        self.assertIn("thermal.part_expansion", said["effects"][0]["members"])
        self.assertLessEqual(said["effects"][0]["probability"], 0.5)
        self.assertIn("temp_part_C", said["otherwise"])

    def test_a_phase_is_as_uncertain_as_its_period_makes_it(self):
        squares, beyond = 0, []
        for seed in range(21, 25):
            said = self.diagnosis(self.record("--seed", seed, "--with", "thermal.cycle:amplitude_um=4,direction=z,period_s=150"))
            [cycle] = said["effects"]
            self.assertEqual(cycle["members"], ["thermal.cycle"])
            beyond.append(cycle["parameters"]["phase_deg"]["value"] / cycle["parameters"]["phase_deg"]["u"])
            squares += beyond[-1] ** 2
        # The sum of 4 squares of unit variance is beyond 18.5 in 0.1 % of such tests.
        self.assertLess(squares, 18.5, beyond)

    def test_speeds_that_were_measured_are_those_that_were_commanded(self):
        """The machine is off along x as it goes faster, which no effect does; each touch logs its own speed."""
        said = []
        for step in (1.0, 0.001):
            count = itertools.count(1)

            def faster(row):
                speed = round((3 + 4 * (next(count) * 0.6180339887 % 1)) / step) * step
                return farther(row, 1.5 * (speed - 5) * float(row["nx"])) | {"speed_mm_s": f"{speed:.3f}"}
            said.append(self.diagnosis(self.changed(self.record("--seed", 3), faster)))
        for d in said:
            self.assertEqual((d["verdict"], d["location"][0]["factor"]), ("unexplained", "speed"))

    def test_an_effect_of_the_machine_file_that_is_gone_is_named(self):
        machine = json.loads(PORTAL.read_text())
        machine["effects"] = [{"name": "probe.pretravel_lobing", "parameters": {"amplitude_um": {"value": 0.11, "u": 0}}}]
        self.abbe("record", SPHERE, "--machine", PORTAL, "--seed", 6, "-o", "sphere.csv")
        said = self.diagnosis("sphere.csv", self.write("mended.json", json.dumps(machine)))
        self.assertEqual(said["effects"][0]["members"][0], "probe.pretravel_lobing")
        self.assertGreater(said["effects"][0]["probability"], 0.8)
        self.assertIn("it is not there any more", said["effects"][0]["sentence"])


if __name__ == "__main__":
    harness.main()
