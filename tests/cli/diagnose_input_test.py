"""abbe diagnose: the forms that a recording may have, and what is wrong with one."""
import json
import math
import os
import random
import subprocess
import threading

import harness
from recorded_input import CORNER, PROGRAM, RADIUS, TARGET, Input


class Frames(Input):
    def test_targets_of_the_program_suit_every_frame_and_point(self):
        expected = self.said(self.recording)
        for frame in ("mcs", "part"):
            for point in ("tip_centre", "surface"):
                def change(row):
                    for a in "xyz":
                        v = float(row[a]) - (CORNER[a] if frame == "part" else 0) - (RADIUS * float(row["n" + a]) if point == "surface" else 0)
                        row[a] = f"{v:.7f}"
                    return self.without(row, *TARGET)
                path = self.changed(self.recording, change, f"{frame}_{point}.csv")
                path.write_text(path.read_text().replace("frame: mcs", f"frame: {frame}").replace("point: tip_centre", f"point: {point}"))
                said = self.said(path, "--program", PROGRAM)
                self.assertEqual(self.codes(said), [], (frame, point))   # the program says where the part stood
                self.assertEqual((said["verdict"], said["effects"][0]["members"]), (expected["verdict"], expected["effects"][0]["members"]), (frame, point))

    def test_part_coordinates_need_a_place_in_the_program(self):
        self.recording.write_text(self.recording.read_text().replace("frame: mcs", "frame: part"))
        other = self.changed(self.recording, lambda row: row | {"feature": "OTHER"})
        self.refused("E0544", "diagnose", other, "--program", PROGRAM)


class Placement(Input):
    def test_a_part_off_its_targets_is_no_other_part(self):
        """Beside its targets, or turned too, with the approaches that its program turns along; which of two equal members comes first is rounding."""
        def members(said):
            return said["verdict"], sorted(said["effects"][0]["members"])

        expected = members(self.said(self.recording))
        cos, sin = math.cos(math.radians(1)), math.sin(math.radians(1))

        def turned(x, y):
            return cos * x - sin * y, sin * x + cos * y

        def change(row):
            x, y = turned(float(row["x"]) - 780, float(row["y"]) - 450)
            ax, ay = turned(float(row["ax"]), float(row["ay"]))
            return row | {"x": f"{x + 782:.7f}", "y": f"{y + 450:.7f}", "z": f"{float(row['z']) - 1:.7f}", "ax": f"{ax:.9f}", "ay": f"{ay:.9f}"}
        for path in (self.moved(lambda x, y, z: (x + 0.3, y, z)), self.changed(self.recording, change, "turned.csv")):
            said = self.said(path)
            self.assertEqual(self.codes(said), ["N0709"])
            self.assertEqual(members(said), expected)

    def test_a_reversed_part_is_touched_as_its_program_says(self):
        """Turned by half a turn, and nothing logged but positions: the program travels against the normals of the part wherever that stands."""
        turned = self.moved(lambda x, y, z: (1560 - x, 900 - y, z))
        bare = self.changed(turned, lambda row: {k: row[k] for k in ("feature", "touch", "x", "y", "z")}, "bare.csv")
        text = [line for line in bare.read_text().splitlines() if not line.startswith("# sensor")]
        said = self.said(self.write("bare.csv", "\n".join(text) + "\n"), "--program", PROGRAM)
        self.assertEqual(self.codes(said), ["N0709"])

    def test_a_part_that_is_not_its_drawing_is_compared_with_itself(self):
        """One bore is three millimetres too large, or two faces are tilted and every touch a little off: the rest fits to its targets, and yet only what
        repeats differently can be judged."""
        def wide(row):
            return 1.5 if row["feature"] == "BORE1" else 0

        def rough(row):
            return 0.6 * (int(row["touch"]) % 4 > 1) if row["feature"] in ("PLB", "PLC") else 0.04 * math.sin(float(row["tx"]) + 2 * float(row["ty"]) + 3 * float(row["tz"]))
        for off in (wide, rough):
            def change(row):
                return row | {a: f"{float(row[a]) + off(row) * float(row['n' + a]):.7f}" for a in "xyz"}
            runs = []
            for run in (1, 2):
                self.abbe("record", PROGRAM, "--run", run, "-o", f"run{run}.csv")
                runs.append(self.changed(self.folder / f"run{run}.csv", change, f"off{run}.csv"))
            said = self.said(*runs)
            self.assertIn("W0704", self.codes(said))
            self.assertEqual(said["verdict"], "no_mismatch")

    def test_a_part_that_is_nowhere_its_drawing_is_compared_with_itself(self):
        """Three faces and two bores, off by up to millimetres: beside that as noise nothing would show."""
        faces = {"TOP": ((0, 0, 1), [(-43, 15, 31), (43, 15, 31), (43, -35, 31), (-50, -25, 31)]),
                 "FRONT": ((0, -1, 0), [(19, -53, 23), (19, -53, 15), (-19, -53, 15), (-19, -53, 23)]),
                 "LEFT": ((-1, 0, 0), [(-87, -14, 23), (-87, -29, 23), (-87, -29, 15), (-87, -14, 15)])}
        touches = [(name, n, at) for name, (n, places) in faces.items() for at in places]
        touches += [(name, (-x, -y, 0), (r * x, r * y, z)) for name, r, heights in (("WIDE", 14.5, (23, 17)), ("NARROW", 5.25, (5, 11)))
                    for z in heights for x, y in ((0, 1), (1, 0), (0, -1), (-1, 0))]
        draw, rough = random.Random(2), random.Random(3)
        faces_off = {"TOP": lambda at: -0.6, "FRONT": lambda at: 1 + 0.012 * at[0], "LEFT": lambda at: 1.9 - 0.016 * (at[1] + 21)}
        bore_off = lambda n: 0.15 * n[0] - 0.07 * n[1] + 0.05   # elsewhere, and too small
        wrong = [(faces_off[name](at) if name in faces_off else bore_off(n)) + rough.gauss(0, 0.03) for name, n, at in touches]
        lines = ["run,feature,touch,x,y,z,nx,ny,nz,tx,ty,tz"]
        for run in (1, 2):
            for k, ((name, n, at), by) in enumerate(zip(touches, wrong)):
                out = by + draw.gauss(0, 0.0004)
                lines.append(",".join(map(str, (run, name, k + 1, *(round(a + out * c, 7) for a, c in zip(at, n)), *n, *at))))
        said = self.said(self.write("part.csv", "\n".join(lines) + "\n"))
        self.assertIn("W0704", self.codes(said))
        self.assertEqual(said["verdict"], "no_mismatch")
        self.assertAlmostEqual(said["baseline"]["noise_um"], 0.4, delta=0.15)

    def test_of_targets_instead_of_positions_nothing_is_judged(self):
        machine = json.loads(self.abbe("machine", "init", "m").stdout)
        for component in machine["geometry"]["components"].values():
            component["e_max"] = 0
        machine["specification"]["v_max"] = "unlimited"   # or it is too good for its specification
        self.write("m.json", json.dumps(machine))
        path = self.changed(self.recording, lambda row: row | {a: row["t" + a] for a in "xyz"})
        said = self.said(path, "--machine", "m.json")
        self.assertEqual((said["verdict"], said["p_value"], said["rivals"], self.codes(said)), ("cannot_judge", None, None, ["W0717"]))
        self.assertGreater(len(said["smallest_detectable"]), 5)
        self.assertIn("W0717", self.codes(self.said(path)))       # nor has a machine with errors reported them
        said = self.said(self.recording, "--machine", "m.json")   # and a real one of such a machine is judged
        self.assertIn("probe.tip_radius", said["effects"][0]["members"])

    def test_what_nothing_can_be_judged_of_is_said(self):
        alone = iter(range(1, 1000))
        every_touch_a_setup = self.changed(self.recording, lambda row: row | {"setup": next(alone)}, "setups.csv")
        unknown = self.write("unknown.csv", "# surfaces: unknown\n" + self.recording.read_text())
        for path in (every_touch_a_setup, unknown):
            said = self.said(path, "--fail-on-mismatch")   # no mismatch was found
            self.assertEqual((said["verdict"], said["p_value"], said["effects"]), ("cannot_judge", None, []))
            self.assertIn("W0710", self.codes(said))
            self.assertTrue(said["otherwise"])
            text = self.abbe("diagnose", path, "--report", "page.html").stdout
            self.assertTrue(text.startswith("Nothing can be judged"), text)
            self.assertIn("Nothing can be judged", (self.folder / "page.html").read_text())


class Encodings(Input):
    def test_text_of_windows_is_read(self):
        text = self.recording.read_text().replace("PLA", "FLÄCHE").replace("PROBE", "FÜHLER").replace("# seed: 1", "# Prüfer: Müller")
        for encoding in ("utf-8", "cp1252"):
            path = self.write("text.csv", text.encode(encoding))
            done = self.abbe("diagnose", path, "--design-only", "--format", "json")
            json.loads(done.stdout)
            self.assertEqual("N0617" in done.stderr, encoding == "cp1252")
        self.refused("E0618", "diagnose", self.write("text.csv", text.encode("utf-16")))

    def test_labels_of_a_program_and_a_recording_are_the_same_letters(self):
        program = self.write("part.dmi", PROGRAM.read_text().replace("(PLA)", "(FLÄ)").encode("cp1252"))
        bare = self.changed(self.recording, lambda row: self.without(row, *TARGET), "bare.csv")
        bare.write_bytes(bare.read_text().replace("PLA,", "FLÄ,").encode("cp1252"))
        self.abbe("diagnose", bare, "--program", program, "--design-only", "--format", "json")

    def test_a_result_file_of_windows_is_read(self):
        self.abbe("record", PROGRAM, "-o", "x.csv", "--dmo", "part.dmo")
        result = self.folder / "part.dmo"
        result.write_bytes(result.read_text().replace("OUTPUT", "$$ Prüfer Müller\nOUTPUT", 1).replace("TA(DIA1)", "TA(DIÄ1)").encode("cp1252"))
        program = self.write("part.dmi", PROGRAM.read_text().replace("(DIA1)", "(DIÄ1)").encode("cp1252"))
        json.loads(self.abbe("diagnose", result, "--program", program, "--format", "json").stdout)


class Outputs(Input):
    def test_no_file_of_a_command_is_destroyed(self):
        program = self.write("part.dmi", PROGRAM.read_text())
        before = self.recording.read_text(), program.read_text()
        (self.folder / "link.csv").symlink_to("rec.csv")
        for args in (("diagnose", "rec.csv", "--report", "./rec.csv"), ("diagnose", "rec.csv", "--report", "link.csv"),
                     ("diagnose", "rec.csv", "--report", "out", "--model-out", "out"), ("diagnose", "rec.csv", "--program", program, "--model-out", program),
                     ("record", program, "-o", program), ("record", program, "-o", "out", "--dmo", "out"),
                     ("run", program, "--csv", program), ("run", program, "--recording", "rec.csv", "--dmo", "rec.csv"), ("test", program, "--junit", program)):
            self.refused("E0616", *args)
        self.assertEqual((self.recording.read_text(), program.read_text()), before)
        self.assertFalse((self.folder / "out").exists())

    def test_no_file_that_a_program_names_is_destroyed(self):
        machine, workpiece = json.loads((harness.ROOT / "examples/machines/coord3-mc16.json").read_text()), \
            {"schema": "abbe.workpiece/1", "name": "w", "material": {"cte_ppm_per_K": 11.5}, "temperature": {"log": "log.csv"}}
        text = "".join(line for line in PROGRAM.read_text().splitlines(True) if not line.startswith("$$!"))
        first = text.index("\n") + 1
        named = "$$! machine mine.json\n$$! workpiece w.json\n"
        files = {"mine.json": json.dumps(machine), "w.json": json.dumps(workpiece), "log.csv": "time_s,temp_part_C\n0,20\n",
                 "module.dmi": "DMISMD/'module',5.2\nENDFIL\n",
                 "p.dmi": text[:first] + named + "INCLUD/DMIS,'module.dmi'\n" + text[first:]}
        files["expects.dmi"] = files["p.dmi"].replace(named, named + "$$! expect TA(DIA1) u >= 0\n")
        for name, content in files.items():
            self.write(name, content)
        for target in ("mine.json", "w.json", "log.csv", "module.dmi"):
            for args in (("run", "p.dmi", "--machines", 20, "--csv", target), ("run", "p.dmi", "--machines", 20, "--dmo", target),
                         ("record", "p.dmi", "-o", target), ("record", "p.dmi", "-o", "out.csv", "--dmo", target), ("test", "expects.dmi", "--junit", target)):
                self.refused("E0616", *args)
        for args in (("--program", "p.dmi", "--report", "module.dmi"), ("--workpiece", "w.json", "--report", "log.csv"),
                     ("--workpiece", "w.json", "--model-out", "w.json")):
            self.refused("E0616", "diagnose", "rec.csv", *args)
        self.assertFalse((self.folder / "out.csv").exists())
        self.assertEqual({name: (self.folder / name).read_text() for name in files}, files)

    def piped(self, text, *args):
        """What a command says that reads this text from the pipe `pipe`."""
        os.mkfifo(self.folder / "pipe")
        writer = threading.Thread(target=lambda: (self.folder / "pipe").write_text(text))
        writer.start()
        said = self.abbe(*args).stdout
        writer.join()
        return said

    def test_a_recording_comes_through_a_pipe(self):
        expected = self.abbe("diagnose", "rec.csv", "--design-only", "--format", "json").stdout
        said = self.piped(self.recording.read_text(), "diagnose", "pipe", "--design-only", "--format", "json")
        self.assertEqual(said.replace("pipe", "rec.csv"), expected)

    def test_a_machine_file_comes_through_a_pipe(self):
        machine = (harness.ROOT / "examples/machines/coord3-mc16.json").read_text()
        self.abbe("diagnose", "rec.csv", "--machine", self.write("mine.json", machine), "--model-out", "expected.json")
        self.piped(machine, "diagnose", "rec.csv", "--machine", "pipe", "--model-out", "out.json")
        self.assertEqual((self.folder / "out.json").read_text(), (self.folder / "expected.json").read_text())

    def test_a_pipe_stays_a_pipe(self):
        os.mkfifo(self.folder / "pipe")
        came = []
        reader = threading.Thread(target=lambda: came.append((self.folder / "pipe").read_text()))
        reader.start()
        self.abbe("record", PROGRAM, "-o", "pipe", "--with", "probe.tip_radius:amplitude_um=4")
        reader.join()
        self.assertEqual(came, [self.recording.read_text()])

    def test_who_waits_at_a_terminal_sees_the_step(self):
        """Each step takes the place of the one before, and none stays; a file or a pipe gets none."""
        terminal, stderr = self.pseudo_terminal()
        done = subprocess.run([self.abbe_path, "diagnose", self.recording], stdout=subprocess.PIPE, stderr=stderr, timeout=120)
        os.close(stderr)
        shown = os.read(terminal, 65536).decode()
        os.close(terminal)
        self.assertEqual(done.returncode, 0)
        *steps, rest = shown.split("\r\x1b[K")[1:]
        for step in ("virtual machines of the specification ...", "simulated recordings without a mismatch ...", "the next measurement ..."):
            self.assertIn(step, steps)
        self.assertEqual(rest, "")
        self.assertEqual(self.abbe("diagnose", self.recording).stderr, "")


class Mistakes(Input):
    """What is wrong with a file is said instead of being diagnosed."""
    PLACE = ("x", "y", "z")

    def test_a_plan_finds_nothing_to_write_or_to_fail_on(self):
        for option in (("--model-out", "out.json"), ("--fail-on-mismatch",)):
            done = self.abbe("diagnose", self.recording, "--design-only", *option, code=2)
            self.assertIn(option[0], done.stderr)
        self.assertFalse((self.folder / "out.json").exists())

    def told(self, code, change, *args):
        return self.refused(code, "diagnose", self.changed(self.recording, change), *args)

    def scaled(self, columns, by):
        return lambda row: row | {c: repr(by * float(row[c])) for c in columns}

    def test_units(self):
        targets, readings = ("tx", "ty", "tz"), ("enc_x", "enc_y", "enc_z")
        for columns, by, words in ((targets, 1 / 25.4, "targets are in inches"), (targets, 1e-3, "targets are in metres"), (targets, 1e3, "targets are in micrometres"),
                                   (self.PLACE, 1 / 25.4, "positions are in inches"), (self.PLACE, 1e3, "positions are in micrometres"),
                                   (readings, 1e3, "readings are in micrometres"), (readings, 1 / 25.4, "readings are in inches"),
                                   (self.PLACE + targets + readings, 1e3, "are in micrometres"), (self.PLACE + targets + readings, 1e-3, "are in metres")):
            self.assertIn(words, self.told("E0701", self.scaled(columns, by)))
        self.assertIn("x of the recorded positions is in micrometres", self.told("E0701", self.scaled(("x",), 1e3)))
        half = lambda row: row | ({c: "" for c in readings} if int(row["touch"]) % 2 else {})
        self.assertIn("readings are in inches", self.told("E0701", lambda row: half(self.scaled(readings, 1 / 25.4)(row))))   # some have none
        elsewhere = self.scaled(self.PLACE, 1e-3)
        self.assertIn("in metres", self.told("E0701", lambda row: elsewhere(row | {"x": repr(float(row["x"]) + 500)})))   # wherever the part stood
        self.assertIn("line", self.told("E0530", lambda row: row | {"x": "1e300"}).replace("changed.csv:", "line "))
        self.assertIn("it holds seconds from any moment on", self.told("E0530", lambda row: row | {"time_s": "08:00:10.02"}))

    def test_units_of_readings_where_the_head_turns(self):
        """The readings jump from orientation to orientation; those of one orientation tell the unit."""
        folder = harness.ROOT / "examples/iso10360"
        machine = folder / "portal-2009.json"
        self.abbe("record", folder / "form_and_size_5x25.dmi", "--machine", machine, "-o", "rec.csv")
        readings = ("enc_x", "enc_y", "enc_z")
        for by, unit in ((1 / 25.4, "inches"), (1e-3, "metres"), (1e3, "micrometres")):
            self.assertIn(f"readings are in {unit}", self.told("E0701", self.scaled(readings, by), "--machine", machine))
        self.assertIn("are in radians", self.told("E0701", self.scaled(("head_A_deg", "head_B_deg"), math.pi / 180), "--machine", machine))

    def test_readings_of_other_axes(self):
        exchanged = lambda row: row | {"enc_x": row["enc_y"], "enc_y": row["enc_x"]}
        mirrored = lambda row: row | {"enc_y": repr(-float(row["enc_y"]))}
        self.assertIn("write the columns enc_x, enc_y, enc_z as they are now enc_y, enc_x, enc_z", self.told("E0701", exchanged))
        self.assertIn("the sign of enc_y is turned round", self.told("E0701", mirrored))
        self.assertIn("the sign of enc_z is turned round", self.told("E0701", lambda row: row | {"enc_z": repr(-float(row["enc_z"]))}))
        self.assertIn("enc_x is in micrometres", self.told("E0701", self.scaled(("enc_x",), 1e3)))
        self.assertIn("the sign of x is turned round", self.told("E0701", lambda row: row | {"x": repr(-float(row["x"]))}))  # and not of enc_x

    def test_who_is_wrong_is_told_by_the_others(self):
        """Positions, targets and readings: two of them agree."""
        def times(columns, by):
            return lambda row: row | {c: repr(by * float(row[c])) for c in columns}
        self.assertIn("the signs of x, y and z are turned round", self.told("E0701", times(self.PLACE, -1)))
        self.assertIn("the scale readings agree with tx: divide x by 25.4", self.told("E0701", times(("x",), 25.4)))
        self.assertIn("the scale readings agree with x: tx is in inches", self.told("E0701", times(("tx",), 1 / 25.4)))
        self.assertIn("positions are 25.4 times the targets", self.told("E0701", times(self.PLACE, 25.4)))
        self.assertIn("x, y, z of the recorded positions are the same in all rows", self.told("E0701", lambda row: row | {"x": "500", "y": "300", "z": "-400"}))
        self.assertIn("y of the recorded positions is the same in all rows", self.told("E0701", lambda row: row | {"y": "300"}))
        some = lambda row: row | ({a: repr(1e3 * float(row[a])) for a in self.PLACE} if int(row["touch"]) % 3 == 0 else {})
        self.assertIn("x, y, z are in micrometres there", self.told("E0711", some))

    def test_normals_and_directions_that_contradict_each_other(self):
        """Points that are features by themselves, as they are in files of other programs."""
        folder = harness.ROOT / "examples/iso10360"
        machine = folder / "portal-2009.json"
        self.abbe("record", folder / "form_and_size_5x25.dmi", "--machine", machine, "-o", "rec.csv")
        swapped = lambda of, a, b: lambda row: row | {of + a: row[of + b], of + b: row[of + a]}
        turned = lambda row: row | {"n" + a: repr(-float(row["n" + a])) for a in "xyz"}
        no_travel = lambda row: {k: v for k, v in row.items() if k not in ("ax", "ay", "az")}
        told = lambda change: self.told("E0701", change, "--machine", machine)
        self.assertIn("nx, ny, nz as they are now ny, nx, nz", told(swapped("n", "x", "y")))
        self.assertIn("stand on the balls of the targets: write the columns ax, ay, az as they are now az, ay, ax", told(swapped("a", "x", "z")))
        self.assertIn("the sign of ay is turned round", told(lambda row: row | {"ay": repr(-float(row["ay"]))}))
        self.assertIn("the stylus would come through its material", told(lambda row: no_travel(turned(row))))

    def test_faces_tell_of_exchanged_axes_that_one_column_is_wrong(self):
        exchanged = lambda row: row | {"ax": row["ay"], "ay": row["ax"]}
        told = self.told("E0701", exchanged)
        self.assertIn("write the columns nx, ny, nz as they are now ny, nx, nz; or, where the normals are right, ax, ay, az as they are now ay, ax, az",
                      told.replace("write the columns ax", "ax"))

    def test_no_touch_is_made_along_its_normal(self):
        turned = lambda row: row | ({"n" + a: repr(-float(row["n" + a])) for a in "xyz"} if row["feature"] == "PLB" else {})
        for options in ((), ("--program", PROGRAM)):
            told = self.told("E0701", turned, *options)
            self.assertIn("at touch 1 of 'PLB' the machine travels along the normal, out of the material, not against it (in all 4 of 'PLB')", told)
        no_travel = lambda row: {k: v for k, v in row.items() if k not in ("ax", "ay", "az")}
        self.assertIn("at touch 1 of 'PLB'", self.told("E0701", lambda row: no_travel(turned(row)), "--program", PROGRAM))
        along = lambda row: row | ({"ax": "0", "ay": "0", "az": "1"} if row["feature"] == "PLB" and row["touch"] == "3" else {})
        self.assertRegex(self.told("E0701", along), r"at touch 3 of 'PLB' the machine travels along the surface, which touches nothing\n")

    def test_a_hollow_ball_is_told_and_judged(self):
        """Normals that point into a ball whose stylus nobody knows: it may be hollow."""
        folder = harness.ROOT / "examples/iso10360"
        self.abbe("record", folder / "form_and_size_1x25.dmi", "--machine", folder / "portal-2009.json", "-o", "rec.csv")
        inward = lambda row: {k: row[k] for k in ("feature", "touch", *self.PLACE, *TARGET[:3])} | {"n" + a: repr(-float(row["n" + a])) for a in "xyz"}
        path = self.changed(self.recording, inward)
        path.write_text("".join(line for line in path.read_text().splitlines(True) if not line.startswith("#")))
        self.assertIn("N0733", self.codes(self.said(path, "--machine", folder / "portal-2009.json")))

    def test_two_rings_of_a_bore_are_no_hollow_ball(self):
        """They lie on a ball, but their normals do not stand on it."""
        rows = ["feature,touch,x,y,z,tx,ty,tz,nx,ny,nz"]
        for k in range(24):
            a, z = math.tau * (k % 12) / 12, -500 - 12 * (k // 12)
            at = [f"{v:.6f}" for v in (500 + 18 * math.cos(a), 400 + 18 * math.sin(a), z)]
            rows.append(",".join(["BORE", str(k + 1), *at, *at, f"{-math.cos(a):.9f}", f"{-math.sin(a):.9f}", "0"]))
        said = self.said(self.write("bore.csv", "\n".join(rows) + "\n"), "--machine", "coord3-mc16")
        self.assertNotIn("N0733", self.codes(said))

    def test_a_recording_names_a_machine_beside_it(self):
        machine = (harness.ROOT / "examples/machines/moving-table-700.json").read_text()
        self.write("there/mm2.json", machine)
        named = self.write("there/rec.csv", self.recording.read_text().replace("# machine: coord3-mc16", "# machine: mm2.json"))
        found, meant, other = (self.said(named, "--design-only", *options) for options in ((), ("--machine", "there/mm2.json"), ("--machine", "coord3-mc16")))
        self.assertEqual(found, meant)
        self.assertNotEqual(found, other)
        alone = self.write("rec2.csv", named.read_text())
        message = self.refused("E0411", "diagnose", alone)
        self.assertIn("rec2.csv: '# machine: mm2.json'", message)
        self.said(alone, "--machine", "coord3-mc16", "--design-only")   # whoever names one need not have the other

    def test_a_wrong_tip(self):
        def out(by):
            return lambda row: row | {a: repr(float(row[a]) + by * float(row["n" + a])) for a in self.PLACE}
        for by in (0.1, -0.1, 2, -4):
            self.assertIn("tip radius", self.told("E0701", out(by)))
        for feature, by, words in (("BORE2", -4, "too far in along its normal, which is the diameter"), ("PLB", 2, "which is the radius")):
            said = self.told("E0701", lambda row: out(by)(row) if row["feature"] == feature else row)
            self.assertIn(f"every touch of '{feature}' is", said)
            self.assertIn(words, said)
        lines = self.recording.read_text().splitlines()
        placed = self.changed(self.recording, lambda row: row | {"setup": "2"}, "placed.csv").read_text().splitlines()
        both = self.write("both.csv", "\n".join(lines + [line for line in placed if not line.startswith("#")][1:]) + "\n")
        again = self.changed(both, lambda row: out(0.0004)(out(2)(row) if row["feature"] == "PLB" else row) if row["setup"] == "2" else row, "again.csv")
        self.assertIn("every touch of 'PLB' in setup 2 is", self.refused("E0701", "diagnose", again))
        sizes = self.changed(self.recording, out(0.1))
        sizes.write_text("# surfaces: unknown_size\n" + sizes.read_text())
        self.abbe("diagnose", sizes)

    def test_touches_beside_their_targets(self):
        def lost(wrong):
            return lambda row: row | ({"y": repr(float(row["y"]) + 40)} if (row["feature"], row["touch"]) in wrong else {})
        few = self.abbe("diagnose", self.changed(self.recording, lost([("PLA", "3")])))
        self.assertIn("W0712", few.stderr)
        self.assertIn("touch 3 of 'PLA'", few.stderr)
        turned = lambda row: row | ({"touch": str(int(row["touch"]) % 12 + 1)} if row["feature"] == "BORE2" else {})
        bare = self.changed(self.recording, lambda row: self.without(turned(row), *TARGET), "bare.csv")
        self.assertIn("of 'BORE2'", self.refused("E0711", "diagnose", bare, "--program", PROGRAM))

    def test_a_touch_counts_once(self):
        lines = self.recording.read_text().splitlines()
        copied = self.write("copied.csv", "\n".join(lines + lines[-30:]) + "\n")
        said = self.said(copied)
        self.assertEqual((self.codes(said), said["touches"]), (["W0702"], 37))
        first = lambda row: row | {"x": repr(float(row["x"]) + 0.003)}
        other = self.changed(self.recording, first, "other.csv").read_text().splitlines()
        self.refused("E0713", "diagnose", self.write("two.csv", "\n".join(lines + other[-30:]) + "\n"))
        copy = self.write("again.csv", self.recording.read_text())
        self.refused("E0713", "diagnose", self.recording, copy)
        self.refused("E0713", "diagnose", self.write("other.csv", "\n".join(other) + "\n"), self.recording, copy)

    def test_a_run_that_was_copied_is_no_repeat(self):
        lines = self.recording.read_text().splitlines()
        header = next(k for k, line in enumerate(lines) if not line.startswith("#"))
        run = lines[header].split(",").index("run")
        def as_run(line, number):
            fields = line.split(",")
            return ",".join(fields[:run] + [str(number)] + fields[run + 1:])
        whole = self.write("runs.csv", "\n".join(lines + [as_run(line, 2) for line in lines[header + 1:]]) + "\n")
        self.assertIn("run 2 of setup 1 holds the same touches as run 1 of setup 1", self.refused("E0713", "diagnose", whole))

    def test_rows_without_a_target_are_named(self):
        some = self.changed(self.recording, lambda row: row | {c: "" for c in TARGET} if row["feature"] == "BORE2" else row)
        none = self.changed(self.recording, lambda row: self.without(row, *TARGET), "none.csv")
        self.assertIn("of 'BORE2' has no target", self.refused("E0543", "diagnose", some))
        self.assertIn("touch 1 of 'PLA' has no target", self.refused("E0543", "diagnose", none))
        pointless = self.changed(self.recording, lambda row: self.without(row, "nx", "ny", "nz"), "pointless.csv")
        self.assertRegex(self.refused("E0543", "diagnose", pointless), "touch 1 of 'PLA' has no normal\n.*give the columns nx, ny, nz, or")
        unlike = lambda row: self.without(row | {"run": "2", "z": repr(float(row["z"]) + 1e-4)}, *TARGET)
        of_two = self.refused("E0543", "diagnose", self.recording, self.changed(self.recording, unlike, "second.csv"))
        self.assertRegex(of_two, r"E0543\]?: \S*second\.csv:\d+: touch")

    def test_who_gives_a_plan_hears_how_a_plan_is_asked(self):
        plan = self.changed(self.recording, lambda row: self.without(row, "x", "y", "z"), "plan.csv")
        self.assertIn("--design-only says", self.refused("E0527", "diagnose", plan))

    def test_targets_in_the_place_of_some_positions_are_left_out(self):
        in_order = self.folder / "in_order.csv"
        self.abbe("record", PROGRAM, "-o", in_order)
        other = lambda row: row | {a: row["t" + a] for a in "xyz"} if int(row["touch"]) % 3 == 0 else row
        left_out = lambda row: None if int(row["touch"]) % 3 == 0 else row
        said, without = self.said(self.changed(in_order, other)), self.said(self.changed(in_order, left_out, "fewer.csv"))
        self.assertEqual((self.codes(said), said["verdict"]), (["W0717"], "no_mismatch"))
        self.assertEqual((said["touches"], said["p_value"]), (without["touches"], without["p_value"]))
        rounded = lambda row: row | {a: f"{float(row[a]):.2f}" for a in "xyz"} | {"t" + a: f"{float(row['t' + a]):.2f}" for a in "xyz"}
        self.assertNotIn("W0717", self.codes(self.said(self.changed(in_order, rounded, "rounded.csv"))))   # by chance

    def test_tables_of_another_kind(self):
        text = self.recording.read_text()
        self.assertIn("semicolons", self.refused("E0531", "diagnose", self.write("bad.csv", text.replace(",", ";"))))
        self.assertIn("tabs", self.refused("E0531", "diagnose", self.write("bad.csv", text.replace(",", "\t"))))

    def test_a_sensor_that_nobody_describes_is_named_at_its_row(self):
        lines = self.recording.read_text().splitlines()
        at = next(k for k, line in enumerate(lines) if line.startswith("BORE1,1,"))
        lines[at] = lines[at].replace("PROBE", "FINGER")
        self.assertIn(f"bad.csv:{at + 1}: ", self.refused("E0301", "diagnose", self.write("bad.csv", "\n".join(lines) + "\n")))

    def test_machines_that_do_not_fit(self):
        repeat = self.changed(self.recording, lambda row: row | {"run": "2", "z": repr(float(row["z"]) + 1e-4)}, "repeat.csv")
        repeat.write_text(repeat.read_text().replace("# machine: coord3-mc16", "# machine: other"))
        self.assertIn("W0714", self.abbe("diagnose", self.recording, repeat, "--design-only").stderr)
        self.abbe("machine", "init", "mine.json")
        spelt = self.write("spelt.csv", self.recording.read_text().replace("machine: coord3-mc16", "machine: mine.json"))
        for other, warned in (("./mine.json", False), (self.folder / "mine.json", False), ("coord3-mc16", True)):
            repeat.write_text(repeat.read_text().replace("# machine: other", f"# machine: {other}"))
            self.assertEqual("W0714" in self.abbe("diagnose", spelt, repeat, "--design-only").stderr, warned, other)
            repeat.write_text(repeat.read_text().replace(f"# machine: {other}", "# machine: other"))
        self.assertIn("W0715", self.abbe("diagnose", self.recording, "--known", "mine.json", "--design-only").stderr)
        other = json.loads((self.folder / "mine.json").read_text()) | {"name": "another"}
        self.write("another.json", json.dumps(other))
        said = self.abbe("diagnose", self.recording, "--known", "another.json", "--design-only").stderr
        self.assertIn("'another.json' knows machine 'another', the recording is of 'coord3-mc16': it is compared with what is known of 'another'", said)
        said = self.abbe("diagnose", self.recording, "--known", "another.json", "--machine", "coord3-mc16", "--design-only").stderr
        self.assertIn("--machine says 'coord3-mc16'", said)
        self.refused("E0601", "diagnose", self.recording, "--known", "another.json", "--machine", "nowhere.json", "--design-only")


    def test_a_number_beyond_its_range_is_told_as_such(self):
        far = self.changed(self.recording, lambda row: row | {"x": "1e11"} if row["touch"] == "3" else row)
        said = self.refused("E0530", "diagnose", far)
        self.assertIn("a number in mm from -", said)
        self.assertNotIn("E0528", said)

    def test_the_file_that_holds_values_is_named(self):
        values = self.write("values.csv", "program,characteristic,value\np.dmi,T1,1.0\n")
        self.assertIn("'values.csv' holds values", self.refused("E0554", "diagnose", self.recording, values).replace(str(self.folder) + "/", ""))
        self.assertIn("values.csv:2", self.refused("E0601", "diagnose", values))   # no program of that name


class Values(Input):
    def test_units_of_values(self):
        for value, words in (("29999.1", "micrometres"), ("0.0299991", "metres"), ("1.18107", "inches")):
            path = self.write("values.csv", f"characteristic,value\nDIA1,{value}\n")
            self.assertIn(words, self.refused("E0701", "diagnose", path, "--program", PROGRAM))
        path = self.write("values.csv", "characteristic,value,reference\nPITCH,80.0004,80000\n")
        self.assertIn("micrometres", self.refused("E0701", "diagnose", path, "--program", PROGRAM))


if __name__ == "__main__":
    harness.main()
