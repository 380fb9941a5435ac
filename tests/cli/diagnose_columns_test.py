"""abbe diagnose where columns say less than they seem to: few digits, clocks with another beginning, gaps, another unit, a dirty touch."""
import json

import harness

PROGRAM = harness.ROOT / "examples/iso10360/form_and_size_5x25.dmi"   # one sphere, five orientations of the head, 125 touches
SPHERE = harness.ROOT / "examples/iso10360/form_and_size_1x25.dmi"   # in one of them, 25 touches
MACHINE = harness.ROOT / "examples/iso10360/portal-2009.json"


class Columns(harness.Case):
    def record(self, *options, name="whole.csv", program=None, whole=False):
        """Of a part of PROGRAM, unless it is to be the whole or another."""
        self.abbe("record", PROGRAM if whole else program or self.sphere(), "--machine", MACHINE, "-o", name, *options)
        return self.folder / name

    def diagnosis(self, *args):
        return json.loads(self.abbe("diagnose", *args, "--machine", MACHINE, "--format", "json").stdout)

    def codes(self, said):
        return [m["code"] for m in said["messages"]]

    def test_positions_of_two_decimals_are_rounded_and_nothing_else(self):
        for seed in (4, 7):
            rounded = self.changed(self.record("--seed", seed), lambda row: row | {a: f"{float(row[a]):.2f}" for a in "xyz"} | {f"enc_{a}": "" for a in "xyz"})
            said = self.diagnosis(rounded)
            self.assertEqual([e["members"] for e in said["effects"]], [["noise.resolution"]])
            self.assertAlmostEqual(said["effects"][0]["parameters"]["resolution_um"]["value"], 10)
            self.assertEqual(said["baseline"]["outliers"], [])

    def test_what_record_rounds_is_found(self):
        """A round number of nanometres or not, as that of a counter which divides a period of 40 um by 12."""
        for seed, step_um in ((7, 3), (8, 5), (9, 3.3333333)):
            said = self.diagnosis(self.record("--seed", seed, "--with", f"noise.resolution:resolution_um={step_um}", whole=True))
            self.assertEqual([e["members"] for e in said["effects"]], [["noise.resolution"]], (seed, step_um))
            self.assertAlmostEqual(said["effects"][0]["parameters"]["resolution_um"]["value"], step_um, 6)
            self.assertIn(f"Record the digits that the machine has: x, y and z come in steps of {step_um:g} um.", said["otherwise"] or "")

    def test_the_only_stylus_of_a_machine_without_a_head_need_not_be_logged(self):
        """It is in no orientation, so no column says what its touches lack, and no error of a head explains them."""
        machine = {k: v for k, v in json.loads(MACHINE.read_text()).items() if k != "head"}
        (self.folder / "fixed.json").write_text(json.dumps(machine | {"sensors": {"DOWN": {"tip_in_r_mm": [0, 0, -150], "diameter_mm": 4}}}))
        said = {}
        for name, missing in (("logged", ()), ("not_logged", ("sensor", "head_A_deg", "head_B_deg", "visit"))):
            whole = self.record("--seed", 4, "--with", "probe.pretravel_lobing:amplitude_um=3", program=SPHERE)
            path = self.changed(whole, lambda row: row | {c: "" for c in missing}, f"{name}.csv")
            path.write_text("".join(line for line in path.read_text().splitlines(True) if not line.startswith("# sensor")))
            said[name] = json.loads(self.abbe("diagnose", path, "--machine", "fixed.json", "--format", "json").stdout)
            self.assertEqual({c["effect"]: c["missing"] for c in said[name]["cannot_judge"] if c["effect"] in ("head.axis_errors", "head.reindexing")},
                             {"head.axis_errors": [], "head.reindexing": []})
        self.assertEqual([e["members"][0] for e in said["logged"]["effects"]], ["probe.pretravel_lobing"])
        for key in ("verdict", "effects", "p_value"):
            self.assertEqual(said["logged"][key], said["not_logged"][key], key)

    def test_a_part_off_its_targets_hides_no_rounding(self):
        def moved(row):
            return row | {a: f"{round(2e2 * (float(row[a]) + by)) / 2e2:.3f}" for a, by in (("x", 0.2), ("y", -0.3), ("z", 0.1))} | {f"enc_{a}": "" for a in "xyz"}
        said = self.diagnosis(self.changed(self.record("--seed", 4, program=SPHERE), moved))
        self.assertEqual([e["members"] for e in said["effects"]], [["noise.resolution"]])
        self.assertAlmostEqual(said["effects"][0]["parameters"]["resolution_um"]["value"], 5)

    def test_without_a_clock_no_machine_file_carries_a_moment(self):
        """The seconds are those of touches alone; the program takes others, and the step would lie after its end."""
        step = self.record("--seed", 4, "--with", "machine.step:amplitude_um=25,t0_s=130,direction=x", whole=True)
        untimed = self.changed(step, lambda row: row | {"time_s": ""}, "untimed.csv")
        said = self.diagnosis(untimed, "--model-out", "after.json")
        self.assertTrue(any("machine.step" in e["members"] for e in said["effects"]))
        self.assertIn("Until then no machine file carries it", said["effects"][0]["sentence"])
        self.assertEqual(json.loads((self.folder / "after.json").read_text()).get("effects", []), [])
        self.assertIn("W0737", self.codes(said))
        self.assertNotIn("W0737", self.codes(self.diagnosis(step, "--model-out", "timed.json")))
        self.assertNotEqual(json.loads((self.folder / "timed.json").read_text())["effects"], [])

    def test_a_clock_may_begin_anywhere(self):
        """In the year 1970 or long before, in the night of a day, or of the day when it is put back."""
        whole = self.record("--seed", 4, "--with", "machine.step:amplitude_um=25,t0_s=25,direction=x", program=SPHERE)

        def clocked(clock_s):
            return self.changed(whole, lambda row: row | {"time_s": f"{clock_s(float(row['time_s'])):.3f}"})

        def moment(said):
            return said["effects"][0]["parameters"]["t0_s"]["value"]

        said = self.diagnosis(whole)
        day = self.diagnosis(clocked(lambda s: 10700 + s))
        self.assertEqual(day["effects"][0]["members"], said["effects"][0]["members"])
        self.assertFalse({"N0727", "N0734"} & set(self.codes(day)))
        for code, clock_s in (("N0727", lambda s: (86380 + s) % 86400), ("N0734", lambda s: 10700 + s - (3600 if s > 20 else 0))):
            other = self.diagnosis(clocked(clock_s))
            self.assertIn(code, self.codes(other))
            self.assertEqual(other["effects"][0]["members"], day["effects"][0]["members"])
            self.assertAlmostEqual(moment(other), moment(day), places=3)

        begin = 10.0   # of the clock at the first touch
        later = self.diagnosis(clocked(lambda s: 1.7e9 + s))
        self.assertEqual(later["effects"][0]["members"], said["effects"][0]["members"])
        self.assertLess(abs(moment(said) - begin - moment(later)), 5)
        for said in (later, self.diagnosis(clocked(lambda s: s - 1e11), "--design-only")):
            self.assertIn("N0721", self.codes(said))

    def test_what_is_logged_in_part_is_left_out(self):
        whole = self.record("--seed", 4)
        gap = self.changed(whole, lambda row: row | ({"time_s": ""} if row["feature"] == "P2_12" else {"time_s": f"{float(row['time_s']) + 1.7e9:.3f}"}))
        said = self.diagnosis(gap)
        self.assertIn("W0722", self.codes(said))
        self.assertEqual(said["verdict"], "no_mismatch")
        without = self.diagnosis(self.changed(whole, lambda row: {k: v for k, v in row.items() if k != "time_s"}))
        self.assertEqual(said["p_value"], without["p_value"])

    def test_of_several_files_the_one_is_named_that_is_meant(self):
        short = {"program": SPHERE}
        whole, again = self.record("--seed", 4, **short), self.record("--seed", 4, "--run", 2, name="again.csv", **short)
        at = lambda C, but=None: lambda row: row | {"temp_part_C": "" if row["touch"] == but else C}
        warm = self.changed(whole, at("20.1"), "warm.csv").name

        def told(other):
            said, = (m for m in self.diagnosis(warm, other.name)["messages"] if m["code"] in ("W0722", "W0724", "W0712"))
            return said["message"], said["help"]
        message, help_ = told(again)
        self.assertTrue(message.startswith("again.csv: temp_part_C is in no row, only in other files"), message)
        self.assertNotIn("leave those rows out", help_)
        message, help_ = told(self.changed(again, at("20.1", "13"), "gap.csv"))
        self.assertTrue(message.startswith("gap.csv: temp_part_C is empty in 1 of 25 rows, first for 'BALL' touch 13"), message)
        self.assertIn("leave those rows out", help_)
        self.assertTrue(told(self.changed(again, at("68.2"), "hot.csv"))[0].startswith("hot.csv: temp_part_C is 68.2 degrees C"))
        astray = self.changed(again, lambda row: at("20.1")(row) | ({"x": repr(float(row["x"]) + 500)} if row["touch"] == "7" else {}), "astray.csv")
        self.assertIn("of astray.csv) lies 500", told(astray)[0])

    def test_degrees_fahrenheit_are_doubted(self):
        whole = self.record("--seed", 4)
        warm = self.changed(whole, lambda row: row | {"temp_part_C": "68.2"})
        self.assertIn("W0724", self.codes(self.diagnosis(warm)))
        self.assertNotIn("W0724", self.codes(self.diagnosis(self.changed(whole, lambda row: row | {"temp_part_C": "20.1"}))))

    def test_sensors_that_were_not_read_and_speeds_per_minute_are_doubted(self):
        whole = self.record("--seed", 4)
        unread = self.changed(whole, lambda row: row | {"temp_part_C": "0" if row["feature"] == "P2_12" else "20.1"})
        self.assertIn("W0724", self.codes(self.diagnosis(unread)))
        self.assertNotIn("W0728", self.codes(self.diagnosis(unread)))
        per_minute = self.changed(whole, lambda row: row | {"speed_mm_s": f"{60 * float(row['speed_mm_s']):g}"})
        self.assertIn("W0728", self.codes(self.diagnosis(per_minute)))

    def test_readings_that_were_commanded_are_not_used(self):
        """They hold no touch's own deviation: predicted from them, a touch would predict itself."""
        whole = self.record("--seed", 4)
        commanded = lambda row: row | {f"enc_{a}": f"{float(row['enc_' + a]) - float(row[a]) + float(row['t' + a]):.7f}" for a in "xyz"}
        none = lambda row: row | {f"enc_{a}": "" for a in "xyz"}
        coarse = lambda row: row | {a: f"{float(row[a]):.2f}" for a in "xyz"}
        said, without = (self.diagnosis(self.changed(whole, change)) for change in (commanded, none))
        self.assertIn("W0729", self.codes(said))
        self.assertEqual((said["verdict"], said["p_value"]), ("no_mismatch", without["p_value"]))
        for read in (whole, self.changed(whole, coarse)):
            self.assertNotIn("W0729", self.codes(self.diagnosis(read)))

    def test_readings_that_tell_no_phase_are_not_used(self):
        """What is wrong with a touch would be all that they hold, once it is taken out of them: a period of the scale explained every recording."""
        whole, readings = self.record("--seed", 4), ("enc_x", "enc_y", "enc_z")
        without = self.diagnosis(self.changed(whole, lambda row: row | {c: "" for c in readings}))
        other = lambda row, c: "0" if int(row["feature"].split("_")[1]) % 2 else row[c]
        for change, why in ((lambda row: {"enc_z": "-400"}, "enc_z is the same in all rows, and z is not"),
                            (lambda row: {c: "500" for c in readings}, "enc_x is the same in all rows"),
                            (lambda row: {"enc_y": other(row, "enc_y")}, "enc_y does not follow y"),
                            (lambda row: {c: f"{float(row[c]):.2f}" for c in readings}, "enc_x is written in steps of 10 um")):
            said = self.diagnosis(self.changed(whole, lambda row: row | change(row)))
            self.assertEqual(self.codes(said), ["W0731"], why)
            self.assertIn(why, said["messages"][0]["message"])
            self.assertEqual((said["verdict"], said["p_value"]), ("no_mismatch", without["p_value"]), why)
            self.assertIn({"effect": "machine.scale_interpolation", "missing": list(readings), "constant": [], "too_few": []}, said["cannot_judge"])
        for wrong in ("-43660.1", "-1e7"):   # of one touch: a decimal point that was lost
            said = self.diagnosis(self.changed(whole, lambda row: row | {"enc_z": wrong} if row["feature"] == "P2_12" else row))
            self.assertEqual((self.codes(said), said["p_value"]), (["W0731"], without["p_value"]))
            self.assertIn("of 'P2_12'", said["messages"][0]["message"])

    def test_readings_of_few_digits_and_of_an_axis_at_rest_are_used(self):
        def equator(row):
            level = {"z": f"{-400 + 1e-4 * float(row['x']):.7f}", "tz": "-400", "nz": "0", "enc_z": "-250"}
            return row | level if abs(float(row["nz"])) < 0.1 else None

        def recorded(run, change):
            whole = self.record("--seed", 4, "--run", run, program=SPHERE)
            return self.changed(whole, change, f"{change.__name__}{run}.csv")

        def rounded(row):
            return row | {f"enc_{a}": f"{float(row['enc_' + a]):.3f}" for a in "xyz"}

        for change in (rounded, equator):
            said = self.diagnosis(*(recorded(run, change) for run in (1, 2, 3)))
            self.assertNotIn("W0731", self.codes(said))
            if change is rounded:  # eight points by themselves tell no period
                self.assertNotIn("enc_x", str(said["cannot_judge"]))

    def test_a_head_that_never_turned_in_the_log_turned_with_the_styli(self):
        """One stylus in five orientations, and angles that nobody read: the answer is that without them."""
        whole = self.record("--seed", 4, "--with", "probe.pretravel_lobing:amplitude_um=0.1")
        at_rest = self.changed(whole, lambda row: row | {"head_A_deg": "0", "head_B_deg": "0"}, "at_rest.csv")
        said, without = self.diagnosis(at_rest), self.diagnosis(self.changed(whole, lambda row: row | {"head_A_deg": "", "head_B_deg": ""}, "without.csv"))
        self.assertEqual((self.codes(said), self.codes(without)), (["W0736"], []))
        self.assertEqual((said["verdict"], said["effects"], said["p_value"]), (without["verdict"], without["effects"], without["p_value"]))
        self.assertEqual(said["effects"][0]["members"], ["probe.pretravel_lobing"])

    def test_one_scale_that_was_commanded_is_told(self):
        whole = self.record("--seed", 4)
        said = self.diagnosis(self.changed(whole, lambda row: row | {"enc_z": f"{float(row['enc_z']) - float(row['z']) + float(row['tz']):.7f}"}))
        self.assertEqual(self.codes(said), ["W0729"])
        self.assertIn("enc_z does not hold", said["messages"][0]["message"])

    def test_a_row_in_micrometres_is_left_out(self):
        whole = self.record("--seed", 4)
        wrong = self.changed(whole, lambda row: row | ({a: repr(1e3 * float(row[a])) for a in "xyz"} if row["feature"] == "P3_6" else {}), "um.csv")
        said = self.diagnosis(wrong)
        self.assertEqual((said["verdict"], self.codes(said)), ("no_mismatch", ["W0712"]))
        self.assertEqual((said["touches"], said["p_value"]), (64, self.diagnosis(self.changed(whole, lambda row: None if row["feature"] == "P3_6" else row))["p_value"]))
        self.assertIn("lies 1104476.2 mm from its target: left out", said["messages"][0]["message"])
        self.assertIn("in micrometres there: multiply them by 0.001", said["messages"][0]["help"])

    def test_a_machine_moves_as_machines_do(self):
        """Seconds, millimetres: what is a thousand times too much or too little is doubted, by its own column."""
        whole = self.record("--seed", 4)
        for column, by, words in (("accel_mm_s2", 1e-3, "m/s2"), ("accel_mm_s2", 1e3, "um/s2"), ("speed_mm_s", 1e-3, "m/s"), ("time_s", 1e3, "milliseconds")):
            said = self.diagnosis(self.changed(whole, lambda row: row | {column: f"{by * float(row[column]):.6f}"}))
            told = [m for m in said["messages"] if m["code"] == "W0728"]
            self.assertEqual(len(told), 1, column)
            self.assertIn(column, told[0]["message"])
            self.assertIn(words, told[0]["help"])
        for change, words in (({"speed_mm_s": "0"}, "leave the field empty"), ({"accel_mm_s2": "0"}, "leave the field empty")):
            told = [m for m in self.diagnosis(self.changed(whole, lambda row: row | change))["messages"] if m["code"] == "W0728"]
            self.assertIn(words, told[0]["help"])

    def test_a_row_of_another_clock_is_told_and_takes_no_longer(self):
        whole = self.record("--seed", 4)
        for changed, words in ((lambda row: {"time_s": "1e9"} if row["feature"] == "P2_12" else {}, "days pass between two touches"),
                               (lambda row: {"time_s": f"{float(row['time_s']) / 86400:.12f}"}, "s or less after the one before")):
            said = self.diagnosis(self.changed(whole, lambda row: row | changed(row)))
            self.assertIn("W0728", self.codes(said))
            self.assertIn(words, " ".join(m["message"] for m in said["messages"]))

    def test_directions_that_are_the_same_in_all_rows_are_not_used(self):
        whole = self.record("--seed", 4)
        said = self.diagnosis(self.changed(whole, lambda row: row | {"ax": "0", "ay": "0", "az": "-1"}))
        self.assertEqual((said["verdict"], self.codes(said)), ("no_mismatch", ["W0732"]))

    def test_errors_far_beyond_the_specification_are_told(self):
        """A step that a larger geometry would explain as well: nobody should take the machine for one in order."""
        said = self.diagnosis(self.record("--seed", 0, "--with", "machine.step:t0_s=80,amplitude_um=4,direction=x", whole=True))
        self.assertEqual(said["verdict"], "no_mismatch")
        self.assertGreater(said["baseline"]["geometry_scale"], 2)
        self.assertIn("W0723", self.codes(said))
        loose = ("--with", "noise.unequal:ratio=4,group=one orientation,head_a_deg=90,head_b_deg=90")
        scattered = self.diagnosis(self.record("--seed", 4, "--with", "machine.step:t0_s=80,amplitude_um=6,direction=x", *loose, whole=True))
        self.assertEqual([e["members"] for e in scattered["effects"]], [["noise.unequal"]])
        self.assertIn("W0723", self.codes(scattered))

    def test_a_name_beside_errors_far_beyond_the_specification_is_doubted(self):
        """The same step beside lobes: it hides in the errors of the machine, and the lobes are told for certain only without it."""
        lobes = ("--with", "probe.pretravel_lobing:amplitude_um=0.4")
        certain = self.diagnosis(self.record("--seed", 4, *lobes, whole=True))["effects"][0]
        self.assertGreater(certain["probability"], 0.9)
        said = self.diagnosis(self.record("--seed", 4, *lobes, "--with", "machine.step:t0_s=80,amplitude_um=6,direction=x", whole=True))
        self.assertGreater(said["baseline"]["geometry_scale"], 2)
        self.assertEqual((said["effects"][0]["members"], said["effects"][0]["probability"]), (["probe.pretravel_lobing"], 0.5))
        self.assertRegex(said["effects"][0]["sentence"], r"beside it the machine's errors would have to be 2\.\d times those of its specification")

    def test_scatter_beyond_the_machine_file_is_told(self):
        """Of 25 touches scatter twice as large as it should be may have no name; five times as large has one. Neither is a machine in order."""
        sphere = harness.ROOT / "examples/iso10360/form_and_size_1x25.dmi"
        portal = harness.ROOT / "examples/iso10360/portal-2009.json"

        def shaken(sd_um, seed):
            self.abbe("record", sphere, "--machine", portal, "--seed", seed, "--with", f"noise.vibration:sd_um={sd_um}", "-o", "shaken.csv")
            return "diagnose", "shaken.csv", "--machine", portal
        told = self.abbe(*shaken(1.2, 2))
        self.assertIn("W0730", told.stderr)
        self.assertIn("if its touches scatter 2.0 times as much as its file says", told.stdout)
        plan = json.loads(self.abbe(*shaken(1.2, 2), "--design-only", "--format", "json").stdout)
        self.assertTrue(any(d["effect"] == "noise.vibration" for d in plan["smallest_detectable"]))
        said = json.loads(self.abbe(*shaken(3, 1), "--format", "json").stdout)
        self.assertEqual([e["members"] for e in said["effects"]], [["noise.vibration"]])
        self.assertNotIn("W0730", self.codes(said))

    def test_the_last_digits_of_readings_have_no_name(self):
        """Positions that were corrected and readings that were not: at one height, what a scale makes of the readings is what a touch deviates,
        ten thousand times smaller."""
        faces = (("TOP", (500, -5, 0), (0, 0, 1), [(100 * k / 3, y, 0) for y in (-5, -35) for k in range(31)]),
                 ("FRONT", (500, 0, -5), (0, 1, 0), [(100 * k / 3, 0, z) for z in (-5, -25) for k in range(31)]))
        lines = ["DMISMN/'a straightedge',4.0", "UNITS/MM,ANGDEC", "SNSET/APPRCH,3", "SNSET/RETRCT,3", "FEDRAT/MESVEL,MMPS,5",
                 "S(P)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,150,4", "SNSLCT/S(P)", "D(R)=TRANS/XORIG,300,YORIG,500,ZORIG,-498"]
        words = lambda v: ",".join(f"{c:.4f}" for c in v)
        for name, at, normal, points in faces:
            lines += [f"F({name})=FEAT/PLANE,CART,{words(at)},{words(normal)}", f"MEAS/PLANE,F({name}),{len(points)}", f"GOTO/CART,0,{60 * normal[1]},{60 * normal[2]}"]
            lines += [f"PTMEAS/CART,{words(p)},{words(normal)}" for p in points] + ["ENDMES", "GOTO/CART,1000,60,60"]
        bar = self.record("--seed", 3, program=self.write("bar.dmi", "\n".join([*lines, "ENDFIL", ""])))
        def corrected(row):
            return row | {"z": f"{float(row['z']) + 0.003 * float(row['nz']) * (2 * (float(row['tx']) / 137 % 1) - 1):.7f}"}
        said = self.diagnosis(self.changed(bar, corrected))
        self.assertNotEqual(said["verdict"], "no_mismatch")
        for e in said["effects"]:
            self.assertNotIn("machine.map_scallops", e["members"])
            self.assertGreater(e["largest_um"], 1)

    def test_what_an_unknown_size_hides_is_listed(self):
        sized = self.write("sized.csv", "# surfaces: unknown_size\n" + self.record("--seed", 4).read_text())
        said = self.diagnosis(sized)
        told = {d["effect"] for d in said["smallest_detectable"]}
        self.assertNotIn("probe.tip_radius", told)
        self.assertIn({"effect": "probe.tip_radius", "missing": [], "constant": [], "too_few": []}, said["cannot_judge"])

    def test_scatter_of_groups_that_are_not_parted_cannot_be_judged(self):
        whole = self.record("--seed", 4, whole=True)
        upright = self.changed(whole, lambda row: row | {"head_A_deg": "0", "head_B_deg": "0", "time_s": ""}, "upright.csv")
        few = self.changed(whole, lambda row: row | {"time_s": ""} | ({"visit": "1", "head_A_deg": "0", "head_B_deg": "0"} if row["feature"] != "P5_1" else {"visit": "2"}), "few.csv")
        columns = ["head_A_deg", "sensor", "speed_mm_s", "time_s"]

        def unjudged(path, effect):
            return [c for c in self.diagnosis(path, "--design-only")["cannot_judge"] if c["effect"] == effect]
        self.assertEqual(unjudged(whole, "noise.unequal"), [])
        entry, = unjudged(upright, "noise.unequal")
        self.assertEqual((entry["missing"], entry["constant"], entry["too_few"]), (columns, ["head_A_deg", "speed_mm_s"], ["sensor"]))
        told = self.abbe("diagnose", few, "--machine", MACHINE, "--design-only").stdout
        self.assertRegex(told, "noise.unequal +missing: time_s; the same throughout: speed_mm_s; fewer than 20 touches in another orientation or with longer styli: head_A_deg, sensor")
        self.assertRegex(told, "head.reindexing +fewer than three indexings: visit")

    def test_styli_that_were_not_logged_are_missed_where_one_cannot_reach_all(self):
        def without_styli(path, name):
            return self.changed(path, lambda row: row | {c: "" for c in ("sensor", "head_A_deg", "head_B_deg")}, name)
        several = self.record("--seed", 4, "--with", "machine.squareness:squareness_urad=80", name="several.csv")
        one = self.record("--seed", 4, program=SPHERE, name="one.csv")
        said = self.diagnosis(several)
        self.assertNotIn("W0725", self.codes(said))
        self.assertGreater(said["effects"][0]["probability"], 0.9)
        in_order = self.record("--seed", 1, name="in_order.csv")
        for path in (several, in_order):
            nobody_knows = self.changed(path, lambda row: {c: row[c] for c in ("feature", "touch", "x", "y", "z", "tx", "ty", "tz", "nx", "ny", "nz")}, "bare.csv")
            nobody_knows.write_text("".join(line for line in nobody_knows.read_text().splitlines(True) if not line.startswith("#")))
            said = self.diagnosis(nobody_knows)
            self.assertEqual((said["verdict"], said["p_value"], said["effects"], self.codes(said)), ("cannot_judge", None, [], ["W0541", "W0725"]))
            self.assertTrue(all("sensor" in c["missing"] for c in said["cannot_judge"]))
            self.assertIn("sensor", said["otherwise"])
            if path == in_order:
                continue
            told = self.abbe("diagnose", nobody_knows, "--machine", MACHINE, "--fail-on-mismatch", "--model-out", "same.json").stdout
            self.assertIn("Whether this is a mismatch cannot be judged", told.splitlines()[0])
            # What holds for all effects a reader is told once.
            self.assertRegex(told, r"cannot be judged from this recording:\n  every effect +missing: sensor, head_A_deg, head_B_deg\nbaseline")
            self.assertEqual(json.loads((self.folder / "same.json").read_text()).get("effects", []), [])
        self.assertNotIn("W0725", self.codes(self.diagnosis(without_styli(one, "one_stylus.csv"))))

    def test_one_dirty_touch_is_no_failed_acceptance_test(self):
        whole = self.record("--seed", 4, program=harness.ROOT / "examples/iso10360/e0.dmi")
        first = []

        def dirty(row):
            first.append(row)
            return row | ({"x": repr(float(row["x"]) - 0.04 * float(row["nx"]))} if len(first) == 1 else {})
        said = self.diagnosis(self.changed(whole, dirty))
        self.assertNotIn("W0716", self.codes(said))
        self.assertEqual(len(said["baseline"]["outliers"]), 1)

    def test_an_unknown_part_may_move(self):
        whole = self.record("--seed", 4)
        again = self.record("--seed", 4, "--run", 2, "--setup", 2, name="again.csv")
        moved = self.changed(again, lambda row: row | {a: repr(float(row[a]) + 50) for a in ("x", "tx", "enc_x")}, "moved.csv")
        both = [self.write(f"unknown_{path.name}", "# surfaces: unknown\n" + path.read_text()) for path in (whole, moved)]
        self.assertNotIn("W0710", self.codes(self.diagnosis(*both)))

    def balls_on_the_table(self, *planted, **parts):
        """Nine balls all over the table in three placements, the second of a part that differs from the others."""
        centres = [(x, y, z) for x, z in ((300, -500), (800, -350), (1300, -500)) for y in (250, 500, 750)]
        program = self.write("balls.dmi", harness.balls(centres, ((0, 0, 1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0))))
        for setup in (1, 2, 3):
            part = self.write("part.json", json.dumps({"schema": "abbe.workpiece/1", "name": "balls", **parts["other" if setup == 2 else "usual"]}))
            yield self.record("--workpiece", part, "--setup", setup, *planted, name=f"{setup}.csv", program=program)

    def test_a_load_that_nobody_weighed_in_one_placement_is_no_clamping(self):
        """It had passed for clamping, or for what no effect explains: its load was not logged, or once for all placements."""
        weighed = list(self.balls_on_the_table("--with", "part.load_bending:sag_um_per_500kg=4", usual={"load_kg": 20}, other={"load_kg": 400}))
        self.assertEqual([(e["members"], e["probability"] > 0.9) for e in self.diagnosis(*weighed)["effects"]], [(["part.load_bending"], True)])
        for load_kg, missed in (("", "The recording has no load_kg"), ("20", "load_kg is the same throughout")):
            said = self.diagnosis(*(self.changed(path, lambda row: row | {"load_kg": load_kg}, f"{path.stem}_{load_kg}.csv") for path in weighed))
            self.assertEqual((said["verdict"], [(e["members"][0], e["probability"]) for e in said["effects"]]), ("cannot_judge", [("part.load_bending", 0.5)]))
            self.assertEqual(said["effects"][0]["parameters"]["setup"]["value"], 2)
            self.assertIn(missed, said["effects"][0]["sentence"])

    def test_a_part_that_was_warm_in_one_placement_is_thought_of(self):
        """It was what no effect explains, where its temperature was not logged or taken for 20 degrees C."""
        at = lambda part_C: {"material": {"cte_ppm_per_K": 0}, "temperature": {"part_C": part_C, "scale_C": 20}}   # its growth is the effect that is planted
        warm = list(self.balls_on_the_table("--with", "thermal.part_expansion:cte_error_ppm_per_K=11.5", usual=at(20), other=at(23)))
        for C in ("", "20"):
            said = self.diagnosis(*(self.changed(path, lambda row: row | {c: C for c in row if c.startswith("temp_")}, f"{path.stem}_{C}.csv") for path in warm))
            self.assertEqual((said["verdict"], [(e["members"], e["probability"]) for e in said["effects"]]), ("cannot_judge", [(["thermal.part_expansion"], 0.5)]))
            told = said["effects"][0]["parameters"]
            self.assertEqual(told["setup"]["value"], 2)
            self.assertLess(abs(told["temperature_error_K"]["value"] - 3), 3 * told["temperature_error_K"]["u"])


if __name__ == "__main__":
    harness.main()
